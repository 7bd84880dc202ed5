// Compares the functions of tyndall/atmosphere.glsl, which engines include in their shaders, with `probe` and with the
// CPU models in double precision. The shader is compiled from the header that is installed;
// tests/package/consume.cmake compares both. All cases share one build of the default tables.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>

#include "atmosphere_points.hpp"
#include "effect/shared.hpp"
#include "effect_frame.hpp"
#include "models/precomputed.hpp"

namespace tyndall {
namespace {

constexpr double kTolerance = 0.003;
constexpr double kRadius_m = 6360000.0;

// Coordinates of an engine: the position of its origin relative to the planet's centre.
struct Place {
  glm::dvec3 origin;
  glm::dvec3 to_sun;
};

// Returns the query of `probe` for a position relative to the origin, and a direction.
RayQuery probe_query(const Place& place, const glm::dvec3& position, const glm::dvec3& direction) {
  const glm::dvec3 from_centre = place.origin + position;
  const glm::dvec3 up = glm::normalize(from_centre);
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  const glm::dvec3 flat_view = direction - up * glm::dot(up, direction);
  const glm::dvec3 flat_sun = place.to_sun - up * glm::dot(up, place.to_sun);
  RayQuery out;
  out.altitude_m = glm::length(from_centre) - kRadius_m;
  out.view_zenith_rad = angle(glm::dot(up, direction));
  out.sun_zenith_rad = angle(glm::dot(up, place.to_sun));
  out.azimuth_rad =
      angle(glm::dot(flat_view, flat_sun) / std::max(glm::length(flat_view) * glm::length(flat_sun), 1e-9));
  return out;
}

RayAngles angles_of(const RayQuery& q) {
  const models::Ray ray = models::ray_from_query(q);
  return {ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun};
}

// The positions that the device sees are rounded to single precision.
glm::dvec3 rounded(const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)); }

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0; }
  glm::dvec3 direction() {
    const double z = uniform(-1.0, 1.0);
    const double a = uniform(0.0, 6.283185307179586);
    return {std::sqrt(1.0 - z * z) * std::cos(a), std::sqrt(1.0 - z * z) * std::sin(a), z};
  }

 private:
  std::mt19937 engine_;
};

class AtmosphereGlsl : public GpuTest {
 protected:
  static Params params() {
    Params out;
    out.planet.ground_albedo = Vec3(0.3F);
    out.scattering.scale = 1.0F;
    return out;
  }
  void SetUp() override {
    GpuTest::SetUp();
    if (model_) return;
    Result<models::PrecomputedModel> made = models::PrecomputedModel::create(host(), params());
    ASSERT_OK(made);
    model_.emplace(std::move(made).value());
  }
  static void TearDownTestSuite() { model_.reset(); }

  // Evaluates the functions on the device.
  static std::vector<Answer> evaluate(const Place& place, const std::vector<Query>& queries) {
    AtmosphereInputs inputs;
    inputs.origin_from_centre_m = {place.origin.x, place.origin.y, place.origin.z};
    inputs.sun.irradiance = Vec3(1.0F);
    inputs.sun.direction_to_sun = {static_cast<float>(place.to_sun.x), static_cast<float>(place.to_sun.y),
                                   static_cast<float>(place.to_sun.z)};
    return evaluate_points(host(), model_->effect(), params(), inputs, queries);
  }

  // Returns what `probe --model precomputed` returns.
  static std::vector<Answer> probe(const std::vector<RayQuery>& queries, bool visible_ground) {
    const Result<std::vector<models::Answer>> answers = model_->answer(queries, visible_ground);
    EXPECT_OK(answers);
    std::vector<Answer> out(queries.size());
    if (!answers.ok()) return out;
    const auto vec = [](const std::array<double, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = {vec(answers.value()[i].radiance), vec(answers.value()[i].transmittance)};
    }
    return out;
  }

  static void expect_near(const char* what, const glm::dvec3& value, const glm::dvec3& truth, const RayQuery& q) {
    // In space, the irradiance of the sky is 0 up to rounding.
    constexpr double kNothing = 1e-7;
    const double largest = std::max({truth.x, truth.y, truth.z});
    const double error = largest > kNothing ? relative_error(value, truth) : glm::length(value - truth) / 1e-4;
    EXPECT_LE(error, kTolerance) << what << ": altitude " << q.altitude_m << ", view zenith " << q.view_zenith_rad
                                 << ", sun zenith " << q.sun_zenith_rad << ", azimuth " << q.azimuth_rad << ": "
                                 << value.x << ' ' << value.y << ' ' << value.z << ", expected " << truth.x << ' '
                                 << truth.y << ' ' << truth.z;
    worst_ = std::max(worst_, error);
  }

  // Compares all functions without shadows at random positions, up to `reach_m` from the origin of the coordinates and
  // at altitudes of at least `lowest_m`.
  static void expect_probe(const Place& place, double reach_m, double lowest_m, std::uint32_t seed);

  static inline std::optional<models::PrecomputedModel> model_;
  static inline double worst_ = 0.0;
};

void AtmosphereGlsl::expect_probe(const Place& place, double reach_m, double lowest_m, std::uint32_t seed) {
  constexpr double kHighest_m[] = {300.0, 3000.0, 70000.0, 600000.0};
  Random random(seed);
  std::vector<Query> queries;
  std::vector<RayQuery> skies, rays;
  const glm::dvec3 below = glm::length(place.origin) > 1.0 ? glm::normalize(place.origin) : random.direction();
  for (int i = 0; i < 120; ++i) {
    const glm::dvec3 up = glm::normalize(below + random.direction() * std::min(reach_m / kRadius_m, 1e6));
    const double altitude_m = random.uniform(lowest_m, kHighest_m[i % 4]);
    const glm::dvec3 position = rounded(up * (kRadius_m + altitude_m) - place.origin);
    const glm::dvec3 direction = rounded(random.direction());
    queries.push_back(query(sun_irradiance, position, direction));
    queries.push_back(query(sky_irradiance, position, glm::normalize(place.origin + position)));
    queries.push_back(query(sky_radiance, position, direction));
    queries.push_back(query(to_sky, position, direction));
    rays.push_back(probe_query(place, position, direction));
    skies.push_back(rays.back());
    skies.back().sky_irradiance = true;
  }
  const std::vector<Answer> answers = evaluate(place, queries);
  const std::vector<Answer> sky = probe(skies, true);
  const std::vector<Answer> seen = probe(rays, true);
  const std::vector<Answer> path = probe(rays, false);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Answer* a = &answers[4 * i];
    const RayQuery& q = rays[i];
    // The light of the sun's disc fades over its angular radius; that of `probe` ends where its centre sets.
    const double dip = std::acos(std::min(kRadius_m / (kRadius_m + q.altitude_m), 1.0));
    if (std::abs(q.sun_zenith_rad - dip - 1.570796) > 0.02) expect_near("sun", a[0].light, sky[i].transmittance, q);
    expect_near("sky irradiance", a[1].light, sky[i].light, q);
    expect_near("sky radiance", a[2].light, seen[i].light, q);
    expect_near("in-scattering", a[3].light, path[i].light, q);
    expect_near("transmittance", a[3].transmittance, path[i].transmittance, q);
  }
}

TEST_F(AtmosphereGlsl, AgreesWithProbeFromACameraAnywhere) {
  // z up, y up and tilted; the origin is the camera, or a point of the ground.
  const glm::dvec3 ups[] = {{0, 0, 1}, {0, 1, 0}, glm::normalize(glm::dvec3(1, -2, 0.5))};
  for (std::uint32_t i = 0; i < 3; ++i) {
    for (const double elevation : {60.0, 8.0, -3.0}) {
      const double angle = elevation * 3.141592653589793 / 180.0;
      const glm::dvec3 side = glm::normalize(glm::cross(ups[i], glm::dvec3(0.3, 0.5, 0.8)));
      const Place place = {ups[i] * (kRadius_m + 250.0), rounded(ups[i] * std::sin(angle) + side * std::cos(angle))};
      expect_probe(place, 30e3, -450.0, 10 * i + static_cast<std::uint32_t>(elevation + 10.0));
    }
  }
  RecordProperty("worst", std::to_string(worst_));
}

TEST_F(AtmosphereGlsl, AgreesWithProbeFromThePlanetsCentre) {
  // Positions so far from the origin, and altitudes, are rounded to half a metre.
  expect_probe({{0, 0, 0}, rounded(glm::normalize(glm::dvec3(0.2, 0.7, -0.3)))}, 1e12, 200.0, 7);
}

TEST_F(AtmosphereGlsl, PathsBetweenPointsAddUp) {
  const Place place = {{0, 0, kRadius_m}, rounded(glm::normalize(glm::dvec3(0.5, 0.3, 0.4)))};
  Random random(5);
  std::vector<Query> queries;
  std::vector<RayQuery> starts, ends;
  std::vector<double> lengths;
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 from = rounded({0, 0, random.uniform(1.0, i % 2 == 0 ? 2000.0 : 60000.0)});
    glm::dvec3 direction = random.direction();
    // Paths downwards end before the ground, so that the tables have both ends.
    const double length =
        direction.z < 0.0 ? random.uniform(0.05, 0.9) * from.z / -direction.z : random.uniform(50.0, 90000.0);
    if (length > 90000.0) continue;
    const glm::dvec3 to = rounded(from + direction * length);
    direction = glm::normalize(to - from);
    queries.push_back(query(between, from, to));
    starts.push_back(probe_query(place, from, direction));
    ends.push_back(probe_query(place, to, direction));
    lengths.push_back(glm::length(to - from));
  }
  const std::vector<Answer> answers = evaluate(place, queries);
  const std::vector<Answer> before = probe(starts, false);
  const std::vector<Answer> after = probe(ends, false);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const glm::dvec3 t = true_transmittance(params(), angles_of(starts[i]), lengths[i]);
    expect_near("transmittance", answers[i].transmittance, t, starts[i]);
    // The rest of the ray, seen through the path, and the path together are the whole ray.
    const glm::dvec3 together = answers[i].light + answers[i].transmittance * after[i].light;
    expect_near("in-scattering", together, before[i].light, starts[i]);
  }
}

TEST_F(AtmosphereGlsl, ShadowsRemoveSingleScattering) {
  const Place place = {{0, 0, kRadius_m}, rounded(glm::normalize(glm::dvec3(0.5, 0.1, 0.4)))};
  const glm::dvec3 from = {0, 0, 300};
  std::vector<Query> queries;
  std::vector<glm::dvec3> targets;
  for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0.05), {0, 1, 0.2}, {-1, -1, 0.01}, {0.1, 0, 1}}) {
    const glm::dvec3 to = rounded(from + glm::normalize(direction) * 20000.0);
    targets.push_back(to);
    const glm::dvec3 along = glm::normalize(to - from);
    for (const double lit_m : {1e9, -1e9, 7000.0}) {  // lit up to this distance
      Query q = query(between_shadowed, from, to, 400.0);
      for (int c = 0; c < 3; ++c) q.plane[c] = static_cast<float>(along[c]);
      q.plane[3] = static_cast<float>(glm::dot(along, from) + lit_m);
      queries.push_back(q);
    }
    queries.push_back(query(between, from, to));
  }
  const std::vector<Answer> answers = evaluate(place, queries);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const RayQuery ray = probe_query(place, from, glm::normalize(targets[i] - from));
    const Answer* a = &answers[4 * i];
    EXPECT_LE(relative_error(a[0].light, a[3].light), 1e-5) << "nothing is in shadow";
    const glm::dvec3 lit = true_inscattering(params(), angles_of(ray), 0.0, 7000.0);
    // The differences of table values have larger errors than the tables themselves.
    EXPECT_LE(relative_error(a[2].light - a[1].light, lit), 0.01) << "lit up to 7 km, direction " << i;
    EXPECT_GT(a[1].light.z, 0.0) << "light that is scattered more than once is not shadowed";
    EXPECT_LT(a[1].light.z, 0.8 * a[0].light.z);
    for (int k = 0; k < 3; ++k) EXPECT_LE(relative_error(a[k].transmittance, a[3].transmittance), 1e-6);
  }
}

TEST_F(AtmosphereGlsl, RefusesInputsWithoutMeaning) {
  AtmosphereInputs inputs;
  Params params;
  EXPECT_OK(atmosphere_constants(params, inputs));
  const auto message = [&] {
    const Result<AtmosphereConstants> result = atmosphere_constants(params, inputs);
    return result.ok() ? std::string() : result.error().message;
  };
  inputs.sun.direction_to_sun = Vec3(0.0F);
  EXPECT_NE(message().find("direction_to_sun has no direction; expected"), std::string::npos) << message();
  inputs = {};
  inputs.origin_from_centre_m.x = NAN;
  EXPECT_NE(message().find("origin_from_centre_m is not finite; expected"), std::string::npos) << message();
  inputs = {};
  inputs.sun.irradiance.y = -1.0F;
  EXPECT_NE(message().find("irradiance is negative or not finite; expected"), std::string::npos) << message();
  inputs.sun.irradiance = Vec3(3e38F);
  EXPECT_EQ(message(), "");
  params.scattering.scale = 10.0F;
  EXPECT_NE(message().find("irradiance times scattering.scale is too large; expected"), std::string::npos) << message();
  params = {};
  inputs = {};
  inputs.origin_from_centre_m.x = 1e39;
  EXPECT_NE(message().find("origin_from_centre_m exceeds"), std::string::npos) << message();
  inputs = {};
  params.atmosphere.mie_g = 2.0F;
  EXPECT_NE(message().find("atmosphere.mie_g"), std::string::npos) << message();
}

// The volume of a homogeneous medium is lit by the sunlight that arrives there.
TEST_F(AtmosphereGlsl, FroxelsHaveTheSunlightOfTheirMedium) {
  AtmosphereInputs inputs;
  inputs.sun.irradiance = {2.0F, 3.0F, 5.0F};
  Params params;
  params.scattering.scale = 2.0F;
  params.homogeneous_medium.sunlight = {0.5F, 0.25F, 0.125F};
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    params.scattering.medium = medium;
    const Result<AtmosphereConstants> made = atmosphere_constants(params, inputs);
    ASSERT_TRUE(made.ok()) << made.error().message;
    shared::AtmosphereConstants constants = {};
    std::memcpy(&constants, made.value().bytes.data(), sizeof constants);
    const glm::vec3 light(constants.froxel_irradiance.x, constants.froxel_irradiance.y, constants.froxel_irradiance.z);
    const bool homogeneous = medium == MediumKind::homogeneous;
    EXPECT_EQ(light, homogeneous ? glm::vec3(2.0F, 1.5F, 1.25F) : glm::vec3(4.0F, 6.0F, 10.0F));
    EXPECT_EQ(constants.sun_irradiance.x, 4.0F);
  }
}

}  // namespace
}  // namespace tyndall
