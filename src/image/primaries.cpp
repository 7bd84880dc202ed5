#include "image/primaries.hpp"

#include <algorithm>
#include <cstddef>

namespace tyndall::image {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

constexpr double kD65[] = {0.3127, 0.3290};
constexpr double kAcesWhite[] = {0.32168, 0.33767};

// The chromaticities of the primaries and of white, in the order of Primaries.
constexpr Chromaticities kChromaticities[] = {
    {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {kD65[0], kD65[1]}},
    {{1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}, {1.0 / 3.0, 1.0 / 3.0}},
    {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {kD65[0], kD65[1]}},
    {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {kAcesWhite[0], kAcesWhite[1]}},
};

Vector times(const Matrix& m, const Vector& v) {
  Vector out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  }
  return out;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    }
  }
  return out;
}

// Returns the inverse by the cross products of the rows.
Matrix inverse(const Matrix& m) {
  const auto cofactor = [&](std::size_t i, std::size_t k) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    return m[i1][k1] * m[i2][k2] - m[i1][k2] * m[i2][k1];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Matrix out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[k][i] = cofactor(i, k) / determinant;
  }
  return out;
}

// Returns XYZ of a chromaticity with Y = 1, or with X + Y + Z = 1 where there is no luminance.
Vector xyz_of(const double (&xy)[2]) {
  const double y = xy[1] > 0.0 ? xy[1] : 1.0;
  return {xy[0] / y, xy[1] / y, (1.0 - xy[0] - xy[1]) / y};
}

// Returns the matrix from colours to XYZ, in which white has Y = 1.
Matrix to_xyz(const Chromaticities& c) {
  const Vector r = xyz_of(c.red), g = xyz_of(c.green), b = xyz_of(c.blue);
  Matrix out = {{{r[0], g[0], b[0]}, {r[1], g[1], b[1]}, {r[2], g[2], b[2]}}};
  const Vector scale = times(inverse(out), xyz_of(c.white));
  for (Vector& row : out) {
    for (std::size_t k = 0; k < 3; ++k) row[k] *= scale[k];
  }
  return out;
}

// Returns the matrix that adapts XYZ from one white to another.
Matrix adaptation(const double (&from)[2], const double (&to)[2]) {
  constexpr Matrix kBradford = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const Vector before = times(kBradford, xyz_of(from)), after = times(kBradford, xyz_of(to));
  Matrix scaled = kBradford;
  for (std::size_t i = 0; i < 3; ++i) {
    for (double& value : scaled[i]) value *= after[i] / before[i];
  }
  return product(inverse(kBradford), scaled);
}

// Returns the matrix from linear Rec. 709.
Matrix from_rec709(Primaries primaries) {
  const Matrix xyz = to_xyz(chromaticities_of(Primaries::rec709));
  if (primaries == Primaries::xyz) return xyz;
  const Matrix back = inverse(to_xyz(chromaticities_of(primaries)));
  if (primaries != Primaries::acescg) return product(back, xyz);
  return product(back, product(adaptation(kD65, kAcesWhite), xyz));
}

}  // namespace

std::optional<Primaries> primaries_of_name(std::string_view name) {
  const auto* const found = std::find(kPrimariesNames.begin(), kPrimariesNames.end(), name);
  if (found == kPrimariesNames.end()) return std::nullopt;
  return static_cast<Primaries>(found - kPrimariesNames.begin());
}

const Chromaticities& chromaticities_of(Primaries primaries) {
  return kChromaticities[static_cast<std::size_t>(primaries)];
}

std::array<double, 3> in_primaries(const std::array<double, 3>& color, Primaries primaries) {
  return primaries == Primaries::rec709 ? color : times(from_rec709(primaries), color);
}

void convert_to(Primaries primaries, Image& image) {
  if (primaries == Primaries::rec709) return;
  const Matrix matrix = from_rec709(primaries);
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const Vector out = times(matrix, {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) image.rgb[i + c] = static_cast<float>(out[c]);
  }
}

}  // namespace tyndall::image
