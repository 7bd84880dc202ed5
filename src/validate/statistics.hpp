// Errors of a model against the reference: of a channel relative to the largest channel of the reference, so
// that dark channels do not dominate.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/path_tracer.hpp"

namespace tyndall::validate {

using reference::Rgb;

// |model - reference| / largest channel of the reference; not finite where the reference is dark.
[[nodiscard]] Rgb relative_error(const Rgb& model, const Rgb& reference);

struct Summary {
  std::size_t count = 0;
  double mean = 0.0, median = 0.0, p95 = 0.0, worst = 0.0;  // quantiles by nearest rank
};

// Of the values that are finite.
[[nodiscard]] Summary summarise(std::vector<double> values);

struct ErrorSummary {
  std::array<Summary, 3> channels;
  Summary all;         // the three channels together
  double noise = 0.0;  // mean of the reference's standard errors, in the same measure: a floor under `mean`
};

struct Comparison {
  Rgb error;  // relative_error
  Rgb noise;  // standard error of the reference, relative likewise
};

[[nodiscard]] ErrorSummary summarise(std::span<const Comparison> comparisons);

}  // namespace tyndall::validate
