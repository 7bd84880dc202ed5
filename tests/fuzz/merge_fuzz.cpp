// The shards that `merge` reads. A line "%" ends a part of the input: the parts are a manifest and the file that it
// lists, again and again. Sizes and checksums in the manifests are set right. What is merged can be read again.
#include <cmath>
#include <filesystem>

#include "files/csv.hpp"
#include "files/file_sum.hpp"
#include "files/files.hpp"
#include "fuzz.hpp"
#include "manifests.hpp"
#include "merge_shards.hpp"

namespace {

using namespace tyndall;

cli::ValidateModels models() {
  const validate::Model model = {"model", "a model", 1, {}};
  return {{model}, {model}, {{"colours", {}}}, {}};
}

void check_table(const std::string& path) {
  const Result<std::string> text = files::read_file(path, std::uint64_t{1} << 30U);
  fuzz::require(text.ok(), "the table is there");
  const Result<files::CsvTable> table = files::parse_csv(text.value(), "out");
  fuzz::require(table.ok(), "the table can be read");
  for (std::size_t column = 0; column < table.value().header.size(); ++column) {
    const std::string name = files::csv_value(table.value().header[column]);
    if (name != "L_r" && name != "X") continue;
    for (std::size_t row = 0; row < table.value().rows(); ++row) {
      double value = 0.0;
      const auto read = files::read_number(files::csv_value(table.value().field(row, column)), value);
      fuzz::require(read == files::NumberError::none, "the means are finite");
    }
  }
}

void check_manifest(const std::string& path) {
  const Result<cli::Manifest> merged = cli::read_manifest(path);
  fuzz::require(merged.ok(), "the manifest can be read");
  fuzz::require(merged.value().items.size() == merged.value().total, "the manifest lists every item");
  for (const cli::ManifestItem& item : merged.value().items) {
    for (const cli::ManifestFile& file : item.files) {
      fuzz::require(cli::is_whole(file, std::filesystem::path(path).parent_path().string()), "its files are found");
    }
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  static constexpr std::string_view kEnd = "\n%\n";
  constexpr std::size_t kMaxManifests = 6;
  std::string_view rest = fuzz::text_of(data, size);
  const auto next = [&rest] {
    const std::string_view part = rest.substr(0, std::min(rest.find(kEnd), rest.size()));
    rest.remove_prefix(std::min(part.size() + kEnd.size(), rest.size()));
    return part;
  };
  std::vector<std::string> paths;
  std::size_t seeds = 0;
  std::string verb;
  while (!rest.empty() && paths.size() < kMaxManifests) {
    const std::string_view text = next();
    const std::string name = "file-" + std::to_string(paths.size());
    const Result<files::FileSum> sum = files::sum_of_file(folder.write(name, next()));
    fuzz::require(sum.ok(), "a file can be summed");
    const std::string manifest = fuzz::mended_manifest(text, name, &sum.value());
    paths.push_back(folder.write("m-" + std::to_string(paths.size()) + ".json", manifest));
    if (const Result<cli::Manifest> read = cli::parse_manifest(manifest, "m"); read.ok()) {
      verb = read.value().verb;
      if (read.value().shard.count == 1) ++seeds;
    }
  }
  // The formats that the last verb has; manifests of several verbs are refused before.
  std::vector<const char*> endings = {".json"};
  if (verb == "probe") endings = {".csv"};
  if (verb == "validate") endings = {".md", ".html", ".json"};
  for (const char* const ending : endings) {
    const std::string output = folder.at(std::string("out") + ending);
    const Result<void> merged = cli::merge_shards(output, paths, models);
    const bool there = std::filesystem::exists(output);
    fuzz::require(there == merged.ok(), "a refusal writes nothing");
    if (!merged) {
      fuzz::require_one_line(merged.error());
      continue;
    }
    // The table of a single run is copied, and need not be of numbers.
    if (verb == "probe" && seeds > 1) check_table(output);
    if (verb == "render" || verb == "sky") check_manifest(output);
    std::filesystem::remove(output);
  }
  return 0;
}
