// Writes docs/generated/passes.md: the passes of a frame and of a build of the tables, with their inputs and outputs,
// from the lists of steps that the effect records.
//
// `passes --modes` prints a line for each mode: its name, and the options of `tyndall bench` that select it.
// `passes DIR` prints the page. The costs are from DIR/MODE.json (`tyndall bench --json`) and DIR/tables.json (`tyndall
// tables --json`); passes without a report have none.
// `passes --check PAGE` compares a page with the lists, except for the costs.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.hpp"
#include "effect/frame_steps.hpp"
#include "effect/sky_probe_steps.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr FrameShape kShape = {{1280, 720}, 4, 1, false};  // the shape of the demo scene's frames
constexpr std::string_view kNoCost = "–";

struct Mode {
  const char* name;
  const char* title;
  std::vector<const char*> settings;
};
const Mode kModes[] = {
    {"default", "default settings", {}},
    {"multi_pass", "`shadows.cascade_processing=multi-pass`", {"shadows.cascade_processing=multi-pass"}},
    {"multi_pass_instanced",
     "`shadows.cascade_processing=multi-pass-instanced`",
     {"shadows.cascade_processing=multi-pass-instanced"}},
    {"downscaled", "`scattering.downscale=2`", {"scattering.downscale=2"}},
    {"show_sampling", "`epipolar.show_sampling=true`", {"epipolar.show_sampling=true"}},
    {"brute_force", "`scattering.technique=brute-force`", {"scattering.technique=brute-force"}},
    {"froxels", "`scattering.technique=froxels`", {"scattering.technique=froxels"}},
    {"disabled", "`scattering.enabled=false`", {"scattering.enabled=false"}},
};

// Milliseconds by the names of passes; empty if nothing has been measured.
using Costs = std::map<std::string, double>;

Result<Costs> costs_in(const std::string& path, const char* rows, const char* value) {
  Costs out;
  std::ifstream file(path);
  if (!file) return out;
  const nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
  if (!report.is_object() || !report.contains(rows)) {
    return Error{ErrorCode::invalid_argument, path + ": not a report with '" + rows + "'; expected one of --json"};
  }
  for (const nlohmann::json& row : report[rows]) {
    if (row.value("in_effect", true)) out[row["name"]] = row[value];
  }
  return out;
}

// Returns the share of the pass in the sum of all, once for each name.
std::string share(Costs& costs, const std::string& name, double total) {
  const auto found = costs.find(name);
  if (found == costs.end()) return std::string(kNoCost);
  if (found->second < 0.0) return "above";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * found->second / total);
  found->second = -1.0;
  return text;
}

double sum_of(const Costs& costs) {
  double sum = 0.0;
  for (const auto& [name, ms] : costs) sum += ms;
  return std::max(sum, 1e-9);
}

std::string shader_of(const Step& step) {
  if (!step.dispatches()) return "";
  const std::string name = step.pipeline.shader->name;
  return "`" + name.substr(0, name.find("_comp")) + ".comp`";
}

std::string work_of(const Step& step) {
  const std::string list = step.chosen == Resource::none ? "" : std::string("`") + name_of(step.chosen) + "`";
  switch (step.kind) {
    case Step::Kind::dispatch_indirect: return "items of " + list;
    case Step::Kind::reset_list: return "empties " + list;
    case Step::Kind::clear: return "clears " + list;
    case Step::Kind::copy: return "copies " + list + " to `" + name_of(step.target) + "`";
    case Step::Kind::host_read: return "shows " + list + " to the host";
    case Step::Kind::dispatch: break;
  }
  const VkExtent3D& n = step.invocations;
  std::string out = std::to_string(n.width);
  if (n.height > 1 || n.depth > 1) out += " × " + std::to_string(n.height);
  if (n.depth > 1) out += " × " + std::to_string(n.depth);
  return out;
}

// Returns the resources that a step reads or writes, without duplicates, in the order of resources.def.
std::string names_of(const Step& step, bool writes) {
  std::set<Resource> resources;
  for (const Use& use : uses_of(step)) {
    const VkAccessFlags access = writes ? use.access & kWriteAccess : use.access & ~kWriteAccess;
    if (access != 0) resources.insert(use.resource);
  }
  std::string out;
  for (const Resource resource : resources) out += (out.empty() ? "`" : ", `") + std::string(name_of(resource)) + "`";
  return out;
}

void add_row(std::string& out, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) out += "| " + cell + " ";
  out += "|\n";
}

// The passes of a frame during which the contents of a resource are valid: from the first that writes it to the last
// that reads it.
using Lifetimes = std::map<Resource, std::pair<std::string, std::string>>;

void add_lifetimes(Lifetimes& out, const std::vector<Step>& steps) {
  for (const Step& step : steps) {
    if (!step.dispatches()) continue;
    for (const Use& use : uses_of(step)) {
      auto& [first, last] = out[use.resource];
      if (first.empty() && (use.access & kWriteAccess) != 0) first = step.name;
      if ((use.access & ~kWriteAccess) != 0) last = step.name;
    }
  }
}

struct TableRow {
  Step step;
  int runs = 0;
  int part = 0;  // of the frame, from 1; 0 for steps of other lists
};

// Returns the rows of the table. Steps that differ only in their push constants share a row if they are consecutive or
// belong to a build of the tables.
std::vector<TableRow> rows_of(std::span<const Step> steps, int part) {
  const bool of_frame = part > 0;
  std::vector<TableRow> out;
  for (const Step& step : steps) {
    const auto first = of_frame && !out.empty() ? out.end() - 1 : out.begin();
    const auto found = std::find_if(first, out.end(), [&](const TableRow& row) {
      return std::string_view(row.step.name) == step.name && row.step.kind == step.kind &&
             row.step.chosen == step.chosen && row.step.pipeline == step.pipeline;
    });
    if (found == out.end()) {
      out.push_back({step, 1, part});
    } else {
      ++found->runs;
    }
  }
  return out;
}

void add_passes(std::string& out, const std::vector<TableRow>& rows, Costs costs) {
  const double total = sum_of(costs);
  const bool of_frame = !rows.empty() && rows[0].part > 0;
  std::vector<std::string> cells = {"pass", "shader", "runs", "work", "reads", "writes", "cost"};
  if (of_frame) cells.insert(cells.begin() + 1, "part");
  add_row(out, cells);
  out += of_frame ? "|---|---|---|---|---|---|---|---|\n" : "|---|---|---|---|---|---|---|\n";
  for (const auto& [step, runs, part] : rows) {
    const bool pass = step.dispatches();
    cells = {pass ? std::string(step.name) : "",
             shader_of(step),
             std::to_string(runs),
             work_of(step),
             names_of(step, false),
             names_of(step, true),
             pass ? share(costs, step.name, total) : ""};
    if (of_frame) cells.insert(cells.begin() + 1, std::to_string(part));
    add_row(out, cells);
  }
}

std::string lifetime_of(Resource resource, const Lifetimes& frame, const Lifetimes& build) {
  const auto span = [&](const Lifetimes& lifetimes) {
    const auto found = lifetimes.find(resource);
    if (found == lifetimes.end() || found->second.first.empty()) return std::string("unused with these settings");
    const auto& [first, last] = found->second;
    return "`" + first + "`" + (last.empty() ? "" : " to `" + last + "`");
  };
  switch (info_of(resource).lifetime) {
    case Lifetime::constants: return "written by the host";
    case Lifetime::caller: return "the caller's";
    case Lifetime::tables: return "until other tables are complete";
    case Lifetime::frame: return "a frame: " + span(frame);
    case Lifetime::probe: return "a sky probe";
    case Lifetime::build: return "a build: " + span(build);
    case Lifetime::chosen: break;
  }
  return "";
}

Result<Params> params_of(const Mode& mode) {
  config::Settings settings;
  for (const char* setting : mode.settings) {
    const Result<void> set = config::set(settings, setting);
    if (!set.ok()) return set.error();
  }
  return settings.effect;
}

void add_resources(std::string& out, const Lifetimes& frame, const Lifetimes& build) {
  out += "\n## Resources\n\n"
         "The name of a resource is that of its binding in GLSL, in memory reports and in debuggers. The lifetime "
         "names the first\n"
         "pass that writes the contents and the last pass that reads them, in a frame with the default settings. For "
         "resources that\n"
         "only other modes use, it names the passes of those modes. The buffers of a frame are allocated once, and the "
         "next frame\n"
         "uses them again.\n\n";
  add_row(out, {"resource", "format", "resolution", "lifetime", "MiB"});
  out += "|---|---|---|---|---|\n";
  EffectDesc desc;
  desc.max_extent = kShape.extent;
  const FrameBufferSizes sizes = frame_buffer_sizes(desc, {});
  for (std::size_t i = 0; i < kResources; ++i) {
    const auto resource = static_cast<Resource>(i);
    const ResourceInfo& info = info_of(resource);
    if (info.lifetime == Lifetime::chosen) continue;
    char mib[32] = "";
    const bool frame_buffer = i >= kFirstFrameBuffer && i < kFirstFrameBuffer + kFrameBuffers;
    if (frame_buffer) std::snprintf(mib, sizeof mib, "%.2f", static_cast<double>(sizes[resource]) / 1048576.0);
    add_row(out, {std::string("`") + info.name + "`", info.format, info.resolution, lifetime_of(resource, frame, build),
                  mib});
  }
}

// The device memory of an effect with default settings, from the sizes of its buffers and tables. Devices round each
// up.
void add_memory(std::string& out) {
  out += "\n## Memory by resolution\n\n"
         "The sum of the buffers above for other pictures (`EffectDesc::max_extent`), and of the tables, with default "
         "settings. Devices\n"
         "may round each buffer up; `query_memory` returns the exact sum.\n\n";
  add_row(out, {"picture", "buffers of a frame, MiB", "tables, MiB"});
  out += "|---|--:|--:|\n";
  for (const VkExtent2D extent : {VkExtent2D{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) {
    EffectDesc desc;
    desc.max_extent = extent;
    VkDeviceSize sum = 0;
    for (const VkDeviceSize bytes : frame_buffer_sizes(desc, {}).bytes) sum += bytes;
    char text[2][32];
    std::snprintf(text[0], sizeof text[0], "%.1f", static_cast<double>(sum) / 1048576.0);
    std::snprintf(text[1], sizeof text[1], "%.1f", static_cast<double>(table_bytes({})) / 1048576.0);
    add_row(out, {std::to_string(extent.width) + " × " + std::to_string(extent.height), text[0], text[1]});
  }
}

// Returns the page. `folder` contains the measured costs; it is empty if there are none.
Result<std::string> page(const std::string& folder) {
  std::string out =
      "# Passes\n\n"
      "`make passes` makes this page from the lists that the effect records (`frame_steps()`, `table_steps()` and\n"
      "`resources.def` in `src/effect`). The frame is that of `scenes/demo.toml` at 1280 × 720 with four cascades, of "
      "which\n"
      "three are marched. \"Runs\" is the number of dispatches, which differ in their push constants. \"Part\" is the "
      "`FramePart` to\n"
      "which a pass belongs if the frame is recorded in two parts. \"Work\" is the number of\n"
      "invocations, or the list whose items an indirect dispatch processes. \"Cost\" is the share of the time of the "
      "effect, or\n"
      "of the build, on the CPU device llvmpipe. Passes with the same name are measured together, and the share stands "
      "at the\n"
      "first of them. Steps without a name only reset, clear or copy. [epipolar.md](../epipolar.md) and\n"
      "[tables.md](../tables.md) describe the methods.\n";
  Lifetimes frame, build;
  for (const Mode& mode : kModes) {
    TYNDALL_ASSIGN(const Params params, params_of(mode));
    const FrameSteps list = frame_steps({}, params, kShape);
    const std::vector<Step> steps(list.begin(), list.end());
    out += std::string("\n## A frame: ") + mode.title + "\n\n";
    TYNDALL_ASSIGN(const Costs costs, costs_in(folder + "/" + mode.name + ".json", "passes", "median_ms"));
    std::vector<TableRow> rows = rows_of(list.of(FramePart::first), 1);
    const std::vector<TableRow> second = rows_of(list.of(FramePart::second), 2);
    rows.insert(rows.end(), second.begin(), second.end());
    add_passes(out, rows, costs);
    // The lifetime of a resource is that in the first mode that uses it.
    Lifetimes own;
    add_lifetimes(own, steps);
    frame.insert(own.begin(), own.end());
  }
  const std::vector<Step> steps = table_steps({}, kAllTables);
  out += "\n## A build of the tables: default settings\n\n";
  TYNDALL_ASSIGN(const Costs costs, costs_in(folder + "/tables.json", "stages", "ms"));
  add_passes(out, rows_of(steps, 0), costs);
  add_lifetimes(build, steps);
  out += "\n## An update of a sky probe\n\n"
         "With a cube map of 64 texels per face; without one, the passes `sky_cube…` are missing.\n\n";
  constexpr std::uint32_t kCube = 64;
  add_passes(out, rows_of(sky_probe_steps(ColorMode::rgb, kCube), 0), {});
  add_resources(out, frame, build);
  add_memory(out);
  return out;
}

// Returns the page without the costs, which are the last cells of its rows.
std::string without_costs(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  bool costs = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| pass |") || line.starts_with("| resource |")) costs = line.ends_with("| cost |");
    if (costs && line.starts_with("| ")) line.erase(line.rfind('|', line.size() - 2));
    out += line + "\n";
  }
  return out;
}

int fail(const std::string& message) {
  std::fprintf(stderr, "passes: error: %s\n", message.c_str());
  return 2;
}

int print_modes() {
  for (const Mode& mode : kModes) {
    std::string line = mode.name;
    for (const char* setting : mode.settings) line += std::string(" --set ") + setting;
    std::printf("%s\n", line.c_str());
  }
  return 0;
}

int check(const std::string& path) {
  std::ifstream file(path);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const Result<std::string> current = page("");
  if (!current.ok()) return fail(current.error().message);
  std::istringstream have(without_costs(committed)), want(without_costs(current.value()));
  std::string a, b;
  for (int line = 1;; ++line) {
    const bool more_a = static_cast<bool>(std::getline(have, a));
    const bool more_b = static_cast<bool>(std::getline(want, b));
    if (!more_a && !more_b) return 0;
    if (more_a == more_b && a == b) continue;
    std::fprintf(stderr, "%s:%d: differs from the lists of steps; expected\n%s\nRun `make passes`.\n", path.c_str(),
                 line, more_b ? b.c_str() : "the end");
    return 1;
  }
}

}  // namespace
}  // namespace tyndall

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 1 && arguments[0] == "--modes") return tyndall::print_modes();
  if (arguments.size() == 2 && arguments[0] == "--check") return tyndall::check(arguments[1]);
  if (arguments.size() != 1) return tyndall::fail("expected --modes, --check PAGE or the folder of measurements");
  const tyndall::Result<std::string> text = tyndall::page(arguments[0]);
  if (!text.ok()) return tyndall::fail(text.error().message);
  std::printf("%s", text.value().c_str());
  return 0;
}
