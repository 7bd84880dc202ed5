// Random parameters and frames for long runs of the library, small so that each takes little time.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "../gpu/effect_frame.hpp"

namespace tyndall {

constexpr VkExtent2D kLargest = {48, 32};
constexpr std::uint32_t kLargestShadows = 64;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1.0p-53);
  }
  // Returns an end of the range, a number inside of it, or one of any magnitude.
  double number(double low, double high, double usual) {
    switch (below(6)) {
      case 0: return low;
      case 1: return high;
      case 2: return uniform(low, high);
      case 3:
        return low > 0.0 ? low * std::pow(high / low, uniform(0.0, 1.0)) : high * std::pow(10.0, uniform(-9.0, 0.0));
      default: return usual;
    }
  }

 private:
  std::mt19937_64 engine_;
};

// Limits what only takes time: large tables and volumes, samples, steps and orders.
void shorten(Params& params);
// Returns parameters of which one to four rows have changed, each within its range, or the defaults. They may be
// impossible together.
Params changed(const Params& from, Random& random);
// Returns a frame that is not larger than the limit. Its camera may be impossible with the parameters.
TestFrame random_frame(const Params& params, VkExtent2D limit, Random& random);

}  // namespace tyndall
