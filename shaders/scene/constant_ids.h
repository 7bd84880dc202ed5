// The specialisation constants of the shaders of the demo scene. GLSL declares a constant by its id here, and src/scene
// sets it under the same name. The ids continue those of the effect (shaders/shared/constant_ids.h), so that one id
// means one thing everywhere.
#ifndef TYNDALL_SCENE_CONSTANT_IDS
#define TYNDALL_SCENE_CONSTANT_IDS

const uint kPerPixelId = 32u;        // 1: the model is evaluated per pixel, 0: per vertex (scattering.evaluate)
const uint kIntegralMethodId = 33u;  // Oneil::integral_method
const uint kSampleSpacingId = 34u;   // Oneil::spacing
const uint kLayerId = 35u;           // layer that mesh.frag draws: one of the following values

const uint kOpaqueLayer = 0u;      // opaque surfaces and diffusing glass
const uint kClearLayer = 1u;       // clear glass, multiplied into the picture
const uint kReflectionLayer = 2u;  // the light that clear glass reflects, added

#endif
