#include "tables/pipeline_store.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "files/file_cache.hpp"
#include "gpu/guard.hpp"
#include "tyndall/version.hpp"

namespace tyndall::tables {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20U;

files::FileCache open_cache(const CacheDesc& desc) {
  return {files::cache_directory(desc.place), desc.limit_bytes, TYNDALL_VERSION_STRING};
}

std::string key_of(const VkPhysicalDeviceProperties& p) {
  std::string key = "pipelines " + std::to_string(p.vendorID) + " " + std::to_string(p.deviceID) + " " +
                    std::to_string(p.driverVersion) + " " + p.deviceName;
  for (const std::uint8_t byte : p.pipelineCacheUUID) key += " " + std::to_string(byte);
  return key;
}

}  // namespace

bool is_of_device(std::span<const std::byte> data, const VkPhysicalDeviceProperties& device) {
  // VkPipelineCacheHeaderVersionOne as integers: its version is an enumeration, but damaged data may hold any number.
  struct Header {
    std::uint32_t bytes, version, vendor, device;
    std::array<std::uint8_t, VK_UUID_SIZE> uuid;
  } header = {};
  static_assert(sizeof(Header) == sizeof(VkPipelineCacheHeaderVersionOne));
  if (data.size() < sizeof header) return false;
  std::memcpy(&header, data.data(), sizeof header);
  return header.bytes >= sizeof header && header.bytes <= data.size() &&
         header.version == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendor == device.vendorID &&
         header.device == device.deviceID &&
         std::memcmp(header.uuid.data(), device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

PipelineStore::PipelineStore(gpu::Host& host, const CacheDesc& cache) : host_(host), desc_(cache) {
  static_cast<void>(within_memory("reading the compiled pipelines", [&]() -> Result<void> {
    const gpu::Device& device = host_.device();
    key_ = key_of(device.properties);
    files::FileCache files = open_cache(desc_);
    std::optional<std::string> stored;
    const std::uint64_t bytes = files.size(key_);
    if (bytes > 0 && bytes <= kMaxBytes) stored = files.read(key_, bytes);
    note_ = files.note();
    VkPipelineCacheCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    if (stored && is_of_device(std::as_bytes(std::span(*stored)), device.properties)) {
      info.initialDataSize = stored->size();
      info.pInitialData = stored->data();
    }
    VkPipelineCache made = VK_NULL_HANDLE;
    if (device.vk.CreatePipelineCache(device.device, &info, device.allocator, &made) != VK_SUCCESS) return {};
    // A driver may ignore the stored data. What it has accepted decides whether there is more to store at the end.
    if (device.vk.GetPipelineCacheData(device.device, made, &stored_bytes_, nullptr) != VK_SUCCESS) stored_bytes_ = 0;
    cache_ = gpu::Handle<VkPipelineCache>(device, made);
    host_.set_pipeline_cache(made);
    return {};
  }));
}

PipelineStore::~PipelineStore() {
  static_cast<void>(within_memory("storing the compiled pipelines", [&]() -> Result<void> {
    store();
    return {};
  }));
  host_.set_pipeline_cache(VK_NULL_HANDLE);
}

void PipelineStore::store() {
  const gpu::Device& device = host_.device();
  std::size_t bytes = 0;
  if (!cache_) return;
  if (device.vk.GetPipelineCacheData(device.device, cache_.get(), &bytes, nullptr) != VK_SUCCESS) return;
  // Some drivers only return the header. The size does not shrink, because nothing is ever removed.
  if (bytes <= sizeof(VkPipelineCacheHeaderVersionOne) || bytes <= stored_bytes_ || bytes > kMaxBytes) return;
  std::vector<std::byte> data(bytes);
  if (device.vk.GetPipelineCacheData(device.device, cache_.get(), &bytes, data.data()) != VK_SUCCESS) return;
  data.resize(bytes);
  if (!is_of_device(data, device.properties)) return;
  open_cache(desc_).write(key_, data);
}

}  // namespace tyndall::tables
