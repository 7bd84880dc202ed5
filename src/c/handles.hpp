// The objects behind the handles of the C interface.
#pragma once

#include <memory>
#include <optional>

#include "tyndall/effect.hpp"
#include "tyndall/sky_probe.hpp"
#include "tyndall/tyndall.h"

struct TyndallEffect {
  // Outlive `effect`, which refers to them: its own, and those with which its tables were made, which it may share.
  std::shared_ptr<const TyndallDeviceInfo> callbacks, callbacks_of_tables;
  std::optional<tyndall::Effect> effect;
};

struct TyndallSkyProbe {
  std::optional<tyndall::SkyProbe> probe;
};
