#include "input_files.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "files/files.hpp"
#include "files/text.hpp"
#include "scene/elevation/elevation_file.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;

// Returns the file name for a URI, whose special characters are written as %XX (RFC 3986).
std::string decoded_uri(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::string digits(uri.substr(i + 1, 2));
    if (uri[i] == '%' && digits.size() == 2 &&
        digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos) {
      out += static_cast<char>(std::stoi(digits, nullptr, 16));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

// Adds the files that a glTF file refers to. Unreadable files are skipped; the model's reader reports them.
void add_references(const std::string& path, std::vector<InputFile>& out) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return;  // a pipe can only be read once
  constexpr std::uint64_t kLargestDocument = std::uint64_t{64} << 20;
  const Result<std::string> text = files::read_file(path, kLargestDocument);
  if (!text) return;
  const nlohmann::json document = nlohmann::json::parse(text.value(), nullptr, false);
  if (!document.is_object()) return;
  for (const char* const list : {"buffers", "images"}) {
    const auto found = document.find(list);
    if (found == document.end() || !found->is_array()) continue;
    for (const nlohmann::json& entry : *found) {
      const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
      if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
      const std::string name = uri->get<std::string>();
      if (files::lower_case(name.substr(0, 5)) == "data:") continue;
      out.push_back({"a file of meshes.source", (fs::path(path).parent_path() / decoded_uri(name)).string()});
    }
  }
}

// Adds the files that an elevation file refers to.
void add_rasters(const std::string& source, std::vector<InputFile>& out) {
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored)) return;  // nothing to read, or a name of GDAL's own
  for (std::string& path : scene::elevation_file_list(source)) {
    if (path != source) out.push_back({"a file of terrain.source", std::move(path)});
  }
}

bool same_file(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

}  // namespace

std::vector<InputFile> input_files(const CommonOptions& options) {
  std::vector<InputFile> out;
  if (!options.scene_file.empty()) out.push_back({"the scene file", options.scene_file});
  for (const config::Row& row : config::rows()) {
    if (row.info.type == ParamType::string && row.info.unit == "file") {
      out.push_back({row.key(), config::value_text(row, options.settings)});
    }
  }
  add_references(options.settings.scene.meshes.source, out);
  add_rasters(options.settings.scene.terrain.source, out);
  return out;
}

Result<void> check_not_input(const std::string& path, std::string_view option, const std::vector<InputFile>& inputs) {
  struct stat output {};
  if (::stat(path.c_str(), &output) != 0 || !S_ISREG(output.st_mode)) return {};
  for (const InputFile& input : inputs) {
    struct stat info {};
    if (::stat(input.path.c_str(), &info) != 0 || !same_file(info, output)) continue;
    return files::input_error(concat({"'", files::one_line(path, 200), "' is ", input.name, " of this run"}), option,
                              "expected a file that is not an input");
  }
  return {};
}

}  // namespace tyndall::cli
