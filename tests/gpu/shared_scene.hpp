// The fixture of tests that draw with one scene after the other. They share it, because creating the pipelines of a
// scene takes seconds; scene_test.cpp shows that a scene that has been changed draws what a new one would.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <utility>

#include "gpu_test.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {

class SharedSceneTest : public GpuTest {
 public:
  static void TearDownTestSuite() { shared_.reset(); }

 protected:
  // Returns the scene with these parameters, or null after an error, which fails the test.
  static Scene* shared_scene(VkExtent2D extent, const Params& params, const SceneParams& scene,
                             int terrain_coarseness = 4) {
    if (shared_ == nullptr) {
      SceneDesc desc;
      desc.extent = extent;
      desc.timings = true;
      desc.terrain_coarseness = terrain_coarseness;
      Result<std::unique_ptr<Scene>> made = Scene::create(host(), desc, params, scene);
      EXPECT_OK(made);
      if (!made.ok()) return nullptr;
      shared_ = std::move(made).value();
    }
    const bool changed = shared_->set_extent(extent, terrain_coarseness).ok() && shared_->set_params(params).ok() &&
                         shared_->set_scene(scene).ok();
    EXPECT_TRUE(changed);
    return changed ? shared_.get() : nullptr;
  }

 private:
  static inline std::unique_ptr<Scene> shared_;
};

// Writes an elevation file as text: a square of `n` samples around the origin, x to the east and z to the south [m].
inline void write_grid(const std::filesystem::path& path, int n, double cell_m,
                       const std::function<double(double x, double z)>& height) {
  std::ofstream out(path);
  out << "ncols " << n << "\nnrows " << n << "\nxllcorner 0\nyllcorner 0\ncellsize " << cell_m << "\n";
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      out << height((column - 0.5 * n) * cell_m, (row - 0.5 * n) * cell_m) << (column + 1 < n ? " " : "\n");
    }
  }
}

}  // namespace tyndall::scene
