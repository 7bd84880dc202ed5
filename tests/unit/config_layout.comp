// Declares the GLSL view of the parameters in a buffer, for config_layout_test.cpp to reflect.
#version 460
#include "shared/params.glsl"

layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Block { Params params; };

void main() { params.atmosphere.mie_phase = MiePhase_henyey_greenstein; }
