// The objects behind the handles of the C interface.
#pragma once

#include <optional>

#include "tyndall/effect.hpp"
#include "tyndall/sky_probe.hpp"
#include "tyndall/tyndall.h"

struct TyndallEffect {
  TyndallDeviceInfo callbacks;  // outlives `effect`, which refers to it
  std::optional<tyndall::Effect> effect;
};

struct TyndallSkyProbe {
  std::optional<tyndall::SkyProbe> probe;
};
