// CLI11 splits the arguments into options and values. Parsing the values and all messages are our own.
#include "arguments.hpp"

#include <CLI/CLI.hpp>
#include <deque>

#include "cli.hpp"
#include "files/text.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;
using files::one_line;

// Returns the last name of "-o,--output", which messages use.
std::string long_name(const std::string& names) { return names.substr(names.rfind(',') + 1); }

std::string_view summary_of(std::string_view verb) {
  for (const Verb& known : kVerbs) {
    if (known.name == verb) return known.summary;
  }
  return "";
}

}  // namespace

struct Arguments::Implementation {
  struct Option {
    std::string names;        // as declared: "-o,--output"; the name of a positional argument
    std::string placeholder;  // stands for the value in the help; empty for flags
    std::string help;
    bool repeatable = false;
    std::function<Result<void>(const std::string&)> store;
    std::vector<std::string> values;  // filled by CLI11
  };
  struct Positional {
    std::string name, help;
    std::string* target;
    bool required;
  };

  explicit Implementation(const std::string& verb_name) : verb(verb_name), command("tyndall " + verb_name) {
    app.allow_extras();
    app.set_help_flag("-h,--help", "print this help");
  }

  // Options must not move: CLI11 holds their addresses.
  void add(Option option) {
    options.push_back(std::move(option));
    CLI::Option* const added = app.add_option(options.back().names, options.back().values);
    added->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }

  [[nodiscard]] std::string help() const;
  [[nodiscard]] std::vector<std::string> known_names() const;
  [[nodiscard]] Result<void> store_options() const;
  [[nodiscard]] Result<void> store_positionals() const;

  std::string verb;
  std::string command;
  CLI::App app;
  std::deque<Option> options;
  std::vector<std::pair<std::string, std::string>> flags;  // names, help
  std::vector<Positional> positionals;
  std::string rest_name, rest_help;
  std::vector<std::string>* rest = nullptr;  // target of the repeated positional argument
  std::string footer;
};

std::string Arguments::Implementation::help() const {
  std::string usage;
  std::vector<std::pair<std::string, std::string>> lines;
  for (const Positional& positional : positionals) {
    usage += positional.required ? concat({" ", positional.name}) : concat({" [", positional.name, "]"});
    lines.emplace_back(positional.name, positional.help);
  }
  if (rest != nullptr) {
    usage += concat({" ", rest_name, "..."});
    lines.emplace_back(rest_name, rest_help);
  }
  for (const Option& option : options) {
    lines.emplace_back(option.placeholder.empty() ? option.names : concat({option.names, " ", option.placeholder}),
                       option.help);
  }
  lines.insert(lines.end(), flags.begin(), flags.end());
  lines.emplace_back("-h,--help", "print this help");
  std::string text = concat({"Usage: ", command, usage, " [OPTIONS]\n\n", summary_of(verb), "\n\n"});
  for (const auto& [left, right] : lines) {
    constexpr std::size_t kColumn = 26;
    text.append("  ").append(left).append(left.size() < kColumn ? kColumn - left.size() : 1, ' ');
    text.append(right).append("\n");
  }
  if (!footer.empty()) text.append("\n").append(footer);
  return text;
}

std::vector<std::string> Arguments::Implementation::known_names() const {
  std::vector<std::string> names = {"--help"};
  for (const Option& option : options) names.push_back(long_name(option.names));
  for (const auto& [flag, help_text] : flags) names.push_back(long_name(flag));
  return names;
}

Result<void> Arguments::Implementation::store_options() const {
  for (const Option& option : options) {
    if (!option.repeatable && option.values.size() > 1) {
      return input_error(
          concat({"option '", long_name(option.names), "' given ", std::to_string(option.values.size()), " times"}),
          command, "expected it at most once");
    }
    for (const std::string& given : option.values) {
      if (Result<void> stored = option.store(given); !stored) return stored;
    }
  }
  return {};
}

// Stores the arguments that CLI11 does not recognise as options: positional ones. Reports unknown options.
Result<void> Arguments::Implementation::store_positionals() const {
  std::size_t next = 0;
  bool names_only = false;  // after "--"
  std::vector<std::string> given;
  for (const std::string& argument : app.remaining()) {
    if (!names_only && argument == "--") {
      names_only = true;
    } else if (!names_only && argument.size() > 1 && argument[0] == '-') {
      const std::string name = argument.substr(0, argument.find('='));
      const std::optional<std::string> near = files::nearest(name, known_names());
      return input_error(concat({"unknown option '", one_line(name), "'"}), command,
                         near ? concat({"did you mean '", *near, "'?"}) : concat({"see '", command, " --help'"}));
    } else {
      given.push_back(argument);
    }
  }
  for (const std::string& argument : given) {
    const bool extra = next == positionals.size();
    if (extra && rest == nullptr) {
      return input_error(concat({"unexpected argument '", one_line(argument), "'"}), command,
                         concat({"see '", command, " --help'"}));
    }
    if (argument.empty()) {
      return input_error("empty file name ''", command,
                         concat({"expected ", extra ? rest_name : positionals[next].name}));
    }
    if (extra)
      rest->push_back(argument);
    else
      *positionals[next++].target = argument;
  }
  if (next < positionals.size() && positionals[next].required) {
    return input_error(concat({"missing argument ", positionals[next].name}), command,
                       concat({"see '", command, " --help'"}));
  }
  if (rest != nullptr && rest->empty())
    return input_error(concat({"missing argument ", rest_name}), command, concat({"see '", command, " --help'"}));
  return {};
}

Arguments::Arguments(const std::string& verb) : implementation_(std::make_unique<Implementation>(verb)) {}
Arguments::~Arguments() = default;

void Arguments::flag(const std::string& names, bool& target, const std::string& help) {
  implementation_->app.add_flag(names, target)->disable_flag_override();
  implementation_->flags.emplace_back(names, help);
}

void Arguments::value(const std::string& names, const std::string& placeholder, const std::string& help,
                      std::function<Result<void>(const std::string&)> store) {
  implementation_->add({names, placeholder, help, false, std::move(store), {}});
}

void Arguments::text(const std::string& names, std::string& target, const std::string& placeholder,
                     const std::string& help) {
  value(names, placeholder, help, [&target](const std::string& given) {
    target = given;
    return Result<void>();
  });
}

void Arguments::texts(const std::string& names, std::vector<std::string>& target, const std::string& placeholder,
                      const std::string& help) {
  const auto append = [&target](const std::string& given) {
    target.push_back(given);
    return Result<void>();
  };
  implementation_->add({names, placeholder, help, true, append, {}});
}

void Arguments::count(const std::string& names, std::uint32_t& target, std::uint32_t min, std::uint32_t max,
                      const std::string& help) {
  const std::string shown_help = concat({help, " [", std::to_string(target), "]"});
  value(names, "N", shown_help, [&target, min, max, name = long_name(names)](const std::string& given) {
    const Result<std::uint32_t> read = parse_count(given, name, min, max);
    if (!read) return Result<void>(read.error());
    target = read.value();
    return Result<void>();
  });
}

void Arguments::number(const std::string& names, double& target, double min, double max, const std::string& help) {
  const std::string shown_help = concat({help, " [", files::number_text(target), "]"});
  value(names, "X", shown_help, [&target, min, max, name = long_name(names)](const std::string& given) {
    const Result<double> read = parse_number(given, name, min, max);
    if (!read) return Result<void>(read.error());
    target = read.value();
    return Result<void>();
  });
}

void Arguments::number(const std::string& names, std::optional<double>& target, double min, double max,
                       const std::string& help) {
  value(names, "X", help, [&target, min, max, name = long_name(names)](const std::string& given) {
    const Result<double> read = parse_number(given, name, min, max);
    if (!read) return Result<void>(read.error());
    target = read.value();
    return Result<void>();
  });
}

void Arguments::choice(const std::string& names, std::string& target, const std::vector<std::string>& allowed,
                       const std::string& help) {
  std::string list;
  for (const std::string& one : allowed) list.append(list.empty() ? "" : ", ").append(one);
  const std::string shown_help = concat({help, ": ", list, " [", target, "]"});
  value(names, "NAME", shown_help, [&target, allowed, list, name = long_name(names)](const std::string& given) {
    if (std::find(allowed.begin(), allowed.end(), given) == allowed.end()) {
      return Result<void>(
          input_error(concat({"unknown value '", one_line(given), "'"}), name, concat({"expected one of ", list})));
    }
    target = given;
    return Result<void>();
  });
}

void Arguments::positional(const std::string& name, std::string& target, bool required, const std::string& help) {
  implementation_->positionals.push_back({name, help, &target, required});
}

void Arguments::rest(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  implementation_->rest_name = name;
  implementation_->rest_help = help;
  implementation_->rest = &target;
}

void Arguments::footer(const std::string& text) { implementation_->footer = text; }

std::optional<int> Arguments::parse(Args args) {
  try {
    // CLI11 expects the arguments in reverse order.
    implementation_->app.parse(std::vector<std::string>(args.rbegin(), args.rend()));
  } catch (const CLI::CallForHelp&) {
    return print(implementation_->help());
  } catch (const CLI::ArgumentMismatch& mismatch) {
    // The message is "--size: 1 required WxH missing" or "--json was given a disallowed flag override".
    const std::string text = mismatch.what();
    std::string name = text.substr(0, text.find_first_of(": "));
    if (!name.starts_with('-')) name.insert(0, "--");
    const bool flag = text.find("flag override") != std::string::npos;
    return fail(input_error(concat({flag ? "unexpected value for '" : "missing value for '", name, "'"}),
                            implementation_->command, concat({"see '", implementation_->command, " --help'"})));
  } catch (const CLI::ParseError& error) {
    return fail(input_error(one_line(error.what(), 300), implementation_->command,
                            concat({"see '", implementation_->command, " --help'"})));
  }
  if (const Result<void> stored = implementation_->store_positionals(); !stored) return fail(stored.error());
  if (const Result<void> stored = implementation_->store_options(); !stored) return fail(stored.error());
  return std::nullopt;
}

}  // namespace tyndall::cli
