// A run that makes several items, such as frames. A shard makes a part of them, and --resume skips finished ones.
// Records what is finished, for the manifest and for the message of an interrupted run. See docs/batch.md.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "manifest.hpp"
#include "shard.hpp"

namespace tyndall::cli {

class Arguments;

struct BatchOptions {
  Shard shard;
  bool sharded = false;
  bool resume = false;
  // Returns whether the run has a manifest.
  [[nodiscard]] bool active() const { return sharded || resume; }
};
// Adds --shard and --resume. `unit` names the items: "frames".
void add_batch_options(Arguments& arguments, BatchOptions& options, const std::string& unit);

struct BatchDesc {
  BatchOptions options;
  std::string verb;
  std::string unit;    // for messages: "frames"
  std::string output;  // -o
  std::uint64_t total = 0;
  std::vector<std::uint64_t> numbers;  // numbers of the items that this run makes, ascending
  Inputs inputs;                       // only needed if options.active()
  // The name of an input of which each item uses only a part, such as a list with one row for each item, and a function
  // that returns a checksum of the part of an item. --resume compares these checksums instead of the input. Both may be
  // empty. The function is called until the last finished().
  std::string items_input = {};
  std::function<std::string(std::uint64_t number)> item_inputs = {};
};

// Use from one thread, except describe().
class Batch {
 public:
  // Without --shard or --resume this only counts. Otherwise it reads the manifest for --resume and starts a new one.
  // Call it after all checks of the options. Errors: io if the manifest cannot be written.
  [[nodiscard]] static Result<Batch> begin(BatchDesc desc);

  // Returns the items that have to be made.
  [[nodiscard]] const std::vector<std::uint64_t>& numbers() const { return numbers_; }

  // Sets the name of the device, for the manifest.
  void set_device(const std::string& device);
  // Records an item and the files that it consists of, which are complete. Updates the manifest at most once a second.
  [[nodiscard]] Result<void> finished(std::uint64_t number, const std::vector<std::string>& paths,
                                      const std::string& name = {});
  // Completes the manifest.
  [[nodiscard]] Result<void> end();

  // Returns a function that updates the manifest and returns "3 of 10 frames are finished", which may be called by any
  // thread, also after the batch is gone.
  [[nodiscard]] std::function<std::string()> describe() const;

 private:
  struct State;

  Batch() = default;

  std::shared_ptr<State> state_;
  std::vector<std::uint64_t> numbers_;
};

// Returns an error if the frame number of an output with a manifest is in the name of a folder.
[[nodiscard]] Result<void> check_batch_output(const std::string& output);

}  // namespace tyndall::cli
