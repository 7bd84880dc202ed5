// What of the light is asked for: specialisation constants, so that no mode pays for another (CPU devices
// execute every branch). Values as in include/tyndall/params.def; the ids are those of ModeConstants in
// src/effect/modes.hpp.
#ifndef TYNDALL_MODES_GLSL
#define TYNDALL_MODES_GLSL

const uint kNone = 0u;
const uint kIntegration = 1u;  // of kSingle
const uint kTable = 2u;
const uint kContiguous = 0u;  // of kSections
const uint kEach = 1u;

layout(constant_id = 0) const uint kSingle = kIntegration;
layout(constant_id = 1) const bool kOccluded = false;  // the higher orders are cut by shadows
layout(constant_id = 2) const uint kSections = kContiguous;
layout(constant_id = 4) const bool kColors = false;  // what is lit is lit through glass: shadow_colors

// Whether the light of the tables is cut by shadows.
const bool kLitTables = kSingle == kTable || kOccluded;

#endif
