// Misuse and failing allocations in the C interface, on the fake device: each call returns a status and a text, and
// changes nothing. No exception leaves a function; it would end the program.
#include <functional>
#include <iostream>
#include <string>
#include <string_view>

#include "c_structures.hpp"
#include "small_effect.hpp"

namespace tyndall {
namespace {

using faults::Kind;

OwnedParams c_params() {
  TyndallParams* p = nullptr;
  EXPECT_SUCCESS(tyndall_params_create(&p));
  const double size[4] = {8, 16, 16, 4};
  EXPECT_SUCCESS(tyndall_params_set_numbers(p, "tables.size", size, 4));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "tables.orders", 2));
  return OwnedParams(p);
}

const TyndallDeviceInfo kDevice = c_device(faults::fake_device());
const TyndallEffectDesc kDesc = c_desc(small_desc());

OwnedEffect make_c() {
  TyndallEffect* out = nullptr;
  EXPECT_SUCCESS(tyndall_effect_create(&kDevice, &kDesc, c_params().get(), &out));
  return OwnedEffect(out);
}

void expect_invalid(TyndallStatus status, std::initializer_list<const char*> parts) {
  EXPECT_EQ(status, TyndallStatus_invalid_argument);
  const std::string text = tyndall_last_error();
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
}

TEST(CFaults, NullPointersAreRefused) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const OwnedParams params = c_params();
  const CFrame frame = c_frame(fake_frame());
  TyndallEffect* made = nullptr;
  auto memory = sized<TyndallMemoryUsage>();
  std::uint32_t count = 0;
  std::size_t size = 0;
  expect_invalid(tyndall_effect_create(nullptr, &kDesc, params.get(), &made), {"TyndallDeviceInfo", "null"});
  expect_invalid(tyndall_effect_create(&kDevice, nullptr, params.get(), &made), {"TyndallEffectDesc", "null"});
  expect_invalid(tyndall_effect_create(&kDevice, &kDesc, params.get(), nullptr), {"'effect' is null"});
  EXPECT_EQ(made, nullptr);
  expect_invalid(tyndall_query_memory(&kDevice, &kDesc, params.get(), nullptr), {"TyndallMemoryUsage", "null"});
  expect_invalid(tyndall_query_memory(nullptr, &kDesc, params.get(), &memory), {"TyndallDeviceInfo", "null"});
  tyndall_effect_destroy(nullptr);
  expect_invalid(tyndall_effect_record(nullptr, kCommands, &frame.inputs), {"tyndall_effect_record", "'effect'"});
  expect_invalid(tyndall_effect_record(effect, VK_NULL_HANDLE, &frame.inputs), {"command buffer is null"});
  expect_invalid(tyndall_effect_record_part(nullptr, kCommands, &frame.inputs, TyndallFramePart_first), {"'effect'"});
  expect_invalid(tyndall_effect_record_part(effect, kCommands, nullptr, TyndallFramePart_first), {"null"});
  expect_invalid(tyndall_effect_record(effect, kCommands, nullptr), {"TyndallFrameInputs", "null"});
  CFrame without = c_frame(fake_frame());
  without.inputs.cascades = nullptr;
  expect_invalid(tyndall_effect_record(effect, kCommands, &without.inputs), {"TyndallFrameInputs::cascades", "null"});
  without.inputs.cascade_count = 9;
  expect_invalid(tyndall_effect_record(effect, kCommands, &without.inputs), {"cascade_count is 9", "at most 8"});
  expect_invalid(tyndall_effect_set_params(effect, nullptr, nullptr), {"'params' is null"});
  expect_invalid(tyndall_effect_set_params(nullptr, params.get(), nullptr), {"'effect' is null"});
  expect_invalid(tyndall_effect_get_params(effect, nullptr), {"'params' is null"});
  expect_invalid(tyndall_effect_get_table_params(effect, nullptr), {"'params' is null"});
  expect_invalid(tyndall_effect_picture_color(effect, nullptr), {"'choice' is null"});
  expect_invalid(tyndall_effect_get_desc(effect, nullptr), {"TyndallEffectDesc", "null"});
  expect_invalid(tyndall_effect_set_limits(nullptr, {1, 1}, 1, 1), {"'effect' is null"});
  expect_invalid(tyndall_effect_set_shadow_colors(nullptr, 1), {"'effect' is null"});
  expect_invalid(tyndall_effect_prepare_pipelines(nullptr, 1, nullptr), {"'effect' is null"});
  expect_invalid(tyndall_effect_record_precompute(nullptr, kCommands, 1, nullptr), {"'effect' is null"});
  expect_invalid(tyndall_effect_precompute_progress(effect, nullptr), {"'progress' is null"});
  expect_invalid(tyndall_effect_table_key(effect, nullptr, nullptr), {"'size' is null"});
  expect_invalid(tyndall_effect_table_key(nullptr, &size, nullptr), {"'effect' is null"});
  expect_invalid(tyndall_effect_table_bytes(effect, nullptr), {"'bytes' is null"});
  expect_invalid(tyndall_effect_record_save_tables(effect, kCommands, VK_NULL_HANDLE, 0),
                 {"the buffer of the tables is null"});
  expect_invalid(tyndall_effect_record_load_tables(effect, kCommands, VK_NULL_HANDLE, 0),
                 {"the buffer of the tables is null"});
  expect_invalid(tyndall_effect_memory(effect, nullptr), {"TyndallMemoryUsage", "null"});
  expect_invalid(tyndall_effect_counters(effect, 0, 0, nullptr), {"TyndallCounters", "null"});
  expect_invalid(tyndall_effect_light_tables(effect, nullptr), {"TyndallLightTables", "null"});
  expect_invalid(tyndall_effect_scattering_tables(effect, nullptr), {"TyndallScatteringTables", "null"});
  expect_invalid(tyndall_effect_atmosphere_images(effect, 0, nullptr, nullptr), {"'count' is null"});
  const auto atmosphere = sized<TyndallAtmosphereInputs>();
  expect_invalid(tyndall_atmosphere_constants(nullptr, &atmosphere, nullptr, 512), {"'constants' is null"});
  expect_invalid(tyndall_atmosphere_constants(nullptr, nullptr, &memory, 512), {"TyndallAtmosphereInputs", "null"});
  expect_invalid(tyndall_effect_resources(effect, nullptr, nullptr), {"'count' is null"});
  expect_invalid(tyndall_effect_timings(effect, 0, 0, nullptr, nullptr), {"'count' is null"});
  expect_invalid(tyndall_effect_precompute_timings(nullptr, &count, nullptr), {"'effect' is null"});
  EXPECT_SUCCESS(tyndall_effect_record_precompute(effect, kCommands, UINT32_MAX, nullptr));
  EXPECT_SUCCESS(tyndall_effect_record(effect, kCommands, &frame.inputs));
}

TEST(CFaults, TheModeIsThatOfTheTablesInUse) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const OwnedParams params = c_params(), used = c_params();
  const auto modes = [&] {
    const char* picture = "";
    const char* tables = "";
    EXPECT_SUCCESS(tyndall_effect_picture_color(effect, &picture));
    EXPECT_SUCCESS(tyndall_effect_get_table_params(effect, used.get()));
    EXPECT_SUCCESS(tyndall_params_get_choice(used.get(), "scattering.color", &tables));
    return std::string(picture) + " " + tables;
  };
  EXPECT_SUCCESS(tyndall_effect_record_precompute(effect, kCommands, UINT32_MAX, nullptr));
  EXPECT_EQ(modes(), "rgb rgb");
  EXPECT_SUCCESS(tyndall_params_set_choice(params.get(), "scattering.color", "spectral"));
  EXPECT_SUCCESS(tyndall_effect_set_params(effect, params.get(), nullptr));
  EXPECT_EQ(modes(), "rgb rgb");
  EXPECT_SUCCESS(tyndall_effect_record_precompute(effect, kCommands, UINT32_MAX, nullptr));
  EXPECT_EQ(modes(), "spectral spectral");
}

TEST(CFaults, SizesOfStructuresAreChecked) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const OwnedParams params = c_params();
  TyndallEffect* made = nullptr;
  auto memory = sized<TyndallMemoryUsage>();
  for (const int difference : {-4, 4, -1000000}) {
    const auto wrong = [&](auto structure) {
      structure.struct_size = difference < -1000 ? 0 : structure.struct_size + static_cast<std::uint32_t>(difference);
      return structure;
    };
    auto device = wrong(kDevice);
    auto desc = wrong(kDesc);
    const CFrame frame = c_frame(fake_frame());
    auto inputs = wrong(frame.inputs);
    // These structures have grown, so smaller sizes are those of earlier versions.
    if (difference == -4) {
      device.struct_size = offsetof(TyndallDeviceInfo, allocate_memory) - 4;
      desc.struct_size = offsetof(TyndallEffectDesc, clouds) - 4;
      inputs.struct_size = offsetof(TyndallFrameInputs, clouds) - 4;
    }
    auto light = wrong(sized<TyndallLightTables>());
    auto counters = wrong(sized<TyndallCounters>());
    auto usage = wrong(sized<TyndallMemoryUsage>());
    auto scattering = wrong(sized<TyndallScatteringTables>());
    expect_invalid(tyndall_effect_create(&device, &kDesc, nullptr, &made), {"TyndallDeviceInfo::struct_size is"});
    expect_invalid(tyndall_effect_create(&kDevice, &desc, nullptr, &made), {"TyndallEffectDesc::struct_size is"});
    expect_invalid(tyndall_query_memory(&kDevice, &desc, nullptr, &memory), {"TyndallEffectDesc::struct_size is"});
    expect_invalid(tyndall_query_memory(&kDevice, &kDesc, nullptr, &usage), {"TyndallMemoryUsage::struct_size is"});
    expect_invalid(tyndall_effect_set_params(effect, params.get(), &desc), {"TyndallEffectDesc::struct_size is"});
    expect_invalid(tyndall_effect_record(effect, kCommands, &inputs), {"TyndallFrameInputs::struct_size is"});
    expect_invalid(tyndall_effect_light_tables(effect, &light), {"TyndallLightTables::struct_size is"});
    expect_invalid(tyndall_effect_scattering_tables(effect, &scattering), {"TyndallScatteringTables::struct_size is"});
    expect_invalid(tyndall_effect_counters(effect, 0, 0, &counters), {"TyndallCounters::struct_size is"});
    expect_invalid(tyndall_effect_memory(effect, &usage), {"TyndallMemoryUsage::struct_size is", "expected"});
    EXPECT_EQ(usage.persistent, 0U);
    EXPECT_EQ(light.sky_irradiance, VK_NULL_HANDLE);
  }
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(memory.persistent, 0U);
  // Programs of the first version do not know the callbacks for memory, and what follows their structure is not read.
  TyndallDeviceInfo first = kDevice;
  first.struct_size = offsetof(TyndallDeviceInfo, allocate_memory);
  first.free_memory = [](void*, const TyndallMemoryBlock*, VkDeviceSize) { ADD_FAILURE() << "not part of it"; };
  // Nor do they know clouds.
  TyndallEffectDesc first_desc = kDesc;
  first_desc.struct_size = offsetof(TyndallEffectDesc, clouds);
  first_desc.clouds = VK_TRUE;
  EXPECT_SUCCESS(tyndall_effect_create(&first, &first_desc, params.get(), &made));
  CFrame first_frame = c_frame(fake_frame());
  first_frame.inputs.clouds.map.view = first_frame.inputs.color.view;
  expect_invalid(tyndall_effect_record(made, kCommands, &first_frame.inputs), {"FrameInputs::clouds"});
  first_frame.inputs.struct_size = offsetof(TyndallFrameInputs, clouds);
  EXPECT_SUCCESS(tyndall_effect_record(made, kCommands, &first_frame.inputs));
  tyndall_effect_destroy(made);
}

TEST(CFaults, ValuesOutOfRangeAreRefused) {
  const OwnedEffect owned = make_c();
  TyndallEffect* made = nullptr;
  const auto refused = [&](const std::function<void(TyndallEffectDesc&)>& change, const char* part) {
    TyndallEffectDesc desc = kDesc;
    change(desc);
    expect_invalid(tyndall_effect_create(&kDevice, &desc, c_params().get(), &made), {part, "expected"});
  };
  refused([](TyndallEffectDesc& d) { d.frames_in_flight = 0; }, "frames_in_flight");
  refused([](TyndallEffectDesc& d) { d.output_format = static_cast<TyndallOutputFormat>(77); }, "output_format");
  refused([](TyndallEffectDesc& d) { d.max_cascades = 9; }, "max_cascades");
  refused([](TyndallEffectDesc& d) { d.views = 9; }, "views");
  refused([](TyndallEffectDesc& d) { d.sky_depth = 0.5F; }, "sky_depth");
  const TyndallDeviceInfo none = sized<TyndallDeviceInfo>();
  expect_invalid(tyndall_effect_create(&none, &kDesc, nullptr, &made), {"DeviceInfo"});
  EXPECT_EQ(made, nullptr);
  CFrame frame = c_frame(fake_frame());
  frame.inputs.extent = {65, 32};
  expect_invalid(tyndall_effect_record(owned.get(), kCommands, &frame.inputs), {"extent", "expected"});
  expect_invalid(tyndall_effect_set_limits(owned.get(), {0, 1}, 1, 1), {"max_extent", "expected"});
  frame = c_frame(fake_frame());
  expect_invalid(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, static_cast<TyndallFramePart>(4)),
                 {"part", "expected FramePart::whole"});
  expect_invalid(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_second),
                 {"FramePart::second", "no first part"});
  // Both parts are recorded through C.
  EXPECT_EQ(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_first),
            TyndallStatus_success);
  expect_invalid(tyndall_effect_record(owned.get(), kCommands, &frame.inputs), {"FramePart::second"});
  EXPECT_EQ(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_second),
            TyndallStatus_success);
  // A frame can be dropped after its first part.
  frame.inputs.frame_index = 1;
  EXPECT_EQ(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_first),
            TyndallStatus_success);
  EXPECT_EQ(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_drop),
            TyndallStatus_success);
  expect_invalid(tyndall_effect_record_part(owned.get(), kCommands, &frame.inputs, TyndallFramePart_drop),
                 {"FramePart::drop", "no first part"});
}

TEST(CFaults, SettingsChangeAndAreReadBack) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  auto desc = sized<TyndallEffectDesc>();
  ASSERT_SUCCESS(tyndall_effect_get_desc(effect, &desc));
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(&desc), sizeof desc),
            std::string_view(reinterpret_cast<const char*>(&kDesc), sizeof kDesc));
  ASSERT_SUCCESS(tyndall_effect_set_shadow_colors(effect, 7));
  ASSERT_SUCCESS(tyndall_effect_set_limits(effect, {128, 48}, 6, 300));
  ASSERT_SUCCESS(tyndall_effect_get_desc(effect, &desc));
  EXPECT_EQ(desc.shadow_colors, VK_TRUE);
  EXPECT_EQ(desc.max_extent.width, 128U);
  EXPECT_EQ(desc.max_extent.height, 48U);
  EXPECT_EQ(desc.max_cascades, 6U);
  EXPECT_EQ(desc.max_shadow_resolution, 300U);
  const OwnedParams params = c_params(), read = c_params();
  ASSERT_SUCCESS(tyndall_params_set_number(params.get(), "epipolar.slices", 40));
  desc.max_cascades = 3;
  ASSERT_SUCCESS(tyndall_effect_set_params(effect, params.get(), &desc));
  ASSERT_SUCCESS(tyndall_effect_get_params(effect, read.get()));
  ASSERT_SUCCESS(tyndall_effect_get_desc(effect, &desc));
  EXPECT_EQ(desc.max_cascades, 3U);
  double slices = 0.0;
  ASSERT_SUCCESS(tyndall_params_get_number(read.get(), "epipolar.slices", &slices));
  EXPECT_EQ(slices, 40.0);
  TyndallProgress progress = {};
  ASSERT_SUCCESS(tyndall_effect_prepare_pipelines(effect, UINT32_MAX, &progress));
  EXPECT_EQ(progress.done, progress.total);
}

// Lets each allocation of `body` fail once, until it succeeds. Returns how many have failed.
long fail_each(Kind kind, const char* name, const std::function<TyndallStatus()>& body) {
  for (long n = 0; n < 2000; ++n) {
    faults::arm(kind, n);
    const TyndallStatus status = body();
    if (!faults::disarm()) {
      EXPECT_SUCCESS(status) << name;
      std::cout << n << (kind == Kind::host ? " failing allocations of the host: " : " failing calls of Vulkan: ")
                << name << "\n";
      return n;
    }
    EXPECT_EQ(status, TyndallStatus_out_of_memory) << name << " " << n;
    EXPECT_STRNE(tyndall_last_error(), "") << name << " " << n;
  }
  ADD_FAILURE() << name << " does not end";
  return 0;
}

TEST(CFaults, FailedAllocationsAreReturned) {
  const OwnedParams params = c_params();
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    const long created = fail_each(kind, "create", [&] {
      TyndallEffect* made = nullptr;
      const TyndallStatus status = tyndall_effect_create(&kDevice, &kDesc, params.get(), &made);
      EXPECT_EQ(made != nullptr, status == TyndallStatus_success);
      tyndall_effect_destroy(made);
      EXPECT_EQ(faults::live_objects(), 0U);
      EXPECT_EQ(faults::live_pipeline_objects(), 0U);
      return status;
    });
    EXPECT_GT(created, kind == Kind::vulkan ? 150 : 40);
  }
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const OwnedParams other = c_params();
  ASSERT_SUCCESS(tyndall_params_set_number(other.get(), "epipolar.slices", 40));
  EXPECT_GT(fail_each(Kind::host, "params",
                      [&] {
                        TyndallParams* made = nullptr;
                        const TyndallStatus status = tyndall_params_create(&made);
                        tyndall_params_destroy(made);
                        return status;
                      }),
            0);
  fail_each(Kind::host, "set_params", [&] { return tyndall_effect_set_params(effect, other.get(), nullptr); });
  auto memory = sized<TyndallMemoryUsage>();
  fail_each(Kind::host, "query_memory", [&] { return tyndall_query_memory(&kDevice, &kDesc, other.get(), &memory); });
  std::size_t size = 0;
  EXPECT_GT(fail_each(Kind::host, "table_key", [&] { return tyndall_effect_table_key(effect, &size, nullptr); }), 0);
  fail_each(Kind::host, "prepare_pipelines",
            [&] { return tyndall_effect_prepare_pipelines(effect, UINT32_MAX, nullptr); });
}

TEST(CFaults, FailedAllocationsOfEveryOtherFunctionAreReturned) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const OwnedParams params = c_params(), other = c_params();
  const double angles[] = {0.0, 90.0, 180.0}, wavelengths[] = {400.0, 700.0};
  const std::vector<double> values(6, 0.0795774715);
  auto desc = sized<TyndallSkyProbeDesc>();
  desc.frames_in_flight = 2;
  desc.cube_size = 32;
  auto memory = sized<TyndallMemoryUsage>();
  const std::pair<const char*, std::function<TyndallStatus()>> calls[] = {
      {"params_copy", [&] { return tyndall_params_copy(other.get(), params.get()); }},
      {"params_set_choice", [&] { return tyndall_params_set_choice(params.get(), "scattering.color", "rgb"); }},
      {"params_set_numbers",
       [&] {
         const double size[4] = {8, 16, 16, 4};
         return tyndall_params_set_numbers(params.get(), "tables.size", size, 4);
       }},
      {"params_set_phase_table",
       [&] { return tyndall_params_set_phase_table(params.get(), angles, 3, wavelengths, 2, values.data()); }},
      {"effect_get_params", [&] { return tyndall_effect_get_params(effect, other.get()); }},
      {"effect_get_table_params", [&] { return tyndall_effect_get_table_params(effect, other.get()); }},
      {"sky_probe_query_memory", [&] { return tyndall_sky_probe_query_memory_with(&kDevice, &desc, &memory); }}};
  for (const auto& [name, call] : calls) fail_each(Kind::host, name, call);
  ASSERT_SUCCESS(tyndall_effect_record_precompute(effect, kCommands, UINT32_MAX, nullptr));
  const std::size_t objects = faults::live_objects();
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    EXPECT_GT(fail_each(kind, "sky_probe_create",
                        [&] {
                          TyndallSkyProbe* made = nullptr;
                          const TyndallStatus status = tyndall_sky_probe_create_with(effect, &desc, &made);
                          EXPECT_EQ(made != nullptr, status == TyndallStatus_success);
                          tyndall_sky_probe_destroy(made);
                          EXPECT_EQ(faults::live_objects(), objects);
                          return status;
                        }),
              3);
    // A call that has changed the effect changes nothing more, so every failure has a new one.
    const auto changes = {std::pair{"effect_set_limits",
                                    +[](TyndallEffect* e) {
                                      return tyndall_effect_set_limits(e, {128, 48}, 6, 300);
                                    }},
                          std::pair{"effect_set_shadow_colors",
                                    +[](TyndallEffect* e) { return tyndall_effect_set_shadow_colors(e, 1); }}};
    for (const auto& [name, change] : changes) {
      OwnedEffect changed = make_c();
      fail_each(kind, name, [&, change = change] { return change(changed.get()); });
    }
  }
}

// The message of an invalid argument takes more than one allocation. A call returns out_of_memory if one of them fails,
// and otherwise invalid_argument.
TEST(CFaults, FailedAllocationsOfErrorsAreReturned) {
  const OwnedEffect owned = make_c();
  const OwnedParams params = c_params();
  const std::function<TyndallStatus()> calls[] = {
      [&] { return tyndall_effect_record(nullptr, kCommands, nullptr); },
      [&] { return tyndall_effect_record(owned.get(), kCommands, nullptr); },
      [&] { return tyndall_params_set_number(params.get(), "a parameter that does not exist", 1.0); },
      [&] { return tyndall_params_set_number(params.get(), "epipolar.slices", 1.5); },
      [&] { return tyndall_requirements(nullptr); }};
  for (const auto& call : calls) {
    bool failed = true;
    for (long n = 0; failed && n < 100; ++n) {
      faults::arm(Kind::host, n);
      const TyndallStatus status = call();
      failed = faults::disarm();
      EXPECT_EQ(status, failed ? TyndallStatus_out_of_memory : TyndallStatus_invalid_argument) << n;
      EXPECT_STRNE(tyndall_last_error(), "");
    }
    EXPECT_FALSE(failed);
  }
}

TEST(CFaults, RecordingAndReportsAllocateNothing) {
  const OwnedEffect owned = make_c();
  TyndallEffect* effect = owned.get();
  const CFrame frame = c_frame(fake_frame());
  auto memory = sized<TyndallMemoryUsage>();
  auto counters = sized<TyndallCounters>();
  std::uint32_t count = 64;
  std::vector<TyndallResourceMemory> resources(64);
  const std::function<TyndallStatus()> calls[] = {
      [&] { return tyndall_effect_record_precompute(effect, kCommands, UINT32_MAX, nullptr); },
      [&] { return tyndall_effect_record(effect, kCommands, &frame.inputs); },
      [&] { return tyndall_effect_memory(effect, &memory); },
      [&] { return tyndall_effect_counters(effect, 0, 0, &counters); },
      [&] { return tyndall_effect_resources(effect, &count, resources.data()); }};
  for (const auto& call : calls) EXPECT_EQ(fail_each(Kind::host, "call", call), 0);
}

}  // namespace
}  // namespace tyndall
