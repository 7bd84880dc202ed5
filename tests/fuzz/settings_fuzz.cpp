// Assignments of --set: one in each line of the input. What is accepted is written and read back to the same value.
#include "config/settings.hpp"
#include "fuzz.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tyndall;
  std::string_view rest = fuzz::text_of(data, size);
  config::Settings settings;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const Result<void> set = config::set(settings, line);
    if (!set) fuzz::require_one_line(set.error());
    const config::Row* const row = set ? config::find_row(line.substr(0, line.find('='))) : nullptr;
    if (row == nullptr) continue;
    const std::string text = config::value_text(*row, settings);
    config::Settings again;
    fuzz::require(config::set(again, row->key(), text, "again").ok(), "a value is read back");
    fuzz::require(config::value_text(*row, again) == text, "a value is read back unchanged");
  }
  const Result<void> checked = config::check(settings);
  if (!checked) fuzz::require_one_line(checked.error());
  return 0;
}
