#include "manifest.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "config/scene_file.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "input_files.hpp"
#include "tyndall/version.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;
using nlohmann::ordered_json;

constexpr std::uint64_t kFormat = 1;  // version of the format of manifests
constexpr std::uint64_t kLargestManifest = std::uint64_t{1} << 30U;
constexpr double kLongest_s = 1e9;  // longest accepted duration of an item

std::string hash_of(const Inputs& inputs) {
  std::string text;
  for (const auto& [name, value] : inputs) {
    text.append(std::to_string(name.size())).append(":").append(name);
    text.append(std::to_string(value.size())).append(":").append(value);
  }
  return files::checksum_text(text);
}

// Returns whether a file can be read only once: a pipe, a socket or a device.
bool is_stream(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  return fs::is_fifo(status) || fs::is_socket(status) || fs::is_character_file(status);
}

// The text that is stored has to be valid UTF-8, which names of files need not be.
std::string stored(std::string_view text) { return files::one_line(text, text.size()); }

ordered_json json_of(const ManifestItem& item) {
  ordered_json out;
  out["item"] = item.number;
  if (!item.name.empty()) out["name"] = stored(item.name);
  if (!item.inputs_hash.empty()) out["inputs_hash"] = stored(item.inputs_hash);
  out["files"] = ordered_json::array();
  for (const ManifestFile& file : item.files) {
    out["files"].push_back({{"file", stored(file.name)}, {"bytes", file.sum.bytes}, {"checksum", file.sum.checksum}});
  }
  out["seconds"] = item.seconds;
  return out;
}

// Reads a text without storing it, and stops at an object with more names than any manifest has, or at deep nesting.
// The time to store the names of an object grows with the square of their number.
class Limits final : public nlohmann::json_sax<ordered_json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool key(string_t&) override { return ++names_.back() <= kMaxNames; }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  static constexpr std::size_t kMaxDepth = 16, kMaxNames = 4096;
  bool enter() {
    names_.push_back(0);
    return names_.size() <= kMaxDepth;
  }
  bool leave() {
    names_.pop_back();
    return true;
  }
  std::vector<std::size_t> names_;  // numbers of names in the objects that contain the current position
};

// Returns a whole number. The conversions of the JSON library would also accept negative and fractional numbers.
std::uint64_t whole_number(const ordered_json& value) {
  if (!value.is_number_unsigned()) throw std::out_of_range("whole number");
  return value.get<std::uint64_t>();
}

double seconds_of(const ordered_json& value) {
  const auto seconds = value.get<double>();
  if (!(seconds >= 0.0 && seconds <= kLongest_s)) throw std::out_of_range("seconds");
  return seconds;
}

const ordered_json& list_of(const ordered_json& value) {
  if (!value.is_array()) throw std::out_of_range("list");
  return value;
}

// Throws an exception if a member is missing or has another type or an impossible value.
Manifest from_json(const ordered_json& json) {
  Manifest out;
  out.verb = json.at("verb").get<std::string>();
  constexpr std::array<std::string_view, 4> kVerbs = {"probe", "render", "sky", "validate"};
  if (std::find(kVerbs.begin(), kVerbs.end(), out.verb) == kVerbs.end()) throw std::out_of_range("verb");
  out.version = json.at("version").get<std::string>();
  out.device = json.at("device").get<std::string>();
  out.time = json.at("time").get<std::string>();
  out.output = json.at("output").get<std::string>();
  const std::uint64_t index = whole_number(json.at("shard"));
  const std::uint64_t count = whole_number(json.at("shards"));
  if (index < 1 || index > count || count > kMaxShards) throw std::out_of_range("shard");
  out.shard = {static_cast<std::uint32_t>(index - 1), static_cast<std::uint32_t>(count)};
  out.total = whole_number(json.at("total"));
  out.complete = json.at("complete").get<bool>();
  const ordered_json& inputs = json.at("inputs");
  if (!inputs.is_object()) throw std::out_of_range("inputs");
  for (const auto& [name, value] : inputs.items()) out.inputs.emplace_back(name, value.get<std::string>());
  if (json.at("inputs_hash").get<std::string>() != hash_of(out.inputs)) throw std::out_of_range("inputs_hash");
  for (const ordered_json& made : list_of(json.at("items"))) {
    ManifestItem item;
    item.number = whole_number(made.at("item"));
    if (!out.items.empty() && item.number <= out.items.back().number) throw std::out_of_range("order");
    item.name = made.value("name", std::string());
    item.inputs_hash = made.value("inputs_hash", std::string());
    for (const ordered_json& file : list_of(made.at("files"))) {
      item.files.push_back({file.at("file").get<std::string>(),
                            {whole_number(file.at("bytes")), file.at("checksum").get<std::string>()}});
    }
    item.seconds = seconds_of(made.at("seconds"));
    out.items.push_back(std::move(item));
  }
  return out;
}

}  // namespace

std::string Manifest::inputs_hash() const { return hash_of(inputs); }

std::string Manifest::input(std::string_view name) const {
  const auto found = std::find_if(inputs.begin(), inputs.end(), [&](const auto& pair) { return pair.first == name; });
  return found == inputs.end() ? std::string() : found->second;
}

std::string shard_path(const std::string& output, const Shard& shard, const std::string& ending) {
  if (shard.count == 1) return output;
  return concat({output, ".shard-", std::to_string(shard.index + 1), "-of-", std::to_string(shard.count), ending});
}

std::string manifest_path(const std::string& output, const Shard& shard) {
  return concat({output, ".shard-", std::to_string(shard.index + 1), "-of-", std::to_string(shard.count), ".json"});
}

std::string to_json(const Manifest& manifest) {
  ordered_json out;
  out["format"] = kFormat;
  out["verb"] = manifest.verb;
  out["version"] = manifest.version;
  out["device"] = stored(manifest.device);
  out["time"] = manifest.time;
  out["output"] = stored(manifest.output);
  out["shard"] = manifest.shard.index + 1;
  out["shards"] = manifest.shard.count;
  out["total"] = manifest.total;
  out["complete"] = manifest.complete;
  double seconds = 0.0;
  for (const ManifestItem& item : manifest.items) seconds += item.seconds;
  out["seconds"] = seconds;
  out["inputs_hash"] = manifest.inputs_hash();
  out["inputs"] = ordered_json::object();
  for (const auto& [name, value] : manifest.inputs) out["inputs"][name] = value;
  out["items"] = ordered_json::array();
  for (const ManifestItem& item : manifest.items) out["items"].push_back(json_of(item));
  return out.dump(1) + "\n";
}

Result<Manifest> parse_manifest(std::string_view text, std::string_view name) {
  constexpr std::string_view kExpected = "expected a manifest, OUT.shard-I-of-N.json, that --shard or --resume wrote";
  const auto error = [&](std::string_view what) {
    return files::input_error(what, files::one_line(name, 200), kExpected);
  };
  try {
    Limits limits;
    const bool within = ordered_json::sax_parse(text, &limits);
    const ordered_json json = within ? ordered_json::parse(text, nullptr, false) : ordered_json();
    if (!json.is_object()) return error("it is not a JSON object");
    if (whole_number(json.at("format")) != kFormat) return error("it has an unknown format");
    return from_json(json);
  } catch (const std::exception&) {
    return error("it is not a manifest, or it is damaged");
  }
}

Result<Manifest> read_manifest(const std::string& path) {
  Result<std::string> text = files::read_file(path, kLargestManifest);
  if (!text) return std::move(text).error();
  return parse_manifest(text.value(), path);
}

std::string relative_name(const std::string& path, const std::string& folder) {
  std::error_code failed;
  const fs::path from = fs::absolute(folder.empty() ? "." : folder, failed);
  return fs::absolute(path, failed).lexically_normal().lexically_relative(from.lexically_normal()).string();
}

bool is_whole(const ManifestFile& file, const std::string& folder) {
  const std::string path = (fs::path(folder) / file.name).string();
  std::error_code failed;
  if (fs::file_size(path, failed) != file.sum.bytes || failed) return false;
  const Result<files::FileSum> sum = files::sum_of_file(path);
  return sum && sum.value() == file.sum;
}

std::string first_difference(const Inputs& a, const Inputs& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    if (i >= a.size()) return b[i].first;
    if (i >= b.size() || a[i] != b[i]) return a[i].first;
  }
  return {};
}

void add_file(Inputs& inputs, const std::string& name, const std::string& path) {
  if (is_stream(path)) {
    inputs.emplace_back(name, kStream);
    return;
  }
  const Result<files::FileSum> sum = files::sum_of_file(path);
  inputs.emplace_back(name, sum ? concat({"checksum ", sum.value().checksum}) : std::string("unreadable"));
}

Inputs common_inputs(const CommonOptions& options) {
  Inputs out = {{"version", TYNDALL_VERSION_STRING}};
  for (const config::Row& row : config::rows()) {
    const std::string key = row.key();
    // These two parameters do not change results, because they only select where tables are stored.
    if (key == "tables.cache" || key == "tables.cache_limit_mib") continue;
    const std::string value = config::value_text(row, options.settings);
    std::error_code failed;
    const bool may_be_file = row.info.type == ParamType::string && row.info.unit == "file";
    if (may_be_file && (fs::is_regular_file(value, failed) || is_stream(value))) {
      add_file(out, key, value);
    } else {
      out.emplace_back(key, stored(value));
    }
  }
  if (!options.settings.path.empty()) {
    config::Settings only_path;
    only_path.path = options.settings.path;
    out.emplace_back("[[path]]", concat({"checksum ", files::checksum_text(config::to_toml(only_path))}));
  }
  // Files that parameters name have been added above. The scene file itself is not added, because its values have been.
  std::size_t number = 0;
  for (const InputFile& file : input_files(options)) {
    if (file.name.starts_with("a file of "))
      add_file(out, concat({file.name, " ", std::to_string(++number)}), file.path);
  }
  return out;
}

}  // namespace tyndall::cli
