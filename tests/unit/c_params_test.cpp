// The functions of the C interface that need no device: versions, errors, and parameters by name.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "c/structures.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/tyndall.h"

namespace tyndall {

// A structure that has grown by `added` since its first version.
struct Grown {
  uint32_t struct_size;
  uint32_t first;
  uint32_t added;
};
template <>
struct c::Published<Grown> {
  static constexpr const char* kName = "Grown";
  static constexpr std::size_t kFirstSize = offsetof(Grown, added);
};

namespace {

struct Destroy {
  void operator()(TyndallParams* params) const { tyndall_params_destroy(params); }
};
using OwnedParams = std::unique_ptr<TyndallParams, Destroy>;

OwnedParams make_params() {
  TyndallParams* out = nullptr;
  EXPECT_EQ(tyndall_params_create(&out), TyndallStatus_success);
  return OwnedParams(out);
}

TyndallParamInfo info_of(std::uint32_t index) {
  TyndallParamInfo out = {};
  out.struct_size = sizeof out;
  EXPECT_EQ(tyndall_param_info(index, &out), TyndallStatus_success) << tyndall_last_error();
  return out;
}

// Expects an error of the arguments whose text contains `parts` and is one line.
void expect_invalid(TyndallStatus status, std::initializer_list<const char*> parts) {
  EXPECT_EQ(status, TyndallStatus_invalid_argument);
  const std::string text = tyndall_last_error();
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(CInterface, VersionIsThatOfTheHeaders) {
  EXPECT_EQ(tyndall_version(), TYNDALL_VERSION);
  const std::string text = std::to_string(tyndall_version() >> 22) + "." +
                           std::to_string(tyndall_version() >> 12 & 0x3FF) + "." +
                           std::to_string(tyndall_version() & 0xFFF);
  EXPECT_EQ(text, TYNDALL_VERSION_STRING);
  EXPECT_LT(TYNDALL_MAKE_VERSION(0, 9, 9), TYNDALL_MAKE_VERSION(0, 10, 0));
}

TEST(CInterface, EachStatusHasAName) {
  std::set<std::string> names;
  for (int status = 0; status <= 6; ++status) {
    EXPECT_TRUE(names.insert(tyndall_status_name(static_cast<TyndallStatus>(status))).second) << status;
  }
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_STREQ(tyndall_status_name(static_cast<TyndallStatus>(7)), "unknown");
}

TEST(CInterface, RequirementsAreThoseOfCpp) {
  TyndallRequirements c = {};
  c.struct_size = sizeof c;
  ASSERT_EQ(tyndall_requirements(&c), TyndallStatus_success) << tyndall_last_error();
  const Requirements cpp = requirements();
  EXPECT_EQ(c.api_version, cpp.api_version);
  ASSERT_EQ(c.device_extension_count, cpp.device_extensions.size());
  for (std::uint32_t i = 0; i < c.device_extension_count; ++i) {
    EXPECT_STREQ(c.device_extensions[i], cpp.device_extensions[i]);
  }
}

TEST(CInterface, DefaultsAreThoseOfCpp) {
  TyndallEffectDesc desc;
  ASSERT_EQ(tyndall_effect_desc_defaults(&desc, sizeof desc), TyndallStatus_success);
  const EffectDesc cpp;
  EXPECT_EQ(desc.struct_size, sizeof desc);
  EXPECT_EQ(desc.max_extent.width, cpp.max_extent.width);
  EXPECT_EQ(desc.max_extent.height, cpp.max_extent.height);
  EXPECT_EQ(desc.frames_in_flight, cpp.frames_in_flight);
  EXPECT_EQ(desc.max_shadow_resolution, cpp.max_shadow_resolution);
  EXPECT_EQ(desc.check_inputs, VK_TRUE);
  EXPECT_EQ(desc.timings, VK_FALSE);
  TyndallFrameInputs inputs;
  ASSERT_EQ(tyndall_frame_inputs_defaults(&inputs, sizeof inputs), TyndallStatus_success);
  EXPECT_EQ(inputs.struct_size, sizeof inputs);
  EXPECT_EQ(inputs.color.layout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_EQ(inputs.camera.world_from_view[15], 1.0F);
  EXPECT_EQ(inputs.sun.irradiance[2], 10.0F);
  EXPECT_EQ(inputs.sun.angular_radius_rad, Sun{}.angular_radius_rad);
  EXPECT_EQ(inputs.cascades, nullptr);
  TyndallDeviceInfo device;
  ASSERT_EQ(tyndall_device_info_defaults(&device, sizeof device), TyndallStatus_success);
  EXPECT_EQ(device.struct_size, sizeof device);
  EXPECT_EQ(device.device, VK_NULL_HANDLE);
}

TEST(CInterface, ParametersAreThoseOfCpp) {
  const std::span<const ParamInfo> table = param_table();
  ASSERT_EQ(tyndall_param_count(), table.size());
  const OwnedParams params = make_params();
  const Params defaults;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    const TyndallParamInfo c = info_of(i);
    const ParamInfo& cpp = table[i];
    EXPECT_EQ(c.name, std::string(cpp.group) + "." + std::string(cpp.name));
    EXPECT_EQ(static_cast<std::uint32_t>(c.type), static_cast<std::uint32_t>(cpp.type)) << c.name;
    EXPECT_EQ(static_cast<std::uint32_t>(c.affects), static_cast<std::uint32_t>(cpp.affects)) << c.name;
    EXPECT_EQ(c.choices, cpp.choices) << c.name;
    EXPECT_EQ(c.unit, cpp.unit) << c.name;
    EXPECT_EQ(c.doc, cpp.doc) << c.name;
    EXPECT_EQ(c.min, cpp.min) << c.name;
    EXPECT_EQ(c.max, cpp.max) << c.name;
    // The default, read as numbers from the structure of C++.
    const char* at = reinterpret_cast<const char*>(&defaults) + cpp.offset;
    if (cpp.type == ParamType::enumeration) {
      const char* choice = nullptr;
      ASSERT_EQ(tyndall_params_get_choice(params.get(), c.name, &choice), TyndallStatus_success);
      std::uint32_t value = 0;
      std::memcpy(&value, at, sizeof value);
      std::string choices = std::string(c.choices) + "|";
      for (std::uint32_t n = 0; n < value; ++n) choices.erase(0, choices.find('|') + 1);
      EXPECT_EQ(choice, choices.substr(0, choices.find('|'))) << c.name;
      continue;
    }
    double values[4] = {};
    ASSERT_EQ(tyndall_params_get_numbers(params.get(), c.name, values, c.value_count), TyndallStatus_success) << c.name;
    for (std::uint32_t n = 0; n < c.value_count; ++n) {
      float real = 0.0F;
      std::uint32_t whole = 0;
      std::memcpy(&real, at + 4 * n, 4);
      std::memcpy(&whole, at + 4 * n, 4);
      const bool is_real = cpp.type == ParamType::float32 || cpp.type == ParamType::vec3;
      EXPECT_EQ(values[n], is_real ? static_cast<double>(real) : whole) << c.name;
    }
  }
}

// Sets every parameter to its limits or to each of its choices and reads them back.
TEST(CInterface, EveryParameterCanBeSet) {
  const OwnedParams params = make_params(), before = make_params();
  for (std::uint32_t i = 0; i < tyndall_param_count(); ++i) {
    const TyndallParamInfo info = info_of(i);
    if (info.type == TyndallParamType_enumeration) {
      std::string choices = std::string(info.choices) + "|";
      while (!choices.empty()) {
        const std::string choice = choices.substr(0, choices.find('|'));
        choices.erase(0, choice.size() + 1);
        if (std::string(info.name) == "atmosphere.mie_phase" && choice == "table") {
          // A table cannot be given through the C interface.
          EXPECT_EQ(tyndall_params_set_choice(params.get(), info.name, "table"), TyndallStatus_invalid_argument);
          continue;
        }
        const char* read = nullptr;
        EXPECT_EQ(tyndall_params_set_choice(params.get(), info.name, choice.c_str()), TyndallStatus_success);
        EXPECT_EQ(tyndall_params_get_choice(params.get(), info.name, &read), TyndallStatus_success);
        EXPECT_EQ(read, choice);
      }
      continue;
    }
    // Larger tables are refused, and so is a visibility beyond that of clear air.
    const std::string name = info.name;
    const double high = name == "tables.size" ? 64.0 : name == "atmosphere.visibility_m" ? 1.0e5 : info.max;
    // The values of these that are allowed depend on other parameters.
    const bool dependent = name == "atmosphere.aerosol_optical_depth" || name == "atmosphere.visibility_m" ||
                           name == "atmosphere.ozone_du" || name == "atmosphere.pressure_hpa";
    const OwnedParams others = make_params();
    TyndallParams* const p = dependent ? others.get() : params.get();
    for (const double value : {info.min, high}) {
      const double values[4] = {value, value, value, value};
      double read[4] = {};
      ASSERT_EQ(tyndall_params_set_numbers(p, info.name, values, info.value_count), TyndallStatus_success)
          << tyndall_last_error();
      ASSERT_EQ(tyndall_params_get_numbers(p, info.name, read, info.value_count), TyndallStatus_success);
      for (std::uint32_t n = 0; n < info.value_count; ++n) {
        EXPECT_FLOAT_EQ(static_cast<float>(read[n]), static_cast<float>(value)) << info.name;
      }
    }
  }
  std::uint32_t mask = 0;
  EXPECT_EQ(tyndall_params_affected(before.get(), params.get(), &mask), TyndallStatus_success);
  EXPECT_EQ(mask, 0x1FU);
  EXPECT_EQ(tyndall_params_copy(before.get(), params.get()), TyndallStatus_success);
  EXPECT_EQ(tyndall_params_affected(before.get(), params.get(), &mask), TyndallStatus_success);
  EXPECT_EQ(mask, 0U);
}

TEST(CInterface, WrongParametersChangeNothing) {
  const OwnedParams params = make_params(), before = make_params();
  TyndallParams* p = params.get();
  const char* choice = nullptr;
  double numbers[4] = {};
  expect_invalid(tyndall_params_set_number(p, "atmosphere.mie_gg", 0.5),
                 {"tyndall_params_set_number", "'atmosphere.mie_gg'", "expected"});
  expect_invalid(tyndall_params_set_number(p, "", 0.5), {"''"});
  expect_invalid(tyndall_params_set_number(p, "two\nlines", 0.5), {"'two lines'"});
  expect_invalid(tyndall_params_set_number(p, std::string(5000, 'x').c_str(), 0.5), {"unknown parameter 'xxx"});
  expect_invalid(tyndall_params_set_number(p, "scattering.technique", 1),
                 {"scattering.technique", "is an enumeration", "tyndall_params_set_choice"});
  expect_invalid(tyndall_params_get_number(p, "scattering.technique", numbers), {"is an enumeration"});
  expect_invalid(tyndall_params_set_choice(p, "scattering.technique", "fast"),
                 {"cannot be 'fast'", "epipolar|brute-force"});
  expect_invalid(tyndall_params_set_choice(p, "scattering.scale", "1"), {"scattering.scale", "not an enumeration"});
  expect_invalid(tyndall_params_get_choice(p, "scattering.scale", &choice), {"not an enumeration"});
  expect_invalid(tyndall_params_set_number(p, "tables.size", 8), {"tables.size", "1 numbers", "expected 4"});
  expect_invalid(tyndall_params_get_numbers(p, "tables.size", numbers, 3), {"expected 4"});
  expect_invalid(tyndall_params_set_number(p, "atmosphere.ozone_absorption", 0), {"1 numbers", "expected 3"});
  const double color[] = {0.1, 0.2, 0.3};
  ASSERT_EQ(tyndall_params_set_numbers(p, "planet.ground_albedo", color, 3), TyndallStatus_success);
  expect_invalid(tyndall_params_get_number(p, "planet.ground_albedo", numbers), {"three different values"});
  ASSERT_EQ(tyndall_params_set_number(p, "planet.ground_albedo", 0.25), TyndallStatus_success);
  ASSERT_EQ(tyndall_params_get_number(p, "planet.ground_albedo", numbers), TyndallStatus_success);
  EXPECT_EQ(numbers[0], 0.25);
  ASSERT_EQ(tyndall_params_get_numbers(p, "planet.ground_albedo", numbers, 3), TyndallStatus_success);
  EXPECT_TRUE(numbers[0] == 0.25 && numbers[1] == 0.25 && numbers[2] == 0.25);
  ASSERT_EQ(tyndall_params_set_number(p, "planet.ground_albedo", 0.0), TyndallStatus_success);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {-1.0, 2.0, 1e300, -1e300, kInfinity, -kInfinity, std::nan("")}) {
    expect_invalid(tyndall_params_set_number(p, "atmosphere.mie_g", value), {"atmosphere.mie_g is", "expected"});
  }
  for (const double value : {1.5, -1.0, 4.0e9, 1e300, kInfinity, std::nan("")}) {
    expect_invalid(tyndall_params_set_number(p, "epipolar.slices", value), {"epipolar.slices", "expected"});
  }
  for (const double value : {2.0, 0.5, -1.0}) {
    expect_invalid(tyndall_params_set_number(p, "scattering.enabled", value), {"scattering.enabled", "expected"});
  }
  expect_invalid(tyndall_params_set_number(p, "scattering.downscale", 3), {"expected 1, 2 or 4"});
  std::uint32_t mask = 1;
  EXPECT_EQ(tyndall_params_affected(before.get(), p, &mask), TyndallStatus_success);
  EXPECT_EQ(mask, 0U);
}

TEST(CInterface, TheColourOfTheSunFollowsTheMode) {
  const OwnedParams params = make_params();
  float color[3] = {};
  ASSERT_EQ(tyndall_params_sun_color(params.get(), color), TyndallStatus_success);
  EXPECT_TRUE(color[0] == 1.0F && color[1] == 1.0F && color[2] == 1.0F);
  ASSERT_EQ(tyndall_params_set_choice(params.get(), "scattering.color", "spectral"), TyndallStatus_success);
  ASSERT_EQ(tyndall_params_sun_color(params.get(), color), TyndallStatus_success);
  Params cpp;
  cpp.scattering.color = ColorMode::spectral;
  EXPECT_TRUE(Vec3(color[0], color[1], color[2]) == sun_color(cpp));
  EXPECT_GT(color[0], 1.05F);
}

TEST(CInterface, NullPointersAreRefused) {
  const OwnedParams params = make_params();
  TyndallParams* p = params.get();
  const char* name = "scattering.scale";
  double value = 1.0;
  const char* choice = nullptr;
  std::uint32_t mask = 0;
  expect_invalid(tyndall_params_create(nullptr), {"tyndall_params_create", "'params' is null"});
  tyndall_params_destroy(nullptr);
  expect_invalid(tyndall_params_copy(nullptr, p), {"'from' is null"});
  expect_invalid(tyndall_params_copy(p, nullptr), {"'to' is null"});
  expect_invalid(tyndall_params_set_number(nullptr, name, 1.0), {"'params' is null"});
  expect_invalid(tyndall_params_set_number(p, nullptr, 1.0), {"'name' is null"});
  expect_invalid(tyndall_params_set_numbers(p, name, nullptr, 1), {"'values' is null"});
  expect_invalid(tyndall_params_get_number(p, name, nullptr), {"'values' is null"});
  expect_invalid(tyndall_params_get_number(nullptr, name, &value), {"'params' is null"});
  expect_invalid(tyndall_params_set_choice(p, "scattering.technique", nullptr), {"'choice' is null"});
  expect_invalid(tyndall_params_get_choice(p, "scattering.technique", nullptr), {"'choice' is null"});
  expect_invalid(tyndall_params_get_choice(nullptr, name, &choice), {"'params' is null"});
  float color[3] = {};
  expect_invalid(tyndall_params_sun_color(nullptr, color), {"'params' is null"});
  expect_invalid(tyndall_params_sun_color(p, nullptr), {"'color' is null"});
  expect_invalid(tyndall_params_affected(nullptr, p, &mask), {"'before' is null"});
  expect_invalid(tyndall_params_affected(p, nullptr, &mask), {"'after' is null"});
  expect_invalid(tyndall_params_affected(p, p, nullptr), {"'mask' is null"});
  expect_invalid(tyndall_requirements(nullptr), {"TyndallRequirements", "is null"});
  expect_invalid(tyndall_param_info(0, nullptr), {"TyndallParamInfo", "is null"});
  expect_invalid(tyndall_effect_desc_defaults(nullptr, sizeof(TyndallEffectDesc)), {"TyndallEffectDesc", "is null"});
}

TEST(CInterface, SizesOfStructuresAreChecked) {
  TyndallRequirements requirements = {};
  expect_invalid(tyndall_requirements(&requirements), {"TyndallRequirements::struct_size is 0", "expected"});
  requirements.struct_size = sizeof requirements + 8;
  expect_invalid(tyndall_requirements(&requirements), {"struct_size is", "expected"});
  EXPECT_EQ(requirements.device_extensions, nullptr);
  TyndallParamInfo info = {};
  info.struct_size = sizeof info;
  expect_invalid(tyndall_param_info(tyndall_param_count(), &info), {"'index' is", "tyndall_param_count"});
  EXPECT_EQ(info.name, nullptr);
  TyndallFrameInputs inputs;
  expect_invalid(tyndall_frame_inputs_defaults(&inputs, 0), {"TyndallFrameInputs", "struct_size is 0"});
  expect_invalid(tyndall_frame_inputs_defaults(&inputs, sizeof inputs + 4), {"expected"});
}

TEST(CInterface, StructuresOfEarlierHeadersAreUnderstood) {
  const Grown defaults = {0, 10, 20};
  const Grown earlier = {8, 1, 2}, now = {12, 1, 2};  // of a program that does not know `added`, and of one that does
  const Result<Grown> from_earlier = c::read("test", &earlier, defaults), from_now = c::read("test", &now, defaults);
  ASSERT_TRUE(from_earlier.ok() && from_now.ok());
  EXPECT_EQ(from_earlier.value().first, 1U);
  EXPECT_EQ(from_earlier.value().added, 20U);
  EXPECT_EQ(from_now.value().added, 2U);
  Grown out = {8, 0, 7};
  ASSERT_TRUE(c::write("test", Grown{0, 3, 4}, &out).ok());
  EXPECT_EQ(out.struct_size, 8U);
  EXPECT_EQ(out.first, 3U);
  EXPECT_EQ(out.added, 7U);
  out.struct_size = 12;
  ASSERT_TRUE(c::write("test", Grown{0, 3, 4}, &out).ok());
  EXPECT_EQ(out.added, 4U);
  Grown filled = {0, 0, 7};
  ASSERT_TRUE(c::write_defaults("test", defaults, &filled, 8).ok());
  EXPECT_EQ(filled.struct_size, 8U);
  EXPECT_EQ(filled.first, 10U);
  EXPECT_EQ(filled.added, 7U);
  for (const uint32_t size : {0U, 4U, 7U, 13U, 16U}) {
    const Grown wrong = {size, 1, 2};
    const Result<Grown> refused = c::read("test", &wrong, defaults);
    ASSERT_FALSE(refused.ok()) << size;
    EXPECT_NE(refused.error().message.find("Grown::struct_size is"), std::string::npos) << refused.error().message;
  }
}

TEST(CInterface, ErrorsBelongToTheirThread) {
  expect_invalid(tyndall_params_create(nullptr), {"tyndall_params_create"});
  std::thread([] {
    EXPECT_STREQ(tyndall_last_error(), "");
    EXPECT_EQ(tyndall_requirements(nullptr), TyndallStatus_invalid_argument);
    EXPECT_NE(std::string(tyndall_last_error()).find("tyndall_requirements"), std::string::npos);
  }).join();
  EXPECT_NE(std::string(tyndall_last_error()).find("tyndall_params_create"), std::string::npos);
  EXPECT_EQ(tyndall_last_vk_result(), 0);
}

TEST(CInterface, TakesAPhaseTable) {
  const OwnedParams params = make_params();
  const double angles[] = {0, 90, 180}, nm[] = {450, 650};
  const double isotropic = 1.0 / (4.0 * std::acos(-1.0));
  double values[6];
  for (double& value : values) value = isotropic;
  const auto set = [&](const double* at, uint32_t angle_count, uint32_t wavelength_count, const double* v) {
    return tyndall_params_set_phase_table(params.get(), at, angle_count, nm, wavelength_count, v);
  };
  expect_invalid(tyndall_params_set_choice(params.get(), "atmosphere.mie_phase", "table"), {"atmosphere.mie_phase"});
  expect_invalid(set(nullptr, 3, 2, values), {"tyndall_params_set_phase_table", "angles_deg"});
  expect_invalid(set(angles, 3, 2, nullptr), {"values"});
  expect_invalid(set(angles, 2, 2, values), {"2 angles"});
  expect_invalid(set(angles, 3, 0xFFFFFFFFU, values), {"wavelengths"});
  ASSERT_EQ(set(angles, 3, 2, values), TyndallStatus_success) << tyndall_last_error();
  EXPECT_EQ(tyndall_params_set_choice(params.get(), "atmosphere.mie_phase", "table"), TyndallStatus_success)
      << tyndall_last_error();
  // A copy shares the table, and another table is a change of the tables.
  const OwnedParams copy = make_params();
  ASSERT_EQ(tyndall_params_copy(params.get(), copy.get()), TyndallStatus_success);
  uint32_t mask = 1;
  EXPECT_EQ(tyndall_params_affected(params.get(), copy.get(), &mask), TyndallStatus_success);
  EXPECT_EQ(mask, 0U);
  values[0] = values[1] = 5.0 * isotropic;
  expect_invalid(set(angles, 3, 2, values), {"integral"});
  values[0] = values[1] = 1.1 * isotropic;
  ASSERT_EQ(set(angles, 3, 2, values), TyndallStatus_success) << tyndall_last_error();
  EXPECT_EQ(tyndall_params_affected(params.get(), copy.get(), &mask), TyndallStatus_success);
  EXPECT_NE(mask & (1U << TyndallAffects_Tables), 0U);
}

}  // namespace
}  // namespace tyndall
