// The luminance histogram that shaders/post measures, and the state of the exposure. The histogram is over log2 of
// luminance: the centre of bin i is at kLowestStop + i * kStopsPerBin. A sample is divided between the two nearest
// bins, so that sums over bins have the same mean as sums over samples.
#ifndef TYNDALL_SHARED_EXPOSURE
#define TYNDALL_SHARED_EXPOSURE

const uint kLuminanceBins = 256u;
const float kLowestStop = -24.0;  // darker samples count as black
const float kStopsPerBin = 0.1875;
const uint kSampleParts = 256u;  // a sample is divided into this many parts

// The histogram of one picture, counted in sample parts.
struct LuminanceCounts {
  uint black;
  uint bins[kLuminanceBins];
};

struct ExposureState {
  float exposure;   // scales the radiance
  float luminance;  // luminance to which the eye is adapted
  float measured;   // log-average of the luminances that count; 0: none counts
  float counted;    // mean weight of the samples, 0 to 1
  float bright;     // luminance of the bright part of the picture, to which the weights are relative
  float unused_0;
  uint adapted;  // 1: `luminance` was measured from a picture
  uint samples;
};

#endif
