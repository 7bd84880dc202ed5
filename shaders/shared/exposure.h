// What shaders/post measures of a picture, and the state of its exposure. One histogram of log2 of luminance: bin i
// stands at the stop kLowestStop + i * kStopsPerBin, and a sample is shared between the two bins that it lies between,
// so that sums over bins have the mean that sums over samples would have.
#ifndef TYNDALL_SHARED_EXPOSURE
#define TYNDALL_SHARED_EXPOSURE

const uint kLuminanceBins = 256u;
const float kLowestStop = -24.0;  // darker samples count as black
const float kStopsPerBin = 0.1875;
const uint kSampleParts = 256u;  // that a sample is made of

// Filled anew for each picture, in sample parts.
struct LuminanceCounts {
  uint black;
  uint bins[kLuminanceBins];
};

struct ExposureState {
  float exposure;   // scales the radiance
  float luminance;  // that the eye is adapted to
  float measured;   // log-average of what counts in the picture; 0: nothing does
  float counted;    // mean weight of the samples, 0 to 1
  float bright;     // luminance of the bright part of the picture that weights refer to
  float unused_0;
  uint adapted;  // 1: `luminance` comes from a picture
  uint samples;
};

#endif
