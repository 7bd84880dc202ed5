#include "viewer/shader_reload.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <shaderc/shaderc.hpp>
#include <spirv-tools/optimizer.hpp>
#include <sstream>

#include "files/glsl_sources.hpp"
#include "shader_sources.hpp"
#include "viewer/platform/files.hpp"
#include "viewer/platform/window.hpp"

namespace tyndall::viewer {
namespace {

namespace fs = std::filesystem;

bool read(const fs::path& path, std::string& text) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  std::ostringstream out;
  out << file.rdbuf();
  text = out.str();
  return true;
}

// Finds included files in the folders that the build searches.
class Includer : public shaderc::CompileOptions::IncluderInterface {
 public:
  explicit Includer(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  shaderc_include_result* GetInclude(const char* wanted, shaderc_include_type, const char*, std::size_t) override {
    auto* found = new Found;
    found->text = "cannot be found";
    for (const std::string& folder : folders_) {
      const fs::path path = fs::path(folder) / wanted;
      if (!read(path, found->text)) continue;
      found->name = path.string();
      break;
    }
    found->result = {found->name.c_str(), found->name.size(), found->text.c_str(), found->text.size(), found};
    return &found->result;
  }
  void ReleaseInclude(shaderc_include_result* result) override { delete static_cast<Found*>(result->user_data); }

 private:
  struct Found {
    std::string name, text;
    shaderc_include_result result;
  };
  std::vector<std::string> folders_;
};

shaderc_shader_kind kind_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT: return shaderc_glsl_vertex_shader;
    case VK_SHADER_STAGE_FRAGMENT_BIT: return shaderc_glsl_fragment_shader;
    default: return shaderc_glsl_compute_shader;
  }
}

// Returns whether a module has the binding numbers and the workgroup size that the program recorded at build time.
// Reads the decorations of the module (SPIR-V 1.6, 3.32: OpDecorate 71, OpExecutionMode 16).
bool fits(const gpu::Shader& shader, const std::vector<std::uint32_t>& words) {
  constexpr std::uint32_t kDecorate = 71, kBinding = 33, kExecutionMode = 16, kLocalSize = 17;
  std::set<std::uint32_t> found, known;
  for (const gpu::Binding& binding : shader.bindings) known.insert(binding.binding);
  bool same_size = true;
  for (std::size_t i = 5; i < words.size();) {
    const std::uint32_t length = words[i] >> 16U;
    const std::uint32_t code = words[i] & 0xFFFFU;
    if (length == 0 || i + length > words.size()) return false;
    if (code == kDecorate && length == 4 && words[i + 2] == kBinding) found.insert(words[i + 3]);
    if (code == kExecutionMode && length == 6 && words[i + 2] == kLocalSize) {
      same_size = std::equal(shader.local_size, shader.local_size + 3, &words[i + 3]);
    }
    i += length;
  }
  return same_size && found == known;
}

}  // namespace

ShaderReload::~ShaderReload() {
  if (compiling_.valid()) compiling_.wait();
}

std::span<const std::uint32_t> ShaderReload::replace(void* user, std::string_view name) {
  auto* self = static_cast<ShaderReload*>(user);
  const std::lock_guard<std::mutex> locked(self->mutex_);
  const auto found = self->words_.find(name);
  return found == self->words_.end() ? std::span<const std::uint32_t>() : std::span<const std::uint32_t>(found->second);
}

ShaderReload::Compiled ShaderReload::compile(const std::string& folder) {
  Compiled out;
  const fs::path shaders(folder);
  shaderc::Compiler compiler;
  files::GlslSources sources(folder);
  for (const ShaderSource& row : kShaderSources) {
    const fs::path path = shaders / row.source;
    std::string checksum = sources.checksum(std::string(row.source));
    if (checksum.empty()) {
      out.message = path.string() + " cannot be read";
      return out;
    }
    // A shader whose source is that of the program, or that of its last compilation, need not be compiled.
    Known& known = known_[row.shader->name];
    if (checksum == row.checksum) {
      known = {};
      continue;
    }
    if (checksum == known.checksum) {
      if (known.differs) out.changed.emplace(row.shader->name, known.words);
      continue;
    }
    known = {};
    shaderc::CompileOptions options;
    options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_2);
    options.SetWarningsAsErrors();
    options.SetIncluder(std::make_unique<Includer>(files::glsl_include_folders(folder)));
    std::istringstream macros{std::string(row.macros)};
    for (std::string macro; std::getline(macros, macro, ',');) {
      const std::size_t equals = macro.find('=');
      options.AddMacroDefinition(macro.substr(0, equals), macro.substr(equals + 1));
    }
    std::string text;
    if (!read(path, text)) {
      out.message = path.string() + " cannot be read";
      return out;
    }
    const shaderc::SpvCompilationResult result =
        compiler.CompileGlslToSpv(text, kind_of(row.shader->stage), path.string().c_str(), options);
    if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
      out.message = result.GetErrorMessage();
      return out;
    }
    // Optimise as the build does. Names are not stripped, because bindings are found by name.
    const Words raw(result.cbegin(), result.cend());
    Words words;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    optimizer.RegisterPerformancePasses();
    if (!optimizer.Run(raw.data(), raw.size(), &words)) {
      out.message = path.string() + " cannot be optimised";
      return out;
    }
    if (words.size() == row.shader->spirv.size() && std::equal(words.begin(), words.end(), row.shader->spirv.begin())) {
      known.checksum = std::move(checksum);
      continue;
    }
    if (!fits(*row.shader, words)) {
      out.message = path.string() + ": bindings or the workgroup size have changed; rebuild the program";
      return out;
    }
    known = {std::move(checksum), words, true};
    out.changed.emplace(row.shader->name, std::move(words));
  }
  return out;
}

void ShaderReload::revert() {
  if (before_.empty()) return;
  const std::lock_guard<std::mutex> locked(mutex_);
  std::swap(words_, before_.back());
  refused_.push_back(std::move(before_.back()));
  before_.pop_back();
}

bool ShaderReload::supported() { return true; }

Result<void> ShaderReload::start() {
  const std::string folder = shipped_folder("shaders");
  if (folder.empty()) {
    return Error{
        ErrorCode::io,
        "F8: the sources of the shaders are not found; expected $TYNDALL_DATA to name the folder above shaders/"};
  }
  compiling_ = std::async(std::launch::async, [this, folder] {
    Compiled compiled = compile(folder);
    Window::wake();
    return compiled;
  });
  return {};
}

Result<ShaderReload::Rebuilt> ShaderReload::finish() {
  Rebuilt out;
  if (!compiling_.valid() || compiling_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return out;
  Compiled compiled = compiling_.get();
  out.finished = true;
  out.message = std::move(compiled.message);
  if (!out.message.empty()) return out;
  for (const auto& [name, words] : compiled.changed) {
    const auto old = words_.find(name);
    if (old == words_.end() || old->second != words) ++out.changed;
  }
  for (const auto& [name, words] : words_) {
    if (!compiled.changed.contains(name)) ++out.restored;
  }
  for (const ShaderSource& row : kShaderSources) {
    const bool of_tables = row.source.starts_with("precompute/");
    if (of_tables && compiled.changed.contains(row.shader->name)) out.tables_differ = true;
  }
  if (out.changed > 0 || out.restored > 0) {
    const std::lock_guard<std::mutex> locked(mutex_);
    before_.push_back(std::move(words_));
    words_ = std::move(compiled.changed);
  }
  return out;
}

}  // namespace tyndall::viewer
