// Elevation files for tests, in a folder that is removed with the object.
#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

namespace tyndall::scene {

struct TestFile {
  const char* name = "test.tif";
  const char* driver = "GTiff";
  int width = 64, height = 64;
  int bands = 1;
  GDALDataType type = GDT_Float32;
  std::array<double, 6> transform = {500000.0, 100.0, 0.0, 5000000.0, 0.0, -100.0};
  bool placed = true;
  int epsg = 32632;  // 0: no coordinate system
  const char* unit = "";
  double scale = 1.0, offset = 0.0;
  bool has_no_data = false;
  double no_data = 0.0;
  std::string definition = {};                     // of the coordinate system, instead of `epsg`
  std::function<void(GDALDataset&)> prepare = {};  // changes the data set before it is stored
};

class TestFolder {
 public:
  TestFolder() : path_(std::filesystem::temp_directory_path() / ("tyndall_terrain_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
    GDALAllRegister();
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] std::filesystem::path path(const char* name) const { return path_ / name; }

  // Writes value(column, row) into every band. Files of formats that GDAL cannot create directly are copied from
  // memory.
  std::filesystem::path write(const TestFile& file, const std::function<double(int, int)>& value) const {
    GDALDriverManager& drivers = *GetGDALDriverManager();
    GDALDataset* data =
        drivers.GetDriverByName("MEM")->Create("", file.width, file.height, file.bands, file.type, nullptr);
    if (file.placed) {
      std::array<double, 6> transform = file.transform;
      data->SetGeoTransform(transform.data());
    }
    if (file.epsg != 0) {
      OGRSpatialReference srs;
      srs.importFromEPSG(file.epsg);
      data->SetSpatialRef(&srs);
    }
    if (!file.definition.empty()) {
      OGRSpatialReference srs;
      srs.SetFromUserInput(file.definition.c_str());
      data->SetSpatialRef(&srs);
    }
    std::vector<double> samples(static_cast<std::size_t>(file.width) * file.height);
    for (int y = 0; y < file.height; ++y) {
      for (int x = 0; x < file.width; ++x) samples[static_cast<std::size_t>(y) * file.width + x] = value(x, y);
    }
    for (int b = 1; b <= file.bands; ++b) {
      GDALRasterBand& band = *data->GetRasterBand(b);
      if (band.RasterIO(GF_Write, 0, 0, file.width, file.height, samples.data(), file.width, file.height, GDT_Float64,
                        0, 0, nullptr) != CE_None)
        ADD_FAILURE() << "writing samples";
      if (file.unit[0] != '\0') band.SetUnitType(file.unit);
      if (file.scale != 1.0) band.SetScale(file.scale);
      if (file.offset != 0.0) band.SetOffset(file.offset);
      if (file.has_no_data) band.SetNoDataValue(file.no_data);
    }
    if (file.prepare) file.prepare(*data);
    std::filesystem::path to = path(file.name);
    GDALDataset* copy =
        drivers.GetDriverByName(file.driver)->CreateCopy(to.string().c_str(), data, FALSE, nullptr, nullptr, nullptr);
    EXPECT_NE(copy, nullptr) << file.driver;
    if (copy != nullptr) GDALClose(copy);
    GDALClose(data);
    return to;
  }

 private:
  std::filesystem::path path_;
};

// Returns the path of the real file that some tests use if present.
inline std::filesystem::path real_file() {
  const char* folder = std::getenv("TYNDALL_DATA_DIR");
  const std::filesystem::path base = folder != nullptr
                                         ? std::filesystem::path(folder)
                                         : std::filesystem::path(TYNDALL_SOURCE_DIR).parent_path() / "shared" / "data";
  return base / "mont-blanc.tif";
}

}  // namespace tyndall::scene
