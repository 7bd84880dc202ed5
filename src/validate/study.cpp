#include "validate/study.hpp"

#include <algorithm>
#include <cmath>

#include "math/angles.hpp"
#include "reference/atmosphere.hpp"

namespace tyndall::validate {
namespace {

constexpr double kMaxNoise = 0.03;       // standard error, relative to the reference's largest channel
constexpr std::uint32_t kSkyFactor = 4;  // the sky's irradiance has this many times as many paths
constexpr double kVerticalSuns_deg[] = {45.0, 6.0, 0.0, -4.0};
constexpr double kHorizonSuns_deg[] = {20.0, 0.0};
constexpr double kHorizonAltitude_m = 2000.0;

RayQuery query_of(double altitude_m, double view_zenith_deg, double sun_elevation_deg, double azimuth_deg) {
  return {altitude_m, view_zenith_deg * kRadPerDeg, (90.0 - sun_elevation_deg) * kRadPerDeg, azimuth_deg * kRadPerDeg,
          false};
}

std::vector<RayTest> make_ray_tests(const std::vector<Atmosphere>& atmospheres, const Options& options) {
  std::vector<RayTest> tests(atmospheres.size());
  const auto groups = static_cast<std::uint32_t>(atmospheres.size()) * kRegions * kSunBands;
  const std::uint32_t count = std::max(options.rays / groups, 1U);
  for (std::size_t a = 0; a < atmospheres.size(); ++a) {
    const Params& params = atmospheres[a].params;
    for (const Region region : {Region::ground, Region::air, Region::space}) {
      for (const SunBand band : {SunBand::up, SunBand::twilight}) {
        const std::vector<TestRay> made =
            make_rays(region, band, count, options.seed * 16 + a, params.planet.radius_m, params.atmosphere.height_m);
        tests[a].rays.insert(tests[a].rays.end(), made.begin(), made.end());
      }
    }
    for (const TestRay& ray : tests[a].rays) tests[a].answers.queries.push_back(ray.query);
  }
  return tests;
}

std::vector<RayTest> make_turbid_tests(const Params& params, const Options& options) {
  std::vector<RayTest> tests(std::size(kTurbidAirs));
  const std::uint32_t count = options.rays / 4 / static_cast<std::uint32_t>(std::size(kTurbidAirs));
  for (std::size_t a = 0; a < tests.size(); ++a) {
    for (const SunBand band : {SunBand::up, SunBand::twilight}) {
      const std::uint32_t part = std::max(band == SunBand::up ? count - count / 3 : count / 3, 1U);
      const std::vector<TestRay> made =
          make_horizon_rays(band, part, options.seed * 16 + a, params.planet.radius_m, params.atmosphere.height_m);
      tests[a].rays.insert(tests[a].rays.end(), made.begin(), made.end());
    }
    for (const TestRay& ray : tests[a].rays) tests[a].answers.queries.push_back(ray.query);
  }
  return tests;
}

// Summarises a model's errors over the rays of a test that a predicate selects.
ErrorSummary summarise_tests(std::span<const RayTest> tests, std::size_t model, int orders,
                             const std::function<bool(const TestRay&)>& takes) {
  std::vector<Comparison> comparisons;
  for (const RayTest& test : tests) {
    for (std::size_t i = 0; i < test.rays.size(); ++i) {
      const Truth right = truth(test.answers.reference[i], orders);
      if (takes(test.rays[i]) && is_comparable(right))
        comparisons.push_back(compare(test.answers.models[model][i], right));
    }
  }
  return summarise(comparisons);
}

std::vector<VerticalTest> make_verticals() {
  std::vector<VerticalTest> tests;
  for (const double sun : kVerticalSuns_deg) {
    VerticalTest test;
    test.sun_elevation_deg = sun;
    for (int angle = -90; angle <= 90; angle += 5) {
      // Avoid the horizon itself, where the result is undefined.
      const double angle_deg = std::clamp(static_cast<double>(angle), -89.5, 89.5);
      test.angle_deg.push_back(angle_deg);
      test.answers.queries.push_back(query_of(0.0, std::abs(angle_deg), sun, angle_deg < 0.0 ? 0.0 : 180.0));
    }
    tests.push_back(std::move(test));
  }
  return tests;
}

SkyTest make_sky() {
  SkyTest test;
  for (const double sun : {90.0, 75.0, 60.0, 45.0, 30.0, 20.0, 15.0, 10.0, 8.0,  6.0,  4.0, 3.0,
                           2.0,  1.0,  0.0,  -1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -7.0, -8.0}) {
    test.sun_elevation_deg.push_back(sun);
    RayQuery query = query_of(0.0, 0.0, sun, 0.0);
    query.sky_irradiance = true;
    test.answers.queries.push_back(query);
  }
  return test;
}

std::vector<HorizonTest> make_horizons(const Params& params) {
  std::vector<HorizonTest> tests;
  const double radius = params.planet.radius_m;
  const double dip_deg = std::acos(radius / (radius + kHorizonAltitude_m)) / kRadPerDeg;
  for (const double sun : kHorizonSuns_deg) {
    HorizonTest test;
    test.altitude_m = kHorizonAltitude_m;
    test.sun_elevation_deg = sun;
    for (int i = -16; i <= 24; ++i) {
      const double elevation = 0.25 * i + 0.125;
      test.elevation_deg.push_back(elevation);
      test.answers.queries.push_back(query_of(kHorizonAltitude_m, 90.0 + dip_deg - elevation, sun, 60.0));
    }
    tests.push_back(std::move(test));
  }
  return tests;
}

}  // namespace

std::vector<Atmosphere> atmospheres(const Params& params) {
  std::vector<Atmosphere> out = {{"as given", params}, {"five times the aerosol", params}, {"without ozone", params}};
  AtmosphereParams& turbid = out[1].params.atmosphere;
  turbid.aerosol_density *= 5.0F;
  // An optical depth or a visibility replaces the density, and a column of ozone its absorption.
  if (turbid.visibility_m > 0.0F) {
    const reference::Atmosphere medium(params);
    const double to_550_nm = std::pow(static_cast<double>(turbid.wavelengths_nm.y) / 550.0, turbid.angstrom_exponent);
    turbid.aerosol_optical_depth = static_cast<float>(medium.mie_extinction[1] * medium.mie_scale_height_m * to_550_nm);
    turbid.visibility_m = 0.0F;
  }
  turbid.aerosol_optical_depth = std::min(5.0F * turbid.aerosol_optical_depth, 100.0F);
  out[2].params.atmosphere.ozone_absorption = {0.0F, 0.0F, 0.0F};
  out[2].params.atmosphere.ozone_du = 0.0F;
  return out;
}

Params turbid_params(const Params& params, const TurbidAir& air) {
  Params out = params;
  out.planet.ground_albedo = Vec3(static_cast<float>(air.ground_albedo));
  if (out.atmosphere.aerosol_optical_depth > 0.0F || out.atmosphere.visibility_m > 0.0F) {
    out.atmosphere.aerosol_optical_depth = static_cast<float>(air.optical_depth);
    out.atmosphere.visibility_m = 0.0F;
    return out;
  }
  const reference::Atmosphere medium(params);
  const double depth = medium.mie_extinction[1] * medium.mie_scale_height_m;
  if (depth > 0.0) out.atmosphere.aerosol_density *= static_cast<float>(air.optical_depth / depth);
  return out;
}

Truth truth(const reference::Estimate& estimate, int orders) {
  if (orders <= 0 || static_cast<std::size_t>(orders) >= estimate.order_radiance.size()) {
    return {estimate.radiance, estimate.standard_error};
  }
  Truth out = {};
  for (std::size_t n = 0; n < static_cast<std::size_t>(orders); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      out.value[c] += estimate.order_radiance[n][c];
      out.standard_error[c] = std::hypot(out.standard_error[c], estimate.order_standard_error[n][c]);
    }
  }
  return out;
}

bool is_comparable(const Truth& truth) {
  const double largest = *std::max_element(truth.value.begin(), truth.value.end());
  const double noise = *std::max_element(truth.standard_error.begin(), truth.standard_error.end());
  return largest > 0.0 && noise <= kMaxNoise * largest;
}

Comparison compare(const Rgb& model, const Truth& truth) {
  Comparison out = {relative_error(model, truth.value), {}};
  const double largest = *std::max_element(truth.value.begin(), truth.value.end());
  for (std::size_t c = 0; c < 3; ++c) out.noise[c] = truth.standard_error[c] / largest;
  return out;
}

Study prepare_study(const Params& params, const Options& options, std::vector<Model> models,
                    std::vector<Model> horizon_models) {
  Study study;
  study.options = options;
  study.models = std::move(models);
  study.horizon_models = std::move(horizon_models);
  study.atmospheres = atmospheres(params);
  study.rays = make_ray_tests(study.atmospheres, options);
  study.turbid = make_turbid_tests(params, options);
  study.verticals = make_verticals();
  study.sky = make_sky();
  if (!study.horizon_models.empty()) study.horizons = make_horizons(params);
  return study;
}

std::vector<Evaluation> evaluations(Study& study, const Params& params) {
  const Options& options = study.options;
  std::vector<Evaluation> out;
  const auto add = [&](const Params& air, const std::vector<Model>& models, std::uint64_t samples,
                       std::vector<Answers*> answers, int orders_factor = 1) {
    reference::Options how;
    how.samples = samples;
    how.orders = orders_factor * options.orders;
    // Use different random numbers for each set of queries.
    how.seed = options.seed + 1000 * out.size();
    how.by_order = true;
    out.push_back({air, &models, how, std::move(answers)});
  };
  // Complete one atmosphere before the next, because a model may hold the tables of the last one.
  add(study.atmospheres[0].params, study.models, options.samples, {&study.rays[0].answers});
  std::vector<Answers*> verticals;
  for (VerticalTest& test : study.verticals) verticals.push_back(&test.answers);
  add(params, study.models, options.samples, verticals);
  add(params, study.models, std::uint64_t{kSkyFactor} * options.samples, {&study.sky.answers});
  std::vector<Answers*> horizons;
  for (HorizonTest& test : study.horizons) horizons.push_back(&test.answers);
  if (!horizons.empty()) add(params, study.horizon_models, options.samples, horizons);
  for (std::size_t a = 1; a < study.rays.size(); ++a) {
    add(study.atmospheres[a].params, study.models, options.samples, {&study.rays[a].answers});
  }
  for (std::size_t a = 0; a < study.turbid.size(); ++a) {
    add(turbid_params(params, kTurbidAirs[a]), study.models, kTurbidSamplesFactor * options.samples,
        {&study.turbid[a].answers}, kTurbidOrdersFactor);
  }
  return out;
}

ErrorSummary summarise(const Study& study, std::size_t model, std::size_t atmosphere,
                       const std::function<bool(const TestRay&)>& takes) {
  return summarise_tests({&study.rays[atmosphere], 1}, model, study.models[model].orders, takes);
}

ErrorSummary summarise_turbid(const Study& study, std::size_t model, std::size_t first, std::size_t count,
                              const std::function<bool(const TestRay&)>& takes) {
  return summarise_tests(std::span(study.turbid).subspan(first, count), model, study.models[model].orders, takes);
}

std::vector<BadRay> worst_rays(const Study& study, std::size_t model, std::size_t count) {
  std::vector<BadRay> out;
  for (std::size_t a = 0; a < study.rays.size(); ++a) {
    const RayTest& test = study.rays[a];
    for (std::size_t i = 0; i < test.rays.size(); ++i) {
      const Truth right = truth(test.answers.reference[i], study.models[model].orders);
      if (is_comparable(right)) out.push_back({a, i, compare(test.answers.models[model][i], right)});
    }
  }
  const auto error = [](const BadRay& r) {
    return *std::max_element(r.comparison.error.begin(), r.comparison.error.end());
  };
  std::stable_sort(out.begin(), out.end(), [&](const BadRay& a, const BadRay& b) { return error(a) > error(b); });
  out.resize(std::min(out.size(), count));
  return out;
}

ErrorSummary summarise_sky(const Study& study, std::size_t model, double low_deg, double high_deg) {
  std::vector<Comparison> comparisons;
  for (std::size_t i = 0; i < study.sky.sun_elevation_deg.size(); ++i) {
    const double sun = study.sky.sun_elevation_deg[i];
    const Truth right = truth(study.sky.answers.reference[i], study.models[model].orders);
    if (sun >= low_deg && sun <= high_deg && is_comparable(right)) {
      comparisons.push_back(compare(study.sky.answers.models[model][i], right));
    }
  }
  return summarise(comparisons);
}

}  // namespace tyndall::validate
