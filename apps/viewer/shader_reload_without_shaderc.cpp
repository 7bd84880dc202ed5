// Replaces the reloading of shaders in a build without shaderc.
#include "viewer/shader_reload.hpp"

namespace tyndall::viewer {

ShaderReload::~ShaderReload() = default;

bool ShaderReload::supported() { return false; }

Result<void> ShaderReload::start() {
  return Error{ErrorCode::invalid_argument,
               "F8: built without shaderc; shaders cannot be reloaded; expected a program built with shaderc", 0};
}

Result<ShaderReload::Rebuilt> ShaderReload::finish() { return Rebuilt{}; }

void ShaderReload::revert() {}

std::span<const std::uint32_t> ShaderReload::replace(void* /*user*/, std::string_view /*name*/) { return {}; }

}  // namespace tyndall::viewer
