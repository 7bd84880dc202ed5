#include "batch.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <mutex>

#include "arguments.hpp"
#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "tyndall/version.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using files::concat;

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  ::gmtime_r(&now, &parts);
  char text[32];
  return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts));
}

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

// Returns the place of the first item with at least this number.
auto place_of(const std::vector<ManifestItem>& items, std::uint64_t number) {
  return std::lower_bound(items.begin(), items.end(), number,
                          [](const ManifestItem& item, std::uint64_t n) { return item.number < n; });
}

bool holds(const std::vector<ManifestItem>& items, std::uint64_t number) {
  const auto place = place_of(items, number);
  return place != items.end() && place->number == number;
}

// Returns the items among `numbers` that have the inputs of this run and whose files are there as the manifest says,
// ordered by number.
std::vector<ManifestItem> whole_items(const Manifest& manifest, const std::vector<std::uint64_t>& numbers,
                                      const std::string& folder,
                                      const std::function<std::string(std::uint64_t)>& item_inputs) {
  std::vector<ManifestItem> out;
  for (const ManifestItem& item : manifest.items) {
    if (!std::binary_search(numbers.begin(), numbers.end(), item.number) || item.files.empty()) continue;
    if (holds(out, item.number)) continue;
    if (item_inputs && item.inputs_hash != item_inputs(item.number)) continue;
    if (std::all_of(item.files.begin(), item.files.end(),
                    [&](const ManifestFile& file) { return is_whole(file, folder); })) {
      out.insert(place_of(out, item.number), item);
    }
  }
  return out;
}

// Returns the inputs that every item depends on.
Inputs shared_inputs(Inputs inputs, const std::string& items_input) {
  std::erase_if(inputs, [&](const auto& input) { return !items_input.empty() && input.first == items_input; });
  return inputs;
}

}  // namespace

struct Batch::State {
  std::mutex mutex;  // guards the rest
  Manifest manifest;
  std::string path;    // path of the manifest; empty without one
  std::string folder;  // folder of the manifest
  std::string unit;
  std::function<std::string(std::uint64_t)> item_inputs;
  std::size_t wanted = 0;  // number of items of this run, including those that were made before it
  Clock::time_point last_item = Clock::now();
  Clock::time_point last_write = Clock::now();

  Result<void> write() {
    last_write = Clock::now();
    manifest.time = utc_now();
    return path.empty() ? Result<void>() : files::write_file(path, to_json(manifest));
  }
};

void add_batch_options(Arguments& arguments, BatchOptions& options, const std::string& unit) {
  arguments.value("--shard", "I/N", concat({"compute only part I of N of the ", unit, ", and write a manifest"}),
                  [&options](const std::string& text) {
                    const Result<Shard> shard = parse_shard(text, "--shard");
                    if (!shard) return Result<void>(shard.error());
                    options.shard = shard.value();
                    options.sharded = true;
                    return Result<void>();
                  });
  arguments.flag(
      "--resume", options.resume,
      "skip what the manifest of an earlier run lists, if it is there, undamaged and of the same parameters");
}

Result<Batch> Batch::begin(BatchDesc desc) {
  Batch out;
  out.state_ = std::make_shared<State>();
  State& state = *out.state_;
  state.unit = desc.unit;
  state.wanted = desc.numbers.size();
  out.numbers_ = std::move(desc.numbers);
  if (!desc.options.active()) return out;
  Manifest& manifest = state.manifest;
  manifest.verb = desc.verb;
  manifest.version = TYNDALL_VERSION_STRING;
  manifest.output = fs::path(desc.output).filename().string();
  manifest.shard = desc.options.shard;
  manifest.total = desc.total;
  manifest.inputs = std::move(desc.inputs);
  for (const auto& [name, value] : manifest.inputs) {
    if (value == kStream)
      return files::input_error("cannot be read twice", name, "expected a regular file with --shard and --resume");
  }
  state.path = manifest_path(desc.output, manifest.shard);
  state.folder = folder_of(state.path);
  state.item_inputs = std::move(desc.item_inputs);
  std::error_code ignored;
  if (desc.options.resume && fs::exists(state.path, ignored)) {
    Result<Manifest> earlier = read_manifest(state.path);
    if (!earlier) {
      note(concat({"--resume: ", earlier.error().message, "; everything is made again"}));
    } else if (const Inputs before = shared_inputs(earlier.value().inputs, desc.items_input),
               now = shared_inputs(manifest.inputs, desc.items_input);
               earlier.value().verb != manifest.verb || before != now) {
      note(concat({"--resume: '", files::one_line(state.path, 200), "' has other parameters (",
                   files::one_line(first_difference(before, now)), "); everything is made again"}));
    } else {
      manifest.device = earlier.value().device;
      manifest.items = whole_items(earlier.value(), out.numbers_, state.folder, state.item_inputs);
      std::vector<std::uint64_t> missing;
      for (const std::uint64_t number : out.numbers_) {
        if (!holds(manifest.items, number)) missing.push_back(number);
      }
      out.numbers_ = std::move(missing);
    }
  }
  if (Result<void> written = state.write(); !written) return std::move(written).error();
  return out;
}

void Batch::set_device(const std::string& device) {
  const std::scoped_lock lock(state_->mutex);
  state_->manifest.device = device;
}

Result<void> Batch::finished(std::uint64_t number, const std::vector<std::string>& paths, const std::string& name) {
  ManifestItem item;
  item.number = number;
  item.name = name;
  if (!state_->path.empty()) {
    if (state_->item_inputs) item.inputs_hash = state_->item_inputs(number);
    for (const std::string& path : paths) {
      Result<files::FileSum> sum = files::sum_of_file(path);
      if (!sum) return std::move(sum).error();
      item.files.push_back({relative_name(path, state_->folder), std::move(sum).value()});
    }
  }
  const std::scoped_lock lock(state_->mutex);
  const Clock::time_point now = Clock::now();
  item.seconds = std::chrono::duration<double>(now - state_->last_item).count();
  state_->last_item = now;
  std::vector<ManifestItem>& items = state_->manifest.items;
  items.insert(place_of(items, number), std::move(item));
  return now - state_->last_write < std::chrono::seconds(1) ? Result<void>() : state_->write();
}

Result<void> Batch::end() {
  const std::scoped_lock lock(state_->mutex);
  state_->manifest.complete = state_->manifest.items.size() == state_->wanted;
  return state_->write();
}

std::function<std::string()> Batch::describe() const {
  return [state = state_]() -> std::string {
    const std::scoped_lock lock(state->mutex);
    std::string text = concat({std::to_string(state->manifest.items.size()), " of ", std::to_string(state->wanted), " ",
                               state->unit, " are finished"});
    if (state->path.empty()) return text;
    const Result<void> written = state->write();
    if (!written) return concat({text, "; ", written.error().message});
    return concat({text, "; --resume makes the others"});
  };
}

Result<void> check_batch_output(const std::string& output) {
  const std::string folder = folder_of(output);
  if (frame_path(folder, 0) == folder) return {};
  return files::input_error(concat({"the frame number is in the name of a folder of '", files::one_line(output), "'"}),
                            "-o", "expected it in the name of the file with --shard and --resume");
}

}  // namespace tyndall::cli
