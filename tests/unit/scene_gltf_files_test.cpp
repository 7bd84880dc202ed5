// The files that a glTF file names: in its folder or below it.
#include <cctype>
#include <cstdlib>

#include "files/access.hpp"
#include "scene_gltf.hpp"

namespace tyndall::scene {
namespace {

// A model that was downloaded cannot make the program read files elsewhere.
TEST_F(SceneGltf, UrisStayInTheFolder) {
  const std::filesystem::path folder = at("");
  const std::filesystem::path inside = folder / "model";
  std::filesystem::create_directories(inside / "textures");
  const std::string png = picture();  // at("p.png"), outside of the model's folder
  std::filesystem::copy_file(at("p.png"), inside / "textures/p.png");
  std::filesystem::create_symlink(folder / "p.png", inside / "link.png");
  std::filesystem::create_directory_symlink(folder, inside / "folder");
  std::filesystem::create_symlink("/dev/zero", inside / "endless.bin");
  const auto message = [&](const std::string& uri, bool buffer = false) {
    GltfFile file = triangle();
    set_picture(file, png);
    if (!buffer) file.root["images"] = {{{"uri", uri}}};
    json document = json::parse(file.text());
    if (buffer) document["buffers"].push_back({{"uri", uri}, {"byteLength", 1}});
    std::ofstream((inside / "a.gltf").string(), std::ios::binary) << document.dump();
    const Result<MeshData> read = load_gltf((inside / "a.gltf").string());
    return read.ok() ? std::string() : read.error().message;
  };
  for (const std::string& uri : {std::string("../p.png"), std::string("%2e%2E/p.png"), std::string("..%2fp.png"),
                                 std::string("textures/../../p.png"), at("p.png"), std::string("link.png"),
                                 std::string("folder/p.png"), std::string("/dev/zero")}) {
    for (const bool buffer : {false, true}) {
      EXPECT_NE(message(uri, buffer).find("leaves the folder of the glTF file; expected a file in that folder"),
                std::string::npos)
          << uri << ": " << message(uri, buffer);
    }
  }
  EXPECT_NE(message("endless.bin", true).find("leaves the folder"), std::string::npos);
  EXPECT_NE(message("file:///etc/hostname").find("is not a file"), std::string::npos);
  for (const std::string& uri : {std::string("textures/p.png"), std::string("./textures/p.png"),
                                 std::string("textures/../textures/p.png"), (inside / "textures/p.png").string()}) {
    EXPECT_EQ(message(uri), "") << uri;
  }
  // Run in a separate process, because allow_outside() applies to the whole process.
  const auto allowed = [&] {
    files::allow_outside();
    return message("../p.png").empty() && message("link.png").empty();
  };
  EXPECT_EXIT(std::exit(allowed() ? 0 : 1), testing::ExitedWithCode(0), "");
}

// The scheme of a URI, and "base64", are written in any case.
TEST_F(SceneGltf, DataUrisAreCaseInsensitive) {
  for (const bool capitals : {false, true}) {
    GltfFile file = triangle();
    json document = json::parse(file.text());
    std::string uri = document["buffers"][0]["uri"];
    const std::size_t comma = uri.find(',');
    ASSERT_NE(comma, std::string::npos);
    for (std::size_t i = 0; capitals && i < comma; ++i) uri[i] = static_cast<char>(std::toupper(uri[i]));
    document["buffers"][0]["uri"] = uri;
    std::ofstream(at("data.gltf"), std::ios::binary) << document.dump();
    const Result<MeshData> read = load_gltf(at("data.gltf"));
    EXPECT_TRUE(read.ok()) << uri.substr(0, comma) << ": " << read.error().message;
  }
}

}  // namespace
}  // namespace tyndall::scene
