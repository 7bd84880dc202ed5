// The version of the library that these headers belong to.
#pragma once

#include "tyndall/version.h"
