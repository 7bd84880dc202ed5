// The command line `tyndall`: finds the verb and passes the other arguments to it. Every failure ends in one line on
// stderr and an exit status.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "cli.hpp"
#include "features.hpp"
#include "files/text.hpp"
#include "large_pages.hpp"
#include "verbs.hpp"

namespace tyndall::cli {
namespace {

using files::concat;

std::string help_text() {
  std::string text = "Outdoor light scattering: sky, haze and light shafts.\n\n"
                     "Usage: tyndall VERB [OPTIONS]\n\nVerbs:\n";
  for (const Verb& verb : kVerbs) {
    constexpr std::size_t kColumn = 12;
    text.append("  ").append(verb.name).append(kColumn - verb.name.size(), ' ').append(verb.summary).append("\n");
  }
  return text + "\n'tyndall VERB --help' lists the options of a verb; 'tyndall --version' prints the version.\n"
                "Exit status: 0 success, 1 failure at run time, 2 bad usage or bad input.\n";
}

int run_verb(const std::string& name, Args args) {
  std::vector<std::string> names;
  std::string list;
  for (const Verb& verb : kVerbs) {
    if (verb.name == name) return verb.run(args);
    names.emplace_back(verb.name);
    list.append(list.empty() ? "" : ", ").append(verb.name);
  }
  const bool option = name.starts_with('-');
  const std::optional<std::string> near = option ? std::nullopt : files::nearest(name, names);
  return fail(files::input_error(
      concat({option ? "unknown option '" : "unknown verb '", files::one_line(name), "'"}),
      option ? "before the verb" : "command line",
      near ? concat({"did you mean '", *near, "'?"})
           : concat({option ? "expected --help or --version" : "expected one of ", option ? "" : list})));
}

bool wants_large_pages(Args args) {
  return !args.empty() && std::any_of(std::begin(kVerbs), std::end(kVerbs),
                                      [&](const Verb& verb) { return verb.large_pages && verb.name == args[0]; });
}

int run(Args args) {
  if (args.empty()) return fail("command line: missing verb; see 'tyndall --help'", kBadUsage);
  const std::string& first = args[0];
  if (first == "--version" || first == "-V") return print(version_text());
  if (first == "--help" || first == "-h" || (first == "help" && args.size() == 1)) return print(help_text());
  if (first == "help") {
    const std::vector<std::string> help = {"--help"};
    return run_verb(args[1], help);
  }
  return run_verb(first, args.subspan(1));
}

}  // namespace
}  // namespace tyndall::cli

int main(int argc, char** argv) {
  // Exceeding a file size limit must be an ordinary write error, not a signal that ends the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const std::vector<std::string> args(argv + (argc > 0 ? 1 : 0), argv + argc);
    if (tyndall::cli::wants_large_pages(args)) tyndall::cli::restart_with_large_pages(argv);
    return tyndall::cli::run(args);
  } catch (const std::bad_alloc&) {
    std::fputs("tyndall: error: this machine: not enough memory; expected a smaller size or fewer resources\n", stderr);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "tyndall: error: %s\n", exception.what());
  } catch (...) {
    std::fputs("tyndall: error: unknown failure\n", stderr);
  }
  return tyndall::cli::kFailed;
}
