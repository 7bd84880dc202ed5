// The verbs of the command line, one .cpp each. A verb gets the arguments after its name and returns
// the exit status; it prints results on stdout (cli.hpp's print) and at most one error line.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tyndall::cli {

using Args = std::span<const std::string>;

int run_bench(Args args);
int run_compare(Args args);
int run_devices(Args args);
int run_params(Args args);
int run_probe(Args args);
int run_render(Args args);
int run_sky(Args args);
int run_tables(Args args);
int run_validate(Args args);
int run_view(Args args);

struct Verb {
  std::string_view name;
  int (*run)(Args args);
  std::string_view summary;
};

// What `tyndall --help` lists, in its order.
inline constexpr Verb kVerbs[] = {
    {"render", run_render, "render one frame or a sequence to PNG or EXR"},
    {"view", run_view, "fly over the scene in a window, with every control under the hand"},
    {"probe", run_probe, "radiance and transmittance for given rays, by any of the models"},
    {"tables", run_tables,
     "build the scattering tables anew (those in the cache too), say how long it took, export them"},
    {"sky", run_sky, "the sky as an environment map, for a sun given by angles or by place and time"},
    {"validate", run_validate, "every model against the reference, as a report with tables and plots"},
    {"bench", run_bench, "measure GPU milliseconds per pass"},
    {"compare", run_compare, "say how much two images differ"},
    {"devices", run_devices, "list the Vulkan devices and say which one would be used"},
    {"params", run_params, "list every parameter: name, type, default, range, unit, meaning"},
};

}  // namespace tyndall::cli
