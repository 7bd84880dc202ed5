// Private to src/scene/elevation: runs a reader in a child process, because some of GDAL's drivers crash on damaged
// files, or run or allocate without bound.
#pragma once

#include <functional>
#include <string>

#include "tyndall/result.hpp"

namespace tyndall::scene {

// Runs `work` in a child process, and returns the bytes that it returned there. The child is a copy of this process
// with the calling thread only: `work` must not wait for other threads. Its processor time and memory are limited.
// Errors name `source`: the child crashed, exceeded a limit, ran out of memory or could not be started.
Result<std::string> in_child(const std::string& source, const std::function<std::string()>& work);

}  // namespace tyndall::scene
