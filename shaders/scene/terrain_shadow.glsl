// Sunlight on the terrain.
#ifndef TYNDALL_TERRAIN_SHADOW_GLSL
#define TYNDALL_TERRAIN_SHADOW_GLSL

#include "scene/terrain_surface.glsl"

#define SHADED terrain
#define SHADOW_MAPS 3
#include "scene/sun_shadow.glsl"

#endif
