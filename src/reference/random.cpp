#include "reference/random.hpp"

namespace tyndall::reference {
namespace {

// Primitive polynomials and initial direction numbers of Joe and Kuo, "Constructing Sobol sequences with better
// two-dimensional projections" (2008), dimensions 2 to 8. The first dimension is van der Corput's sequence.
struct SobolRow {
  int degree;
  std::uint32_t polynomial;
  std::array<std::uint32_t, 5> initial;
};
constexpr std::array<SobolRow, SobolBlock::kDimensions - 1> kRows = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
}};

using Columns = std::array<std::uint32_t, SobolBlock::kMaxLog2Count>;

// Returns the columns of a dimension's generating matrix as binary fractions of `bits` bits.
Columns direction_numbers(int dimension, int bits) {
  Columns v{};
  for (int j = 0; j < bits; ++j) v[static_cast<std::size_t>(j)] = 1U << (bits - 1 - j);
  if (dimension == 0) return v;
  const SobolRow& row = kRows[static_cast<std::size_t>(dimension - 1)];
  std::array<std::uint32_t, SobolBlock::kMaxLog2Count> m{};
  for (int j = 0; j < bits; ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (j < row.degree) {
      m[at] = row.initial[at];
    } else {
      const auto degree = static_cast<std::size_t>(row.degree);
      m[at] = m[at - degree] ^ (m[at - degree] << row.degree);
      for (int k = 1; k < row.degree; ++k) {
        if (((row.polynomial >> (row.degree - 1 - k)) & 1U) != 0) m[at] ^= m[at - static_cast<std::size_t>(k)] << k;
      }
    }
    v[at] = m[at] << (bits - 1 - j);
  }
  return v;
}

}  // namespace

SobolBlock::SobolBlock(int log2_count, Generator& generator)
    : log2_count_(log2_count),
      width_(1.0 / static_cast<double>(1U << log2_count)),
      strata_(static_cast<std::size_t>(kDimensions) << log2_count) {
  const std::uint32_t count = 1U << log2_count;
  std::vector<std::uint8_t> flips(count);  // one per node of the binary tree of prefixes: 1 swaps its halves
  for (int dimension = 0; dimension < kDimensions; ++dimension) {
    const Columns columns = direction_numbers(dimension, log2_count);
    for (std::uint32_t i = 0; i < count; i += 64) {
      const std::uint64_t bits = generator.bits();
      for (std::uint32_t k = 0; k < 64 && i + k < count; ++k) flips[i + k] = (bits >> k) & 1U;
    }
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i > 0) {  // Gray code order: one column per step
        value ^= columns[static_cast<std::size_t>(__builtin_ctz(i))];
      }
      std::uint32_t scrambled = 0;
      std::uint32_t node = 1;  // heap index of the prefix
      for (int bit = log2_count - 1; bit >= 0; --bit) {
        const std::uint32_t digit = (value >> bit) & 1U;
        scrambled = (scrambled << 1) | (digit ^ flips[node]);
        node = 2 * node + digit;
      }
      strata_[(static_cast<std::size_t>(dimension) << log2_count) + i] = static_cast<std::uint16_t>(scrambled);
    }
  }
}

}  // namespace tyndall::reference
