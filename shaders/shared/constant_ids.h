// The specialisation constants of all compute shaders of the effect: one id means one thing everywhere. GLSL declares a
// constant by its id here, C++ (src/effect/step.hpp) sets it under the same name. The ids of the demo scene and of tone
// mapping (shaders/scene/constant_ids.h, shaders/post/constant_ids.h) are larger than these.
#ifndef TYNDALL_SHARED_CONSTANT_IDS
#define TYNDALL_SHARED_CONSTANT_IDS

const uint kSingleId = 0u;            // SingleScattering of include/tyndall/params.def
const uint kOccludedId = 1u;          // 1: shadows occlude the higher orders of scattering
const uint kSectionsId = 2u;          // LitSections
const uint kTreeId = 3u;              // 1: shadows are found through the min/max tree
const uint kColorsId = 4u;            // 1: the light is coloured by shadow_colors
const uint kHomogeneousId = 5u;       // MediumKind
const uint kDownscaleId = 6u;         // scattering.downscale: 1, 2 or 4
const uint kExtinctionId = 7u;        // Extinction
const uint kCountId = 8u;             // 1: the passes count what they do
const uint kSparsityId = 9u;          // kSparsityNone, kSparsitySkyline or kSparsityAll of shared/epipolar.h
const uint kRefinementId = 10u;       // Refinement
const uint kFormatId = 11u;           // MinMaxFormat
const uint kRaysOfTablesId = 12u;     // 1: the rays are those of the tables, 0: those of the gathering grid
const uint kRefineRunId = 13u;        // consecutive samples per thread of refine_samples.comp: 1, 2, 4, ... 32
const uint kTreePartId = 14u;         // binary logarithm of the cells per thread of min_max_tree.comp, 4 to 7
const uint kPhaseTableId = 15u;       // 1: the aerosol's phase function is read from a table (lib/phase.glsl)
const uint kCloudsId = 16u;           // 1: clouds darken the sunlight
const uint kFloatOutputId = 17u;      // 1: the format of the output is rgba32f, 0: rgba16f
const uint kSpecialisationIds = 18u;  // how many there are

#endif
