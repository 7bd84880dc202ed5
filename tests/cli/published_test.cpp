// `tyndall probe` against the equations of the publications, evaluated here in double precision without any code of the
// library, for random rays and media: Hoffman and Preetham (2002), O'Neil (2005) with his published polynomial,
// O'Neil's table (2004) against the integrals that it stores, and the homogeneous medium of Yusov (2012).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "files/csv.hpp"
#include "files/text.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-3;
using Rgb = std::array<double, 3>;

struct Direction {
  double up = 1.0, across = 0.0, aside = 0.0;
};
Direction direction(double zenith, double azimuth) {
  return {std::cos(zenith), std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth)};
}
double dot(const Direction& a, const Direction& b) { return a.up * b.up + a.across * b.across + a.aside * b.aside; }
Direction along(const Direction& p, const Direction& d, double t) {
  return {p.up + t * d.up, p.across + t * d.across, p.aside + t * d.aside};
}

struct Question {
  double altitude_m = 0.0, view_deg = 0.0, sun_deg = 0.0, azimuth_deg = 0.0;
  [[nodiscard]] Direction view() const { return direction(view_deg * kPi / 180.0, 0.0); }
  [[nodiscard]] Direction sun() const { return direction(sun_deg * kPi / 180.0, azimuth_deg * kPi / 180.0); }
};
struct Seen {
  Rgb radiance = {}, transmittance = {};
};

struct Coefficients {
  Rgb rayleigh = {}, mie = {}, absorption = {};
  double g = 0.0;
};

// The phase functions of Rayleigh, Henyey and Greenstein, and Cornette and Shanks. A positive g scatters forward.
double rayleigh_phase(double c) { return 3.0 / (16.0 * kPi) * (1.0 + c * c); }
double henyey_greenstein(double c, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * c, 1.5));
}
double cornette_shanks(double c, double g) {
  return 3.0 * (1.0 - g * g) * (1.0 + c * c) / (8.0 * kPi * (2.0 + g * g) * std::pow(1.0 + g * g - 2.0 * g * c, 1.5));
}

class CliPublished : public testing::Test {
 protected:
  std::mt19937 engine_{2002};
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  // Returns random numbers that floats represent exactly, because parameters are floats.
  double number(double low, double high) { return static_cast<double>(static_cast<float>(uniform(low, high))); }
  Coefficients coefficients() {
    Coefficients c;
    for (std::size_t i = 0; i < 3; ++i) {
      c.rayleigh[i] = number(3e-6, 4e-5);
      c.mie[i] = number(2e-6, 4e-5);
      c.absorption[i] = number(0.0, 5e-6);
    }
    c.g = number(-0.5, 0.9);
    return c;
  }
  static std::string text(double value) {
    char out[40];
    std::snprintf(out, sizeof out, "%.17g", value);
    return out;
  }
  static std::vector<std::string> with(const Coefficients& c, std::vector<std::string> more) {
    const auto vec = [](const Rgb& v) { return text(v[0]) + "," + text(v[1]) + "," + text(v[2]); };
    for (const std::string& set :
         {std::string("atmosphere.custom_coefficients=true"), "atmosphere.rayleigh_scattering=" + vec(c.rayleigh),
          "atmosphere.mie_scattering=" + vec(c.mie), "atmosphere.mie_absorption=" + vec(c.absorption),
          "atmosphere.mie_g=" + text(c.g), std::string("atmosphere.ozone_absorption=0,0,0")}) {
      more.insert(more.end(), {"--set", set});
    }
    return more;
  }
  // Runs probe and compares every result with `truth`.
  void expect_published(const std::vector<std::string>& arguments, const std::vector<Question>& questions,
                        const std::function<Seen(const Question&)>& truth) {
    std::string csv = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n";
    for (const Question& q : questions) {
      csv += text(q.altitude_m) + "," + text(q.view_deg) + "," + text(q.sun_deg) + "," + text(q.azimuth_deg) + "\n";
    }
    std::vector<std::string> all = {"probe", "--queries", scratch_.write("q.csv", csv)};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProcessResult process = run_tyndall(all);
    ASSERT_EQ(process.status, 0) << process.err;
    const Result<files::CsvTable> table = files::parse_csv(process.out, "output");
    ASSERT_TRUE(table.ok());
    ASSERT_EQ(table.value().rows(), questions.size());
    double worst = 0.0;
    for (std::size_t row = 0; row < questions.size(); ++row) {
      const Seen right = truth(questions[row]);
      for (std::size_t c = 0; c < 3; ++c) {
        for (const bool light : {true, false}) {
          const std::string column = std::string(light ? "L_" : "T_") + "rgb"[c];
          const double published = light ? right.radiance[c] : right.transmittance[c];
          double found = -1.0;
          static_cast<void>(files::read_number(table.value().field(row, table.value().find(column).front()), found));
          EXPECT_NEAR(found, published, kTolerance * published + 1e-12)
              << column << ": altitude " << questions[row].altitude_m << " view " << questions[row].view_deg << " sun "
              << questions[row].sun_deg << " azimuth " << questions[row].azimuth_deg;
          worst = std::max(worst, std::abs(found - published) / std::max(published, 1e-9));
        }
      }
    }
    RecordProperty("worst", std::to_string(worst));
  }

  Scratch scratch_;
};

// The sky is that of two shells, whose optical lengths are given by equation 5.
TEST_F(CliPublished, HoffmanAndPreetham) {
  for (int medium = 0; medium < 4; ++medium) {
    const Coefficients k = coefficients();
    const double air_m = number(5000.0, 12000.0);
    const double haze_m = number(500.0, 4000.0);
    std::vector<Question> questions;
    for (int i = 0; i < 100; ++i)
      questions.push_back({uniform(0.0, 5000.0), uniform(0.0, 89.9), uniform(0.0, 89.9), uniform(0.0, 360.0)});
    const auto length = [](double zenith_m, double deg) {
      return zenith_m / (std::cos(deg * kPi / 180.0) + 0.15 * std::pow(93.885 - deg, -1.253));
    };
    expect_published(
        with(k, {"--model", "homogeneous", "--set", "homogeneous.air_length_m=" + text(air_m), "--set",
                 "homogeneous.haze_length_m=" + text(haze_m)}),
        questions, [&](const Question& q) {
          const double nu = dot(q.view(), q.sun());
          Seen out;
          for (std::size_t c = 0; c < 3; ++c) {
            const double haze_ex = k.mie[c] + k.absorption[c];
            const double sun =
                std::exp(-(k.rayleigh[c] * length(air_m, q.sun_deg) + haze_ex * length(haze_m, q.sun_deg)));
            const double both = k.rayleigh[c] + haze_ex;
            const double low_m = length(haze_m, q.view_deg);
            const double high_m = length(air_m, q.view_deg) - low_m;
            const double air = k.rayleigh[c] * rayleigh_phase(nu);
            const double low = (air + k.mie[c] * henyey_greenstein(nu, k.g)) / both * (1.0 - std::exp(-both * low_m));
            const double high = air / k.rayleigh[c] * (1.0 - std::exp(-k.rayleigh[c] * high_m));
            out.radiance[c] = sun * (low + std::exp(-both * low_m) * high);
            out.transmittance[c] = std::exp(-both * low_m - k.rayleigh[c] * high_m);
          }
          return out;
        });
  }
}

// Rays that hit the ground follow equations 1, 3 and 4: constant density along the whole distance, and the sun as seen
// from the ground.
TEST_F(CliPublished, HoffmanAndPreethamsGround) {
  constexpr double kRadius = 6360000.0;
  for (int medium = 0; medium < 4; ++medium) {
    const Coefficients k = coefficients();
    const double air_m = number(5000.0, 12000.0);
    const double haze_m = number(500.0, 4000.0);
    std::vector<Question> questions;
    for (int i = 0; i < 100; ++i)
      questions.push_back({uniform(100.0, 5000.0), uniform(93.0, 180.0), uniform(0.0, 89.0), uniform(0.0, 360.0)});
    const auto length = [](double zenith_m, double deg) {
      return zenith_m / (std::cos(deg * kPi / 180.0) + 0.15 * std::pow(93.885 - deg, -1.253));
    };
    expect_published(
        with(k, {"--model", "homogeneous", "--set", "homogeneous.air_length_m=" + text(air_m), "--set",
                 "homogeneous.haze_length_m=" + text(haze_m), "--set", "planet.radius_m=6360000"}),
        questions, [&](const Question& q) {
          const double nu = dot(q.view(), q.sun());
          const double r = kRadius + q.altitude_m;
          const double b = r * q.view().up;
          const double s = -b - std::sqrt(b * b - q.altitude_m * (2.0 * kRadius + q.altitude_m));
          Seen out;
          for (std::size_t c = 0; c < 3; ++c) {
            const double haze_ex = k.mie[c] + k.absorption[c];
            const double sun =
                std::exp(-(k.rayleigh[c] * length(air_m, q.sun_deg) + haze_ex * length(haze_m, q.sun_deg)));
            const double ex = k.rayleigh[c] + haze_ex;
            out.transmittance[c] = std::exp(-ex * s);
            out.radiance[c] = sun / ex * (k.rayleigh[c] * rayleigh_phase(nu) + k.mie[c] * henyey_greenstein(nu, k.g)) *
                              (1.0 - out.transmittance[c]);
          }
          return out;
        });
  }
}

// Evaluates the sum of GPU Gems 2, chapter 16, for a ray that leaves the atmosphere. `column` returns density
// integrals.
using Column = std::function<double(double height_m, double scale_height_m, double cos_zenith)>;
Seen oneil(const Question& q, const Coefficients& k, double radius_m, double top_m, const Rgb& scale_heights_m,
           int samples, const Column& column) {
  const Direction eye = {radius_m + q.altitude_m, 0.0, 0.0};
  const Direction view = q.view();
  const Direction sun = q.sun();
  const double b = dot(eye, view);
  const double end = -b + std::sqrt(b * b - dot(eye, eye) + (radius_m + top_m) * (radius_m + top_m));
  const double nu = dot(view, sun);
  Rgb start = {};
  for (std::size_t s = 0; s < 2; ++s) start[s] = column(q.altitude_m, scale_heights_m[s], view.up);
  Seen out;
  for (std::size_t c = 0; c < 3; ++c) {
    const double out_c = k.mie[c] + k.absorption[c];
    for (int i = 0; i < samples; ++i) {
      const Direction p = along(eye, view, (i + 0.5) * end / samples);
      const double r = std::sqrt(dot(p, p));
      Rgb tau = {};
      for (std::size_t s = 0; s < 2; ++s) {
        tau[s] = start[s] - column(r - radius_m, scale_heights_m[s], dot(p, view) / r) +
                 column(r - radius_m, scale_heights_m[s], dot(p, sun) / r);
      }
      out.radiance[c] += end / samples * std::exp(-k.rayleigh[c] * tau[0] - out_c * tau[1]) *
                         (k.rayleigh[c] * std::exp(-(r - radius_m) / scale_heights_m[0]) * rayleigh_phase(nu) +
                          k.mie[c] * std::exp(-(r - radius_m) / scale_heights_m[1]) * cornette_shanks(nu, k.g));
    }
    out.transmittance[c] = std::exp(-k.rayleigh[c] * start[0] - out_c * start[1]);
  }
  return out;
}

TEST_F(CliPublished, ONeilWithThePrintedPolynomial) {
  constexpr double kRadius = 6360000.0;
  constexpr double kTop = 159000.0;
  constexpr double kScaleHeight = 39750.0;  // a quarter of the thickness, for which the polynomial was made
  for (int medium = 0; medium < 4; ++medium) {
    const Coefficients k = coefficients();
    std::vector<Question> questions;
    for (int i = 0; i < 100; ++i)
      questions.push_back({uniform(0.0, 150000.0), uniform(0.0, 85.0), uniform(0.0, 85.0), uniform(0.0, 360.0)});
    // The unit of length in the publication is the thickness of the atmosphere. The polynomial approximates the
    // integral to infinity, which is used in place of the integral to the top.
    const Column printed = [&](double height_m, double scale_height_m, double cos_zenith) {
      const double x = 1.0 - cos_zenith;
      const double scale =
          scale_height_m / kTop * std::exp(-0.00287 + x * (0.459 + x * (3.83 + x * (-6.80 + x * 5.25))));
      return kTop * std::exp(-height_m / scale_height_m) * scale;
    };
    const int samples = 2 + 3 * medium;
    expect_published(with(k, {"--model", "oneil", "--set", "oneil.scale_function=published", "--set",
                              "oneil.samples=" + std::to_string(samples), "--set", "planet.radius_m=6360000", "--set",
                              "atmosphere.height_m=159000", "--set", "atmosphere.rayleigh_scale_height_m=39750",
                              "--set", "atmosphere.mie_scale_height_m=39750"}),
                     questions, [&](const Question& q) {
                       Seen out = oneil(q, k, kRadius, kTop, {kScaleHeight, kScaleHeight, 0.0}, samples, printed);
                       // The model subtracts the integral above the top from that of the whole path.
                       const Direction eye = {kRadius + q.altitude_m, 0.0, 0.0};
                       const Direction view = q.view();
                       const double b = dot(eye, view);
                       const double end = -b + std::sqrt(b * b - dot(eye, eye) + (kRadius + kTop) * (kRadius + kTop));
                       const Direction top = along(eye, view, end);
                       for (std::size_t c = 0; c < 3; ++c) {
                         const double column = printed(q.altitude_m, kScaleHeight, view.up) -
                                               printed(kTop, kScaleHeight, dot(top, view) / (kRadius + kTop));
                         out.transmittance[c] = std::exp(-(k.rayleigh[c] + k.mie[c] + k.absorption[c]) * column);
                       }
                       return out;
                     });
  }
}

// From space to the ground: the ray begins where it enters the atmosphere, and the published integrals go from each
// point back towards the camera.
TEST_F(CliPublished, ONeilFromSpace) {
  constexpr double kRadius = 6360000.0;
  constexpr double kTop = 159000.0;
  constexpr double kScaleHeight = 39750.0;
  const auto scale = [](double cosine) {
    const double x = 1.0 - cosine;
    return kScaleHeight * std::exp(-0.00287 + x * (0.459 + x * (3.83 + x * (-6.80 + x * 5.25))));
  };
  for (int medium = 0; medium < 3; ++medium) {
    const Coefficients k = coefficients();
    const int samples = 3 + 2 * medium;
    std::vector<Question> questions;
    while (questions.size() < 60) {
      const Question q = {uniform(200000.0, 8000000.0), uniform(100.0, 180.0), uniform(0.0, 60.0), uniform(0.0, 360.0)};
      const double r = kRadius + q.altitude_m;
      // Only rays that hit the ground on the day side.
      if (r * std::sin(q.view_deg * kPi / 180.0) > 0.98 * kRadius) continue;
      questions.push_back(q);
    }
    expect_published(
        with(k, {"--model", "oneil", "--set", "oneil.scale_function=published", "--set",
                 "oneil.samples=" + std::to_string(samples), "--set", "planet.radius_m=6360000", "--set",
                 "atmosphere.height_m=159000", "--set", "atmosphere.rayleigh_scale_height_m=39750", "--set",
                 "atmosphere.mie_scale_height_m=39750"}),
        questions, [&](const Question& q) {
          const Direction eye = {kRadius + q.altitude_m, 0.0, 0.0};
          const Direction view = q.view();
          const Direction sun = q.sun();
          const double b = dot(eye, view);
          const auto meets = [&](double radius) { return -b - std::sqrt(b * b - dot(eye, eye) + radius * radius); };
          const double near = meets(kRadius + kTop);
          const double length = meets(kRadius) - near;
          const auto cosine = [](const Direction& p, const Direction& d) { return dot(p, d) / std::sqrt(dot(p, p)); };
          const Direction back = {-view.up, -view.across, -view.aside};
          const Direction start = along(eye, view, near);
          // exp(-4) is the density at the top, where drawing ends.
          const double offset = std::exp(-kTop / kScaleHeight) * scale(cosine(start, back));
          const double nu = dot(view, sun);
          Seen out;
          for (std::size_t c = 0; c < 3; ++c) {
            const double ex = k.rayleigh[c] + k.mie[c] + k.absorption[c];
            for (int i = 0; i < samples; ++i) {
              const Direction p = along(start, view, (i + 0.5) * length / samples);
              const double density = std::exp(-(std::sqrt(dot(p, p)) - kRadius) / kScaleHeight);
              const double column = density * (scale(cosine(p, sun)) + scale(cosine(p, back))) - offset;
              out.radiance[c] += length / samples * density * std::exp(-ex * column) *
                                 (k.rayleigh[c] * rayleigh_phase(nu) + k.mie[c] * cornette_shanks(nu, k.g));
            }
            const Direction ground = along(start, view, length);
            out.transmittance[c] = std::exp(-ex * (scale(cosine(ground, back)) - offset));
          }
          return out;
        });
  }
}

TEST_F(CliPublished, ONeilsTable) {
  constexpr double kRadius = 6360000.0;
  constexpr double kTop = 80000.0;
  const Coefficients k = coefficients();
  std::vector<Question> questions;
  for (int i = 0; i < 60; ++i)
    questions.push_back({uniform(0.0, 40000.0), uniform(0.0, 85.0), uniform(0.0, 85.0), uniform(0.0, 360.0)});
  // Integrates to the top by Simpson's rule in a coordinate that concentrates points where the density is high.
  const Column column = [](double height_m, double scale_height_m, double cos_zenith) {
    const double r = kRadius + height_m;
    const double end =
        -r * cos_zenith +
        std::sqrt(std::max(r * r * (cos_zenith * cos_zenith - 1.0) + (kRadius + kTop) * (kRadius + kTop), 0.0));
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
      const double x = static_cast<double>(i) / kSteps;
      const double t = end * x * x * x;
      const double h = std::sqrt(r * r + 2.0 * r * t * cos_zenith + t * t) - kRadius;
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      sum += weight * 3.0 * x * x * end * std::exp(-h / scale_height_m);
    }
    return sum / (3.0 * kSteps);
  };
  expect_published(with(k, {"--model", "oneil-table", "--set", "oneil.table_size=512", "--set", "oneil.samples=12"}),
                   questions, [&](const Question& q) {
                     return oneil(q, k, kRadius, kTop, {7994.0, 1200.0, 0.0}, 12, column);
                   });
}

// The model is the in-scattering integral under the assumptions of section 2. Simpson's rule computes it here along the
// part of the ray below the flat top of the medium. The ray ends at the planet or at the extent of the medium.
TEST_F(CliPublished, TheHomogeneousMediumOf2012) {
  for (int medium = 0; medium < 4; ++medium) {
    const Coefficients k = coefficients();
    const double density = number(0.01, 3.0);
    const double height_m = number(500.0, 6000.0);
    const double extent_m = number(20000.0, 200000.0);
    const bool hg = medium % 2 == 0;
    std::vector<Question> questions;
    for (int i = 0; i < 100; ++i)
      questions.push_back({uniform(0.0, 8000.0), uniform(0.0, 180.0), uniform(0.0, 180.0), uniform(0.0, 360.0)});
    expect_published(
        with(k, {"--model", "homogeneous-medium", "--set", "homogeneous_medium.density=" + text(density), "--set",
                 "homogeneous_medium.height_m=" + text(height_m), "--set",
                 "homogeneous_medium.extent_m=" + text(extent_m), "--set", "homogeneous_medium.sunlight=1,0.5,0.25",
                 "--set", std::string("atmosphere.mie_phase=") + (hg ? "henyey-greenstein" : "cornette-shanks")}),
        questions, [&](const Question& q) {
          constexpr double kRadius = 6360000.0;
          const Direction eye = {kRadius + q.altitude_m, 0.0, 0.0};
          const double b = dot(eye, q.view());
          const double ground = b * b - dot(eye, eye) + kRadius * kRadius;
          double end = ground > 0.0 && b < 0.0 ? -b - std::sqrt(ground) : extent_m;
          double start = 0.0;
          const double crossing = (height_m - q.altitude_m) / q.view().up;
          if (q.altitude_m > height_m) start = crossing > 0.0 ? crossing : end;
          if (q.altitude_m <= height_m && q.view().up > 0.0) end = std::min(end, crossing);
          const double length = std::max(end - start, 0.0);
          const double nu = dot(q.view(), q.sun());
          const Rgb sunlight = {1.0, 0.5, 0.25};
          Seen out;
          for (std::size_t c = 0; c < 3; ++c) {
            const double sigma = density * (k.rayleigh[c] + k.mie[c] + k.absorption[c]);
            constexpr int kSteps = 1000;
            double sum = 0.0;
            for (int i = 0; i <= kSteps; ++i) {
              const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
              sum += weight * std::exp(-sigma * length * i / kSteps);
            }
            const double phase = k.rayleigh[c] * rayleigh_phase(nu) +
                                 k.mie[c] * (hg ? henyey_greenstein(nu, k.g) : cornette_shanks(nu, k.g));
            out.radiance[c] = sunlight[c] * density * phase * sum * length / (3.0 * kSteps);
            out.transmittance[c] = std::exp(-sigma * length);
          }
          return out;
        });
  }
}

}  // namespace
}  // namespace tyndall::cli
