// The arguments of one verb: declare options, then parse. Wraps CLI11, which is seen by arguments.cpp
// alone, and turns everything that can be wrong into our one-line errors.
// Targets are borrowed and must outlive parse(); they keep their value when the option is not given.
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
  // Takes the verb's name; help shows its summary from kVerbs.
  explicit Arguments(const std::string& verb);
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;
  ~Arguments();

  // `names`: "--size" or "-o,--output". `value`: what stands for the value in the help.
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
  // Any other kind: `store` reads the text and names the option in its error.
  void value(const std::string& names, const std::string& placeholder, const std::string& help,
             std::function<Result<void>(const std::string&)> store);
  void positional(const std::string& name, std::string& target, bool required, const std::string& help);

  // Text below the list of options in the help, in whole lines.
  void footer(const std::string& text);

  // The exit status when there is nothing more to do: after --help (0) or an error (2), both of them
  // printed. Nothing when the verb is to go on.
  [[nodiscard]] std::optional<int> parse(Args args);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tyndall::cli
