// What the readers of images ignore is noted.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
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
  std::string note_of_png(int color_type, double gamma,
                          const std::function<void(png_structp, png_infop)>& prepare = {}) {
    const std::string path = (folder_ / "x.png").string();
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 1, 8, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (gamma > 0.0) png_set_gAMA(png, info, gamma);
    if (prepare) prepare(png, info);
    png_write_info(png, info);
    if (!code_points_.empty())
      png_write_chunk(png, reinterpret_cast<png_const_bytep>("cICP"), code_points_.data(), code_points_.size());
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

  // Writes an EXR of 4 x 4 pixels with luminance and chroma, and returns the error of its reader.
  std::string error_of_chroma(float luminance, int sampling) {
    Imf::Header header(4, 4);
    std::vector<float> values(16, luminance), chroma(16, 0.0F);
    Imf::FrameBuffer buffer;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 16));
    for (const char* name : {"RY", "BY"}) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT, sampling, sampling));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(chroma.data()), 4, 16, sampling, sampling));
    }
    {
      Imf::OutputFile file(at("yc.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(4);
    }
    const Result<File> file = read(at("yc.exr"));
    return file.ok() ? "" : file.error().message;
  }

  [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }

  std::vector<png_byte> code_points_;  // of the chunk cICP; empty: without this chunk

  static std::string note(const std::string& path) {
    const Result<File> file = read(path);
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
    return file.ok() ? file.value().note : "";
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(ImageNotes, TransparencyAndGammaOfPng) {
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB, 0.0), "");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB, 0.45455), "");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB_ALPHA, 0.0), "its transparency is ignored");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB_ALPHA, 1.0),
            "its transparency is ignored; its gamma is ignored, and the sRGB curve is assumed");
}

TEST_F(ImageNotes, ExrFilesThatCannotBeReadAreNamed) {
  EXPECT_EQ(error_of_chroma(0.5F, 2), "");
  EXPECT_NE(error_of_chroma(0.5F, 1).find("its chroma is not stored for every second pixel"), std::string::npos);
  EXPECT_NE(error_of_chroma(1e5F, 2).find("its luminance exceeds half precision"), std::string::npos);
  std::ofstream(at("deep.exr"), std::ios::binary) << std::string("\x76\x2F\x31\x01\x02\x08\x00\x00", 8);
  const Result<File> deep = read(at("deep.exr"));
  ASSERT_FALSE(deep.ok());
  EXPECT_NE(deep.error().message.find("it contains deep pixels; expected"), std::string::npos) << deep.error().message;
}

TEST_F(ImageNotes, PrimariesOfPng) {
  const auto with = [this](double red_x) {
    return note_of_png(PNG_COLOR_TYPE_RGB, 0.0, [red_x](png_structp png, png_infop info) {
      png_set_cHRM(png, info, 0.3127, 0.3290, red_x, 0.32, 0.265, 0.69, 0.15, 0.06);
    });
  };
  EXPECT_EQ(with(0.68), "its primaries are not those of sRGB, and are ignored");
  EXPECT_EQ(note_of_png(PNG_COLOR_TYPE_RGB, 0.0,
                        [](png_structp png, png_infop info) {
                          png_set_cHRM(png, info, 0.3127, 0.3290, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06);
                        }),
            "");
}

// Returns a profile without tags. libpng refuses those that it can compress to less than 81 bytes.
std::vector<png_byte> icc_profile() {
  std::vector<png_byte> out(132 + 0x100, 0);
  for (std::size_t i = 0; i < 0x100; ++i) out[132 + i] = static_cast<png_byte>(i * i * 167U >> 3U);
  out[2] = 1;  // the size, 0x184
  out[3] = 0x84;
  out[8] = 2;  // version
  const auto put = [&out](std::size_t offset, const std::string& text) {
    std::copy(text.begin(), text.end(), out.begin() + static_cast<std::ptrdiff_t>(offset));
  };
  put(12, "mntrRGB XYZ ");
  put(36, "acsp");
  const std::vector<png_byte> white = {0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d};  // D50
  std::copy(white.begin(), white.end(), out.begin() + 68);
  return out;
}

TEST_F(ImageNotes, ProfilesOfPng) {
  const auto with = [this](const char* name) {
    return note_of_png(PNG_COLOR_TYPE_RGB, 0.0, [name](png_structp png, png_infop info) {
      const std::vector<png_byte> profile = icc_profile();
      png_set_iCCP(png, info, name, PNG_COMPRESSION_TYPE_BASE, profile.data(),
                   static_cast<png_uint_32>(profile.size()));
    });
  };
  EXPECT_EQ(with("Display P3"), "its colour profile 'Display P3' is ignored, and sRGB is assumed");
  EXPECT_EQ(with("sRGB IEC61966-2.1"), "");
}

TEST_F(ImageNotes, CodePointsOfPng) {
  const auto with = [this](const std::vector<png_byte>& points) {
    code_points_ = points;
    return note_of_png(PNG_COLOR_TYPE_RGB, 0.0);
  };
  EXPECT_EQ(with({1, 13, 0, 1}), "");
  EXPECT_EQ(with({9, 16, 0, 1}), "its colour space (cICP 9, 16, 0, 1) is ignored, and sRGB is assumed");
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

TEST_F(ImageNotes, PartsOfExr) {
  const std::string path = at("parts.exr");
  const auto write = [&](int parts) {
    std::vector<Imf::Header> headers;
    for (int i = 0; i < parts; ++i) {
      Imf::Header& header = headers.emplace_back(1, 1);
      header.setName("part" + std::to_string(i));
      header.setType(Imf::SCANLINEIMAGE);
      for (const char* const name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), parts);
    for (int i = 0; i < parts; ++i) {
      float value = 0.5F + static_cast<float>(i);
      Imf::FrameBuffer buffer;
      for (const char* const name : {"R", "G", "B"})
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), 4, 4));
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(buffer);
      part.writePixels(1);
    }
  };
  write(2);
  EXPECT_EQ(note(path), "of its 2 parts only the first is read");
  write(1);
  EXPECT_EQ(note(path), "");
}

}  // namespace
}  // namespace tyndall::image
