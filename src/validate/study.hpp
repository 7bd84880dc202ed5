// The numbers of a report: the results of the models and of the reference for the same rays.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tyndall/params.hpp"
#include "tyndall/result.hpp"
#include "validate/rays.hpp"
#include "validate/statistics.hpp"

namespace tyndall::validate {

// Called with the completed fraction of the work, 0 to 1.
using Progress = std::function<void(double done)>;

struct Model {
  std::string name;     // name in reports
  std::string meaning;  // one line
  int orders = 0;       // compare with the sum of this many orders of the reference; 0: all
  // Returns radiance / E0, or the sky's irradiance / E0, for every query.
  std::function<Result<std::vector<Rgb>>(const Params& params, std::span<const RayQuery> queries)> answer;
};

struct Options {
  std::uint32_t rays = 540;  // over all groups; the turbid set has a quarter of this in addition
  // Paths per ray; four times as many for the sky's irradiance, and 16 times as many in turbid atmospheres.
  std::uint32_t samples = 8000;
  std::uint64_t seed = 1;
  int orders = 8;  // orders of scattering of the reference
};

struct Atmosphere {
  std::string name;
  Params params;
};
// Returns the given atmosphere, the same with five times its aerosol, and the same without ozone.
[[nodiscard]] std::vector<Atmosphere> atmospheres(const Params& params);

// A turbid atmosphere, for rays near the horizon under low suns: the hardest case for multiple scattering.
struct TurbidAir {
  double optical_depth;  // vertical optical depth of the aerosol at the second wavelength
  double ground_albedo;
};
constexpr TurbidAir kTurbidAirs[] = {{0.15, 0.0}, {0.15, 0.2}, {0.3, 0.0}, {0.3, 0.2}, {0.5, 0.0}, {0.5, 0.2}};
// Returns the parameters with that amount of aerosol and that ground albedo. Without aerosol they are unchanged.
[[nodiscard]] Params turbid_params(const Params& params, const TurbidAir& air);
// Turbid atmospheres need more orders of scattering: their reference has this many times as many.
constexpr int kTurbidOrdersFactor = 3;
// They also need this many times as many paths per ray. With fewer paths, the noise of the reference would exceed the
// errors of the tables.
constexpr std::uint64_t kTurbidSamplesFactor = 16;

// Queries with the results of the reference and of all models.
struct Answers {
  std::vector<RayQuery> queries;
  std::vector<reference::Estimate> reference;  // with orders
  std::vector<std::vector<Rgb>> models;        // [model][query]
};

// The value that a model is compared with: the sum of the reference's first `orders` orders (0: all).
struct Truth {
  Rgb value, standard_error;
};
[[nodiscard]] Truth truth(const reference::Estimate& estimate, int orders);
// Returns false where the reference is dark, or has a standard error above 3 %.
[[nodiscard]] bool is_comparable(const Truth& truth);
[[nodiscard]] Comparison compare(const Rgb& model, const Truth& truth);

struct RayTest {
  std::vector<TestRay> rays;
  Answers answers;
};

// Rays from sea level in the vertical plane of the sun. `angle_deg` is the zenith angle, negative on the sun's side.
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

// The sky just above and below the horizon, at an altitude and 60 degrees to the side of the sun, for some models.
struct HorizonTest {
  double altitude_m = 0.0;
  double sun_elevation_deg = 0.0;
  std::vector<double> elevation_deg;  // angle of the view above the horizon
  Answers answers;                    // the models are Study::horizon_models
};

struct Study {
  Options options;
  std::vector<Model> models;
  std::vector<Model> horizon_models;  // for the horizon test only, which is left out if there are none
  std::vector<Atmosphere> atmospheres;
  std::vector<RayTest> rays;    // one per atmosphere
  std::vector<RayTest> turbid;  // one per entry of kTurbidAirs
  std::vector<VerticalTest> verticals;
  SkyTest sky;
  std::vector<HorizonTest> horizons;
};

// Runs the reference and all models. Deterministic for given options and device.
[[nodiscard]] Result<Study> run_study(const Params& params, const Options& options, std::vector<Model> models,
                                      std::vector<Model> horizon_models, const Progress& progress);

// Returns the study without answers.
[[nodiscard]] Study prepare_study(const Params& params, const Options& options, std::vector<Model> models,
                                  std::vector<Model> horizon_models);

// A step of a study: the reference and some models for queries of one atmosphere.
struct Evaluation {
  Params params;
  const std::vector<Model>* models;  // models of the study
  reference::Options how;
  std::vector<Answers*> answers;  // answers of the study; their queries, one after the other, are evaluated together
};
// Returns the steps of a study in order. The steps refer to the study.
[[nodiscard]] std::vector<Evaluation> evaluations(Study& study, const Params& params);

// Summarises a model's errors over the rays of one atmosphere that a predicate selects.
[[nodiscard]] ErrorSummary summarise(const Study& study, std::size_t model, std::size_t atmosphere,
                                     const std::function<bool(const TestRay&)>& takes);
// Summarises a model's errors over the selected rays of `count` of kTurbidAirs, from the index `first`.
[[nodiscard]] ErrorSummary summarise_turbid(const Study& study, std::size_t model, std::size_t first, std::size_t count,
                                            const std::function<bool(const TestRay&)>& takes);
// A ray on which a model has one of its largest errors.
struct BadRay {
  std::size_t atmosphere = 0;
  std::size_t ray = 0;  // index in rays[atmosphere]
  Comparison comparison;
};
// Returns the `count` rays of all atmospheres with the model's largest errors, worst first.
[[nodiscard]] std::vector<BadRay> worst_rays(const Study& study, std::size_t model, std::size_t count);

// Summarises a model's errors of the sky's irradiance for sun elevations from `low` to `high` [deg].
[[nodiscard]] ErrorSummary summarise_sky(const Study& study, std::size_t model, double low_deg, double high_deg);

}  // namespace tyndall::validate
