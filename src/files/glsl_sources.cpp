#include "files/glsl_sources.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "files/file_sum.hpp"

namespace tyndall::files {
namespace {

// Returns the names in lines of the form: #include "name".
std::vector<std::string> included_names(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  constexpr std::string_view kInclude = "include";
  std::vector<std::string> names;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const auto skip = [&](std::size_t count) {
      line.remove_prefix(count);
      line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    };
    skip(0);
    if (!line.starts_with('#')) continue;
    skip(1);
    if (!line.starts_with(kInclude)) continue;
    skip(kInclude.size());
    if (!line.starts_with('"') && !line.starts_with('<')) continue;
    const std::size_t close = line.find_first_of("\">", 1);
    if (close != std::string_view::npos) names.emplace_back(line.substr(1, close - 1));
  }
  return names;
}

}  // namespace

std::vector<std::string> glsl_include_folders(const std::string& shaders) {
  const std::filesystem::path folder(shaders);
  return {folder.string(), (folder / ".." / "include").string(), (folder / ".." / "src").string()};
}

const GlslSources::Source& GlslSources::source(const std::string& name) {
  const auto [at, added] = sources_.try_emplace(name);
  Source& source = at->second;
  for (std::size_t i = 0; added && i < folders_.size(); ++i) {
    const std::string path = (std::filesystem::path(folders_[i]) / name).string();
    std::ifstream file(path, std::ios::binary);
    if (!file) continue;
    source.path = path;
    source.text.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    source.included = included_names(source.text);
    break;
  }
  return source;
}

void GlslSources::append(const std::string& name, std::set<std::string>& seen, std::string& whole) {
  if (!seen.insert(name).second) return;
  const Source& of_name = source(name);
  // The lengths separate the files.
  whole += name + '\n' + std::to_string(of_name.text.size()) + '\n' + of_name.text;
  for (const std::string& included : of_name.included) append(included, seen, whole);
}

std::string GlslSources::checksum(const std::string& shader) {
  if (source(shader).path.empty()) return {};
  std::set<std::string> seen;
  std::string whole;
  append(shader, seen, whole);
  return checksum_text(whole);
}

std::set<std::string> GlslSources::paths() const {
  std::set<std::string> out;
  for (const auto& [name, source] : sources_) {
    if (!source.path.empty()) out.insert(source.path);
  }
  return out;
}

}  // namespace tyndall::files
