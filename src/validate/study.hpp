// All that a report says, as numbers: the models' and the reference's answers to the same questions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tyndall/params.hpp"
#include "tyndall/result.hpp"
#include "validate/rays.hpp"
#include "validate/statistics.hpp"

namespace tyndall::validate {

// The part of the work done, 0 to 1.
using Progress = std::function<void(double done)>;

struct Model {
  std::string name;     // as in reports
  std::string meaning;  // one line
  int orders = 0;       // it is compared with the reference's first so many orders; 0: with all
  // Answers every query with radiance / E0, or irradiance / E0 of the sky.
  std::function<Result<std::vector<Rgb>>(const Params& params, std::span<const RayQuery> queries)> answer;
};

struct Options {
  std::uint32_t rays = 540;      // over all groups; the turbid set has a quarter as many more
  std::uint32_t samples = 8000;  // paths per ray; four times as many for the irradiance of the sky
  std::uint64_t seed = 1;
  int orders = 8;  // of the reference
};

struct Atmosphere {
  std::string name;
  Params params;
};
// As given, with five times its aerosol, and without its ozone.
[[nodiscard]] std::vector<Atmosphere> atmospheres(const Params& params);

// Turbid air near the horizon under low suns: where models of multiple scattering are put to the test.
struct TurbidAir {
  double optical_depth;  // of the aerosol, vertical, at the second wavelength
  double ground_albedo;
};
constexpr TurbidAir kTurbidAirs[] = {{0.1, 0.0}, {0.2, 0.2}, {0.3, 0.0}, {0.5, 0.2}};
// As given, with that amount of aerosol and that ground. Air without aerosol stays without.
[[nodiscard]] Params turbid_params(const Params& params, const TurbidAir& air);
// In such air, light is scattered more often: the reference follows it for so many times the orders.
constexpr int kTurbidOrdersFactor = 3;

// Questions with the answers of everyone.
struct Answers {
  std::vector<RayQuery> queries;
  std::vector<reference::Estimate> reference;  // with orders
  std::vector<std::vector<Rgb>> models;        // [model][query]
};

// What a model is compared with: the reference's first `orders` orders (0: all), and its standard error.
struct Truth {
  Rgb value, standard_error;
};
[[nodiscard]] Truth truth(const reference::Estimate& estimate, int orders);
// Nothing where the reference is dark, or so noisy (more than 3 %) that it says nothing.
[[nodiscard]] bool is_comparable(const Truth& truth);
[[nodiscard]] Comparison compare(const Rgb& model, const Truth& truth);

struct RayTest {
  std::vector<TestRay> rays;
  Answers answers;
};

// Along the vertical through the sun at sea level: angles from the zenith, negative on the sun's side.
struct VerticalTest {
  double sun_elevation_deg = 0.0;
  std::vector<double> angle_deg;
  Answers answers;
};

// The sky's irradiance at sea level.
struct SkyTest {
  std::vector<double> sun_elevation_deg;
  Answers answers;
};

// The sky just above and below the horizon at an altitude, in the sun's vertical, by some models.
struct HorizonTest {
  double altitude_m = 0.0;
  double sun_elevation_deg = 0.0;
  std::vector<double> elevation_deg;  // of the view, from the horizon
  Answers answers;                    // the models are Study::horizon_models
};

struct Study {
  Options options;
  std::vector<Model> models;
  std::vector<Model> horizon_models;  // of the horizon test alone; without any it is left out
  std::vector<Atmosphere> atmospheres;
  std::vector<RayTest> rays;    // one per atmosphere
  std::vector<RayTest> turbid;  // one per entry of kTurbidAirs
  std::vector<VerticalTest> verticals;
  SkyTest sky;
  std::vector<HorizonTest> horizons;
};

// Asks everyone. Deterministic for the options and the models' device.
[[nodiscard]] Result<Study> run_study(const Params& params, const Options& options, std::vector<Model> models,
                                      std::vector<Model> horizon_models, const Progress& progress);

// Errors of a model over the rays of one atmosphere that a predicate takes.
[[nodiscard]] ErrorSummary summarise(const Study& study, std::size_t model, std::size_t atmosphere,
                                     const std::function<bool(const TestRay&)>& takes);
// Likewise over the rays of one of kTurbidAirs.
[[nodiscard]] ErrorSummary summarise_turbid(const Study& study, std::size_t model, std::size_t air,
                                            const std::function<bool(const TestRay&)>& takes);
// The rays of all atmospheres on which a model is furthest off, worst first.
struct BadRay {
  std::size_t atmosphere = 0;
  std::size_t ray = 0;  // of rays[atmosphere]
  Comparison comparison;
};
[[nodiscard]] std::vector<BadRay> worst_rays(const Study& study, std::size_t model, std::size_t count);

// Of the sky's irradiance, over the elevations from `low` to `high` [deg].
[[nodiscard]] ErrorSummary summarise_sky(const Study& study, std::size_t model, double low_deg, double high_deg);

}  // namespace tyndall::validate
