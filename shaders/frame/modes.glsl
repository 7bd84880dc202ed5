// Which parts of the light are computed. These are specialisation constants so that no mode pays for another one (CPU
// devices execute every branch).
#ifndef TYNDALL_MODES_GLSL
#define TYNDALL_MODES_GLSL

#include "shared/constant_ids.h"
#include "shared/params.glsl"

const uint kNone = SingleScattering_none;  // values of kSingle
const uint kIntegration = SingleScattering_integration;
const uint kTable = SingleScattering_table;
const uint kContiguous = LitSections_contiguous;  // values of kSections
const uint kEach = LitSections_each;

layout(constant_id = kSingleId) const uint kSingle = kIntegration;
layout(constant_id = kOccludedId) const bool kOccluded = false;  // shadows also apply to the higher orders
layout(constant_id = kSectionsId) const uint kSections = kContiguous;
layout(constant_id = kColorsId) const bool kColors = false;  // shadow_colors tints the sunlight

// True if shadows apply to in-scattering from the tables.
const bool kLitTables = kSingle == kTable || kOccluded;

#endif
