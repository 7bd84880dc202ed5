// The inputs of tyndall/atmosphere.glsl, with which shaders of an engine look up sunlight, sky light, in-scattering and
// transmittance. docs/atmosphere_glsl.md explains how to use it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tyndall/effect.hpp"

namespace tyndall {

// The coordinates in which shaders pass positions and directions, and the sun.
struct AtmosphereInputs {
  // [m] - position of the origin of these coordinates relative to the planet's centre, along their axes, which may
  // point anywhere. Positions have single precision, so choose an origin near them, for example the camera. The default
  // is that of FrameInputs with the default planet.
  DVec3 origin_from_centre_m = {0.0, 6'360'000.0, 0.0};
  Sun sun;  // with its direction along these axes
  // Affine, from these coordinates to (u, v, depth) of Clouds::map. Used with the macro TYNDALL_CLOUDS_BINDING only.
  Mat4 clouds_from_position;
};

// The contents of the uniform block of tyndall/atmosphere.glsl. Copy them to a uniform buffer of this size.
struct AtmosphereConstants {
  alignas(16) std::array<std::byte, 512> bytes = {};
};

// Returns the constants for the tables of these parameters. Pass table_params(effect), so that they belong to the
// images of atmosphere_images() while other tables are being built. Fill the block again after the parameters, the sun
// or the origin have changed, and when new tables are complete. An error names the parameter that is out of range, or
// the input that is not finite.
[[nodiscard]] TYNDALL_API Result<AtmosphereConstants> atmosphere_constants(const Params& params,
                                                                           const AtmosphereInputs& inputs);

// The rows of the phase function with atmosphere.mie_phase = draine or table, as tyndall/atmosphere.glsl reads them
// with the macro TYNDALL_PHASE_BINDING.
constexpr std::size_t kPhaseRows = 1001;
struct AtmospherePhase {
  std::array<std::array<float, 4>, kPhaseRows> rows = {};
};

// Copies the rows for these parameters to `out`, for a uniform buffer of this size. They depend on the parameters
// alone. An error names the parameter that is out of range, or says that no table is needed.
[[nodiscard]] TYNDALL_API Result<void> atmosphere_phase(const Params& params, AtmospherePhase& out);

// The images that tyndall/atmosphere.glsl reads, as combined image samplers. list[i] belongs to the binding
// TYNDALL_FIRST_BINDING + 1 + i.
struct AtmosphereImages {
  std::array<VkDescriptorImageInfo, 8> list = {};
  std::uint32_t count = 0;
};

// Returns the images with their layouts and a sampler, all owned by the effect. They are valid once record_precompute()
// is complete, and change only when it or record_load_tables() completes new tables. Both write them in COMPUTE_SHADER
// / SHADER_WRITE. With froxels.enabled, the last two are the froxel volume of a view, which record() fills in
// COMPUTE_SHADER / SHADER_WRITE. The next record() waits for all earlier commands of the queue, so that they may read
// the volume in any stage. The two change when froxels.enabled, columns, rows or slices change.
[[nodiscard]] TYNDALL_API AtmosphereImages atmosphere_images(const Effect& effect, std::uint32_t view = 0);

}  // namespace tyndall
