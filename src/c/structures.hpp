// Reads and writes structures of the C interface that begin with struct_size, whatever version of tyndall.h the program
// was compiled with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "c/error.hpp"
#include "gpu/try.hpp"
#include "tyndall/tyndall.h"

namespace tyndall::c {

// Returns whether a value of an enumeration of tyndall.h is that of the C++ library.
template <typename C, typename Cpp>
constexpr bool same(C c, Cpp cpp) {
  return sizeof(C) == sizeof(std::uint32_t) && static_cast<std::uint32_t>(c) == static_cast<std::uint32_t>(cpp);
}

// Name, and size in the first version of tyndall.h that had the structure: the end of its last member at that time. The
// end of the last member must be the end of the structure. A later member could otherwise lie in the padding, where
// struct_size would not show whether the program knows it.
template <typename T>
struct Published;
// NOLINTBEGIN(bugprone-sizeof-expression): the members may be pointers, whose own size is meant.
#define TYNDALL_PUBLISHED(type, last_of_first, last)                                                       \
  template <>                                                                                              \
  struct Published<type> {                                                                                 \
    static constexpr const char* kName = #type;                                                            \
    static constexpr std::size_t kFirstSize = offsetof(type, last_of_first) + sizeof(type::last_of_first); \
    static_assert(offsetof(type, struct_size) == 0);                                                       \
    static_assert(offsetof(type, last) + sizeof(type::last) == sizeof(type));                              \
  };
TYNDALL_PUBLISHED(TyndallRequirements, device_extensions, device_extensions)
TYNDALL_PUBLISHED(TyndallParamInfo, max, max)
TYNDALL_PUBLISHED(TyndallDeviceInfo, replace_shader_user, memory_user)
TYNDALL_PUBLISHED(TyndallEffectDesc, table_pipelines_later, tables_of)
TYNDALL_PUBLISHED(TyndallFrameInputs, lowest_ground_m, clouds)
TYNDALL_PUBLISHED(TyndallAtmosphereInputs, origin_from_centre_m, clouds_from_position)
TYNDALL_PUBLISHED(TyndallMemoryUsage, host, host)
TYNDALL_PUBLISHED(TyndallCounters, pixels_corrected, pixels_corrected)
TYNDALL_PUBLISHED(TyndallLightTables, sky_irradiance, sky_irradiance)
TYNDALL_PUBLISHED(TyndallScatteringTables, high_orders, high_orders)
TYNDALL_PUBLISHED(TyndallSkyProbeInputs, sun, sun)
TYNDALL_PUBLISHED(TyndallSkyCoefficients, size, size)
TYNDALL_PUBLISHED(TyndallSkyProbeDesc, cube_size, cube_size)
TYNDALL_PUBLISHED(TyndallSkyCube, sampler, sampler)
#undef TYNDALL_PUBLISHED
// NOLINTEND(bugprone-sizeof-expression)

// Returns an error unless `size` is the size of a version of the structure that this library knows.
template <typename T>
[[nodiscard]] Result<void> check_size(const char* where, std::size_t size) {
  if (size >= Published<T>::kFirstSize && size <= sizeof(T)) return {};
  std::string what = std::string(Published<T>::kName) + "::struct_size is " + std::to_string(size) + "; expected " +
                     std::to_string(sizeof(T)) + ", its size in version " + TYNDALL_VERSION_STRING +
                     ", or that of an earlier version";
  return invalid(where, what);
}

// Returns the structure that `in` points to. Members that the program does not know have the values of `defaults`.
template <typename T>
[[nodiscard]] Result<T> read(const char* where, const T* in, const T& defaults) {
  TYNDALL_TRY(check_pointer(where, Published<T>::kName, in));
  TYNDALL_TRY(check_size<T>(where, in->struct_size));
  T out = defaults;
  std::memcpy(&out, in, in->struct_size);
  return out;
}

// Copies the members that the program knows to `out`, whose struct_size stays.
template <typename T>
[[nodiscard]] Result<void> write(const char* where, T value, T* out) {
  TYNDALL_TRY(check_pointer(where, Published<T>::kName, out));
  TYNDALL_TRY(check_size<T>(where, out->struct_size));
  value.struct_size = out->struct_size;
  std::memcpy(out, &value, out->struct_size);
  return {};
}

// Does the same for a structure whose struct_size is not yet set.
template <typename T>
[[nodiscard]] Result<void> write_defaults(const char* where, T value, T* out, std::size_t size) {
  TYNDALL_TRY(check_pointer(where, Published<T>::kName, out));
  TYNDALL_TRY(check_size<T>(where, size));
  value.struct_size = static_cast<uint32_t>(size);
  std::memcpy(out, &value, size);
  return {};
}

}  // namespace tyndall::c
