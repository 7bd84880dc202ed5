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

// Returns the unit of the heights [m], whatever the direction of their axis is.
double unsigned_unit_m(GDALDataset& stored, GDALDataset& read, std::vector<std::string>& notes) {
  std::string name = files::lower_case(read.GetRasterBand(1)->GetUnitType());
  if (name.empty()) {
    const OGRSpatialReference* const srs = read.GetSpatialRef();
    const double metres = srs != nullptr && srs->IsCompound() != 0 ? srs->GetTargetLinearUnits("VERT_CS") : 0.0;
    if (metres > 0.0) return metres;
    name = unit_of_projection_file(stored);
    if (name.empty()) return 1.0;
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
  const OGRSpatialReference* const srs = stored.GetSpatialRef();
  OGRAxisOrientation orientation = OAO_Up;
  if (srs == nullptr || srs->IsCompound() == 0 || srs->GetAxis("VERT_CS", 0, &orientation) == nullptr ||
      orientation != OAO_Down)
    return unit_m;
  notes.emplace_back("its vertical axis points down: depths are converted to heights");
  return -unit_m;
}

}  // namespace tyndall::scene
