// The document of a glTF file: versions, extensions, buffers, views and accessors. Materials are parsed in
// gltf_materials.cpp, meshes and nodes in gltf_nodes.cpp.
#include "scene/mesh/gltf_document.hpp"

#include <algorithm>
#include <set>

#include "files/text.hpp"
#include "scene/mesh/gltf_decoders.hpp"
#include "scene/mesh/gltf_json.hpp"

namespace tyndall::scene {
namespace {

constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();
constexpr int kMaxJsonDepth = 96;  // glTF itself nests 8 levels

std::string joined(const std::set<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

// Returns whether arrays and objects are nested too deeply for the recursive parser. Strings are skipped.
bool too_deep(std::string_view json) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

// Returns the major and minor number of a text such as "2.0", or nothing.
std::optional<std::pair<std::int64_t, std::int64_t>> version_of(const std::string& text) {
  const std::size_t dot = text.find('.');
  const auto digits = [](const std::string& part) {
    return !part.empty() && part.size() < 9 && part.find_first_not_of("0123456789") == std::string::npos;
  };
  if (dot == std::string::npos || !digits(text.substr(0, dot)) || !digits(text.substr(dot + 1))) return {};
  return std::pair(std::stoll(text.substr(0, dot)), std::stoll(text.substr(dot + 1)));
}

void check_version(const GltfJson& root) {
  const GltfJson asset = root.object("asset");
  const auto version = version_of(asset.text("version"));
  if (!version || version->first != 2) asset.refuse("version", "expected \"2.0\"");
  if (!asset.has("minVersion")) return;
  const auto min = version_of(asset.text("minVersion"));
  if (!min || *min > std::pair<std::int64_t, std::int64_t>(2, 0)) asset.refuse("minVersion", "expected \"2.0\"");
}

void check_extensions(const GltfJson& root, GltfDocument& out) {
  std::set<std::string> supported = {"KHR_materials_pbrSpecularGlossiness", "KHR_materials_transmission",
                                     "KHR_mesh_quantization", "KHR_texture_transform"};
  if (kHasDraco) supported.insert("KHR_draco_mesh_compression");
  if (kHasMeshopt) supported.insert("EXT_meshopt_compression");
  for (const std::string& name : root.texts("extensionsRequired")) {
    if (supported.contains(name)) continue;
    const bool left_out =
        (!kHasDraco && name == "KHR_draco_mesh_compression") || (!kHasMeshopt && name == "EXT_meshopt_compression");
    fail("requires the extension " + files::one_line(name, 80) +
             (left_out ? ", whose decoder this program was built without" : ""),
         "expected " + joined(supported));
  }
  std::set<std::string> ignored;
  for (const std::string& name : root.texts("extensionsUsed")) {
    if (!supported.contains(name)) ignored.insert(files::one_line(name, 80));
  }
  if (!ignored.empty()) out.notes.push_back("glTF extensions that are not supported are ignored: " + joined(ignored));
}

GltfComponent component(const GltfJson& from, const char* name) {
  const std::int64_t type = from.integer(name, 0, kAny);
  if (type < 5120 || type > 5126 || type == 5124) from.refuse(name, "expected 5120, 5121, 5122, 5123, 5125 and 5126");
  return static_cast<GltfComponent>(type);
}

template <std::size_t N>
std::size_t choice(const GltfJson& from, const char* name, const std::array<const char*, N>& names,
                   const char* fallback) {
  const std::string text = from.text(name, fallback == nullptr ? std::optional<std::string>() : fallback);
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) {
    std::set<std::string> allowed(names.begin(), names.end());
    from.refuse(name, "expected " + joined(allowed));
  }
  return static_cast<std::size_t>(found - names.begin());
}

// Parses the range of a buffer to which a view or its compressed form refers.
void parse_range(const GltfJson& json, const GltfDocument& out, std::size_t& buffer, std::uint64_t& offset,
                 std::uint64_t& length) {
  buffer = static_cast<std::size_t>(json.index("buffer", "buffers", true));
  offset = static_cast<std::uint64_t>(json.integer("byteOffset", 0, kAny, 0));
  length = static_cast<std::uint64_t>(json.integer("byteLength", 1, kAny));
  const std::uint64_t size = out.buffers[buffer].length;
  if (offset > size || length > size - offset) {
    fail(json.path() + " ends at byte " + std::to_string(offset + length) + ", beyond the end of its buffer",
         "expected the " + std::to_string(size) + " bytes of " + at("buffers", buffer));
  }
}

GltfMeshopt parse_meshopt(const GltfJson& json, const GltfDocument& out, std::uint64_t view_length) {
  GltfMeshopt meshopt;
  parse_range(json, out, meshopt.buffer, meshopt.offset, meshopt.length);
  meshopt.stride = static_cast<std::size_t>(json.integer("byteStride", 1, 256));
  meshopt.count = static_cast<std::size_t>(json.integer("count", 1, static_cast<std::int64_t>(kMaxMeshIndices)));
  meshopt.mode =
      static_cast<GltfMeshopt::Mode>(choice<3>(json, "mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"}, nullptr));
  meshopt.filter = static_cast<GltfMeshopt::Filter>(
      choice<4>(json, "filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}, "NONE"));
  const std::size_t stride = meshopt.stride;
  using Mode = GltfMeshopt::Mode;
  using Filter = GltfMeshopt::Filter;
  if (meshopt.mode == Mode::attributes ? stride % 4 != 0 : stride != 2 && stride != 4) {
    json.refuse("byteStride",
                meshopt.mode == Mode::attributes ? "expected a multiple of 4 up to 256" : "expected 2 and 4");
  }
  if (meshopt.mode == Mode::triangles && meshopt.count % 3 != 0) json.refuse("count", "expected a multiple of 3");
  const bool fits = meshopt.filter == Filter::none ||
                    (meshopt.mode == Mode::attributes && (meshopt.filter == Filter::exponential || stride == 8 ||
                                                          (meshopt.filter == Filter::octahedral && stride == 4)));
  if (!fits) json.refuse("filter", "expected NONE for this mode and byteStride");
  if (meshopt.count * stride != view_length) {
    fail(json.path() + " decodes to " + std::to_string(meshopt.count * stride) + " bytes",
         "expected the " + std::to_string(view_length) + " of the view's byteLength");
  }
  return meshopt;
}

void parse_views(const GltfJson& root, GltfDocument& out) {
  for (const GltfJson& json : root.objects("buffers")) {
    GltfBuffer buffer;
    if (json.has("uri")) buffer.uri = json.text("uri");
    buffer.length = static_cast<std::uint64_t>(json.integer("byteLength", 1, kAny));
    if (const auto meshopt = json.extension("EXT_meshopt_compression"))
      buffer.fallback = kHasMeshopt && meshopt->flag("fallback");
    out.buffers.push_back(std::move(buffer));
  }
  for (const GltfJson& json : root.objects("bufferViews")) {
    GltfView view;
    parse_range(json, out, view.buffer, view.offset, view.length);
    view.stride = static_cast<std::size_t>(json.integer("byteStride", 4, 252, 0));
    if (view.stride % 4 != 0) json.refuse("byteStride", "expected a multiple of 4 from 4 to 252");
    if (const auto meshopt = json.extension("EXT_meshopt_compression"); kHasMeshopt && meshopt) {
      view.meshopt = parse_meshopt(*meshopt, out, view.length);
      // The decoder writes elements with the stride of the extension.
      if (view.stride != 0 && view.stride != view.meshopt->stride) {
        json.refuse("byteStride",
                    "expected " + std::to_string(view.meshopt->stride) + ", as in EXT_meshopt_compression");
      }
      if (view.meshopt->mode == GltfMeshopt::Mode::attributes) view.stride = view.meshopt->stride;
    }
    out.views.push_back(std::move(view));
  }
}

void check_view_range(const GltfJson& json, const GltfDocument& out, std::size_t view, std::uint64_t offset,
                      std::size_t stride, std::size_t count, std::size_t element) {
  const std::uint64_t size = out.views[view].length;
  if (offset > size || (count - 1) * stride + element > size - offset) {
    fail(json.path() + " of " + std::to_string(count) + " elements ends at byte " +
             std::to_string(offset + (count - 1) * stride + element) + ", beyond the end of its bufferView",
         "expected the " + std::to_string(size) + " bytes of " + at("bufferViews", view));
  }
}

GltfSparse parse_sparse(const GltfJson& json, const GltfDocument& out, const GltfAccessor& accessor) {
  GltfSparse sparse;
  sparse.count = static_cast<std::size_t>(json.integer("count", 1, static_cast<std::int64_t>(accessor.count)));
  const GltfJson indices = json.object("indices");
  const GltfJson values = json.object("values");
  sparse.index_view = static_cast<std::size_t>(indices.index("bufferView", "bufferViews", true));
  sparse.index_offset = static_cast<std::uint64_t>(indices.integer("byteOffset", 0, kAny, 0));
  sparse.index_component = component(indices, "componentType");
  if (sparse.index_component != GltfComponent::uint8 && sparse.index_component != GltfComponent::uint16 &&
      sparse.index_component != GltfComponent::uint32) {
    indices.refuse("componentType", "expected 5121, 5123 and 5125");
  }
  sparse.value_view = static_cast<std::size_t>(values.index("bufferView", "bufferViews", true));
  sparse.value_offset = static_cast<std::uint64_t>(values.integer("byteOffset", 0, kAny, 0));
  const std::size_t index_bytes = bytes_of(sparse.index_component);
  const std::size_t element = bytes_of(accessor.component) * static_cast<std::size_t>(accessor.components);
  check_view_range(indices, out, sparse.index_view, sparse.index_offset, index_bytes, sparse.count, index_bytes);
  check_view_range(values, out, sparse.value_view, sparse.value_offset, element, sparse.count, element);
  return sparse;
}

void parse_accessors(const GltfJson& root, GltfDocument& out) {
  constexpr std::array<const char*, 7> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  constexpr std::array<int, 7> kComponents = {1, 2, 3, 4, 4, 9, 16};
  for (const GltfJson& json : root.objects("accessors")) {
    GltfAccessor accessor;
    accessor.view = json.index("bufferView", "bufferViews");
    accessor.offset = static_cast<std::uint64_t>(json.integer("byteOffset", 0, kAny, 0));
    accessor.count = static_cast<std::size_t>(json.integer("count", 1, static_cast<std::int64_t>(kMaxMeshIndices)));
    accessor.component = component(json, "componentType");
    accessor.components = kComponents[choice(json, "type", kTypes, nullptr)];
    accessor.normalized = json.flag("normalized");
    if (accessor.view >= 0) {
      const auto view = static_cast<std::size_t>(accessor.view);
      const std::size_t element = bytes_of(accessor.component) * static_cast<std::size_t>(accessor.components);
      const std::size_t stride = out.views[view].stride == 0 ? element : out.views[view].stride;
      if (stride < element) {
        fail(json.path() + " has elements of " + std::to_string(element) + " bytes",
             "expected up to the " + std::to_string(stride) + " of " + at("bufferViews", view) + ".byteStride");
      }
      check_view_range(json, out, view, accessor.offset, stride, accessor.count, element);
    }
    if (const auto sparse = json.find_object("sparse")) accessor.sparse = parse_sparse(*sparse, out, accessor);
    out.accessors.push_back(std::move(accessor));
  }
}

}  // namespace

std::size_t bytes_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::int8:
    case GltfComponent::uint8: return 1;
    case GltfComponent::int16:
    case GltfComponent::uint16: return 2;
    case GltfComponent::uint32:
    case GltfComponent::float32: return 4;
  }
  return 4;
}

GltfDocument parse_gltf(std::string_view text) {
  if (too_deep(text)) fail("is nested too deeply", "expected " + std::to_string(kMaxJsonDepth) + " levels");
  const nlohmann::json json = nlohmann::json::parse(text);
  const GltfJson root(json);
  GltfDocument out;
  std::set<std::string> undrawn;
  check_version(root);
  check_extensions(root, out);
  parse_views(root, out);
  parse_accessors(root, out);
  parse_materials(root, out, undrawn);
  parse_nodes(root, out, undrawn);
  if (!undrawn.empty()) out.notes.push_back("these parts of the glTF file are not drawn: " + joined(undrawn));
  return out;
}

}  // namespace tyndall::scene
