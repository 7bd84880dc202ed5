// The unit of the heights in an elevation file.
#include <array>
#include <cmath>
#include <cstdlib>

#include <cpl_string.h>
#include <ogr_spatialref.h>

#include "files/text.hpp"
#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

// Returns the metres per unit, or 0 for an unknown name.
double metres_per(const std::string& name) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr double kFoot = 0.3048;
  constexpr double kSurveyFoot = 1200.0 / 3937.0;
  constexpr std::array<Unit, 24> kUnits = {{{"m", 1.0},
                                            {"metre", 1.0},
                                            {"meter", 1.0},
                                            {"metres", 1.0},
                                            {"meters", 1.0},
                                            {"ft", kFoot},
                                            {"foot", kFoot},
                                            {"feet", kFoot},
                                            {"international foot", kFoot},
                                            {"us survey foot", kSurveyFoot},
                                            {"us survey feet", kSurveyFoot},
                                            {"us_survey_foot", kSurveyFoot},
                                            {"foot_us", kSurveyFoot},
                                            {"us-ft", kSurveyFoot},
                                            {"ftus", kSurveyFoot},
                                            {"mm", 0.001},
                                            {"cm", 0.01},
                                            {"centimetre", 0.01},
                                            {"centimeter", 0.01},
                                            {"dm", 0.1},
                                            {"decimetre", 0.1},
                                            {"decimeter", 0.1},
                                            {"decimeters", 0.1},
                                            {"km", 1000.0}}};
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return unit.metres;
  }
  return 0.0;
}

// Returns the name of the unit in the projection file (.prj) that belongs to a data set, or an empty string. Old files
// of ESRI have a line such as "Zunits FEET", which GDAL ignores. Some have a number of units per metre instead of a
// name.
std::string unit_of_projection_file(GDALDataset& file) {
  const CPLStringList parts(file.GetFileList());
  for (int i = 0; i < parts.Count(); ++i) {
    if (!files::lower_case(parts[i]).ends_with(".prj")) continue;
    const CPLStringList lines(CSLLoad2(parts[i], 100, 1000, nullptr));
    for (int k = 0; k < lines.Count(); ++k) {
      const CPLStringList words(CSLTokenizeString(lines[k]));
      if (words.Count() == 2 && files::lower_case(words[0]) == "zunits" && files::lower_case(words[1]) != "no")
        return files::lower_case(words[1]);
    }
  }
  return {};
}

// The vertical axis of a coordinate system: that of a compound one, or the third of a three-dimensional one.
struct VerticalAxis {
  double metres = 0.0;  // per unit; 0 if there is no such axis
  OGRAxisOrientation orientation = OAO_Up;
};

VerticalAxis vertical_axis(const OGRSpatialReference* srs) {
  VerticalAxis axis;
  if (srs == nullptr || srs->IsGeocentric() != 0) return axis;
  if (srs->IsCompound() != 0) {
    if (srs->GetAxis("VERT_CS", 0, &axis.orientation) != nullptr) axis.metres = srs->GetTargetLinearUnits("VERT_CS");
  } else if (srs->GetAxesCount() == 3) {
    double metres = 0.0;
    if (srs->GetAxis(nullptr, 2, &axis.orientation, &metres) != nullptr) axis.metres = metres;
  }
  return axis;
}

// Notes that metres are assumed in a file whose horizontal coordinates have another unit: its heights often have it
// too.
void note_horizontal_unit(const OGRSpatialReference* srs, std::vector<std::string>& notes) {
  const char* name = nullptr;
  if (srs == nullptr || srs->IsProjected() == 0 || std::abs(srs->GetLinearUnits(&name) - 1.0) < 1e-6) return;
  notes.push_back(
      "the unit of the heights is not declared; metres are assumed, although horizontal coordinates have the "
      "unit '" +
      files::one_line(name == nullptr ? "" : name, 60) + "'");
}

// Returns the unit of the heights [m], whatever the direction of their axis is.
double unsigned_unit_m(GDALDataset& stored, GDALDataset& read, std::vector<std::string>& notes) {
  std::string name = files::lower_case(read.GetRasterBand(1)->GetUnitType());
  if (name.empty()) {
    const double metres = vertical_axis(read.GetSpatialRef()).metres;
    if (metres > 0.0) return metres;
    name = unit_of_projection_file(stored);
    if (name.empty()) {
      note_horizontal_unit(read.GetSpatialRef(), notes);
      return 1.0;
    }
    const double per_metre = std::strtod(name.c_str(), nullptr);
    if (per_metre > 0.0 && std::isfinite(per_metre)) return 1.0 / per_metre;
  }
  const double metres = metres_per(name);
  if (metres > 0.0) return metres;
  notes.push_back("the unit of the heights, '" + name + "', is unknown; metres are assumed");
  return 1.0;
}

}  // namespace

double height_unit_m(GDALDataset& stored, GDALDataset& read, std::vector<std::string>& notes) {
  const double unit_m = unsigned_unit_m(stored, read, notes);
  if (vertical_axis(stored.GetSpatialRef()).orientation != OAO_Down) return unit_m;
  notes.emplace_back("its vertical axis points down: depths are converted to heights");
  return -unit_m;
}

}  // namespace tyndall::scene
