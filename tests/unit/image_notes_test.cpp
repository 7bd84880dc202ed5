// What the readers of images ignore is noted.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <png.h>
#include <unistd.h>

#include "image/image.hpp"

namespace tyndall::image {
namespace {

class ImageNotes : public testing::Test {
 protected:
  ImageNotes() : folder_(std::filesystem::temp_directory_path() / ("tyndall-notes-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ImageNotes() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  // Writes a PNG of two pixels and returns the note of its reader.
  std::string note_of_png(int color_type, double gamma) {
    const std::string path = (folder_ / "x.png").string();
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 1, 8, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (gamma > 0.0) png_set_gAMA(png, info, gamma);
    png_write_info(png, info);
    const std::vector<png_byte> row = {10, 20, 30, 40, 50, 60, 70, 80};
    png_write_row(png, row.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
    return note(path);
  }
  // Writes an EXR of one pixel with these channels, and returns the note of its reader.
  std::string note_of_exr(const std::vector<std::string>& channels, const Imf::Chromaticities* primaries = nullptr) {
    const std::string path = (folder_ / "x.exr").string();
    Imf::Header header(1, 1);
    if (primaries != nullptr) Imf::addChromaticities(header, *primaries);
    float value = 0.5F;
    Imf::FrameBuffer buffer;
    for (const std::string& name : channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), 4, 4));
    }
    {
      Imf::OutputFile file(path.c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(1);
    }
    return note(path);
  }

 private:
  static std::string note(const std::string& path) {
    const Result<File> file = read(path);
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
    return file.ok() ? file.value().note : "";
  }

  std::filesystem::path folder_;
};

TEST_F(ImageNotes, TransparencyAndGammaOfPng) {
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB, 0.0), "");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB, 0.45455), "");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB_ALPHA, 0.0), "its transparency is ignored");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB_ALPHA, 1.0),
            "its transparency is ignored; its gamma is ignored, and the sRGB curve is assumed");
}

TEST_F(ImageNotes, ChannelsAndPrimariesOfExr) {
  EXPECT_EQ(note_of_exr({"R", "G", "B"}), "");
  EXPECT_EQ(note_of_exr({"R", "G", "B", "A"}), "its channel A is ignored");
  EXPECT_EQ(note_of_exr({"X", "Y", "Z"}), "its channels X, Z are ignored");
  EXPECT_EQ(note_of_exr({"R", "G", "B", "a", "b", "c", "d", "e"}), "its channels a, b, c, d, ... are ignored");
  const Imf::Chromaticities rec709;
  EXPECT_EQ(note_of_exr({"R", "G", "B"}, &rec709), "");
  const Imf::Chromaticities xyz({1.0F, 0.0F}, {0.0F, 1.0F}, {0.0F, 0.0F}, {1.0F / 3.0F, 1.0F / 3.0F});
  EXPECT_EQ(note_of_exr({"R", "G", "B"}, &xyz), "its primaries are not those of Rec. 709, and are ignored");
}

}  // namespace
}  // namespace tyndall::image
