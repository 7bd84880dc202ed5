// Memory from the allocator of an engine, on the fake device: every byte is requested with a name and freed, and a
// request that fails changes nothing.
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "c_structures.hpp"
#include "small_effect.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

// Returns the number of the image or the buffer of the fake device.
template <typename Request>
std::uint64_t object_of(const Request& request) {
  return request.image != VK_NULL_HANDLE ? reinterpret_cast<std::uint64_t>(request.image)
                                         : reinterpret_cast<std::uint64_t>(request.buffer);
}

// An engine's allocator. It counts, and can fail.
struct Engine {
  struct Live {
    std::string name;
    VkDeviceSize bytes;
    std::uint64_t object;  // the image or buffer that is bound to it
  };
  std::map<void*, Live> live;  // by MemoryBlock::user
  VkDeviceSize bytes = 0;
  long until_failure = -1;  // requests that succeed before one fails; negative: none fails
  int requests = 0;
  bool refused = false;
  // The fault of the blocks that the allocator returns: see BlocksThatCannotBeUsedAreRefused.
  enum class Wrong { nothing, memory, offset, address } wrong = Wrong::nothing;

  VkResult allocate(const char* name, VkFlags usage, const VkMemoryRequirements& requirements, bool on_host,
                    std::uint64_t object, MemoryBlock& block) {
    ++requests;
    EXPECT_FALSE(std::string(name).empty());
    EXPECT_NE(usage, 0U) << name;
    EXPECT_GT(requirements.size, 0U) << name;
    if (until_failure == 0) {
      until_failure = -1;
      refused = true;
      return VK_ERROR_OUT_OF_POOL_MEMORY;
    }
    if (until_failure > 0) --until_failure;
    block.memory = wrong == Wrong::memory ? VK_NULL_HANDLE : number<VkDeviceMemory>(77);
    block.offset = wrong == Wrong::offset ? requirements.alignment / 2 : 8 * requirements.alignment;
    block.user = std::malloc(on_host ? requirements.size : 1);
    block.mapped = on_host && wrong != Wrong::address ? block.user : nullptr;
    if (wrong == Wrong::memory) {
      std::free(block.user);
      return VK_SUCCESS;
    }
    live[block.user] = {name, requirements.size, object};
    bytes += requirements.size;
    return VK_SUCCESS;
  }
  void free(const MemoryBlock& block, VkDeviceSize freed) {
    const auto found = live.find(block.user);
    ASSERT_NE(found, live.end()) << "freed twice";
    EXPECT_EQ(freed, found->second.bytes) << found->second.name;
    // An image or buffer is bound to the block unless the block is refused.
    EXPECT_FALSE(wrong == Wrong::nothing && faults::is_live(found->second.object))
        << found->second.name << " outlives its memory";
    bytes -= freed;
    live.erase(found);
    std::free(block.user);
  }
  [[nodiscard]] VkDeviceSize bytes_of(const std::string& name) const {
    VkDeviceSize sum = 0;
    for (const auto& [key, row] : live) sum += row.name == name ? row.bytes : 0;
    return sum;
  }
  [[nodiscard]] DeviceInfo device() {
    DeviceInfo out = faults::fake_device();
    out.memory.user = this;
    out.memory.allocate = [](void* user, const MemoryRequest& request, MemoryBlock& block) {
      EXPECT_NE(request.image == VK_NULL_HANDLE, request.buffer == VK_NULL_HANDLE) << request.name;
      EXPECT_EQ(request.preferred & request.needed, request.needed) << request.name;
      const bool on_host = (request.needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
      return static_cast<Engine*>(user)->allocate(request.name, request.usage, request.requirements, on_host,
                                                  object_of(request), block);
    };
    out.memory.free = [](void* user, const MemoryBlock& block, VkDeviceSize size) {
      static_cast<Engine*>(user)->free(block, size);
    };
    return out;
  }
};

VkDeviceSize sum(const MemoryUsage& usage) { return usage.persistent + usage.transient + usage.host; }

Effect make_with(Engine& engine, const Params& params = small_params()) {
  Result<Effect> made = Effect::create(engine.device(), small_desc(), params);
  EXPECT_OK(made);
  return std::move(made).value();
}

TEST(EffectMemory, EveryByteIsRequestedFromTheEngine) {
  Engine engine;
  const DeviceInfo device = engine.device();
  const Result<MemoryUsage> planned = query_memory(device, small_desc(), small_params());
  ASSERT_OK(planned);
  EXPECT_EQ(engine.requests, 0) << "a query allocates nothing";
  {
    Effect effect = make_with(engine);
    EXPECT_EQ(engine.bytes, sum(planned.value()));
    EXPECT_EQ(engine.bytes, sum(effect.memory()));
    for (const ResourceMemory& row : effect.resources()) EXPECT_EQ(engine.bytes_of(row.name), row.bytes) << row.name;
    EXPECT_GT(engine.bytes_of("constants"), 0U);
    EXPECT_OK(effect.record_precompute(kCommands));
    for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
    EXPECT_EQ(engine.bytes, planned.value().persistent + planned.value().host);
    // Changes: the old objects and the new ones.
    EXPECT_OK(effect.set_params(other_params()));
    EXPECT_EQ(engine.bytes, sum(effect.memory()));
    EXPECT_OK(effect.set_limits({32, 16}, 2, 32));
    EXPECT_EQ(engine.bytes, sum(effect.memory()));
    EXPECT_OK(effect.record_precompute(kCommands, 3));
    EXPECT_OK(effect.set_params(small_params()));
    EXPECT_EQ(engine.bytes, sum(effect.memory()));
    const VkDeviceSize before = engine.bytes;
    const Result<SkyProbe> probe = SkyProbe::create(effect, SkyProbeDesc{2, 64});
    ASSERT_OK(probe);
    EXPECT_EQ(engine.bytes - before, sum(SkyProbe::query_memory(device, SkyProbeDesc{2, 64}).value()));
    EXPECT_EQ(engine.bytes - before, sum(probe.value().memory()));
  }
  EXPECT_EQ(engine.live.size(), 0U);
  EXPECT_EQ(faults::live_objects(), 0U);
}

// Recording requests nothing.
TEST(EffectMemory, FramesAndSlicesRequestNothing) {
  Engine engine;
  Effect effect = make_with(engine);
  const int before = engine.requests;
  EXPECT_OK(effect.record_precompute(kCommands));
  for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
  EXPECT_EQ(engine.requests, before);
}

TEST(EffectMemory, RefusedRequestsChangeNothing) {
  long n = 0;
  for (;; ++n) {
    ASSERT_LT(n, 200);
    Engine engine;
    engine.until_failure = n;
    const Result<Effect> made = Effect::create(engine.device(), small_desc(), small_params());
    ASSERT_EQ(made.ok(), !engine.refused) << n;
    if (made.ok()) break;
    EXPECT_EQ(made.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(made.error().message.find("MemoryCallbacks::allocate"), std::string::npos) << made.error().message;
    EXPECT_EQ(engine.live.size(), 0U) << n;
  }
  EXPECT_GE(n, 20);
  for (n = 0;; ++n) {
    ASSERT_LT(n, 200);
    Engine engine;
    Effect effect = make_with(engine);
    EXPECT_OK(effect.record_precompute(kCommands));
    for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
    const Observed before = observe(effect);
    const VkDeviceSize bytes = engine.bytes;
    engine.until_failure = n;
    const Result<void> changed = effect.set_params(other_params());
    engine.until_failure = -1;
    ASSERT_EQ(changed.ok(), !engine.refused) << n;
    if (changed.ok()) break;
    EXPECT_EQ(changed.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(engine.bytes, bytes) << n;
    expect_same(before, observe(effect), std::to_string(n));
    EXPECT_OK(effect.set_params(other_params()));
  }
  EXPECT_GE(n, 10);
}

// Buffers and images that are replaced are destroyed while others, which were replaced later, still wait for their
// frames. Engine::free() checks that each goes before its memory.
TEST(EffectMemory, MemoryIsFreedAfterWhatIsBoundToIt) {
  Engine engine;
  {
    Params params = small_params();
    params.froxels.enabled = true;
    params.froxels.columns = params.froxels.rows = params.froxels.slices = 8;
    Effect effect = make_with(engine, params);
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_OK(effect.set_limits({64 + 16 * i, 32}, 2, 64));
      params.froxels.columns = 8 + 8 * i;
      params.tables.size.x = 4 + i;
      EXPECT_OK(effect.set_params(params));
      EXPECT_OK(effect.record_precompute(kCommands, 1000));
      commands_of_frame(effect);
    }
    for (int frame = 0; frame < 8; ++frame) commands_of_frame(effect);
    EXPECT_EQ(engine.bytes, sum(effect.memory()));
  }
  EXPECT_EQ(engine.live.size(), 0U);
}

TEST(EffectMemory, BlocksThatCannotBeUsedAreRefused) {
  const std::pair<Engine::Wrong, const char*> cases[] = {
      {Engine::Wrong::memory, "has no memory; expected"},
      {Engine::Wrong::offset, "has an offset that is not aligned; expected"},
      {Engine::Wrong::address, "has no address on the host; expected"}};
  for (const auto& [wrong, text] : cases) {
    Engine engine;
    engine.wrong = wrong;
    const Result<Effect> made = Effect::create(engine.device(), small_desc(), small_params());
    ASSERT_FALSE(made.ok()) << text;
    EXPECT_EQ(made.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(made.error().message.find(text), std::string::npos) << made.error().message;
    EXPECT_EQ(engine.live.size(), 0U) << text;
  }
  Engine engine;
  DeviceInfo device = engine.device();
  device.memory.free = nullptr;
  const Result<Effect> made = Effect::create(device, small_desc(), small_params());
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().message.find("only one of allocate and free; expected both or neither"), std::string::npos);
}

TEST(EffectMemory, ProgramsInCHaveTheSameCallbacks) {
  Engine engine;
  TyndallDeviceInfo device = c_device(faults::fake_device());
  device.memory_user = &engine;
  device.allocate_memory = [](void* user, const TyndallMemoryRequest* request, TyndallMemoryBlock* block) {
    MemoryBlock made;
    const bool on_host = (request->needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    const VkResult result = static_cast<Engine*>(user)->allocate(request->name, request->usage, request->requirements,
                                                                 on_host, object_of(*request), made);
    *block = {made.memory, made.offset, made.mapped, made.user};
    return result;
  };
  device.free_memory = [](void* user, const TyndallMemoryBlock* block, VkDeviceSize size) {
    static_cast<Engine*>(user)->free({block->memory, block->offset, block->mapped, block->user}, size);
  };
  const TyndallEffectDesc desc = c_desc(small_desc());
  auto planned = sized<TyndallMemoryUsage>();
  EXPECT_SUCCESS(tyndall_query_memory(&device, &desc, nullptr, &planned));
  TyndallEffect* effect = nullptr;
  engine.until_failure = 5;
  EXPECT_EQ(tyndall_effect_create(&device, &desc, nullptr, &effect), TyndallStatus_out_of_memory);
  EXPECT_EQ(engine.live.size(), 0U);
  EXPECT_SUCCESS(tyndall_effect_create(&device, &desc, nullptr, &effect));
  EXPECT_EQ(engine.bytes, planned.persistent + planned.transient + planned.host);
  tyndall_effect_destroy(effect);
  EXPECT_EQ(engine.live.size(), 0U);
}

}  // namespace
}  // namespace tyndall
