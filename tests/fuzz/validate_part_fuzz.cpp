// The results of a shard of `validate`: accepted ones are written and read back unchanged, and every report can be made
// of them.
#include "validate_part.hpp"

#include <nlohmann/json.hpp>

#include "fuzz.hpp"
#include "validate/report.hpp"

namespace {

using namespace tyndall;
using validate::Model;

// A study without answers. Preparing one takes too long for each input.
struct Prepared {
  std::vector<Model> models = {{"model", "a model", 0, {}}, {"single", "one order", 1, {}}};
  validate::Study study = validate::prepare_study({}, {18, 2, 1, 1}, models, models);
  std::vector<validate::Evaluation> steps = validate::evaluations(study, {});
};

// Makes reports of a study whose results repeat those of `rays` and `colors`.
void make_reports(const validate::StudyPart& rays, const validate::ColorPart& colors) {
  static Prepared prepared;
  std::size_t query = 0;
  for (const validate::Evaluation& step : prepared.steps) {
    for (validate::Answers* const answers : step.answers) {
      const std::size_t count = answers->queries.size();
      answers->reference.resize(count);
      answers->models.assign(step.models->size(), std::vector<validate::Rgb>(count));
      for (std::size_t i = 0; i < count; ++i, ++query) {
        const validate::Answered& ray = rays[query % rays.size()];
        answers->reference[i] = ray.reference;
        answers->reference[i].order_radiance.resize(static_cast<std::size_t>(step.how.orders));
        answers->reference[i].order_standard_error.resize(static_cast<std::size_t>(step.how.orders));
        for (std::size_t m = 0; m < std::min(step.models->size(), ray.models.size()); ++m)
          answers->models[m][i] = ray.models[m];
      }
    }
  }
  const validate::Study& study = prepared.study;
  validate::ColorPart all;
  const std::vector<validate::ColorModel> color_models = {{"model", {}}};
  while (all.size() < validate::color_rays().size()) {
    all.push_back(colors[all.size() % colors.size()]);
    all.back().models.resize(1);
  }
  const Result<validate::ColorTest> test = validate::join_colors(color_models, {std::move(all)});
  fuzz::require(test.ok(), "the test of colours is complete");
  const validate::Origin origin = {"command", "version", "device"};
  fuzz::require(!to_html(study, origin).empty(), "there is a report");
  fuzz::require(!to_markdown(study, test.value(), origin).empty(), "there is a page");
  fuzz::require(nlohmann::json::accept(to_json(study, test.value(), origin)), "the numbers are JSON");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  validate::StudyPart rays;
  validate::ColorPart colors;
  const Result<void> parsed = cli::parse_part(fuzz::text_of(data, size), "part", rays, colors);
  if (!parsed) {
    fuzz::require_one_line(parsed.error());
    return 0;
  }
  const std::string written = cli::part_json(rays, colors);
  validate::StudyPart rays_again;
  validate::ColorPart colors_again;
  fuzz::require(cli::parse_part(written, "written", rays_again, colors_again).ok(), "written results are read back");
  fuzz::require(cli::part_json(rays_again, colors_again) == written, "written results are read back unchanged");
  if (!rays.empty() && !colors.empty()) make_reports(rays, colors);
  return 0;
}
