// Checksums of the sources of shaders and of the files that they include. They show which shaders have changed since
// the program was built.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::files {

// Returns the folders in which shaders below `shaders` find included files, in the order of the search.
[[nodiscard]] std::vector<std::string> glsl_include_folders(const std::string& shaders);

// Reads each file once. Use from one thread.
class GlslSources {
 public:
  explicit GlslSources(const std::string& shaders) : folders_(glsl_include_folders(shaders)) {}

  // Returns the checksum of a shader (a path below `shaders`) together with every file that it includes, also through
  // others and inside of #if. Empty if the shader cannot be read. A missing included file counts as empty.
  [[nodiscard]] std::string checksum(const std::string& shader);
  // Returns the paths of all files that were read.
  [[nodiscard]] std::set<std::string> paths() const;

 private:
  struct Source {
    std::string path;  // empty: cannot be read
    std::string text;
    std::vector<std::string> included;
  };
  const Source& source(const std::string& name);
  void append(const std::string& name, std::set<std::string>& seen, std::string& whole);

  std::vector<std::string> folders_;
  std::map<std::string, Source> sources_;  // by the name in #include
};

}  // namespace tyndall::files
