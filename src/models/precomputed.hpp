// Evaluates the renderer's scattering tables for given rays: the model `precomputed` of `probe` and `validate`.
// Prepares the tables of a set of parameters on a device once and reads them with the renderer's own shader code. Use
// from one thread at a time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gpu/host.hpp"
#include "models/single_scattering.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::models {

class PrecomputedModel {
 public:
  static Result<PrecomputedModel> create(gpu::Host& host, const Params& params, const tables::MakeReady& how = {});
  PrecomputedModel(PrecomputedModel&&) noexcept;
  PrecomputedModel& operator=(PrecomputedModel&&) noexcept;
  ~PrecomputedModel();

  // Returns one answer per query: radiance / E0 [1/sr] of the atmosphere and, with `visible_ground`, of the ground at
  // the ray's end; for the sky, E / E0 and the transmittance towards the sun. The parameter scattering.single decides
  // whether order 1 is integrated.
  Result<std::vector<Answer>> answer(std::span<const RayQuery> queries, bool visible_ground = true);

  // Sets parameters that leave the tables as they are.
  Result<void> set_params(const Params& params);
  [[nodiscard]] const Params& params() const;
  // Returns how the tables were obtained: from the cache, or by building them.
  [[nodiscard]] const tables::Report& origin() const;
  // The effect that holds the tables, for build times, memory use, and images to export.
  [[nodiscard]] Effect& effect();

 private:
  struct State;
  explicit PrecomputedModel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall::models
