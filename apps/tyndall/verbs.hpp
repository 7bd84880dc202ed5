// The verbs of the command line, one .cpp each. A verb receives the arguments after its name and returns the exit
// status. It prints results on stdout with print() of cli.hpp, and at most one error message.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tyndall::cli {

using Args = std::span<const std::string>;

int run_bench(Args args);
int run_compare(Args args);
int run_devices(Args args);
int run_merge(Args args);
int run_params(Args args);
int run_probe(Args args);
int run_render(Args args);
int run_report(Args args);
int run_sky(Args args);
int run_tables(Args args);
int run_validate(Args args);
int run_view(Args args);

// The optional parts of the viewer, for features(). Defined beside run_view().
[[nodiscard]] bool has_viewer();
[[nodiscard]] bool has_shader_reload();

struct Verb {
  std::string_view name;
  int (*run)(Args args);
  std::string_view summary;
  bool large_pages = false;  // uses much memory
};

// The verbs in the order of `tyndall --help`.
inline constexpr Verb kVerbs[] = {
    {"render", run_render, "render one frame or a sequence to PNG or EXR", true},
    {"view", run_view, "fly over the scene in a window with live controls for every parameter", true},
    {"probe", run_probe, "compute radiance and transmittance of given rays with any of the models", true},
    {"tables", run_tables, "build the scattering tables, cache them, report the time of each stage, export them", true},
    {"sky", run_sky, "render the sky as an environment map, with the sun by angles or by place and time", true},
    {"validate", run_validate, "compare every model with the path tracer, in a report with tables and plots", true},
    {"merge", run_merge, "combine the results of shards: tables of probe, reports of validate, manifests"},
    {"bench", run_bench, "measure device milliseconds per pass", true},
    {"compare", run_compare, "measure the difference between two images"},
    {"report", run_report, "measure whether the program is right and fast on a device, in at most 8 minutes"},
    {"devices", run_devices, "list the Vulkan devices and show which one would be used"},
    {"params", run_params, "list every parameter: name, type, default, range, unit, meaning"},
};

}  // namespace tyndall::cli
