// Parts of a study: the answers to some of its queries, which several machines compute separately. The queries of a
// study are numbered from 0 in a fixed order, and query k belongs to part k mod count. Together, the parts give the
// same study, bit for bit, as one run.
#pragma once

#include <functional>
#include <vector>

#include "validate/color.hpp"
#include "validate/study.hpp"

namespace tyndall::validate {

struct PartIndex {
  std::uint64_t index = 0, count = 1;  // index < count
};

// The answers to one query.
struct Answered {
  reference::Estimate reference;
  std::vector<Rgb> models;
};
struct ColorAnswered {
  Color reference = {};
  double noise = 0.0;
  std::vector<Color> models;
};

// The answers of a part, in the order of the queries.
using StudyPart = std::vector<Answered>;
using ColorPart = std::vector<ColorAnswered>;

// Computes a part of run_study().
[[nodiscard]] Result<StudyPart> run_study_part(const Params& params, const Options& options,
                                               const std::vector<Model>& models,
                                               const std::vector<Model>& horizon_models, PartIndex part,
                                               const Progress& progress);
// Joins all parts, in order. The models are not evaluated; only their names, meanings and orders are used. Fails
// (invalid_argument) if the parts are not those of such a study.
[[nodiscard]] Result<Study> join_study(const Params& params, const Options& options, std::vector<Model> models,
                                       std::vector<Model> horizon_models, const std::vector<StudyPart>& parts);

// Computes a part of run_color_test(), as run_study_part() does for a study.
[[nodiscard]] Result<ColorPart> run_color_part(const Params& params, const std::vector<ColorModel>& models,
                                               std::uint64_t samples, std::uint64_t seed, int orders, PartIndex part,
                                               const std::function<void(double)>& progress);
[[nodiscard]] Result<ColorTest> join_colors(const std::vector<ColorModel>& models, const std::vector<ColorPart>& parts);

// The number of queries of the study, and of the test of colours.
[[nodiscard]] std::size_t count_queries(const Params& params, const Options& options, bool with_horizon);

}  // namespace tyndall::validate
