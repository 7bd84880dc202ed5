// The arguments of one verb: declare options, then parse. Wraps CLI11, which only arguments.cpp includes, and turns
// every mistake into a one-line error. Targets are borrowed and must outlive parse(). A target is unchanged if its
// option is not given.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tyndall/result.hpp"
#include "verbs.hpp"

namespace tyndall::cli {

class Arguments {
 public:
  // `verb` is the verb's name; the help shows its summary from kVerbs.
  explicit Arguments(const std::string& verb);
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;
  ~Arguments();

  // `names` is "--size" or "-o,--output". `value` is the placeholder of the value in the help.
  void flag(const std::string& names, bool& target, const std::string& help);
  void text(const std::string& names, std::string& target, const std::string& value, const std::string& help);
  void texts(const std::string& names, std::vector<std::string>& target, const std::string& value,
             const std::string& help);  // may be repeated
  void count(const std::string& names, std::uint32_t& target, std::uint32_t min, std::uint32_t max,
             const std::string& help);
  void number(const std::string& names, double& target, double min, double max, const std::string& help);
  void number(const std::string& names, std::optional<double>& target, double min, double max, const std::string& help);
  void choice(const std::string& names, std::string& target, const std::vector<std::string>& allowed,
              const std::string& help);
  // Adds an option of any other type. `store` parses the text; its error names the option.
  void value(const std::string& names, const std::string& placeholder, const std::string& help,
             std::function<Result<void>(const std::string&)> store);
  void positional(const std::string& name, std::string& target, bool required, const std::string& help);
  // Adds one or more positional arguments, after all others.
  void rest(const std::string& name, std::vector<std::string>& target, const std::string& help);

  // Adds text below the list of options in the help, in whole lines.
  void footer(const std::string& text);

  // Returns the exit status if the verb has to stop: after --help (0) or after an error (2), both of which are printed.
  // Returns nothing if the verb is to continue.
  [[nodiscard]] std::optional<int> parse(Args args);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tyndall::cli
