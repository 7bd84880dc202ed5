// The modes of scattering as specialisation constants, so that no mode pays for another: CPU devices execute every
// branch. The values are those of include/tyndall/params.def; the ids are those of ModeConstants in
// src/effect/modes.hpp.
#ifndef TYNDALL_MODES_GLSL
#define TYNDALL_MODES_GLSL

const uint kNone = 0u;
const uint kIntegration = 1u;  // values of kSingle
const uint kTable = 2u;
const uint kContiguous = 0u;  // values of kSections
const uint kEach = 1u;

layout(constant_id = 0) const uint kSingle = kIntegration;
layout(constant_id = 1) const bool kOccluded = false;  // shadows also apply to the higher orders
layout(constant_id = 2) const uint kSections = kContiguous;
layout(constant_id = 4) const bool kColors = false;  // shadow_colors tints the sunlight

// Whether shadows apply to in-scattering from the tables.
const bool kLitTables = kSingle == kTable || kOccluded;

#endif
