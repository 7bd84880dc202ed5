// The procedural mountains: reproducible, equal in single precision, within bounds, band-limited, without cliffs and
// without repetition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scene/elevation/elevation_source.hpp"
#include "scene/elevation/terrain_glsl.hpp"
#include "terrain_float.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint32_t kSeed = 1;

double height(double x_m, double z_m, double spacing_m, std::uint32_t seed = kSeed) {
  return terrain64::terrain_height_at({std::lround(x_m * 64.0), std::lround(z_m * 64.0)}, spacing_m, seed);
}

class Places {
 public:
  explicit Places(double reach_m) : place_(-reach_m, reach_m) {}
  double operator()() { return place_(random_); }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> place_;
};

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double ma = 0.0;
  double mb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i] / n;
    mb += b[i] / n;
  }
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(TerrainNoise, SourceGivesTheFunctionAndSeedsDiffer) {
  const ElevationSource source = ElevationSource::create({}).value();
  EXPECT_FALSE(source.from_file());
  Places place(500e3);
  std::vector<double> one;
  std::vector<double> other;
  for (int i = 0; i < 2000; ++i) {
    const double x = std::round(place() * 64.0) / 64.0;
    const double z = std::round(place() * 64.0) / 64.0;
    one.push_back(height(x, z, 50.0));
    other.push_back(height(x, z, 50.0, 2));
    EXPECT_EQ(source.height_m(x, z, 50.0), static_cast<float>(one.back()));
  }
  EXPECT_LT(std::abs(correlation(one, other)), 0.35) << "only the range at the origin is common to all seeds";
}

TEST(TerrainNoise, SinglePrecisionAgreesFarFromTheOrigin) {
  Places place(2.0e6);
  std::vector<double> error;
  for (int i = 0; i < 5000; ++i) {
    const auto x = static_cast<int>(std::lround(place() * 64.0));
    const auto z = static_cast<int>(std::lround(place() * 64.0));
    const double reference = terrain64::terrain_height_at({x, z}, 20.0, kSeed);
    error.push_back(std::abs(terrain32::height_at(x, z, 20.0F, kSeed) - reference));
  }
  std::sort(error.begin(), error.end());
  EXPECT_LT(error[error.size() / 2], 0.01);
  EXPECT_LT(error[error.size() * 99 / 100], 0.1);
  EXPECT_LT(error.back(), 1.0);
}

TEST(TerrainNoise, StaysWithinItsBounds) {
  const terrain64::vec2 bounds = terrain64::terrain_height_bounds();
  Places place(2.5e6);
  double low = 1e9;
  double high = -1e9;
  for (int i = 0; i < 100000; ++i) {
    const double h = height(place(), place(), 30.0, static_cast<std::uint32_t>(i % 50));
    low = std::min(low, h);
    high = std::max(high, h);
  }
  EXPECT_GT(low, bounds.x);
  EXPECT_LT(high, bounds.y);
  EXPECT_LT(low, 700.0) << "there are lowlands";
  EXPECT_GT(high, 4000.0) << "there are high summits";
}

TEST(TerrainNoise, OriginLiesInMountainsForEverySeed) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    double high = 0.0;
    for (int z = -20; z <= 20; ++z) {
      for (int x = -20; x <= 20; ++x) high = std::max(high, height(2000.0 * x, 2000.0 * z, 500.0, seed));
    }
    EXPECT_GT(high, 2500.0) << "seed " << seed;
  }
}

TEST(TerrainNoise, CoarseSamplesAreMeansOfFineOnes) {
  for (const double spacing_m : {240.0, 2000.0}) {
    constexpr int kFine = 24;
    const double width_m = 2.0 * spacing_m;  // the shortest wave that the samples can represent
    Places place(100e3);
    double bias = 0.0;
    double error = 0.0;
    double spread = 0.0;
    double aliased = 0.0;
    constexpr int kCells = 300;
    for (int i = 0; i < kCells; ++i) {
      const double x = place();
      const double z = place();
      double sum = 0.0;
      double squares = 0.0;
      for (int b = 0; b < kFine; ++b) {
        for (int a = 0; a < kFine; ++a) {
          const double h =
              height(x + width_m * ((a + 0.5) / kFine - 0.5), z + width_m * ((b + 0.5) / kFine - 0.5), width_m / kFine);
          sum += h;
          squares += h * h;
        }
      }
      const double mean = sum / (kFine * kFine);
      const double coarse = height(x, z, spacing_m) - mean;
      const double point = height(x, z, width_m / kFine) - mean;
      bias += coarse / kCells;
      error += coarse * coarse / kCells;
      aliased += point * point / kCells;
      spread += (squares / (kFine * kFine) - mean * mean) / kCells;
    }
    EXPECT_LT(std::abs(bias), 0.1 * spacing_m) << spacing_m;
    EXPECT_LT(std::abs(bias), 30.0) << spacing_m;
    EXPECT_LT(error, 0.5 * spread) << spacing_m;
    EXPECT_LT(error, aliased) << "the band limit must beat plain sampling, spacing " << spacing_m;
  }
}

TEST(TerrainNoise, HasNoCliffs) {
  Places place(300e3);
  std::vector<double> slope;
  for (int i = 0; i < 40000; ++i) {
    const double x = std::round(place());
    const double z = std::round(place());
    slope.push_back(std::abs(height(x + 0.25, z, 10.0) - height(x, z, 10.0)) / 0.25);
  }
  std::sort(slope.begin(), slope.end());
  EXPECT_LT(slope[slope.size() * 999 / 1000], 2.5);  // 68 degrees
  EXPECT_LT(slope.back(), 8.0);
}

// A jump would remain in ever smaller steps. Every steep step is halved until it is 1/64 m long.
TEST(TerrainNoise, IsContinuous) {
  Places place(300e3);
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    auto x0 = static_cast<int>(std::lround(place() * 64.0));
    const auto z = static_cast<int>(std::lround(place() * 64.0));
    int step = 64 * 64;
    while (step > 1) {
      const double h0 = terrain64::terrain_height_at({x0, z}, 10.0, kSeed);
      const double h1 = terrain64::terrain_height_at({x0 + step / 2, z}, 10.0, kSeed);
      const double h2 = terrain64::terrain_height_at({x0 + step, z}, 10.0, kSeed);
      if (std::abs(h2 - h1) > std::abs(h1 - h0)) x0 += step / 2;
      step /= 2;
    }
    largest = std::max(largest, std::abs(terrain64::terrain_height_at({x0 + 1, z}, 10.0, kSeed) -
                                         terrain64::terrain_height_at({x0, z}, 10.0, kSeed)));
  }
  EXPECT_LT(largest, 1.0);
}

// The terrain without its large shapes must not repeat after a whole number of lattice cells.
TEST(TerrainNoise, DoesNotRepeat) {
  struct Lattice {
    int a, b, shift;
  };
  const auto detail = [](double x, double z) { return height(x, z, 40.0) - height(x, z, 1500.0); };
  for (const Lattice& lattice : {Lattice{1, 2, 18}, Lattice{2, 1, 17}, Lattice{1, 2, 16}, Lattice{1, 4, 16}}) {
    for (const int cells : {1, 2, 3, 7, 16, 64, 256, 1024}) {
      // One cell along the lattice's first axis, in map coordinates.
      const double cell = std::exp2(lattice.shift) / 64.0 / (lattice.a * lattice.a + lattice.b * lattice.b);
      const double dx = cells * cell * lattice.a;
      const double dz = -cells * cell * lattice.b;
      if (std::hypot(dx, dz) < 4000.0) continue;  // neighbours are similar anyway
      Places place(60e3);
      std::vector<double> here;
      std::vector<double> there;
      for (int i = 0; i < 1500; ++i) {
        const double x = place();
        const double z = place();
        here.push_back(detail(x, z));
        there.push_back(detail(x + dx, z + dz));
      }
      EXPECT_LT(std::abs(correlation(here, there)), 0.15)
          << "lattice " << lattice.a << ' ' << lattice.b << ' ' << lattice.shift << ", " << cells << " cells";
    }
  }
}

TEST(TerrainMaterials, AlbedosArePhysicalAndFollowAltitude) {
  Places place(200e3);
  double valley = 0.0;
  double summit = 0.0;
  double face = 0.0;
  constexpr int kPlaces = 500;
  for (int i = 0; i < kPlaces; ++i) {
    const terrain64::ivec2 units = {std::lround(place() * 64.0), std::lround(place() * 64.0)};
    for (const double footprint_m : {0.05, 1.0, 30.0, 1000.0, 1e6}) {
      for (const double altitude_m : {-400.0, 900.0, 2300.0, 4300.0}) {
        for (const double steep : {0.0, 0.5, 1.5}) {
          const terrain64::vec3 normal = glm::normalize(glm::dvec3(-steep, 1.0, 0.3 * steep));
          const terrain64::TerrainMaterial m =
              terrain64::terrain_material(units, altitude_m, normal, 0.0, footprint_m, kSeed);
          for (int c = 0; c < 3; ++c) {
            ASSERT_GT(m.albedo[c], 0.0);
            ASSERT_LT(m.albedo[c], 0.95);
          }
          ASSERT_NEAR(glm::length(m.normal), 1.0, 1e-9);
          ASSERT_GT(m.normal.y, 0.0);
        }
      }
    }
    const terrain64::vec3 up(0.0, 1.0, 0.0);
    valley += terrain64::terrain_material(units, 800.0, up, 0.0, 20.0, kSeed).albedo.y / kPlaces;
    summit += terrain64::terrain_material(units, 4200.0, up, 0.0, 20.0, kSeed).albedo.y / kPlaces;
    face += terrain64::terrain_material(units, 2400.0, glm::normalize(glm::dvec3(1.5, 1.0, 0.0)), 0.0, 20.0, kSeed)
                .albedo.y /
            kPlaces;
  }
  EXPECT_GT(valley, 0.03);
  EXPECT_LT(valley, 0.13);
  EXPECT_GT(summit, 0.7);
  EXPECT_GT(face, 0.10);
  EXPECT_LT(face, 0.28);
}

TEST(TerrainMaterials, DistanceAveragesRatherThanSparkles) {
  // Over a square of 600 m, the mean of the near appearance equals the far appearance.
  Places place(200e3);
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double x = place();
    const double z = place();
    const terrain64::vec3 normal = glm::normalize(glm::dvec3(0.2, 1.0, 0.1));
    double near = 0.0;
    double far = 0.0;
    constexpr int kSide = 30;
    for (int b = 0; b < kSide; ++b) {
      for (int a = 0; a < kSide; ++a) {
        const terrain64::ivec2 units = {std::lround((x + 20.0 * a) * 64.0), std::lround((z + 20.0 * b) * 64.0)};
        near += terrain64::terrain_material(units, 1500.0, normal, 0.0, 2.0, kSeed).albedo.y / (kSide * kSide);
        far += terrain64::terrain_material(units, 1500.0, normal, 0.0, 200.0, kSeed).albedo.y / (kSide * kSide);
      }
    }
    worst = std::max(worst, std::abs(near - far));
  }
  EXPECT_LT(worst, 0.03);
}

}  // namespace
}  // namespace tyndall::scene
