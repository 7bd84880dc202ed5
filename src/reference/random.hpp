// Random numbers: a generator, and scrambled Sobol points for the first dimensions of each path. Every block of samples
// has its own seed and scrambling, so blocks are independent and their spread gives a valid standard error.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall::reference {

// The finaliser of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
inline std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

inline std::uint64_t hash_seed(std::uint64_t seed, std::uint64_t query, std::uint64_t block) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  return mix64(mix64(mix64(seed + kGolden) + query * kGolden + 1) + block * kGolden + 2);
}

// xoshiro256++ (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2018).
class Generator {
 public:
  explicit Generator(std::uint64_t seed) {
    for (std::uint64_t& word : state_) word = mix64(seed += 0x9e3779b97f4a7c15ULL);
  }

  std::uint64_t bits() {
    const auto rotate = [](std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); };
    const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  // Returns a number in [0; 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  std::array<std::uint64_t, 4> state_{};
};

// 2^log2_count Sobol points with nested uniform scrambling (Owen 1995): each point is uniform, and in every dimension
// each of 2^log2_count strata contains exactly one point.
class SobolBlock {
 public:
  static constexpr int kDimensions = 8;
  static constexpr int kMaxLog2Count = 12;

  SobolBlock(int log2_count, Generator& generator);

  // Returns a coordinate of a point, in [0; 1). Precondition: dimension < kDimensions, point < 2^log2_count.
  double operator()(int dimension, std::uint32_t point, Generator& generator) const {
    const std::size_t index = (static_cast<std::size_t>(dimension) << log2_count_) + point;
    return (strata_[index] + generator.uniform()) * width_;
  }

 private:
  int log2_count_;
  double width_;
  std::vector<std::uint16_t> strata_;
};

// The random coordinates of one path, in order of use: first Sobol, then random ones.
class PathNumbers {
 public:
  PathNumbers(const SobolBlock& block, std::uint32_t point, Generator& generator)
      : block_(block), generator_(generator), point_(point) {}

  double next() {
    return dimension_ < SobolBlock::kDimensions ? block_(dimension_++, point_, generator_) : generator_.uniform();
  }
  double random() { return generator_.uniform(); }

 private:
  const SobolBlock& block_;
  Generator& generator_;
  std::uint32_t point_;
  int dimension_ = 0;
};

}  // namespace tyndall::reference
