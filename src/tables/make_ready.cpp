#include "tables/make_ready.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "files/file_cache.hpp"
#include "gpu/guard.hpp"
#include "gpu/try.hpp"
#include "tyndall/version.hpp"

namespace tyndall::tables {
namespace {

std::span<std::byte> bytes_of(const gpu::Buffer& buffer) {
  return {static_cast<std::byte*>(buffer.mapped), static_cast<std::size_t>(buffer.size)};
}

// Makes the tables visible to any stage that reads them next.
void publish(const gpu::Device& device, VkCommandBuffer cmd) {
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
               VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT);
}

// Loads the tables from the cache. Returns whether they were in it.
Result<bool> load(gpu::Host& host, Effect& effect, files::FileCache& cache, Report& report) {
  const gpu::Device& device = host.device();
  const std::string key = effect.table_key();
  if (key.empty() || !cache.holds(key)) return false;
  TYNDALL_ASSIGN(const gpu::Buffer staging,
                 gpu::create_buffer(device, "cached_tables", effect.table_bytes(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                    gpu::MemoryKind::upload));
  const bool found = cache.read(key, bytes_of(staging));
  if (!cache.note().empty()) report.notes.push_back(cache.note());
  if (!found) return false;
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    if (Result<void> r = effect.record_load_tables(cmd, staging.buffer.get()); !r) return r;
    publish(device, cmd);
    return {};
  }));
  return true;
}

// Waits while another process builds the same tables, and loads them when they are there. Returns the lock under which
// this process is to build them, or nothing if they were loaded. After kLongestWait the tables are built without a
// lock: the other process may have been stopped.
Result<std::optional<files::BuildLock>> load_or_lock(gpu::Host& host, Effect& effect, const MakeReady& how,
                                                     files::FileCache& cache, Report& report) {
  constexpr auto kLongestWait = std::chrono::seconds(60);
  constexpr auto kPause = std::chrono::milliseconds(20);
  TYNDALL_ASSIGN(bool loaded, load(host, effect, cache, report));
  if (loaded) return std::optional<files::BuildLock>();
  const std::string key = effect.table_key();
  const auto start = std::chrono::steady_clock::now();
  bool waited = false;
  for (;;) {
    files::BuildLock lock = cache.try_lock(key);
    if (lock.state() != files::BuildLock::State::busy || std::chrono::steady_clock::now() - start > kLongestWait) {
      // Another process may have stored the tables since they were missed. A damaged file is only reported once.
      if (cache.holds(key) && (waited || report.notes.empty())) {
        TYNDALL_ASSIGN(loaded, load(host, effect, cache, report));
        if (loaded) return std::optional<files::BuildLock>();
      }
      return std::optional<files::BuildLock>(std::move(lock));
    }
    waited = true;
    if (how.progress) how.progress(effect.precompute_progress());
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

Result<void> advance(gpu::Host& host, Effect& effect, const MakeReady& how, std::uint32_t budget,
                     std::vector<std::string>& notes) {
  const Progress progress = effect.precompute_progress();
  if (progress.complete()) return {};
  if (progress.done == 0 && !how.rebuild) {
    files::FileCache cache(files::cache_directory(how.cache.place), how.cache.limit_bytes, TYNDALL_VERSION_STRING);
    Report report;
    const Result<bool> loaded = load(host, effect, cache, report);
    notes.insert(notes.end(), report.notes.begin(), report.notes.end());
    if (!loaded && loaded.error().code != ErrorCode::out_of_memory) return loaded.error();
    if (loaded && loaded.value()) return {};
  }
  return host.run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> recorded = effect.record_precompute(cmd, std::max(budget, 1U));
    if (!recorded) return recorded.error();
    publish(host.device(), cmd);
    return {};
  });
}

Result<CacheWriter> CacheWriter::fetch(gpu::Host& host, Effect& effect, const CacheDesc& cache) {
  const gpu::Device& device = host.device();
  TYNDALL_ASSIGN(const gpu::Buffer staging,
                 gpu::create_buffer(device, "cached_tables", effect.table_bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                    gpu::MemoryKind::readback));
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    if (Result<void> r = effect.record_save_tables(cmd, staging.buffer.get()); !r) return r;
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                 VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  CacheWriter out;
  out.cache_ = cache;
  out.key_ = effect.table_key();
  const std::span<std::byte> bytes = bytes_of(staging);
  out.bytes_.assign(bytes.begin(), bytes.end());
  return out;
}

std::string CacheWriter::write() {
  if (key_.empty()) return {};
  files::FileCache cache(files::cache_directory(cache_.place), cache_.limit_bytes, TYNDALL_VERSION_STRING);
  cache.write(key_, bytes_);
  return cache.note();
}

Result<Report> make_ready(gpu::Host& host, Effect& effect, const MakeReady& how) {
  Report report;
  if (effect.precompute_progress().complete()) return report;
  const auto start = std::chrono::steady_clock::now();
  const auto milliseconds = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  files::FileCache cache(files::cache_directory(how.cache.place), how.cache.limit_bytes, TYNDALL_VERSION_STRING);
  // A lack of memory for the cache is not an error: the build has its own memory.
  const auto without_cache = [&](const Error& error) -> Result<void> {
    if (error.code != ErrorCode::out_of_memory) return error;
    report.notes.push_back("the cache of the tables is not used: " + error.message);
    return {};
  };
  std::optional<files::BuildLock> lock;  // held until the tables are stored
  if (!how.rebuild) {
    Result<std::optional<files::BuildLock>> found = load_or_lock(host, effect, how, cache, report);
    if (!found) TYNDALL_TRY(without_cache(found.error()));
    if (found && found.value()) lock.emplace(std::move(*found.value()));
    if (found && !lock) {
      report.origin = Origin::cache;
      report.milliseconds = milliseconds();
      return report;
    }
  }
  if (how.progress) how.progress(effect.precompute_progress());
  while (!effect.precompute_progress().complete()) {
    TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> recorded = effect.record_precompute(cmd, std::max(how.slice_budget, 1U));
      if (!recorded) return recorded.error();
      publish(host.device(), cmd);
      return {};
    }));
    if (how.progress) how.progress(effect.precompute_progress());
  }
  report.origin = Origin::build;
  report.milliseconds = milliseconds();
  if (!cache.enabled()) return report;
  // The new tables are in use and the old ones are freed. If caching now runs out of memory, a note is enough.
  const Result<void> cached = within_memory("caching the tables", [&]() -> Result<void> {
    TYNDALL_ASSIGN(CacheWriter writer, CacheWriter::fetch(host, effect, how.cache));
    // One line is enough: a file that cannot be replaced remains damaged.
    if (const std::string note = writer.write(); !note.empty()) report.notes = {note};
    return {};
  });
  if (!cached) TYNDALL_TRY(without_cache(cached.error()));
  return report;
}

}  // namespace tyndall::tables
