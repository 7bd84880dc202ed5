#include "features.hpp"

#include "image/image.hpp"
#include "scene/elevation/elevation_file.hpp"
#include "scene/mesh/gltf_decoders.hpp"
#include "tyndall/version.hpp"
#include "verbs.hpp"

namespace tyndall::cli {

std::vector<Feature> features() {
  return {{"elevation files (GDAL)", scene::elevation_files_supported()},
          {"EXR files (OpenEXR)", image::exr_supported()},
          {"viewer (GLFW, ImGui)", has_viewer()},
          {"shader reloading (shaderc)", has_shader_reload()},
          {"Draco meshes", scene::kHasDraco},
          {"meshoptimizer meshes", scene::kHasMeshopt}};
}

std::string version_text() {
  std::string with;
  std::string without;
  for (const Feature& feature : features()) {
    std::string& list = feature.built_in ? with : without;
    list.append(list.empty() ? "" : ", ").append(feature.name);
  }
  std::string text = "tyndall " TYNDALL_VERSION_STRING "\n";
  if (!with.empty()) text.append("built with: ").append(with).append("\n");
  if (!without.empty()) text.append("built without: ").append(without).append("\n");
  return text;
}

}  // namespace tyndall::cli
