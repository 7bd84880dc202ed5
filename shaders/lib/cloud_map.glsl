// The map of clouds that FrameInputs::clouds describes.
#ifndef TYNDALL_LIB_CLOUD_MAP
#define TYNDALL_LIB_CLOUD_MAP

// Returns the fraction of a section of a ray that is behind the layer, as seen from the sun. `layer` is the depth of
// the layer, `depth` that of the middle of the section, and `change` the difference of the depths at its ends, 0 for a
// point.
float behind_clouds(float layer, float depth, float change) {
  return clamp((depth - layer) / max(abs(change), 1e-9) + 0.5, 0.0, 1.0);
}

#endif
