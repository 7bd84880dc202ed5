// Reloads shaders (F8): compiles every shader whose source has changed since the build, on another thread and as the
// build does. Pipelines that are created afterwards use the shaders that differ from those in the program. If one does
// not compile, nothing changes, and the compiler's message is reported.
#pragma once

#include <cstdint>
#include <future>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::viewer {

class ShaderReload {
 public:
  struct Rebuilt {
    bool finished = false;       // a rebuild has finished since the last call
    std::string message;         // the compiler's error; empty: none
    std::size_t changed = 0;     // shaders that differ from those of the last rebuild, or from the program's
    std::size_t restored = 0;    // shaders that are equal to the program's again
    bool tables_differ = false;  // the new shaders make other tables than those of the program
  };

  ShaderReload() = default;
  ShaderReload(const ShaderReload&) = delete;
  ShaderReload& operator=(const ShaderReload&) = delete;
  ~ShaderReload();

  // Returns whether the program was built with shaderc. Without it, start() fails.
  [[nodiscard]] static bool supported();
  // Starts to compile. Returns an error when the sources are not found.
  Result<void> start();
  [[nodiscard]] bool working() const { return compiling_.valid(); }
  Result<Rebuilt> finish();
  // Returns to the shaders before the last rebuild, when pipelines cannot be created from the new ones.
  void revert();
  // For DeviceInfo::replace_shader; `user` is a ShaderReload.
  static std::span<const std::uint32_t> replace(void* user, std::string_view name);

 private:
  using Words = std::vector<std::uint32_t>;
  struct Compiled {
    std::string message;
    std::map<std::string, Words, std::less<>> changed;
  };
  // The result of a source that compiles and fits the program.
  struct Known {
    std::string checksum;  // GlslSources::checksum() of its source; empty: not compiled yet
    Words words;           // the compiled shader, if it differs from the program's
    bool differs = false;
  };
  Compiled compile(const std::string& folder);

  std::map<std::string, Known, std::less<>> known_;  // by the shader's name; used only by the compiling thread

  std::mutex mutex_;                                 // guards words_, which threads that create pipelines read
  std::map<std::string, Words, std::less<>> words_;  // the shaders that differ from the program's
  std::vector<std::map<std::string, Words, std::less<>>> before_,
      refused_;  // reverted shaders; not freed, because pipelines may still be created from them
  std::future<Compiled> compiling_;
};

}  // namespace tyndall::viewer
