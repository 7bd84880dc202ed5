// F8: compiles every shader anew from its source, as the build did, on a thread of its own. A shader that comes out
// other than the one in the program takes its place in pipelines made from then on; if one does not compile,
// nothing changes and the compiler's message is told.
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
  struct Outcome {
    bool finished = false;       // since the last call
    std::string message;         // what is wrong with the sources; empty: nothing
    std::size_t changed = 0;     // shaders that differ from those of the last rebuild, or from the program's
    std::size_t restored = 0;    // that are the program's again
    bool tables_differ = false;  // the tables that the shaders now make are not those of the program
  };

  ShaderReload() = default;
  ShaderReload(const ShaderReload&) = delete;
  ShaderReload& operator=(const ShaderReload&) = delete;
  ~ShaderReload();

  // An error when there are no sources here.
  Result<void> start();
  [[nodiscard]] bool working() const { return compiling_.valid(); }
  Result<Outcome> finish();
  // Back to the shaders before the last rebuild, when no pipelines can be made from these.
  void revert();
  // For DeviceInfo::replace_shader; `user` is a ShaderReload.
  static std::span<const std::uint32_t> replace(void* user, std::string_view name);

 private:
  using Words = std::vector<std::uint32_t>;
  struct Compiled {
    std::string message;
    std::map<std::string, Words, std::less<>> changed;
  };
  // What came of a source that compiles and fits.
  struct Known {
    std::string source;  // with what it includes; empty: nothing is known
    Words words;         // where they are not the program's
    bool differs = false;
  };
  Compiled compile(const std::string& folder);

  std::map<std::string, Known, std::less<>> known_;  // by the shader's name; of the thread that compiles

  std::mutex mutex_;                                 // of words_: threads that make pipelines ask for them
  std::map<std::string, Words, std::less<>> words_;  // of shaders other than the program's
  std::vector<std::map<std::string, Words, std::less<>>> before_, refused_;  // pipelines may be being made from them
  std::future<Compiled> compiling_;
};

}  // namespace tyndall::viewer
