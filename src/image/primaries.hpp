// The primaries of linear colours in EXR files, and conversion to them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "image/image.hpp"

namespace tyndall::image {

// CIE xy of red, green, blue and white.
struct Chromaticities {
  double red[2], green[2], blue[2], white[2];
};

// Rec. 709 and Rec. 2020 have the white D65. XYZ are tristimulus values. ACEScg (AP1, S-2014-004) has the white of
// ACES; colours are adapted to it by the method of Bradford (Lam, 1985), so that white stays white.
inline constexpr std::array<std::string_view, 4> kPrimariesNames = {"rec709", "xyz", "rec2020", "acescg"};

// Returns the primaries of a name; nothing if there are none.
[[nodiscard]] std::optional<Primaries> primaries_of_name(std::string_view name);
[[nodiscard]] const Chromaticities& chromaticities_of(Primaries primaries);

// Converts a linear Rec. 709 colour, or all pixels. Components of colours outside of the primaries are negative.
[[nodiscard]] std::array<double, 3> in_primaries(const std::array<double, 3>& color, Primaries primaries);
void convert_to(Primaries primaries, Image& image);

}  // namespace tyndall::image
