// Opening elevation files: errors, files inside archives, files that other files refer to, and no network connections.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <new>

#include <cpl_conv.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "scene/elevation/elevation_child.hpp"
#include "terrain_file_fixture.hpp"

namespace tyndall::scene {
namespace {

TEST_F(ElevationFile, ErrorsAreOneLine) {
  EXPECT_NE(error(folder_.path("missing.tif")).find("does not exist"), std::string::npos);
  std::filesystem::create_directory(folder_.path("folder.tif"));
  EXPECT_NE(error(folder_.path("folder.tif")).find("directory"), std::string::npos);
  std::ofstream(folder_.path("empty.tif")).close();
  EXPECT_NE(error(folder_.path("empty.tif")).find("empty"), std::string::npos);
  std::ofstream(folder_.path("text.tif")) << "no elevations here\n";
  EXPECT_NE(error(folder_.path("text.tif")).find("unsupported format"), std::string::npos);

  TestFile narrow;
  narrow.name = "narrow.tif";
  narrow.width = 1;
  EXPECT_NE(error(folder_.write(narrow, hill)).find("1 x 64 samples"), std::string::npos);
  TestFile complex;
  complex.name = "complex.tif";
  complex.type = GDT_CFloat32;
  EXPECT_NE(error(folder_.write(complex, hill)).find("complex"), std::string::npos);
  TestFile holes;
  holes.name = "holes.tif";
  EXPECT_NE(error(folder_.write(holes, [](int, int) { return 1e30; })).find("every sample is a hole"),
            std::string::npos);
}

TEST_F(ElevationFile, TruncatedFiles) {
  TestFile file;
  file.name = "whole.tif";
  file.width = file.height = 256;
  const std::filesystem::path whole = folder_.write(file, hill);
  const auto size = std::filesystem::file_size(whole);
  for (const double part : {0.02, 0.3, 0.6, 0.95}) {
    const std::filesystem::path cut = folder_.path("cut.tif");
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(static_cast<double>(size) * part));
    error(cut);
  }
}

// GDAL runs in a child process. libnetcdf 4.9 crashes on this file, whose header claims 2^30 variables.
TEST_F(ElevationFile, ACrashOfItsReaderIsAnError) {
  const std::filesystem::path file = folder_.path("counts.nc");
  constexpr std::string_view kHexadecimal =
      "43444601000000000000000a0000000200000001790000000000000300000001780000000000000300000000"
      "000000000000000b40000001000000017a000000000000020000000000000001000000000000000000000005"
      "0000002400000060000000003f80000040000000404000004080000040a0000040c0000040e0000041000000";
  std::ofstream out(file, std::ios::binary);
  for (std::size_t i = 0; i < kHexadecimal.size(); i += 2)
    out.put(static_cast<char>(std::stoi(std::string(kHexadecimal.substr(i, 2)), nullptr, 16)));
  out.close();
  EXPECT_NE(error(file).find("has an unsupported format or is damaged"), std::string::npos) << error(file);
  EXPECT_EQ(elevation_file_list(file.string()), std::vector<std::string>{file.string()});
}

TEST_F(ElevationFile, ChildProcessesHaveLimits) {
  const auto message = [](const std::function<std::string()>& work) {
    const Result<std::string> done = in_child("a.tif", work);
    return done.ok() ? "ok: " + done.value() : done.error().message;
  };
  EXPECT_EQ(message([] { return std::string("text"); }), "ok: text");
  EXPECT_EQ(message([] { return std::string(3000000, 'x'); }).size(), 3000004U);
  EXPECT_EQ(message([]() -> std::string { std::abort(); }),
            "elevation file a.tif has an unsupported format or is damaged (its reader crashed)");
  EXPECT_EQ(message([]() -> std::string {
              ::raise(SIGXCPU);
              return "";
            }),
            "elevation file a.tif cannot be read within 300 s of processor time");
  EXPECT_EQ(message([]() -> std::string {
              ::raise(SIGINT);
              return "";
            }),
            "elevation file a.tif was not read: interrupted");
  EXPECT_EQ(message([]() -> std::string { throw std::bad_alloc(); }), "elevation file a.tif does not fit into memory");
  // The state of the parent is not changed.
  int value = 1;
  EXPECT_EQ(message([&] {
              value = 2;
              return std::to_string(value);
            }),
            "ok: 2");
  EXPECT_EQ(value, 1);
}

TEST_F(ElevationFile, GdalNamesAreRead) {
  TestFile file;
  file.name = "plain.tif";
  const std::filesystem::path plain = folder_.write(file, hill);
  const std::string zip = "/vsizip/" + folder_.path("archive.zip").string() + "/inside.tif";
  ASSERT_EQ(CPLCopyFile(zip.c_str(), plain.string().c_str()), 0);
  EXPECT_EQ(read(zip).heights, read(plain).heights);
  EXPECT_EQ(read("GTIFF_DIR:1:" + plain.string()).heights, read(plain).heights);
  EXPECT_NE(error("/vsizip/" + folder_.path("archive.zip").string() + "/missing.tif").find("unsupported format"),
            std::string::npos);
}

// Downloaded files must not open connections: a virtual raster that refers to a server, and a description of a service.
TEST_F(ElevationFile, FilesDoNotReachTheNetwork) {
  // A listener that must receive no connection.
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(listener, 8), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string server = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  CPLSetConfigOption("GDAL_HTTP_TIMEOUT", "2");  // limits a connection that should not happen
  const auto vrt =
      [&](const char* name, const std::string& source) {
        std::ofstream(folder_.path(name))
            << "<VRTDataset rasterXSize=\"8\" rasterYSize=\"8\"><VRTRasterBand dataType=\"Float32\" band=\"1\">"
               "<SimpleSource><SourceFilename relativeToVRT=\"0\">"
            << source << "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
        return folder_.path(name);
      };
  for (const std::string& source : {"/vsicurl/" + server + "/a.tif", std::string("/vsis3/bucket/a.tif"),
                                    "/vsizip//vsicurl/" + server + "/a.zip/a.tif"}) {
    EXPECT_NE(error(vrt("curl.vrt", source)).find("refers to a network file system"), std::string::npos) << source;
  }
  // A second virtual raster between them is opened only when its samples are read.
  const std::string inner = vrt("inner.vrt", "/vsicurl/" + server + "/a.tif").string();
  error(vrt("outer.vrt", inner));
  std::ofstream(folder_.path("wms.xml"))
      << "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" << server
      << "/${z}/${x}/${y}</ServerUrl></Service>"
         "<DataWindow><UpperLeftX>-20037508.34</UpperLeftX><UpperLeftY>20037508.34</UpperLeftY>"
         "<LowerRightX>20037508.34</LowerRightX><LowerRightY>-20037508.34</LowerRightY><TileLevel>3</TileLevel>"
         "<TileCountX>1</TileCountX><TileCountY>1</TileCountY></DataWindow><Projection>EPSG:3857</Projection>"
         "<BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY><BandsCount>3</BandsCount></GDAL_WMS>";
  EXPECT_NE(error(folder_.path("wms.xml")).find("has an unsupported format or is damaged"), std::string::npos);
  error(vrt("wms.vrt", folder_.path("wms.xml").string()));
  error(vrt("http.vrt", server + "/a.tif"));
  pollfd waiting = {listener, POLLIN, 0};
  EXPECT_EQ(::poll(&waiting, 1, 0), 0) << "something connected";
  ::close(listener);
  // Virtual rasters over local files are read.
  TestFile file;
  file.name = "local.tif";
  folder_.write(file, hill);
  file.driver = "VRT";
  file.name = "local.vrt";
  std::ofstream(folder_.path("local.vrt"))
      << "<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"><GeoTransform>0, 100, 0, 6400, 0, -100</GeoTransform>"
         "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
         "relativeToVRT=\"1\">local.tif</SourceFilename>"
         "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
  EXPECT_FLOAT_EQ(at(read(folder_.path("local.vrt")), 5, 7), static_cast<float>(hill(5, 7)));
}

TEST_F(ElevationFile, FilesOfAVirtualRasterAreListed) {
  const auto vrt = [&](const char* name, const std::string& of) {
    const std::filesystem::path path = folder_.path(name);
    std::ofstream(path)
        << "<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"><VRTRasterBand dataType=\"Float32\" band=\"1\">"
           "<SimpleSource><SourceFilename relativeToVRT=\"1\">"
        << of << "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    return path.string();
  };
  const std::string file = folder_.write({}, hill).string();
  const std::string inner = vrt("inner.png", "test.tif");
  const std::string outer = vrt("outer.vrt", "inner.png");
  std::vector<std::string> listed = elevation_file_list(outer);
  std::sort(listed.begin(), listed.end());
  std::vector<std::string> expected = {file, inner, outer};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(listed, expected);
  EXPECT_EQ(elevation_file_list(file), std::vector<std::string>{file});
  // A file that cannot be opened lists only itself.
  const std::string dangling = vrt("dangling.vrt", "none.tif");
  EXPECT_EQ(elevation_file_list(dangling).front(), dangling);
  EXPECT_EQ(elevation_file_list("/nonexistent.vrt"), std::vector<std::string>{"/nonexistent.vrt"});
}

}  // namespace
}  // namespace tyndall::scene
