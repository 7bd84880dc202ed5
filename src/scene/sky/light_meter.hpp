// Measures the illuminance of sun and sky at a point, from the tables of an effect. For scattering.color = spectral.
#pragma once

#include "gpu/host.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall::scene {

// [lx] - illuminance by the sun on a surface that faces it and on a horizontal one, and by the sky on a horizontal one,
// without terrain and shadows.
struct Illuminance {
  double sun_lux = 0.0, sun_horizontal_lux = 0.0, sky_lux = 0.0;
};

class LightMeter {
 public:
  // The effect must outlive the meter.
  static Result<LightMeter> create(gpu::Host& host, Effect& effect);

  struct Point {
    double altitude_m = 0.0;  // inside the atmosphere
    double cos_sun_zenith = 1.0;
    Vec3 irradiance;               // of the sun, as in Sun
    double white_luminance = 0.0;  // [cd/m^2]; see photometry.hpp
  };
  // Waits for the device. After an error, create the meter again.
  Result<Illuminance> measure(gpu::Host& host, const Params& params, const Point& point);

 private:
  LightMeter(SkyProbe probe, gpu::Buffer result) : probe_(std::move(probe)), result_(std::move(result)) {}

  SkyProbe probe_;
  gpu::Buffer result_;
};

}  // namespace tyndall::scene
