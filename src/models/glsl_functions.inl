// The functions of shaders/lib as C++, in whatever namespace and precision the includer has set up (`float`,
// vec2 to vec4, uint). Included by src/models/glsl_double.hpp and by the tests. There is no include guard, and the
// guards of the GLSL files are removed, so that one translation unit can contain several precisions.
#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#define ONEIL_TABLE ::tyndall::models::OneilTexels
#define ONEIL_TEXEL(table, i) vec4((table)[i][0], (table)[i][1], (table)[i][2], (table)[i][3])
#undef TYNDALL_LIB_PORTABLE
#undef TYNDALL_LIB_GEOMETRY
#undef TYNDALL_LIB_MEDIUM
#undef TYNDALL_LIB_SPECTRUM
#undef TYNDALL_LIB_PHASE
#undef TYNDALL_LIB_OPTICAL_DEPTH
#undef TYNDALL_LIB_SINGLE_SCATTERING
#undef TYNDALL_LIB_SKY_IRRADIANCE
#undef TYNDALL_LIB_ONEIL
#undef TYNDALL_LIB_TABLE_MAPPING
#undef TYNDALL_LIB_TABLE_VALUES
#undef TYNDALL_LIGHT_TABLES_GLSL
#undef TYNDALL_LIB_HOMOGENEOUS
#undef TYNDALL_SHARED_HOMOGENEOUS
#undef TYNDALL_SHARED_MEDIUM
#undef TYNDALL_SHARED_ONEIL
#undef TYNDALL_SHARED_TABLES

using glm::abs;
using glm::acos;
using glm::asin;
using glm::atan;
using glm::clamp;
using glm::cos;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::log;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::sign;
using glm::sin;
using glm::sqrt;
using glm::tan;

#include "shared/homogeneous.h"
#include "shared/medium.h"
#include "shared/oneil.h"
#include "shared/tables.h"

// Internal linkage: a header of plain functions, of which each user takes some.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {
#include "lib/homogeneous.glsl"
#include "lib/oneil.glsl"
#include "lib/sky_irradiance.glsl"
#include "lib/table_mapping.glsl"
#include "lib/table_values.glsl"
#include "tyndall/light_tables.glsl"
}  // namespace
#pragma GCC diagnostic pop

#undef IN
#undef OUT
#undef INOUT
#undef ONEIL_TABLE
#undef PHASE_TABLE_MEMBERS
#undef ONEIL_TEXEL
#undef RAYLEIGH_SCATTERING
#undef MIE_SCATTERING
#undef MIE_EXTINCTION
#undef OZONE_ABSORPTION
#undef CHANNELS
#undef OUTER_CHANNELS
#undef LARGEST
#undef SMALLEST
#undef EACH_CHANNEL
#undef STORED
#undef COLOR
#undef TRANSMITTED
#undef FILTER
#undef LIGHT_TEXEL
#undef LIGHT_OF_TEXEL
