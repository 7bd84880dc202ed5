// Exposure and tone mapping on a device without a scene. Operators are compared with those of the CPU, the exposure
// with sums over all pixels, and adaptation with its closed form.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "gpu_test.hpp"
#include "post/tonemap.hpp"
#include "tyndall/post.hpp"

namespace tyndall::post {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

using Rgb = std::array<float, 3>;
using Paint = std::function<Rgb(std::uint32_t x, std::uint32_t y)>;

Rgb grey(double luminance) {
  return {static_cast<float>(luminance), static_cast<float>(luminance), static_cast<float>(luminance)};
}

// Returns a picture whose luminances span three stops around `middle`. All its pixels have full weight.
Paint mixed(double middle) {
  return [middle](std::uint32_t x, std::uint32_t y) {
    return grey(middle * std::exp2(1.5 * std::sin(0.37 * x) * std::cos(0.23 * y + 0.1 * x)));
  };
}

class GpuPost : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    Result<Tonemap> made = Tonemap::create(host().device(), 2);
    ASSERT_OK(made);
    tonemap_ = std::make_unique<Tonemap>(std::move(made).value());
  }
  void TearDown() override {
    tonemap_.reset();
    picture_ = {};
    display_ = {};
    GpuTest::TearDown();
  }

  // Sets the picture.
  void show(VkExtent2D extent, const Paint& paint) {
    const auto make = [&](const char* name) {
      Result<gpu::Image> image = gpu::create_image(
          host().device(),
          {name,
           VK_FORMAT_R32G32B32A32_SFLOAT,
           {extent.width, extent.height, 1},
           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
      EXPECT_OK(image);
      return std::move(image).value();
    };
    picture_ = make("picture");
    display_ = make("display");
    extent_ = extent;
    std::vector<float> texels;
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) {
        const Rgb c = paint(x, y);
        texels.insert(texels.end(), {c[0], c[1], c[2], 1.0F});
      }
    }
    const VkDeviceSize bytes = texels.size() * sizeof(float);
    ASSERT_OK(gpu::upload(host(), picture_, texels.data(), bytes, VK_IMAGE_LAYOUT_GENERAL));
    ASSERT_OK(gpu::upload(host(), display_, texels.data(), bytes, VK_IMAGE_LAYOUT_GENERAL));
  }

  Measurement measure(double seconds, std::uint32_t slot = 0) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) {
      return tonemap_->exposure().measure(cmd, picture_.view.get(), extent_, settings_, seconds, slot);
    }));
    return tonemap_->exposure().read(slot);
  }
  Measurement measure_alone() {
    tonemap_->exposure().reset_history();
    return measure(0.0);
  }

  std::vector<float> display() {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) {
      return tonemap_->record(cmd, picture_.view.get(), display_.view.get(), extent_, settings_);
    }));
    Result<std::vector<std::byte>> bytes = gpu::download(host(), display_, VK_IMAGE_LAYOUT_GENERAL, 0, 16);
    EXPECT_OK(bytes);
    std::vector<float> out(bytes.value().size() / sizeof(float));
    std::memcpy(out.data(), bytes.value().data(), bytes.value().size());
    return out;
  }

  // Returns the logarithmic mean over all pixels in double precision.
  [[nodiscard]] double log_average(const Paint& paint) const {
    double sum = 0.0;
    for (std::uint32_t y = 0; y < extent_.height; ++y) {
      for (std::uint32_t x = 0; x < extent_.width; ++x) {
        const Rgb c = paint(x, y);
        sum += std::log(0.212671 * static_cast<double>(c[0]) + 0.715160 * static_cast<double>(c[1]) +
                        0.072169 * static_cast<double>(c[2]));
      }
    }
    return std::exp(sum / (static_cast<double>(extent_.width) * extent_.height));
  }

  std::unique_ptr<Tonemap> tonemap_;
  TonemapSettings settings_;
  gpu::Image picture_, display_;
  VkExtent2D extent_ = {};
};

TEST_F(GpuPost, OperatorsAreThoseOfTheCpu) {
  const Paint paint = [](std::uint32_t x, std::uint32_t y) -> Rgb {
    const float specials[] = {0.0F, -1.0F, kInfinity, -kInfinity, kNoNumber, 1e-30F, 1e30F, 0.3F};
    if (y == 0) return {specials[x % 8], specials[(x / 8) % 8], 0.25F};
    const float scale = std::exp2(0.4F * static_cast<float>(x) - 14.0F);
    const float hue = static_cast<float>(y) / 9.0F;
    return {scale * hue, scale * (1.0F - hue), scale * std::abs(0.5F - hue)};
  };
  show({64, 10}, paint);
  settings_.auto_exposure = false;
  for (std::uint32_t op = 0; op < kOperators; ++op) {
    for (const float saturation : {0.5F, 1.0F, 2.0F}) {
      settings_.op = static_cast<Operator>(op);
      settings_.saturation = saturation;
      settings_.white_point = 2.0F + saturation;
      settings_.exposure = 0.7F * saturation;
      const std::vector<float> got = display();
      for (std::uint32_t i = 0; i < extent_.width * extent_.height; ++i) {
        const Rgb c = paint(i % extent_.width, i / extent_.width);
        const std::array<double, 3> expected =
            tonemapped(settings_, static_cast<double>(settings_.exposure), {c[0], c[1], c[2]});
        for (std::size_t k = 0; k < 3; ++k) {
          // The tolerance is a hundredth of an 8-bit step: the error of logarithms and powers in single precision.
          ASSERT_NEAR(static_cast<double>(got[4 * i + k]), expected[k], 4e-5)
              << op << " of " << c[0] << " " << c[1] << " " << c[2] << ", saturation " << saturation;
        }
      }
    }
  }
}

TEST_F(GpuPost, ExposureIsMiddleGreyOverTheLogAverage) {
  for (const double middle : {1e-3, 0.1, 30.0}) {
    const Paint paint = [&](std::uint32_t x, std::uint32_t y) -> Rgb {
      const Rgb c = mixed(middle)(x, y);
      return {1.2F * c[0], c[1], 0.4F * c[2]};
    };
    for (const VkExtent2D extent : {VkExtent2D{64, 36}, VkExtent2D{1, 1}, VkExtent2D{203, 3}}) {
      show(extent, paint);
      const Measurement found = measure_alone();
      const double expected = log_average(paint);
      EXPECT_NEAR(static_cast<double>(found.measured), expected, 1e-3 * expected) << extent.width;
      EXPECT_EQ(found.luminance, found.measured);
      EXPECT_NEAR(static_cast<double>(found.exposure), 0.18 / expected, 1e-3 * 0.18 / expected);
      EXPECT_NEAR(static_cast<double>(found.counted), 1.0, 1e-3);
      EXPECT_EQ(found.black, 0.0F);
    }
  }
  // The picture is mapped with this exposure.
  const std::vector<float> got = display();
  const Measurement found = tonemap_->exposure().read();
  const Rgb c = {1.2F * mixed(30.0)(5, 1)[0], mixed(30.0)(5, 1)[1], 0.4F * mixed(30.0)(5, 1)[2]};
  const auto expected = tonemapped(settings_, static_cast<double>(found.exposure), {c[0], c[1], c[2]});
  EXPECT_NEAR(static_cast<double>(got[4 * (203 + 5)]), expected[0], 4e-5);
  // The exposure is proportional to middle grey. Luminances below least_luminance are treated as equal to it.
  settings_.middle_gray = 0.36F;
  EXPECT_NEAR(static_cast<double>(measure_alone().exposure), 2.0 * static_cast<double>(found.exposure), 1e-3);
  settings_.least_luminance = 100.0F;
  EXPECT_FLOAT_EQ(measure_alone().exposure, 0.36F / 100.0F);
}

// Only a part of the pixels of large pictures is read, but from all rows and columns, so that stripes are measured
// correctly.
TEST_F(GpuPost, LargePicturesAreMeasuredFromAPartOfTheirPixels) {
  const Paint paints[] = {mixed(0.2), [](std::uint32_t x, std::uint32_t) { return grey(x % 2 == 0 ? 0.1 : 0.4); },
                          [](std::uint32_t, std::uint32_t y) { return grey(y % 2 == 0 ? 0.1 : 0.4); }};
  for (const Paint& paint : paints) {
    show({1280, 360}, paint);
    const double expected = log_average(paint);
    EXPECT_NEAR(static_cast<double>(measure_alone().measured), expected, 5e-3 * expected);
  }
}

TEST_F(GpuPost, BlackSpaceDoesNotCount) {
  show({64, 64}, mixed(0.2));
  const Measurement full = measure_alone();
  for (const double dark : {0.0, 1e-9, 0.2 * std::exp2(-10.0)}) {
    for (const std::uint32_t part : {2U, 16U}) {
      const Paint with_space = [&](std::uint32_t x, std::uint32_t y) {
        return y % part == 0 ? mixed(0.2)(x, y / part) : grey(dark);
      };
      show({64, 64 * part}, with_space);
      const Measurement found = measure_alone();
      // The bright part, and with it the weight of the darkest bin, may change slightly.
      EXPECT_NEAR(static_cast<double>(found.measured), static_cast<double>(full.measured), part == 2U ? 1e-3 : 0.02)
          << dark << " " << part;
      EXPECT_NEAR(static_cast<double>(found.counted), 1.0 / part, 2e-3);
      EXPECT_NEAR(static_cast<double>(found.black), dark < 1e-7 ? 1.0 - 1.0 / part : 0.0, 1e-6);
    }
  }
  // A black picture gives the initial exposure, and later the previous one.
  show({64, 64}, [](std::uint32_t, std::uint32_t) { return grey(0.0); });
  const Measurement nothing = measure_alone();
  EXPECT_EQ(nothing.measured, 0.0F);
  EXPECT_EQ(nothing.luminance, 0.1F);
  EXPECT_EQ(nothing.black, 1.0F);
  show({64, 64}, mixed(0.2));
  EXPECT_EQ(measure(0.01).luminance, full.luminance);  // immediately, because there is no previous exposure
  show({64, 64}, [](std::uint32_t, std::uint32_t) { return grey(0.0); });
  EXPECT_EQ(measure(100.0).luminance, full.luminance);
}

TEST_F(GpuPost, OneBrightPixelDoesNotChangeTheExposure) {
  for (const VkExtent2D extent : {VkExtent2D{160, 90}, VkExtent2D{640, 480}}) {
    show(extent, mixed(0.2));
    const Measurement without = measure_alone();
    double largest = 0.0;
    for (std::uint32_t at = 40; at < 44; ++at) {
      show(extent, [&](std::uint32_t x, std::uint32_t y) { return x == at && y == 41 ? grey(7e4) : mixed(0.2)(x, y); });
      largest = std::max(largest, std::abs(static_cast<double>(measure_alone().measured / without.measured) - 1.0));
    }
    // One of 14 400 samples changes the mean by ln(7e4/0.2) / 14 400. In larger pictures one pixel may represent two.
    EXPECT_LT(largest, 1e-3);
  }
}

TEST_F(GpuPost, AdaptationDoesNotDependOnTheFrameRate) {
  constexpr double kDim = 0.05;
  constexpr double kBright = 2.0;
  for (const std::uint32_t rate : {1U, 10U, 30U, 144U}) {
    show({32, 16}, [&](std::uint32_t, std::uint32_t) { return grey(kDim); });
    EXPECT_NEAR(static_cast<double>(measure_alone().luminance), kDim, 1e-3 * kDim);
    show({32, 16}, [&](std::uint32_t, std::uint32_t) { return grey(kBright); });
    Measurement found;
    for (std::uint32_t frame = 0; frame < rate; ++frame) found = measure(1.0 / rate, frame % 2);
    const double expected = kBright + (kDim - kBright) * std::exp(-1.0);
    EXPECT_NEAR(static_cast<double>(found.luminance), expected, 1e-3 * expected) << rate;
    EXPECT_NEAR(static_cast<double>(found.measured), kBright, 1e-3 * kBright);
  }
  // The exposure does not change within 0 s, and changes completely after a long time or without adaptation.
  show({32, 16}, [&](std::uint32_t, std::uint32_t) { return grey(kDim); });
  const float before = tonemap_->exposure().read(1).luminance;
  EXPECT_FLOAT_EQ(measure(0.0).luminance, before);
  EXPECT_FLOAT_EQ(measure(-5.0).luminance, before);
  settings_.light_adaptation = false;
  EXPECT_NEAR(static_cast<double>(measure(1e-3).luminance), kDim, 1e-3 * kDim);
}

TEST_F(GpuPost, FixedExposureIsIndependentOfThePicture) {
  settings_.auto_exposure = false;
  std::vector<float> first;
  for (const double rest : {0.001, 50.0}) {
    show({32, 16}, [&](std::uint32_t x, std::uint32_t) { return grey(x == 3 ? 0.2 : rest); });
    if (!first.empty()) measure(1.0);  // a measurement must not change the fixed exposure
    const std::vector<float> got = display();
    if (first.empty()) first = got;
    EXPECT_EQ(std::vector<float>(got.begin() + 12, got.begin() + 16),
              std::vector<float>(first.begin() + 12, first.begin() + 16));
  }
}

TEST_F(GpuPost, TheHistogramMatchesThePicture) {
  show({64, 32}, [](std::uint32_t x, std::uint32_t) {
    if (x < 16) return grey(0.25);
    if (x < 32) return grey(3.0);
    if (x < 40) return grey(1e12);  // above the range of the histogram
    return x < 48 ? Rgb{kNoNumber, -1.0F, 0.0F} : x < 56 ? Rgb{kInfinity, 1.0F, 1.0F} : grey(0.0);
  });
  const Measurement found = measure_alone();
  const auto between = [&](double low, double high) {
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t i = 0; i < kHistogramBins; ++i) {
      if (stop_of_bin(i) < low || stop_of_bin(i) > high) continue;
      sum += static_cast<double>(found.share[i]);
      moment += static_cast<double>(found.share[i]) * stop_of_bin(i);
    }
    return std::pair(sum, moment / sum);
  };
  EXPECT_NEAR(between(-3.0, -1.0).first, 0.25, 1e-6);
  EXPECT_NEAR(between(-3.0, -1.0).second, -2.0, 1e-3);
  EXPECT_NEAR(between(1.0, 2.0).first, 0.25, 1e-6);
  EXPECT_NEAR(between(1.0, 2.0).second, std::log2(3.0), 1e-3);
  EXPECT_NEAR(static_cast<double>(found.share[kHistogramBins - 1]), 0.25, 1e-6);
  EXPECT_NEAR(static_cast<double>(found.black), 0.25, 1e-6);
  double sum = static_cast<double>(found.black);
  for (const float share : found.share) sum += static_cast<double>(share);
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST_F(GpuPost, TheSamePicturesGiveTheSameBytes) {
  std::vector<Measurement> runs;
  for (int run = 0; run < 3; ++run) {
    tonemap_->exposure().reset_history();
    for (const double middle : {0.1, 0.7, 0.02}) {
      show({321, 97}, mixed(middle));
      measure(0.1);
    }
    runs.push_back(tonemap_->exposure().read());
    EXPECT_EQ(std::memcmp(&runs[0], &runs.back(), sizeof(Measurement)), 0);
  }
}

// The public class records the same work, and refuses what would crash.
TEST_F(GpuPost, TheToneMapperGivesTheSameBytes) {
  Result<ToneMapper> made = ToneMapper::create(info());
  ASSERT_OK(made);
  ToneMapper mapper = std::move(made).value();
  show({37, 21}, mixed(0.2));
  measure_alone();
  const std::vector<float> expected = display();
  show({37, 21}, mixed(0.2));
  const VkImageView from = picture_.view.get();
  const VkImageView to = display_.view.get();
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    EXPECT_FALSE(mapper.record(cmd, from, to, extent_, settings_).ok()) << "nothing was measured";
    EXPECT_FALSE(mapper.measure(VK_NULL_HANDLE, from, extent_, settings_, 0.0).ok());
    EXPECT_FALSE(mapper.measure(cmd, VK_NULL_HANDLE, extent_, settings_, 0.0).ok());
    EXPECT_FALSE(mapper.measure(cmd, from, {0, 1}, settings_, 0.0).ok());
    EXPECT_FALSE(mapper.measure(cmd, from, extent_, settings_, 0.0, 2).ok());
    EXPECT_FALSE(mapper.record(cmd, from, VK_NULL_HANDLE, extent_, settings_).ok());
    EXPECT_FALSE(mapper.measure(cmd, from, extent_, settings_, std::nan("")).ok());
    float TonemapSettings::*const numbers[] = {&TonemapSettings::middle_gray, &TonemapSettings::white_point,
                                               &TonemapSettings::saturation, &TonemapSettings::least_luminance,
                                               &TonemapSettings::exposure};
    for (float TonemapSettings::*const number : numbers) {
      for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.0F}) {
        TonemapSettings wrong = settings_;
        wrong.*number = value;
        EXPECT_FALSE(mapper.measure(cmd, from, extent_, wrong, 0.0).ok()) << value;
        EXPECT_FALSE(mapper.record(cmd, from, to, extent_, wrong).ok()) << value;
      }
    }
    if (Result<void> r = mapper.measure(cmd, from, extent_, settings_, 0.0); !r) return r;
    return mapper.record(cmd, from, to, extent_, settings_);
  }));
  const Result<std::vector<std::byte>> found = gpu::download(host(), display_, VK_IMAGE_LAYOUT_GENERAL, 0, 16);
  ASSERT_OK(found);
  ASSERT_EQ(found.value().size(), expected.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(found.value().data(), expected.data(), found.value().size()), 0);
  const Measurement measured = mapper.measurement();
  const Measurement reference = tonemap_->exposure().read();
  EXPECT_EQ(std::memcmp(&measured, &reference, sizeof measured), 0);
  EXPECT_EQ(mapper.bytes(), tonemap_->exposure().bytes());
  EXPECT_FALSE(ToneMapper::create(info(), 0).ok());
  EXPECT_FALSE(ToneMapper::create({}).ok());
  const ToneMapper moved = std::move(mapper);
  EXPECT_FALSE(mapper.record(VK_NULL_HANDLE, from, to, extent_, settings_).ok());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(moved.measurement().measured, measured.measured);
}

TEST_F(GpuPost, MissingMeasurementsAndWrongOperatorsAreErrors) {
  show({8, 8}, mixed(0.2));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<void> unmeasured = tonemap_->record(cmd, picture_.view.get(), display_.view.get(), extent_, settings_);
    EXPECT_FALSE(unmeasured.ok());
    EXPECT_FALSE(tonemap_->exposure().measure(cmd, picture_.view.get(), extent_, settings_, 0.0, 2).ok());
    TonemapSettings wrong = settings_;
    wrong.auto_exposure = false;
    wrong.op = static_cast<Operator>(kOperators);
    EXPECT_FALSE(tonemap_->record(cmd, picture_.view.get(), display_.view.get(), extent_, wrong).ok());
    return {};
  }));
}

}  // namespace
}  // namespace tyndall::post
