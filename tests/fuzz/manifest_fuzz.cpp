// The manifests that `--resume` reads: accepted ones are written and read back unchanged.
#include "manifest.hpp"

#include <cmath>

#include "fuzz.hpp"
#include "manifests.hpp"

namespace {

using namespace tyndall;

void read(std::string_view text, const std::string& folder) {
  const Result<cli::Manifest> manifest = cli::parse_manifest(text, "m.json");
  if (!manifest) {
    fuzz::require_one_line(manifest.error());
    return;
  }
  const cli::Manifest& made = manifest.value();
  fuzz::require(made.shard.index < made.shard.count, "the shard exists");
  for (std::size_t i = 0; i < made.items.size(); ++i) {
    const cli::ManifestItem& item = made.items[i];
    fuzz::require(std::isfinite(item.seconds) && item.seconds >= 0.0, "times are finite");
    fuzz::require(i == 0 || made.items[i - 1].number < item.number, "items are in order");
    for (const cli::ManifestFile& file : item.files) static_cast<void>(cli::is_whole(file, folder));
  }
  const std::string written = cli::to_json(made);
  const Result<cli::Manifest> again = cli::parse_manifest(written, "m.json");
  fuzz::require(again.ok(), "a written manifest is read back");
  fuzz::require(cli::to_json(again.value()) == written, "a written manifest is read back unchanged");
  fuzz::require(cli::first_difference(made.inputs, again.value().inputs).empty(), "the inputs are read back");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string_view text = fuzz::text_of(data, size);
  read(text, folder.at(""));
  read(fuzz::mended_manifest(text), folder.at(""));
  return 0;
}
