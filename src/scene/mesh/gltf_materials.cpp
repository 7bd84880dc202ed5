// Materials, textures, samplers and images of a glTF document. Pictures are decoded in gltf_images.cpp.
#include <algorithm>

#include "scene/mesh/gltf_json.hpp"

namespace tyndall::scene {
namespace {

TextureWrap wrap(const GltfJson& json, const char* name) {
  switch (json.integer(name, 0, std::numeric_limits<std::int64_t>::max(), 10497)) {
    case 10497: return TextureWrap::repeat;
    case 33071: return TextureWrap::clamp_to_edge;
    case 33648: return TextureWrap::mirrored_repeat;
    default: json.refuse(name, "expected 10497, 33071 and 33648");
  }
}

// Parses a sampler. If a filter is missing, glTF leaves the choice to the program, and the smoothest is used.
MeshSampler sampler(const GltfJson& json) {
  MeshSampler out;
  out.wrap_u = wrap(json, "wrapS");
  out.wrap_v = wrap(json, "wrapT");
  const std::int64_t mag = json.integer("magFilter", 9728, std::numeric_limits<std::int64_t>::max(), 9729);
  if (mag > 9729) json.refuse("magFilter", "expected 9728 and 9729");
  out.mag_linear = mag == 9729;
  switch (json.integer("minFilter", 0, std::numeric_limits<std::int64_t>::max(), 9987)) {
    case 9728: out.min_linear = false, out.mip = MipFilter::none; break;
    case 9729: out.min_linear = true, out.mip = MipFilter::none; break;
    case 9984: out.min_linear = false, out.mip = MipFilter::nearest; break;
    case 9985: out.min_linear = true, out.mip = MipFilter::nearest; break;
    case 9986: out.min_linear = false, out.mip = MipFilter::linear; break;
    case 9987: out.min_linear = true, out.mip = MipFilter::linear; break;
    default: json.refuse("minFilter", "expected 9728, 9729 and 9984 to 9987");
  }
  return out;
}

GltfTextureUse texture_use(const GltfJson& json) {
  GltfTextureUse out;
  out.texture = json.index("index", "textures", true);
  out.set = static_cast<int>(json.integer("texCoord", 0, 1000, 0));
  if (const auto transform = json.extension("KHR_texture_transform")) {
    transform->numbers("offset", std::span<double>(&out.offset.x, 2));
    transform->numbers("scale", std::span<double>(&out.scale.x, 2));
    out.rotation_rad = transform->number("rotation", 0.0);
    out.set = static_cast<int>(transform->integer("texCoord", 0, 1000, out.set));
  }
  return out;
}

// Parses the base colour of either material model. Specular reflection is not drawn, so the diffuse colour of
// KHR_materials_pbrSpecularGlossiness serves as base colour.
void base_color(const GltfJson& json, const char* factor, const char* texture, GltfMaterial& out) {
  glm::dvec4 color(1.0);
  json.bounded(factor, 0.0, 1.0, std::span<double>(&color.x, 4));
  out.drawn.color = glm::vec4(color);
  out.texture = {};
  if (const auto used = json.find_object(texture)) out.texture = texture_use(*used);
}

void alpha_mode(const GltfJson& json, MeshMaterial& out) {
  const std::string mode = json.text("alphaMode", "OPAQUE");
  if (mode == "MASK") {
    out.kind = SurfaceKind::mask;
  } else if (mode == "BLEND") {
    out.kind = SurfaceKind::blend;
  } else if (mode != "OPAQUE") {
    json.refuse("alphaMode", "expected OPAQUE, MASK and BLEND");
  }
  const double cutoff = json.bounded("alphaCutoff", 0.0, std::numeric_limits<double>::max(), 0.5);
  // All values above 1 make the surface disappear.
  if (out.kind == SurfaceKind::mask) out.alpha_cutoff = static_cast<float>(std::min(cutoff, 2.0));
}

GltfMaterial material(const GltfJson& json, std::set<std::string>& undrawn) {
  GltfMaterial out;
  out.drawn.name = json.text("name", "");
  alpha_mode(json, out.drawn);
  out.drawn.double_sided = json.flag("doubleSided");
  if (const auto pbr = json.find_object("pbrMetallicRoughness")) {
    base_color(*pbr, "baseColorFactor", "baseColorTexture", out);
    out.drawn.roughness = static_cast<float>(pbr->bounded("roughnessFactor", 0.0, 1.0, 1.0));
    const bool metallic = pbr->bounded("metallicFactor", 0.0, 1.0, 1.0) > 0.0;
    if (metallic && (pbr->has("metallicFactor") || pbr->has("metallicRoughnessTexture")))
      undrawn.insert("metallic reflection");
  }
  if (const auto specular = json.extension("KHR_materials_pbrSpecularGlossiness")) {
    base_color(*specular, "diffuseFactor", "diffuseTexture", out);
    out.drawn.roughness = static_cast<float>(1.0 - specular->bounded("glossinessFactor", 0.0, 1.0, 1.0));
    undrawn.insert("specular reflection of KHR_materials_pbrSpecularGlossiness");
  }
  if (const auto transmission = json.extension("KHR_materials_transmission")) {
    out.drawn.transmission = static_cast<float>(transmission->bounded("transmissionFactor", 0.0, 1.0, 0.0));
    if (out.drawn.transmission > 0.0F) {
      if (out.drawn.kind == SurfaceKind::blend) undrawn.insert("alpha of materials with transmission");
      out.drawn.kind = SurfaceKind::glass;
    }
    if (transmission->has("transmissionTexture")) undrawn.insert("transmission textures");
  }
  glm::dvec3 emission(0.0);
  json.bounded("emissiveFactor", 0.0, 1.0, std::span<double>(&emission.x, 3));
  if (emission != glm::dvec3(0.0)) undrawn.insert("emission");
  if (json.has("normalTexture")) undrawn.insert("normal maps");
  if (json.has("occlusionTexture")) undrawn.insert("occlusion maps");
  return out;
}

}  // namespace

void parse_materials(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn) {
  for (const GltfJson& json : root.objects("images")) {
    GltfImage image;
    if (json.has("uri")) image.uri = json.text("uri");
    image.view = json.index("bufferView", "bufferViews");
    if (image.uri.has_value() == (image.view >= 0))
      fail(json.path() + " is not a picture", "expected either uri or bufferView");
    out.images.push_back(std::move(image));
  }
  std::vector<MeshSampler> samplers;
  for (const GltfJson& json : root.objects("samplers")) samplers.push_back(sampler(json));
  for (const GltfJson& json : root.objects("textures")) {
    GltfTexture texture;
    texture.image = json.index("source", "images");
    const int index = json.index("sampler", "samplers");
    if (index >= 0) texture.sampler = samplers[static_cast<std::size_t>(index)];
    out.textures.push_back(texture);
  }
  for (const GltfJson& json : root.objects("materials")) out.materials.push_back(material(json, undrawn));
}

}  // namespace tyndall::scene
