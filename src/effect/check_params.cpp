// Checks of parameter values that need no device.
#include <cstring>
#include <string>
#include <utility>

#include "air/coefficients.hpp"
#include "effect/invalid.hpp"
#include "tyndall/params.hpp"

namespace tyndall {
namespace {

Result<void> check_number(const ParamInfo& info, double value) {
  // The ends of a range are included, also when they are rounded to single precision. NaN is rejected.
  const bool real = info.type == ParamType::float32 || info.type == ParamType::vec3;
  const double min = real ? static_cast<double>(static_cast<float>(info.min)) : info.min;
  const double max = real ? static_cast<double>(static_cast<float>(info.max)) : info.max;
  if (value >= min && value <= max) return {};
  return invalid(std::string(info.group) + "." + std::string(info.name) + " is " + std::to_string(value) +
                 "; expected " + std::to_string(info.min) + " to " + std::to_string(info.max));
}

std::uint32_t choice_count(std::string_view choices) {
  std::uint32_t count = 1;
  for (const char c : choices) count += c == '|' ? 1 : 0;
  return count;
}

}  // namespace

Result<void> check_params(const Params& params) {
  const char* bytes = reinterpret_cast<const char*>(&params);
  for (const ParamInfo& info : param_table()) {
    float numbers[3] = {};
    std::uint32_t word = 0;
    std::memcpy(&word, bytes + info.offset, sizeof word);
    std::size_t count = 0;
    switch (info.type) {
      case ParamType::float32: count = 1; break;
      case ParamType::vec3: count = 3; break;
      case ParamType::uint32:
        if (Result<void> r = check_number(info, word); !r) return r;
        break;
      case ParamType::uvec4:
        for (std::size_t i = 0; i < 4; ++i) {
          std::memcpy(&word, bytes + info.offset + i * sizeof word, sizeof word);
          if (Result<void> r = check_number(info, word); !r) return r;
        }
        break;
      case ParamType::enumeration:
        if (word >= choice_count(info.choices)) {
          return invalid(std::string(info.group) + "." + std::string(info.name) +
                         " is not one of its values; expected " + std::string(info.choices));
        }
        break;
      case ParamType::flag:
        if (word > 1) {
          return invalid(std::string(info.group) + "." + std::string(info.name) + " is " + std::to_string(word) +
                         "; expected 0 (off) or 1 (on)");
        }
        break;
      case ParamType::string:
      case ParamType::dvec3: break;  // only scenes have such parameters
    }
    std::memcpy(numbers, bytes + info.offset, count * sizeof(float));
    for (std::size_t i = 0; i < count; ++i) {
      if (Result<void> r = check_number(info, static_cast<double>(numbers[i])); !r) return r;
    }
  }
  if (params.atmosphere.mie_phase == MiePhase::table && !params.phase_table) {
    return invalid("atmosphere.mie_phase is 'table', but there is no table; expected atmosphere.phase_table, or "
                   "Params::phase_table in C++");
  }
  if (Result<void> r = air::check(params); !r) return r;
  const std::uint32_t downscale = params.scattering.downscale;
  if (downscale != 1 && downscale != 2 && downscale != 4) {
    return invalid("scattering.downscale is " + std::to_string(downscale) + "; expected 1, 2 or 4");
  }
  const UVec4& size = params.tables.size;
  if (size.y % 2 != 0) {
    return invalid("tables.size has " + std::to_string(size.y) +
                   " view angles; expected an even number, half of them on each side of the horizon");
  }
  // Larger tables exceed the memory of current devices, and the product of four sizes could overflow.
  constexpr double kMaxTexels = 134217728.0;
  const double texels = static_cast<double>(size.x) * size.y * size.z * size.w;
  if (texels > kMaxTexels) {
    return invalid("tables.size needs " + std::to_string(texels * 24.0 / 1048576.0) +
                   " MiB; expected at most 3072 MiB");
  }
  return {};
}

}  // namespace tyndall
