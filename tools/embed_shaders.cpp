// embed_shaders OUT.hpp OUT.cpp A.spv B.spv ...: writes a header with one tyndall::gpu::Shader for each module: its
// stage, local size, push-constant size, the ids of its specialisation constants, and its bindings by name with whether
// each is read and written. A module is named after its file without the extension; an array named after OUT lists them
// all. The words are in a source, because they take seconds to compile, and several sources include the header. All
// bindings must be in set 0 and have names. Storage images and buffers that a shader only reads or only writes must be
// declared readonly or writeonly, because barriers follow from these declarations.
#include <spirv_cross/spirv_cross_c.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Failure {
  std::string message;
};

struct Reflector {
  spvc_context context = nullptr;
  spvc_compiler compiler = nullptr;

  void check(spvc_result result) const {
    if (result != SPVC_SUCCESS) throw Failure{spvc_context_get_last_error_string(context)};
  }
};

std::vector<std::uint32_t> read_words(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw Failure{path + ": cannot be read"};
  const auto bytes = static_cast<std::size_t>(file.tellg());
  std::vector<std::uint32_t> words(bytes / 4);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
  return words;
}

struct Kind {
  spvc_resource_type resource;
  const char* descriptor;
};

constexpr Kind kKinds[] = {
    {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, "VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER"},
    {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, "VK_DESCRIPTOR_TYPE_STORAGE_BUFFER"},
    {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, "VK_DESCRIPTOR_TYPE_STORAGE_IMAGE"},
    {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, "VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER"},
    {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, "VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE"},
    {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, "VK_DESCRIPTOR_TYPE_SAMPLER"},
};

bool has_decoration(const Reflector& r, const spvc_reflected_resource& resource, bool buffer,
                    SpvDecoration decoration) {
  if (!buffer) return spvc_compiler_has_decoration(r.compiler, resource.id, decoration) != 0;
  const SpvDecoration* decorations = nullptr;
  std::size_t count = 0;
  r.check(spvc_compiler_get_buffer_block_decorations(r.compiler, resource.id, &decorations, &count));
  for (std::size_t i = 0; i < count; ++i) {
    if (decorations[i] == decoration) return true;
  }
  return false;
}

std::string bindings_of(const Reflector& r, const std::string& module, std::size_t& count) {
  spvc_resources resources = nullptr;
  r.check(spvc_compiler_create_shader_resources(r.compiler, &resources));
  std::ostringstream out;
  std::set<unsigned> used;
  count = 0;
  for (const Kind& kind : kKinds) {
    const spvc_reflected_resource* list = nullptr;
    std::size_t size = 0;
    r.check(spvc_resources_get_resource_list_for_type(resources, kind.resource, &list, &size));
    for (std::size_t i = 0; i < size; ++i) {
      const bool buffer =
          kind.resource == SPVC_RESOURCE_TYPE_UNIFORM_BUFFER || kind.resource == SPVC_RESOURCE_TYPE_STORAGE_BUFFER;
      std::string name = spvc_compiler_get_name(r.compiler, list[i].id);
      if (name.empty()) name = list[i].name;
      if (name.empty()) throw Failure{module + ": a binding has lost its name"};
      const unsigned binding = spvc_compiler_get_decoration(r.compiler, list[i].id, SpvDecorationBinding);
      const unsigned set = spvc_compiler_get_decoration(r.compiler, list[i].id, SpvDecorationDescriptorSet);
      if (set != 0) throw Failure{module + ": binding " + name + " is not in set 0"};
      if (!used.insert(binding).second) throw Failure{module + ": two bindings have one number"};
      bool reads = true;
      bool writes = false;
      if (kind.resource == SPVC_RESOURCE_TYPE_STORAGE_BUFFER || kind.resource == SPVC_RESOURCE_TYPE_STORAGE_IMAGE) {
        reads = !has_decoration(r, list[i], buffer, SpvDecorationNonReadable);
        writes = !has_decoration(r, list[i], buffer, SpvDecorationNonWritable);
      }
      out << "    {\"" << name << "\", " << binding << ", " << kind.descriptor << ", " << (reads ? "true" : "false")
          << ", " << (writes ? "true" : "false") << "},\n";
      ++count;
    }
  }
  return out.str();
}

// The ids of the specialisation constants that the optimised module still has, in ascending order.
std::set<unsigned> constants_of(const Reflector& r) {
  const spvc_specialization_constant* list = nullptr;
  std::size_t count = 0;
  r.check(spvc_compiler_get_specialization_constants(r.compiler, &list, &count));
  std::set<unsigned> out;
  for (std::size_t i = 0; i < count; ++i) out.insert(list[i].constant_id);
  return out;
}

std::size_t push_constant_size(const Reflector& r) {
  spvc_resources resources = nullptr;
  r.check(spvc_compiler_create_shader_resources(r.compiler, &resources));
  const spvc_reflected_resource* list = nullptr;
  std::size_t count = 0;
  r.check(spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &list, &count));
  if (count == 0) return 0;
  std::size_t size = 0;
  r.check(spvc_compiler_get_declared_struct_size(
      r.compiler, spvc_compiler_get_type_handle(r.compiler, list[0].base_type_id), &size));
  return size;
}

const char* stage_of(const Reflector& r) {
  switch (spvc_compiler_get_execution_model(r.compiler)) {
    case SpvExecutionModelVertex: return "VK_SHADER_STAGE_VERTEX_BIT";
    case SpvExecutionModelFragment: return "VK_SHADER_STAGE_FRAGMENT_BIT";
    default: return "VK_SHADER_STAGE_COMPUTE_BIT";
  }
}

// The text of both files.
struct Output {
  std::string header, source;
};

void embed(const std::string& path, Output& to) {
  const std::string name = std::filesystem::path(path).stem().string();
  const std::vector<std::uint32_t> words = read_words(path);
  Reflector r;
  if (spvc_context_create(&r.context) != SPVC_SUCCESS) throw Failure{"SPIRV-Cross does not start"};
  spvc_parsed_ir ir = nullptr;
  r.check(spvc_context_parse_spirv(r.context, words.data(), words.size(), &ir));
  r.check(
      spvc_context_create_compiler(r.context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &r.compiler));
  std::size_t binding_count = 0;
  const std::string bindings = bindings_of(r, name, binding_count);
  unsigned local[3] = {1, 1, 1};
  if (spvc_compiler_get_execution_model(r.compiler) == SpvExecutionModelGLCompute) {
    for (unsigned i = 0; i < 3; ++i) {
      local[i] = spvc_compiler_get_execution_mode_argument_by_index(r.compiler, SpvExecutionModeLocalSize, i);
    }
  }
  to.source += "const std::uint32_t " + name + "_words[] = {";
  char word[32];
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::snprintf(word, sizeof word, "%s%u,", i % 8 == 0 ? "\n" : "", words[i]);
    to.source += word;
  }
  to.source += "};\n";
  std::ostringstream out;
  out << "extern const std::uint32_t " << name << "_words[" << words.size() << "];\n";
  if (binding_count > 0) {
    out << "inline constexpr tyndall::gpu::Binding " << name << "_bindings[] = {\n" << bindings << "};\n";
  }
  const std::set<unsigned> constants = constants_of(r);
  if (!constants.empty()) {
    out << "inline constexpr std::uint32_t " << name << "_constants[] = {";
    for (const unsigned id : constants) out << id << ", ";
    out << "};\n";
  }
  out << "inline constexpr tyndall::gpu::Shader " << name << " = {\"" << name << "\", " << stage_of(r) << ", " << name
      << "_words, " << (binding_count > 0 ? name + "_bindings" : "{}") << ", " << push_constant_size(r) << ", {"
      << local[0] << ", " << local[1] << ", " << local[2] << "}, " << (constants.empty() ? "{}" : name + "_constants")
      << "};\n\n";
  spvc_context_destroy(r.context);
  to.header += out.str();
}

void write(const char* path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Failure{std::string(path) + ": cannot be written"};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: embed_shaders OUT.hpp OUT.cpp A.spv...\n");
    return 2;
  }
  try {
    const std::filesystem::path header = argv[1];
    const std::string made_by = "// Made by tools/embed_shaders.cpp from the compiled shaders.\n";
    Output out = {made_by + "#pragma once\n\n#include \"gpu/shader.hpp\"\n\nnamespace tyndall::shaders {\n\n",
                  made_by + "#include \"" + header.filename().string() + "\"\n\nnamespace tyndall::shaders {\n\n"};
    for (int i = 3; i < argc; ++i) embed(argv[i], out);
    out.header += "inline constexpr const tyndall::gpu::Shader* " + header.stem().string() + "[] = {";
    for (int i = 3; i < argc; ++i) out.header += "&" + std::filesystem::path(argv[i]).stem().string() + ", ";
    out.header += "};\n\n}  // namespace tyndall::shaders\n";
    out.source += "\n}  // namespace tyndall::shaders\n";
    write(argv[1], out.header);
    write(argv[2], out.source);
  } catch (const Failure& failure) {
    std::fprintf(stderr, "embed_shaders: error: %s\n", failure.message.c_str());
    return 1;
  }
  return 0;
}
