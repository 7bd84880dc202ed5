// tyndall_shader_list ROWS SHADERS HEADER DEPENDENCIES
// Writes shader_sources.hpp for the viewer: the shaders of the file ROWS (lines name|source|macros), each with the
// checksum of its source and of all files that it includes. SHADERS is the folder of the sources. DEPENDENCIES lists
// the files that were read, in the format of make.
#include <cstdio>
#include <fstream>
#include <string>

#include "files/glsl_sources.hpp"
#include "files/text.hpp"

namespace {

constexpr const char* kBefore =
    R"(// Made by tyndall_shader_list: the shaders of the program and their sources below shaders/.
#pragma once

#include <string_view>

#include "effect_shaders.hpp"
#include "post_shaders.hpp"
#include "scene_shaders.hpp"
#include "viewer_shaders.hpp"

namespace tyndall::viewer {

struct ShaderSource {
  const gpu::Shader* shader;
  std::string_view source, macros;  // KEY=VALUE,KEY=VALUE
  std::string_view checksum;        // files::GlslSources::checksum() of the source at build time
};
inline constexpr ShaderSource kShaderSources[] = {
)";
constexpr const char* kAfter = R"(};

}  // namespace tyndall::viewer
)";

int fail(const std::string& what) {
  std::fprintf(stderr, "tyndall_shader_list: %s\n", what.c_str());
  return 1;
}

// Returns a path with a backslash before each blank, as make expects.
std::string escaped(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == ' ' ? std::string("\\ ") : std::string(1, c);
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  using tyndall::files::part;
  if (count != 5) return fail("expected ROWS SHADERS HEADER DEPENDENCIES");
  std::ifstream rows(arguments[1]);
  if (!rows) return fail(std::string(arguments[1]) + " cannot be read");
  tyndall::files::GlslSources sources(arguments[2]);
  std::string header = kBefore;
  for (std::string row; std::getline(rows, row);) {
    if (row.empty()) continue;
    const std::string name(part(row, '|', 0));
    const std::string source(part(row, '|', 1));
    const std::string macros(part(row, '|', 2));
    const std::string checksum = sources.checksum(source);
    if (checksum.empty()) return fail(source + " cannot be read");
    header += "    {&shaders::" + name + ", \"" + source + "\", \"" + macros + "\", \"" + checksum + "\"},\n";
  }
  header += kAfter;
  std::ofstream(arguments[3], std::ios::binary) << header;
  std::ofstream dependencies(arguments[4], std::ios::binary);
  dependencies << escaped(arguments[3]) << ":";
  for (const std::string& path : sources.paths()) dependencies << " " << escaped(path);
  dependencies << "\n";
  if (!dependencies.flush() || !std::ifstream(arguments[3])) return fail("the output cannot be written");
  return 0;
}
