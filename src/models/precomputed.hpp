// What the renderer's scattering tables answer for given rays: the model `precomputed` of `probe` and
// `validate`. Makes the tables of a set of parameters ready on a device once and reads them there, with the
// renderer's own shader code. One thread at a time.
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

  // One answer per query. Radiance / E0 [1/sr] of air and, with `visible_ground`, of the ground at the ray's
  // end; for the sky E / E0 and the transmittance towards the sun. scattering.single of the parameters says
  // whether order 1 is integrated.
  Result<std::vector<Answer>> answer(std::span<const RayQuery> queries, bool visible_ground = true);

  // Where its tables came from.
  [[nodiscard]] const tables::Outcome& origin() const;
  // The effect that holds the tables: times of the stages, memory, images for export.
  [[nodiscard]] Effect& effect();

 private:
  struct State;
  explicit PrecomputedModel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall::models
