#include "merge_shards.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli.hpp"
#include "config/settings.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "input_files.hpp"
#include "manifest.hpp"
#include "merge_tables.hpp"
#include "reference/path_tracer.hpp"
#include "validate/parts.hpp"
#include "validate/report.hpp"
#include "validate_part.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;
using files::input_error;

constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 34U;  // bytes

// A manifest and where it is.
struct Part {
  Manifest manifest;
  std::string path, folder;
  [[nodiscard]] std::string shown() const { return files::one_line(path, 200); }
};

// The shards of a run, in order.
using Run = std::vector<Part>;

// Returns the inputs that have to be equal: for tables of the path tracer all except its random numbers.
Inputs compared(const Manifest& manifest) {
  Inputs out = manifest.inputs;
  if (manifest.verb == "probe")
    std::erase_if(out, [](const auto& input) { return input.first == "--seed" || input.first == "--samples"; });
  return out;
}

Result<void> check_equal(const Part& first, const Part& part) {
  const auto differs = [&](std::string_view what) {
    return input_error(concat({what, " is not that of '", first.shown(), "'"}), part.shown(),
                       "expected shards of one run");
  };
  if (part.manifest.verb != first.manifest.verb) return differs("the verb");
  if (part.manifest.version != first.manifest.version) return differs("the version");
  const std::string name = first_difference(compared(first.manifest), compared(part.manifest));
  if (!name.empty()) return differs(concat({"the parameter ", files::one_line(name)}));
  if (part.manifest.total != first.manifest.total) return differs("the number of frames, maps, rows or rays");
  return {};
}

// Reads the manifests, and sorts them into runs. Only tables of the path tracer can be of several runs.
Result<std::vector<Run>> read_runs(const std::vector<std::string>& paths) {
  std::map<std::string, Run> by_seed;
  Part first;
  for (const std::string& path : paths) {
    Result<Manifest> manifest = read_manifest(path);
    // An unreadable manifest is bad input, not a failure at run time.
    if (!manifest) return Error{ErrorCode::invalid_argument, std::move(manifest).error().message};
    Part part = {std::move(manifest).value(), path, fs::path(path).parent_path().string()};
    if (first.path.empty()) first = part;
    if (Result<void> r = check_equal(first, part); !r) return std::move(r).error();
    if (!part.manifest.complete) {
      return input_error(concat({"shard ", part.manifest.shard.text(), " is not complete"}), part.shown(),
                         "expected a finished shard; --resume completes it");
    }
    by_seed[part.manifest.verb == "probe" ? part.manifest.input("--seed") : std::string()].push_back(std::move(part));
  }
  std::vector<Run> out;
  for (auto& [seed, run] : by_seed) {
    std::sort(run.begin(), run.end(),
              [](const Part& a, const Part& b) { return a.manifest.shard.index < b.manifest.shard.index; });
    const std::string of_seed = seed.empty() ? std::string() : concat({" with seed ", files::one_line(seed)});
    const Shard& shard = run[0].manifest.shard;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const Manifest& manifest = run[i].manifest;
      if (manifest.shard.count != shard.count || manifest.input("--samples") != run[0].manifest.input("--samples")) {
        return input_error(
            concat({"the number of shards or samples", of_seed, " is not that of '", run[0].shown(), "'"}),
            run[i].shown(), "expected shards of one run");
      }
      if (i > 0 && manifest.shard.index == run[i - 1].manifest.shard.index) {
        return input_error(
            concat({"shard ", manifest.shard.text(), of_seed, " is given twice, also as '", run[i - 1].shown(), "'"}),
            run[i].shown(), "expected each shard once");
      }
    }
    for (std::uint32_t i = 0; i < shard.count; ++i) {
      if (i < run.size() && run[i].manifest.shard.index == i) continue;
      return input_error(concat({"shard ", Shard{i, shard.count}.text(), of_seed, " is missing"}), "tyndall merge",
                         concat({"expected the manifests of all ", std::to_string(shard.count), " shards"}));
    }
    out.push_back(std::move(run));
  }
  return out;
}

// Returns the path of the only file of a shard, after checking that it is as it was written.
Result<std::string> file_of(const Part& part) {
  const Manifest& manifest = part.manifest;
  if (manifest.items.size() != 1 || manifest.items[0].files.empty())
    return input_error("it does not list one table or report", part.shown(),
                       "expected a manifest of probe or validate");
  const ManifestFile& file = manifest.items[0].files[0];
  if (is_whole(file, part.folder)) return (fs::path(part.folder) / file.name).string();
  return input_error(concat({"its file '", files::one_line(file.name, 200), "' is missing, or not as it was written"}),
                     part.shown(), "expected an unchanged file; --resume makes it again");
}

Result<std::string> text_of(const Part& part, std::string& path) {
  Result<std::string> found = file_of(part);
  if (!found) return found;
  path = std::move(found).value();
  return files::read_file(path, kLargestTable);
}

Result<void> merge_tables(const std::string& output, const std::vector<Run>& runs) {
  std::vector<EstimateTable> tables;
  for (const Run& run : runs) {
    std::vector<ShardTable> shards;
    for (const Part& part : run) {
      std::string path;
      Result<std::string> text = text_of(part, path);
      if (!text) return std::move(text).error();
      shards.push_back({std::move(text).value(), path});
    }
    Result<std::string> whole = join_rows(std::move(shards));
    if (!whole) return std::move(whole).error();
    std::int64_t samples = 1;
    static_cast<void>(files::read_integer(run[0].manifest.input("--samples"), samples));
    tables.push_back({std::move(whole).value(), run[0].path,
                      reference::traced_samples(static_cast<std::uint64_t>(std::max<std::int64_t>(samples, 1)))});
  }
  if (tables.size() == 1) return files::write_file(output, tables[0].text);
  const Result<std::string> text = combine_estimates(tables);
  return text ? files::write_file(output, text.value()) : Result<void>(text.error());
}

// Returns the names of the devices of the shards, each once.
std::string devices_of(const Run& run) {
  std::vector<std::string> names;
  std::string out;
  for (const Part& part : run) {
    const std::string& name = part.manifest.device;
    if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    out.append(out.empty() ? "" : ", ").append(name);
  }
  return out;
}

// Restores the parameters of a study from a manifest. Those that name files are left out: the answers have been
// computed, and nothing that remains depends on them.
Result<Params> params_of(const Part& part) {
  config::Settings settings;
  for (const config::Row& row : config::rows()) {
    const std::string value = part.manifest.input(row.key());
    if (value.empty() || (row.info.type == ParamType::string && row.info.unit == "file")) continue;
    if (Result<void> r = config::set(settings, row.key(), value, part.shown()); !r) return std::move(r).error();
  }
  settings.effect.scattering.color = ColorMode::rgb;
  if (settings.effect.atmosphere.mie_phase == MiePhase::table)
    settings.effect.atmosphere.mie_phase = MiePhase::cornette_shanks;
  return settings.effect;
}

Result<validate::Options> options_of(const Part& part) {
  std::int64_t numbers[kStudyRanges.size()] = {};
  for (std::size_t i = 0; i < kStudyRanges.size(); ++i) {
    const StudyRange& range = kStudyRanges[i];
    const std::string text = part.manifest.input(range.option);
    const bool read = files::read_integer(text, numbers[i]) == files::NumberError::none;
    if (!read || numbers[i] < range.min || numbers[i] > range.max) {
      return input_error(concat({"invalid ", range.option, " '", files::one_line(text), "'"}), part.shown(),
                         "expected a manifest of validate");
    }
  }
  validate::Options out;
  out.rays = static_cast<std::uint32_t>(numbers[0]);
  out.samples = static_cast<std::uint32_t>(numbers[1]);
  out.seed = static_cast<std::uint64_t>(numbers[2]);
  out.orders = static_cast<int>(numbers[3]);
  return out;
}

Result<void> merge_reports(const std::string& output, const Run& run, const ValidateModels& models) {
  if (run.size() == 1)
    return input_error("one shard has a complete report", run[0].shown(), "expected the parts of at least two shards");
  const Result<Params> params = params_of(run[0]);
  if (!params) return params.error();
  const Result<validate::Options> options = options_of(run[0]);
  if (!options) return options.error();
  std::vector<validate::StudyPart> rays(run.size());
  std::vector<validate::ColorPart> colors(run.size());
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    std::string path;
    const Result<std::string> text = text_of(run[i], path);
    if (!text) return text.error();
    if (Result<void> r = parse_part(text.value(), path, rays[i], colors[i]); !r) return r;
    total += rays[i].size() + colors[i].size();
  }
  // A manifest cannot claim more rays than there are results.
  if (total != run[0].manifest.total || options.value().rays > total) {
    return input_error(concat({"there are the results of ", std::to_string(total), " rays in all files"}),
                       run[0].shown(), "expected the results of all rays");
  }
  const auto error = [&](const Error& e) {
    return input_error(e.message, run[0].shown(), "expected shards of one run");
  };
  const Result<validate::Study> study =
      validate::join_study(params.value(), options.value(), models.rays, models.horizon, rays);
  if (!study) return error(study.error());
  const Result<validate::ColorTest> test = validate::join_colors(models.colors, colors);
  if (!test) return error(test.error());
  const validate::Origin origin = {run[0].manifest.input("command"), run[0].manifest.version, devices_of(run)};
  return files::write_file(output, output.ends_with(".md")     ? to_markdown(study.value(), test.value(), origin)
                                   : output.ends_with(".json") ? to_json(study.value(), test.value(), origin)
                                                               : to_html(study.value(), origin));
}

// Writes one manifest of all items, after checking that each is there once.
Result<void> merge_manifests(const std::string& output, const Run& run) {
  Manifest merged = run[0].manifest;
  merged.shard = {};
  merged.device = devices_of(run);
  merged.items.clear();
  const std::string folder = fs::path(output).parent_path().string();
  for (const Part& part : run) {
    merged.time = std::max(merged.time, part.manifest.time);
    for (const ManifestItem& item : part.manifest.items) {
      if (!part.manifest.shard.takes(item.number) || item.number >= merged.total) {
        return input_error(
            concat({"item ", std::to_string(item.number), " does not belong to shard ", part.manifest.shard.text()}),
            part.shown(), "expected an unchanged manifest");
      }
      ManifestItem here = item;
      for (ManifestFile& file : here.files) {
        if (!is_whole(file, part.folder)) {
          return input_error(
              concat({"its file '", files::one_line(file.name, 200), "' is missing, or not as it was written"}),
              part.shown(), "expected an unchanged file; --resume makes it again");
        }
        file.name = relative_name((fs::path(part.folder) / file.name).string(), folder);
      }
      merged.items.push_back(std::move(here));
    }
  }
  std::sort(merged.items.begin(), merged.items.end(),
            [](const ManifestItem& a, const ManifestItem& b) { return a.number < b.number; });
  // Every number is there at most once, because the shards differ and their manifests are in order.
  for (std::uint64_t i = 0; i < merged.total; ++i) {
    if (i < merged.items.size() && merged.items[i].number == i) continue;
    return input_error(concat({"item ", std::to_string(i), " is missing"}), "tyndall merge", "expected each item once");
  }
  return files::write_file(output, to_json(merged));
}

// Checks the name of the output, and that it can be written without replacing an input.
Result<void> check_merged(const std::string& output, const std::string& verb, const std::vector<Run>& runs) {
  std::vector<std::string> endings = {".json"};
  if (verb == "probe") endings = {".csv"};
  if (verb == "validate") endings = {".html", ".htm", ".md", ".json"};
  std::string list;
  for (const std::string& ending : endings) list.append(list.empty() ? "" : " or ").append(ending);
  if (std::none_of(endings.begin(), endings.end(), [&](const std::string& e) { return output.ends_with(e); })) {
    return input_error(concat({"unknown format '", files::one_line(output), "' for shards of ", verb}), "OUT",
                       concat({"expected a name that ends in ", list}));
  }
  std::vector<InputFile> inputs;
  for (const Run& run : runs) {
    for (const Part& part : run) {
      inputs.push_back({"a manifest", part.path});
      for (const ManifestItem& item : part.manifest.items) {
        for (const ManifestFile& file : item.files)
          inputs.push_back({"a result", (fs::path(part.folder) / file.name).string()});
      }
    }
  }
  if (Result<void> r = check_not_input(output, "OUT", inputs); !r) return r;
  return files::check_writable(output);
}

}  // namespace

Result<void> merge_shards(const std::string& output, const std::vector<std::string>& paths,
                          const std::function<ValidateModels()>& models) {
  const Result<std::vector<Run>> runs = read_runs(paths);
  if (!runs) return runs.error();
  if (runs.value().empty()) return input_error("no manifests", "IN", "expected the manifests of all shards");
  const std::string verb = runs.value()[0][0].manifest.verb;
  if (Result<void> r = check_merged(output, verb, runs.value()); !r) return r;
  if (verb == "probe") return merge_tables(output, runs.value());
  const Run& run = runs.value()[0];
  return verb == "validate" ? merge_reports(output, run, models()) : merge_manifests(output, run);
}

}  // namespace tyndall::cli
