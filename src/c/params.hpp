// The definition of the opaque type TyndallParams.
#pragma once

#include "tyndall/params.hpp"
#include "tyndall/tyndall.h"

// The values are always valid: check_params() accepts them.
struct TyndallParams {
  tyndall::Params params;
};
