#include "validate/parts.hpp"

#include <algorithm>

namespace tyndall::validate {
namespace {

// Returns the position in a part of query k; all earlier queries of the part come before it.
std::uint64_t position(std::uint64_t query, std::uint64_t count) { return query / count; }

// Returns the first of the queries from `offset` on that belongs to the part, relative to `offset`.
std::uint64_t first_of(PartIndex part, std::uint64_t offset) {
  return (part.index + part.count - offset % part.count) % part.count;
}

// Returns the number of queries among `total` that belong to the part.
std::uint64_t size_of(PartIndex part, std::uint64_t total) {
  return total > part.index ? (total - 1 - part.index) / part.count + 1 : 0;
}

std::vector<RayQuery> queries_of(const Evaluation& evaluation) {
  std::vector<RayQuery> out;
  for (const Answers* const answers : evaluation.answers)
    out.insert(out.end(), answers->queries.begin(), answers->queries.end());
  return out;
}

template <typename T>
std::vector<T> chosen_from(const std::vector<T>& all, std::uint64_t first, std::uint64_t stride) {
  std::vector<T> out;
  for (std::uint64_t i = first; i < all.size(); i += stride) out.push_back(all[i]);
  return out;
}

Error part_error() {
  return {ErrorCode::invalid_argument, "the parts do not have the queries or models of this study"};
}

template <typename Part>
bool sizes_fit(const std::vector<Part>& parts, std::uint64_t total) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].size() != size_of({i, parts.size()}, total)) return false;
  }
  return !parts.empty();
}

}  // namespace

std::size_t count_queries(const Params& params, const Options& options, bool with_horizon) {
  Study study = prepare_study(params, options, {}, with_horizon ? std::vector<Model>(1) : std::vector<Model>());
  std::size_t count = color_rays().size();
  for (const Evaluation& evaluation : evaluations(study, params)) count += queries_of(evaluation).size();
  return count;
}

Result<StudyPart> run_study_part(const Params& params, const Options& options, const std::vector<Model>& models,
                                 const std::vector<Model>& horizon_models, PartIndex part, const Progress& progress) {
  Study study = prepare_study(params, options, models, horizon_models);
  const std::vector<Evaluation> steps = evaluations(study, params);
  double work = 0.0;
  for (const Evaluation& step : steps) {
    work += static_cast<double>(step.how.samples) * static_cast<double>(queries_of(step).size());
  }
  StudyPart out;
  std::uint64_t offset = 0;
  double done = 0.0;
  for (const Evaluation& step : steps) {
    const std::vector<RayQuery> queries = queries_of(step);
    reference::Options how = step.how;
    how.first = first_of(part, offset);
    how.stride = part.count;
    const double share = static_cast<double>(how.samples) * static_cast<double>(queries.size());
    Result<std::vector<reference::Estimate>> estimates =
        reference::trace(step.params, queries, how, [&](double fraction) {
          progress(std::min((done + fraction * share) / work, 1.0));
          return true;
        });
    if (!estimates) return std::move(estimates).error();
    done += share;
    offset += queries.size();
    const std::vector<RayQuery> chosen = chosen_from(queries, how.first, how.stride);
    const std::size_t begin = out.size();
    for (reference::Estimate& estimate : estimates.value()) out.push_back({std::move(estimate), {}});
    if (chosen.empty()) continue;
    for (const Model& model : *step.models) {
      const Result<std::vector<Rgb>> found = model.answer(step.params, chosen);
      if (!found) return found.error();
      for (std::size_t i = 0; i < chosen.size(); ++i) out[begin + i].models.push_back(found.value()[i]);
    }
  }
  return out;
}

Result<Study> join_study(const Params& params, const Options& options, std::vector<Model> models,
                         std::vector<Model> horizon_models, const std::vector<StudyPart>& parts) {
  Study study = prepare_study(params, options, std::move(models), std::move(horizon_models));
  const std::vector<Evaluation> steps = evaluations(study, params);
  std::uint64_t total = 0;
  for (const Evaluation& step : steps) total += queries_of(step).size();
  if (!sizes_fit(parts, total)) return part_error();
  std::uint64_t query = 0;
  for (const Evaluation& step : steps) {
    for (Answers* const answers : step.answers) {
      answers->models.resize(step.models->size());
      for (std::size_t i = 0; i < answers->queries.size(); ++i, ++query) {
        const Answered& answered = parts[query % parts.size()][position(query, parts.size())];
        if (answered.models.size() != step.models->size() ||
            answered.reference.order_radiance.size() != static_cast<std::size_t>(step.how.orders) ||
            answered.reference.order_standard_error.size() != answered.reference.order_radiance.size()) {
          return part_error();
        }
        answers->reference.push_back(answered.reference);
        for (std::size_t m = 0; m < step.models->size(); ++m) answers->models[m].push_back(answered.models[m]);
      }
    }
  }
  return study;
}

Result<Study> run_study(const Params& params, const Options& options, std::vector<Model> models,
                        std::vector<Model> horizon_models, const Progress& progress) {
  Result<StudyPart> whole = run_study_part(params, options, models, horizon_models, {}, progress);
  if (!whole) return std::move(whole).error();
  return join_study(params, options, std::move(models), std::move(horizon_models), {std::move(whole).value()});
}

Result<ColorTest> join_colors(const std::vector<ColorModel>& models, const std::vector<ColorPart>& parts) {
  ColorTest out;
  out.rays = color_rays();
  for (const ColorModel& model : models) out.models.push_back(model.name);
  out.answers.resize(models.size());
  if (!sizes_fit(parts, out.rays.size())) return part_error();
  for (std::uint64_t query = 0; query < out.rays.size(); ++query) {
    const ColorAnswered& answered = parts[query % parts.size()][position(query, parts.size())];
    if (answered.models.size() != models.size()) return part_error();
    out.reference.push_back(answered.reference);
    out.noise.push_back(answered.noise);
    for (std::size_t m = 0; m < models.size(); ++m) out.answers[m].push_back(answered.models[m]);
  }
  return out;
}

Result<ColorTest> run_color_test(const Params& params, const std::vector<ColorModel>& models, std::uint64_t samples,
                                 std::uint64_t seed, int orders, const std::function<void(double)>& progress) {
  Result<ColorPart> whole = run_color_part(params, models, samples, seed, orders, {}, progress);
  if (!whole) return std::move(whole).error();
  return join_colors(models, {std::move(whole).value()});
}

}  // namespace tyndall::validate
