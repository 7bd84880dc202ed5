// The scattering tables and their construction in slices. docs/tables.md describes how the orders of scattering are
// solved.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "effect/frame_constants.hpp"
#include "effect/frame_parts.hpp"
#include "effect/frame_ring.hpp"
#include "effect/phase_rows.hpp"
#include "effect/pipeline_cache.hpp"
#include "effect/shared.hpp"
#include "effect/step_recorder.hpp"
#include "gpu/resource.hpp"
#include "gpu/timer.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

enum class TableId : std::uint32_t { single_rayleigh, single_mie, high_orders, sun_transmittance, sky_irradiance };
constexpr std::uint32_t kTableCount = 5;

// An image of a table. It is in GENERAL layout once a command that writes it has been recorded.
struct TableImage {
  gpu::Image image;
  bool ready = false;
};
using TableSet = std::array<TableImage, kTableCount>;

// Returns an error if the limits of the device do not allow tables of this size.
[[nodiscard]] Result<void> check_table_size(const gpu::Device& device, const Params& params);
[[nodiscard]] gpu::ImageDesc table_desc(TableId table, const Params& params);
// Returns the tables (bits 1 << TableId) that differ between two sets of parameters.
[[nodiscard]] std::uint32_t stale_tables(const Params& built, const Params& wanted);
// Return Effect::table_key() and Effect::table_bytes().
[[nodiscard]] std::string table_key(const gpu::Device& device, const Params& params);
[[nodiscard]] VkDeviceSize table_bytes(const Params& params);

// The scratch memory of a build, freed when the build is complete.
struct TableScratch {
  gpu::Buffer constants;       // Medium, then TableShape and ZenithQuadrature
  gpu::Buffer grid_rays;       // rays of the gathering grid
  gpu::Buffer table_rays;      // rays of one altitude of the tables
  gpu::Buffer phase;           // Fourier coefficients of the phase functions
  gpu::Buffer incident;        // incident radiance of one order
  gpu::Image source_function;  // source function of one order; in the end the sum of all orders >= 2
  gpu::Buffer late_terms;      // Fourier terms of the source function of one late order, and of the sum of these orders
  gpu::Buffer sum;             // sum of the source functions so far
  gpu::Buffer irradiance;      // irradiance of one order
  gpu::Buffer sky;             // sum of the irradiance of all orders
  std::uint32_t views = 0;     // capacity of table_rays
  ColorMode color = ColorMode::rgb;
  bool tabulated = false;  // the aerosol's phase function is read from a table
  [[nodiscard]] VkDeviceSize bytes() const;
};
[[nodiscard]] VkDeviceSize table_scratch_bytes(const gpu::Device& device, const Params& params);

// The effects that use the tables. Counts rounds, in each of which every effect begins a frame, so that retired images
// are freed only when no frame can read them any more.
class TableUsers {
 public:
  struct User {
    const FrameRing* ring = nullptr;  // identifies it
    const FrameParts* parts = nullptr;
    std::uint32_t slots = 0;  // of the ring
  };
  void add(const User& user) { users_.push_back({user, false}); }
  void remove(const FrameRing* ring) noexcept;
  [[nodiscard]] bool empty() const { return users_.empty(); }
  // Returns whether this user counts the memory of the tables as its own, as one of them does.
  [[nodiscard]] bool counted_by(const FrameRing* ring) const {
    return !users_.empty() && users_.front().user.ring == ring;
  }
  // Returns an error if a user has recorded the first part of a frame only, as FrameParts::check_between().
  [[nodiscard]] Result<void> check_between(const char* where) const;

  // Notes that a user begins a frame.
  void begin_frame(const FrameRing* ring);
  // Returns whether each user has begun a frame since the last round, or has no commands in flight. Then begins another
  // round.
  [[nodiscard]] bool end_round();
  // Returns the number of rounds after which no command that is in flight now can still be in flight.
  [[nodiscard]] std::uint32_t rounds(std::uint32_t least) const;

 private:
  struct Entry {
    User user;
    bool begun;
  };
  std::vector<Entry> users_;
};

// Builds the tables. Owns them and, during a build, the scratch memory and the unfinished tables. Objects that
// commands in flight may still use are destroyed after `frames_in_flight` more frames have been recorded, by each
// effect that uses the tables.
class TableBuilder {
 public:
  // The allocated result of plan(); defined below.
  struct Pending;

  struct Options {
    std::uint32_t frames_in_flight = 1;
    bool timings = false;
    bool pipelines_later = false;  // record() makes the pipelines and descriptor sets of a build, instead of plan()
  };
  // `pipelines` must outlive the builder. There are no tables before the first commit().
  Result<void> create(const gpu::Device& device, PipelineCache& pipelines, const Options& options);

  // Allocates everything that the build for other parameters needs (images of another size, scratch memory, the list of
  // steps), and changes nothing else.
  Result<Pending> plan(const Params& params);
  // Takes over the result of the last plan(), and starts the build of the tables that differ from the finished ones.
  void commit(Pending&& pending) noexcept;
  // Records at most `budget` steps. An error records nothing.
  Result<void> record(VkCommandBuffer cmd, std::uint32_t budget);
  // Copies the finished tables to a buffer, in the order of TableId and without padding. Returns an error while some of
  // them are stale.
  Result<void> record_save(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset);
  // Copies the stale tables, if any, from such a buffer, in place of the rest of the build.
  Result<void> record_load(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset);
  // To be called once per frame of each effect, with its ring. Moves new images out of the undefined layout, and frees
  // objects that no frame uses.
  void begin_frame(VkCommandBuffer cmd, const FrameRing* ring = nullptr);

  [[nodiscard]] TableUsers& users() { return users_; }
  [[nodiscard]] const TableUsers& users() const { return users_; }
  // Returns the parameters of the build in progress, or those of the finished tables.
  [[nodiscard]] const Params& wanted() const { return done_ < steps_.size() ? wanted_ : built_; }
  // Returns whether frames with these parameters may read the tables: they are those of the tables, or those of the
  // build that will replace them. Needs some time; the answer changes with revision() only.
  [[nodiscard]] bool serves(const Params& params) const {
    return !complete_ || stale_tables(built_, params) == 0 || stale_tables(wanted(), params) == 0;
  }
  // Returns a number that changes when a build begins, ends or is cancelled.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

  [[nodiscard]] Progress progress() const { return {done_, static_cast<std::uint32_t>(steps_.size())}; }
  // Returns true once tables have been built. Stale tables stay in use until the next build is complete.
  [[nodiscard]] bool ready() const { return complete_; }
  // Returns the parameters of the tables that frames read; `wanted` before the first build is complete.
  [[nodiscard]] const Params& built(const Params& wanted) const { return complete_ ? built_ : wanted; }
  // Returns a number that changes whenever a build is complete.
  [[nodiscard]] std::uint64_t version() const { return version_; }
  // Returns a finished table; before the first build is complete, the table that it fills.
  [[nodiscard]] const gpu::Image& table(TableId id) const { return tables_[static_cast<std::uint32_t>(id)].image; }
  [[nodiscard]] VkDeviceSize persistent_bytes() const;
  [[nodiscard]] VkDeviceSize transient_bytes() const;
  // Returns the times of the stages that the last build had, in their order, once its commands have completed. Needs
  // `timings`.
  [[nodiscard]] std::span<const PassTiming> stage_times();

 private:
  struct Retired {
    TableSet tables;
    TableScratch scratch;
    SetCache sets;
    std::uint32_t frames_left;
  };

  [[nodiscard]] Result<TableScratch> create_scratch(std::uint32_t views, ColorMode color, bool tabulated) const;
  // Makes the pipelines and the descriptor sets of the steps of a build.
  [[nodiscard]] Result<SetCache> make_sets(std::span<const Step> steps);
  void upload_constants(VkCommandBuffer cmd);
  // Gives the image of a table its layout before its first use, and clears it where frames may read it.
  void make_ready(VkCommandBuffer cmd, TableImage& table, bool black);
  void make_images_ready(VkCommandBuffer cmd);
  [[nodiscard]] BoundResources bind_resources();
  void finish() noexcept;
  void retire(TableSet tables, TableScratch scratch, SetCache sets) noexcept;
  TableImage& target(TableId id);

  const gpu::Device* device_ = nullptr;
  TableUsers users_;
  std::uint64_t revision_ = 0;
  Options options_;
  PipelineCache* pipelines_ = nullptr;
  gpu::Handle<VkSampler> linear_ = {};  // samples the source function
  TableSet tables_ = {};
  TableSet next_ = {};  // the new tables, if `tables_` is in use and stale
  TableScratch scratch_ = {};
  SetCache sets_ = {};     // descriptor sets of the build
  Params built_ = {};      // parameters of tables_, if complete_
  Params wanted_ = {};     // parameters of the build
  PhaseRows phase_rows_;   // resolved_phase_rows() for the build
  bool complete_ = false;  // tables_ have been built at least once
  std::uint64_t version_ = 0;
  std::uint32_t stale_ = 0;  // tables that the build writes
  std::vector<Step> steps_ = {};
  std::uint32_t done_ = 0;
  std::vector<Retired> retired_ = {};
  gpu::Timer timer_ = {};
  std::vector<PassTiming> times_ = {};  // the last result of stage_times()
};

// The work that commit() takes over, with everything allocated.
struct TableBuilder::Pending {
  enum class Kind : std::uint32_t {
    nothing,  // the tables, or the running build, already match the parameters
    cancel,   // the finished tables match the parameters, and the running build is not needed
    build
  };
  Kind kind = Kind::nothing;
  Params wanted = {};
  std::uint32_t stale = 0;
  TableSet images = {};       // of stale tables whose image has another size
  TableScratch scratch = {};  // replaces the present one if `views` is not 0
  PhaseRows phase_rows = {};
  std::vector<Step> steps = {};
  SetCache sets = {};  // new ones for each build, because commands may still use those of the one before
};

// The tables of an effect, or of several that share them, with what their builds need.
struct SharedTables {
  gpu::Device device;       // first, because the others refer to it
  PipelineCache pipelines;  // of builds
  TableBuilder builder;
};

}  // namespace tyndall
