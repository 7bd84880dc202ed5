// EXR and PNG files: round trips, and one clear line for damaged files.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "files/files.hpp"
#include "image/image.hpp"
#include "image/metrics.hpp"

namespace tyndall::image {
namespace {

// Returns a smooth picture with values from 0 to `top` that differ between channels.
Image ramp(std::uint32_t width, std::uint32_t height, float top) {
  Image image(width, height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      float* const pixel = image.pixel(x, y);
      pixel[0] = top * static_cast<float>(x) / static_cast<float>(width - 1);
      pixel[1] = top * static_cast<float>(y) / static_cast<float>(height - 1);
      pixel[2] = top * static_cast<float>(x + y) / static_cast<float>(width + height - 2);
    }
  }
  return image;
}

class ImageFiles : public testing::Test {
 protected:
  ImageFiles() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tyndall-test-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
  }
  ~ImageFiles() override { std::filesystem::remove_all(directory_); }

  std::string at(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t entries() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory_)) ++count;
    return count;
  }
  std::string message_of(const std::string& path) const {
    const Result<File> file = read(path);
    return file ? "(accepted)" : file.error().message;
  }

  std::filesystem::path directory_;
  const Metadata metadata_ = {
      {"tyndall.camera.yaw_deg", "332"}, {"tyndall.terrain.source", "h\xc3\xb6he.tif"}, {"tyndall.empty", ""}};
};

TEST_F(ImageFiles, ExrPreservesEveryBit) {
  Image image = ramp(131, 77, 1.0e5F);
  image.pixel(3, 4)[0] = std::numeric_limits<float>::infinity();
  image.pixel(5, 6)[1] = -1.0e-30F;
  const Result<void> written = write_exr(at("a.exr"), image, metadata_);
  ASSERT_TRUE(written.ok()) << written.error().message;
  const Result<File> back = read(at("a.exr"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back.value().kind, FileKind::exr);
  EXPECT_EQ(back.value().image.width, 131U);
  EXPECT_EQ(back.value().image.height, 77U);
  EXPECT_EQ(back.value().image.rgb, image.rgb);
  for (const auto& entry : metadata_) {
    EXPECT_EQ(std::count(back.value().metadata.begin(), back.value().metadata.end(), entry), 1) << entry.first;
  }
  EXPECT_EQ(count_non_finite(back.value().image), 1U);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ImageFiles, HalfExrIsWithinItsPrecision) {
  const Image image = ramp(40, 70, 3.0F);
  ASSERT_TRUE(write_exr(at("a.exr"), image, {}, {.precision = ExrPrecision::half16}).ok());
  const Result<File> back = read(at("a.exr"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    ASSERT_NEAR(back.value().image.rgb[i], image.rgb[i], image.rgb[i] / 2048.0F + 1e-7F);
  }
  const Result<void> too_large = write_exr(at("b.exr"), ramp(4, 4, 70000.0F), {}, {.precision = ExrPrecision::half16});
  ASSERT_FALSE(too_large.ok());
  EXPECT_NE(too_large.error().message.find("65504"), std::string::npos);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ImageFiles, PngPreservesEightBitsAndMetadata) {
  Image image(256, 3);
  for (std::uint32_t x = 0; x < 256; ++x) {
    for (int i = 0; i < 9; ++i)
      image.pixel(x, static_cast<std::uint32_t>(i / 3))[i % 3] = static_cast<float>(x) / 255.0F;
  }
  const Result<void> written = write_png(at("a.png"), image, metadata_, {Encoding::srgb, false});
  ASSERT_TRUE(written.ok()) << written.error().message;
  const Result<File> back = read(at("a.png"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back.value().kind, FileKind::png);
  EXPECT_EQ(back.value().image.rgb, image.rgb);
  EXPECT_EQ(back.value().metadata.size(), metadata_.size());
  for (const auto& entry : metadata_) {
    EXPECT_EQ(std::count(back.value().metadata.begin(), back.value().metadata.end(), entry), 1) << entry.first;
  }
}

TEST_F(ImageFiles, PngEncodesLinearValues) {
  Image image(2, 2);
  const float values[] = {0.0F, 0.002F, 0.2158605F, 1.0F};  // 0.2158605 is 128 / 255 encoded
  for (std::uint32_t i = 0; i < 4; ++i) std::fill_n(image.pixel(i % 2, i / 2), 3, values[i]);
  ASSERT_TRUE(write_png(at("a.png"), image, {}, {Encoding::linear, false}).ok());
  const Result<File> back = read(at("a.png"));
  ASSERT_TRUE(back.ok());
  const float expected[] = {0.0F, 7.0F, 128.0F, 255.0F};
  for (std::uint32_t i = 0; i < 4; ++i)
    EXPECT_EQ(std::round(back.value().image.pixel(i % 2, i / 2)[0] * 255.0F), expected[i]);
}

TEST_F(ImageFiles, TheSameImageGivesTheSameBytes) {
  const Image image = ramp(100, 50, 1.0F);
  for (const std::string ending : {".png", ".exr"}) {
    for (const std::string name : {"a", "b"}) {
      const std::string path = at(name + ending);
      ASSERT_TRUE((ending == ".png" ? write_png(path, image, metadata_) : write_exr(path, image, metadata_)).ok());
    }
    EXPECT_EQ(files::read_file(at("a" + ending), 1U << 20U).value(),
              files::read_file(at("b" + ending), 1U << 20U).value());
  }
}

TEST_F(ImageFiles, NotFiniteIsReportedByPng) {
  Image image(10, 10);
  image.pixel(7, 3)[2] = std::numeric_limits<float>::quiet_NaN();
  image.pixel(8, 3)[2] = -std::numeric_limits<float>::infinity();
  const Result<void> written = write_png(at("a.png"), image, {});
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("2 values are not finite, the first at pixel 7,3"), std::string::npos)
      << written.error().message;
  EXPECT_EQ(entries(), 0U);
}

TEST_F(ImageFiles, UnwritableFilesAreErrors) {
  const Image image = ramp(8, 8, 1.0F);
  std::filesystem::create_symlink("/dev/full", at("full"));
  for (const std::string& path : {at("none/a"), directory_.string(), at("full")}) {
    EXPECT_FALSE(write_png(path, image, {}).ok()) << path;
    const Result<void> exr = write_exr(path, image, {});
    ASSERT_FALSE(exr.ok()) << path;
    EXPECT_EQ(exr.error().code, ErrorCode::io);
  }
  EXPECT_FALSE(write_png(at("a.png"), Image(), {}).ok());
  EXPECT_FALSE(write_exr(at("a.exr"), image, {{std::string(80, 'n'), "v"}}).ok());
  EXPECT_FALSE(write_png(at("a.png"), image, {{"n", "\xff"}}).ok());
  EXPECT_EQ(entries(), 1U);
  EXPECT_TRUE(kind_of_name("A.PNG").ok());
  EXPECT_EQ(kind_of_name("x.y.exr").value(), FileKind::exr);
  EXPECT_EQ(kind_of_name("out.jpg").error().message,
            "'out.jpg': unknown image format; expected a name that ends in .png or .exr");
}

TEST_F(ImageFiles, AFullDiskLeavesNothingAndTheOldFile) {
  ASSERT_TRUE(files::write_file(at("a.png"), "old").ok());
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit = {3000, 3000};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const Image image = ramp(300, 300, 1.0F);
    const bool failed = !write_png(at("a.png"), image, {}).ok() && !write_exr(at("a.exr"), image, {}).ok();
    ::_exit(failed ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(entries(), 1U);
  EXPECT_EQ(files::read_file(at("a.png"), 100).value(), "old");
}

TEST_F(ImageFiles, MissingOrOfAnotherKind) {
  EXPECT_NE(message_of(at("none.png")).find("No such file or directory"), std::string::npos);
  EXPECT_NE(message_of(directory_.string()).find("Is a directory"), std::string::npos);
  ASSERT_TRUE(files::write_file(at("empty.png"), "").ok());
  EXPECT_NE(message_of(at("empty.png")).find("it is empty"), std::string::npos);
  ASSERT_TRUE(files::write_file(at("text.exr"), "hello\n").ok());
  EXPECT_NE(message_of(at("text.exr")).find("it is neither PNG nor EXR"), std::string::npos);
}

// Files cut off at many positions and with many bytes changed are either read or give one line, without a crash.
TEST_F(ImageFiles, DamagedFiles) {
  const Image image = ramp(70, 90, 1.0F);
  ASSERT_TRUE(write_png(at("a.png"), image, metadata_).ok());
  ASSERT_TRUE(write_exr(at("a.exr"), image, metadata_).ok());
  for (const std::string name : {"a.png", "a.exr"}) {
    const std::string whole = files::read_file(at(name), 1U << 20U).value();
    const std::size_t step = whole.size() / 60 + 1;
    int refused = 0;
    for (std::size_t position = 0; position < whole.size(); position += step) {
      ASSERT_TRUE(files::write_file(at("cut"), whole.substr(0, position)).ok());
      const std::string cut = message_of(at("cut"));
      EXPECT_NE(cut, "(accepted)") << name << " cut at " << position;
      EXPECT_EQ(cut.find('\n'), std::string::npos);
      std::string changed = whole;
      changed[position] = static_cast<char>(changed[position] ^ 0x55);
      ASSERT_TRUE(files::write_file(at("changed"), changed).ok());
      const std::string damage = message_of(at("changed"));
      EXPECT_EQ(damage.find('\n'), std::string::npos);
      refused += damage != "(accepted)" ? 1 : 0;
    }
    EXPECT_GT(refused, 20) << name;
  }
}

// Writes a file with its own data window. Every pixel holds its coordinates in the plane of the display window.
void write_windows(const std::string& path, const Imath::Box2i& display, const Imath::Box2i& data) {
  Imf::Header header(display, data);
  for (const char* const name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  std::vector<float> red, green;
  for (int y = data.min.y; y <= data.max.y; ++y) {
    for (int x = data.min.x; x <= data.max.x; ++x) {
      red.push_back(static_cast<float>(x));
      green.push_back(static_cast<float>(y));
    }
  }
  ASSERT_EQ(red.size(), static_cast<std::size_t>(width * height));
  Imf::FrameBuffer source;
  const auto slice = [&](std::vector<float>& values) {
    return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() - data.min.x - data.min.y * width),
                      sizeof(float), sizeof(float) * static_cast<std::size_t>(width));
  };
  source.insert("R", slice(red));
  source.insert("G", slice(green));
  source.insert("B", slice(green));
  Imf::OutputFile output(path.c_str(), header);
  output.setFrameBuffer(source);
  output.writePixels(height);
}

// Writes an EXR and replaces the data of its first block of rows by `data`, which is shorter.
std::string with_short_block(const std::string& path, Imf::Compression compression, std::string_view data) {
  constexpr int kSide = 20;
  std::vector<float> pixels(std::size_t{3} * kSide * kSide, 0.25F);
  {
    Imf::Header header(kSide, kSide);
    header.compression() = compression;
    Imf::FrameBuffer source;
    for (const char* const name : {"R", "G", "B"}) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      source.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), 4, 4 * kSide));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(source);
    file.writePixels(kSide);
  }
  std::string bytes = files::read_file(path, 1U << 20U).value();
  // The table of offsets ends where its first entry points to.
  const std::size_t blocks = compression == Imf::ZIP_COMPRESSION ? 2 : kSide;
  std::size_t table = 0;
  for (std::uint64_t first = 0; first != table + 8 * blocks; ++table)
    std::memcpy(&first, &bytes[table + 1], sizeof first);
  const std::size_t block = table + 8 * blocks;
  const auto size = static_cast<std::uint32_t>(data.size());
  std::memcpy(&bytes[block + 4], &size, sizeof size);
  bytes.replace(block + 8, data.size(), data);
  return bytes;
}

// OpenEXR would take what is in memory for the missing pixels.
TEST_F(ImageFiles, ShortBlocksOfRowsAreRefused) {
  std::string deflated(100, '\0');
  uLongf size = deflated.size();
  const std::string few(30, 'x');
  ASSERT_EQ(::compress(reinterpret_cast<Bytef*>(deflated.data()), &size, reinterpret_cast<const Bytef*>(few.data()),
                       few.size()),
            Z_OK);
  deflated.resize(size);
  const std::pair<Imf::Compression, std::string> cases[] = {{Imf::NO_COMPRESSION, std::string(236, 'x')},
                                                            {Imf::RLE_COMPRESSION, std::string("\x05x\xfe"
                                                                                               "ab",
                                                                                               5)},
                                                            {Imf::ZIPS_COMPRESSION, deflated},
                                                            {Imf::ZIP_COMPRESSION, deflated}};
  for (const auto& [compression, data] : cases) {
    const std::string bytes = with_short_block(at("block.exr"), compression, data);
    EXPECT_TRUE(read(at("block.exr")).ok()) << compression;
    ASSERT_TRUE(files::write_file(at("block.exr"), bytes).ok());
    const Result<File> file = read(at("block.exr"));
    ASSERT_FALSE(file.ok()) << compression;
    EXPECT_NE(file.error().message.find("the file is cut off"), std::string::npos) << file.error().message;
  }
}

TEST_F(ImageFiles, ExrIsItsDisplayWindow) {
  // The data extends beyond the right edge, and is missing left of column 3 and above row 2.
  write_windows(at("a.exr"), {{0, 0}, {15, 8}}, {{3, 2}, {20, 8}});
  const Result<File> file = read(at("a.exr"));
  ASSERT_TRUE(file.ok()) << file.error().message;
  ASSERT_EQ(file.value().image.width, 16U);
  ASSERT_EQ(file.value().image.height, 9U);
  for (std::uint32_t y = 0; y < 9; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      const bool inside = x >= 3 && y >= 2;
      EXPECT_EQ(file.value().image.pixel(x, y)[0], inside ? static_cast<float>(x) : 0.0F) << x << ' ' << y;
      EXPECT_EQ(file.value().image.pixel(x, y)[1], inside ? static_cast<float>(y) : 0.0F) << x << ' ' << y;
    }
  }
  EXPECT_EQ(file.value().note,
            "its data window is 18x7 from 3,2 and its display window 16x9 from 0,0; the display window "
            "is read, black where there are no data");
  // If the data window lies at another position, the same pixels give another picture.
  write_windows(at("b.exr"), {{0, 0}, {15, 8}}, {{0, 0}, {15, 8}});
  const Result<File> whole = read(at("b.exr"));
  ASSERT_TRUE(whole.ok());
  EXPECT_EQ(whole.value().note, "");
  EXPECT_LT(compare(file.value().image, whole.value().image).psnr_db, 40.0);
  // The data is outside the display window. In another file, the display window is far larger than the data.
  write_windows(at("c.exr"), {{0, 0}, {3, 3}}, {{100, 100}, {103, 103}});
  const Result<File> outside = read(at("c.exr"));
  ASSERT_TRUE(outside.ok());
  EXPECT_EQ(outside.value().image.rgb, std::vector<float>(48, 0.0F));
  write_windows(at("d.exr"), {{0, 0}, {32767, 32767}}, {{0, 0}, {3, 3}});
  EXPECT_NE(message_of(at("d.exr")).find("its display window is too large"), std::string::npos);
}

TEST_F(ImageFiles, LuminanceAndChromaAreColours) {
  Imf::Header header(32, 18);
  std::vector<Imf::Rgba> red(32 * 18, Imf::Rgba(0.8F, 0.1F, 0.05F, 1.0F));
  const auto write = [&](const std::string& path, Imf::RgbaChannels channels) {
    Imf::RgbaOutputFile output(path.c_str(), header, channels);
    output.setFrameBuffer(red.data(), 1, 32);
    output.writePixels(18);
  };
  write(at("yc.exr"), Imf::WRITE_YC);
  write(at("y.exr"), Imf::WRITE_Y);
  const Result<File> colour = read(at("yc.exr"));
  ASSERT_TRUE(colour.ok()) << colour.error().message;
  for (std::uint32_t y = 0; y < 18; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x) {
      const float* const pixel = colour.value().image.pixel(x, y);
      EXPECT_NEAR(pixel[0], 0.8F, 0.01F) << x << ' ' << y;
      EXPECT_NEAR(pixel[1], 0.1F, 0.01F) << x << ' ' << y;
      EXPECT_NEAR(pixel[2], 0.05F, 0.01F) << x << ' ' << y;
    }
  }
  const Result<File> grey = read(at("y.exr"));
  ASSERT_TRUE(grey.ok());
  const float* const pixel = grey.value().image.pixel(7, 7);
  EXPECT_NEAR(pixel[0], 0.2126F * 0.8F + 0.7152F * 0.1F + 0.0722F * 0.05F, 0.002F);
  EXPECT_EQ(pixel[0], pixel[2]);
}

TEST_F(ImageFiles, ExrHeadersSayWhatTheChannelsAre) {
  const auto header_of = [&](ExrContent content) {
    EXPECT_TRUE(write_exr(at("a.exr"), ramp(8, 4, 1.0F), {}, {.content = content}).ok());
    return Imf::InputFile(at("a.exr").c_str()).header();
  };
  EXPECT_FALSE(Imf::hasChromaticities(header_of(ExrContent::data)));
  const Imf::Header radiance = header_of(ExrContent::radiance);
  ASSERT_TRUE(Imf::hasChromaticities(radiance));
  EXPECT_NEAR(Imf::chromaticities(radiance).red.x, 0.64F, 1e-6F);
  EXPECT_NEAR(Imf::chromaticities(radiance).white.x, 0.3127F, 1e-6F);
  EXPECT_FALSE(Imf::hasEnvmap(radiance));
  const Imf::Header map = header_of(ExrContent::environment_map);
  ASSERT_TRUE(Imf::hasEnvmap(map));
  EXPECT_EQ(Imf::envmap(map), Imf::ENVMAP_LATLONG);
  EXPECT_TRUE(Imf::hasChromaticities(map));
  const ExrOptions options = {{}, ExrContent::radiance, Primaries::rec2020, 26636.65};
  ASSERT_TRUE(write_exr(at("b.exr"), ramp(8, 4, 1.0F), {}, options).ok());
  const Imf::Header wide = Imf::InputFile(at("b.exr").c_str()).header();
  EXPECT_NEAR(Imf::chromaticities(wide).green.y, 0.797F, 1e-6F);
  ASSERT_TRUE(Imf::hasWhiteLuminance(wide));
  EXPECT_NEAR(Imf::whiteLuminance(wide), 26636.65F, 0.01F);
}

std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>((value >> shift) & 0xFFU);
  return text;
}

std::string little_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 0; shift <= 24; shift += 8) text += static_cast<char>((value >> shift) & 0xFFU);
  return text;
}

std::string exr_attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + little_endian(static_cast<std::uint32_t>(value.size())) + value;
}

// Files of a few bytes whose headers claim gigabytes are rejected without using the memory.
TEST_F(ImageFiles, ClaimsAreCheckedAgainstTheLengthOfTheFile) {
  const std::string png = "\x89PNG\r\n\x1a\n";
  const std::string crc(4, 'c');
  const std::string small =
      big_endian(13) + "IHDR" + big_endian(1) + big_endian(1) + std::string("\x08\x02\0\0\0", 5) + crc;
  const std::string exr = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8);
  const std::string tiled = std::string("\x76\x2f\x31\x01\x02\x02\0\0", 8);
  const std::string window = little_endian(0) + little_endian(0) + little_endian(32767) + little_endian(32767);
  const std::string channel =
      "R" + std::string(1, '\0') + little_endian(2) + std::string(4, '\0') + little_endian(1) + little_endian(1);
  std::string rest = exr_attribute("channels", "chlist", channel + '\0') +
                     exr_attribute("dataWindow", "box2i", window) + exr_attribute("displayWindow", "box2i", window) +
                     exr_attribute("compression", "compression", std::string(1, '\x03')) +
                     exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                     exr_attribute("pixelAspectRatio", "float", little_endian(0x3f800000)) +
                     exr_attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
                     exr_attribute("screenWindowWidth", "float", little_endian(0x3f800000));
  const std::string tile = exr_attribute("tiles", "tiledesc", little_endian(1) + little_endian(1) + '\0');
  const std::pair<const char*, std::string> claims[] = {
      {"a text chunk", png + small + big_endian(0x7ffffff0U) + "tEXta"},
      {"pixels of a PNG", png + big_endian(13) + "IHDR" + big_endian(32768) + big_endian(32768) +
                              std::string("\x10\x02\0\0\0", 5) + crc + big_endian(4) + "IDAT" + "abcd" + crc +
                              big_endian(0) + "IEND" + crc},
      {"a string", exr + "comments" + '\0' + "string" + '\0' + little_endian(0x7ffffff0U) + "abc"},
      {"scan lines", exr + rest + '\0'},
      {"tiles", tiled + rest + tile + '\0'},
  };
  for (const auto& [what, bytes] : claims) {
    ASSERT_TRUE(files::write_file(at("claim"), bytes).ok());
    const pid_t child = ::fork();
    if (child == 0) {
      const std::string message = message_of(at("claim"));
      rusage used{};
      ::getrusage(RUSAGE_SELF, &used);
      const bool refused = message.find("cannot read") != std::string::npos;
      ::_exit(!refused ? 1 : used.ru_maxrss > 200 * 1024 ? 2 : 0);  // KiB
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0) << what << ": " << message_of(at("claim"));
  }
}

}  // namespace
}  // namespace tyndall::image
