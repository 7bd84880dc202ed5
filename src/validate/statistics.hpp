// Errors of a model against the reference, relative to the largest channel of the reference, so that dark channels do
// not dominate.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/path_tracer.hpp"

namespace tyndall::validate {

using reference::Rgb;

// Returns |model - reference| / largest channel of the reference; not finite where the reference is dark.
[[nodiscard]] Rgb relative_error(const Rgb& model, const Rgb& reference);

struct Summary {
  std::size_t count = 0;
  double mean = 0.0, median = 0.0, p95 = 0.0, worst = 0.0;  // quantiles by nearest rank
};

// Summarises the finite values.
[[nodiscard]] Summary summarise(std::vector<double> values);

struct ErrorSummary {
  std::array<Summary, 3> channels;
  Summary all;         // the three channels together
  double noise = 0.0;  // mean standard error of the reference in the same measure: a lower limit of `mean`
};

struct Comparison {
  Rgb error;  // relative_error
  Rgb noise;  // standard error of the reference, relative in the same way
};

[[nodiscard]] ErrorSummary summarise(std::span<const Comparison> comparisons);

}  // namespace tyndall::validate
