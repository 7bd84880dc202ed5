// Parameters that have no effect because of other parameters are named. Shipped scenes have no such parameters.
#include <gtest/gtest.h>

#include <filesystem>

#include "config/scene_file.hpp"
#include "scene/description/unused_params.hpp"

namespace tyndall::scene {
namespace {

std::vector<std::string> unused(std::initializer_list<const char*> assignments) {
  config::Settings settings;
  for (const char* const text : assignments) EXPECT_TRUE(config::set(settings, text, "--set").ok()) << text;
  return unused_params(settings.effect, settings.scene);
}

using Lines = std::vector<std::string>;

TEST(UnusedParams, DefaultsAndUsedParametersAreNotNamed) {
  EXPECT_EQ(unused({}), Lines());
  EXPECT_EQ(unused({"scattering.medium=homogeneous", "homogeneous_medium.density=3", "scattering.downscale=2"}),
            Lines());
  EXPECT_EQ(unused({"scattering.model=oneil", "oneil.samples=9", "scattering.evaluate=pixel"}), Lines());
  EXPECT_EQ(unused({"tonemap.auto_exposure=off", "tonemap.exposure=2"}), Lines());
}

TEST(UnusedParams, AreNamedWithTheirReason) {
  EXPECT_EQ(unused({"scattering.model=oneil", "scattering.medium=homogeneous", "homogeneous_medium.density=3"}),
            Lines({"scattering.medium, homogeneous_medium.density have no effect with scattering.model = oneil"}));
  EXPECT_EQ(unused({"scattering.model=homogeneous", "scattering.medium=homogeneous"}),
            Lines({"scattering.medium has no effect with scattering.model = homogeneous"}));
  EXPECT_EQ(unused({"scattering.technique=brute-force", "scattering.downscale=2"}),
            Lines({"scattering.downscale has no effect with scattering.technique = brute-force"}));
  EXPECT_EQ(unused({"scattering.evaluate=pixel"}),
            Lines({"scattering.evaluate has no effect with scattering.model = atmosphere"}));
  EXPECT_EQ(unused({"homogeneous_medium.extent_m=50"}),
            Lines({"homogeneous_medium.extent_m has no effect with scattering.medium = atmosphere"}));
  EXPECT_EQ(unused({"tonemap.exposure=4"}),
            Lines({"tonemap.exposure has no effect with tonemap.auto_exposure = true"}));
  EXPECT_EQ(unused({"atmosphere.mie_scattering=1e-5,1e-5,1e-5"}),
            Lines({"atmosphere.mie_scattering has no effect with atmosphere.custom_coefficients = false"}));
  EXPECT_EQ(unused({"atmosphere.aerosol_optical_depth=0.2", "atmosphere.aerosol_density=2"}),
            Lines({"atmosphere.aerosol_density has no effect with atmosphere.aerosol_optical_depth"}));
  EXPECT_EQ(unused({"atmosphere.visibility_m=20000", "atmosphere.single_scattering_albedo=0.9",
                    "atmosphere.aerosol_absorption=0.2"}),
            Lines({"atmosphere.aerosol_absorption has no effect with atmosphere.single_scattering_albedo"}));
  EXPECT_EQ(unused({"sun.time=2026-06-21T06:00:00Z", "sun.place=46,8", "sun.elevation_deg=20"}),
            Lines({"sun.elevation_deg has no effect with sun.time"}));
  EXPECT_EQ(unused({"sun.place=46,8"}), Lines({"sun.place has no effect with an empty sun.time"}));
  EXPECT_EQ(unused({"atmosphere.ozone_du=300", "atmosphere.ozone_absorption=0,0,0"}),
            Lines({"atmosphere.ozone_absorption has no effect with atmosphere.ozone_du"}));
  EXPECT_EQ(unused({"tonemap.operator=exponential-channels", "tonemap.saturation=0.5", "tonemap.white_point=2"}).size(),
            2U);
}

TEST(UnusedParams, OfWhatIsNotDrawnAreNamed) {
  EXPECT_EQ(unused({"epipolar.slices=64", "scattering.technique=brute-force"}),
            Lines({"epipolar.slices has no effect with scattering.technique = brute-force"}));
  EXPECT_EQ(unused({"epipolar.slices=64", "scattering.model=oneil"}),
            Lines({"epipolar.slices has no effect with scattering.model = oneil"}));
  EXPECT_EQ(unused({"froxels.columns=64"}), Lines({"froxels.columns has no effect with froxels.enabled = false"}));
  EXPECT_EQ(unused({"froxels.columns=64", "scattering.technique=froxels"}), Lines());
  EXPECT_EQ(unused({"meshes.scale=2"}), Lines({"meshes.scale has no effect with meshes.source = none"}));
  EXPECT_EQ(unused({"meshes.scale=2", "meshes.source=hall"}), Lines());
  EXPECT_EQ(unused({"moon.elevation_deg=30"}), Lines({"moon.elevation_deg has no effect with moon.visible = false"}));
  EXPECT_EQ(unused({"moon.elevation_deg=30", "moon.light=true"}), Lines());
  EXPECT_EQ(unused({"sun.animate_speed_deg=5"}),
            Lines({"sun.animate_speed_deg has no effect with sun.animate = false"}));
  EXPECT_EQ(unused({"scattering.enabled=false", "scattering.multiple=occluded", "epipolar.slices=64"}),
            Lines({"scattering.multiple, epipolar.slices have no effect with scattering.enabled = false"}));
  // The homogeneous model leaves out the ground, with scattering on or off. The folder of the cache also contains
  // pipelines.
  EXPECT_EQ(unused({"scattering.model=homogeneous", "scattering.enabled=false", "scattering.only=true"}), Lines());
  EXPECT_EQ(unused({"scattering.model=oneil", "tables.cache=none"}), Lines());
  EXPECT_EQ(unused({"scattering.light_shafts=false", "epipolar.min_max_tree=false"}),
            Lines({"epipolar.min_max_tree has no effect with scattering.light_shafts = false"}));
  EXPECT_EQ(unused({"epipolar.min_max_tree=false", "epipolar.min_max_format=float32"}),
            Lines({"epipolar.min_max_format has no effect with epipolar.min_max_tree = false"}));
  EXPECT_EQ(unused({"scattering.single=integration", "scattering.sections=each"}),
            Lines({"scattering.sections has no effect with scattering.single = integration"}));
  EXPECT_EQ(unused({"scattering.single=integration", "scattering.sections=each", "scattering.multiple=occluded"}),
            Lines());
  EXPECT_EQ(unused({"scattering.medium=homogeneous", "scattering.single=integration"}),
            Lines({"scattering.single has no effect with scattering.medium = homogeneous"}));
  EXPECT_EQ(unused({"scattering.medium=homogeneous", "scattering.single=none"}), Lines());
  EXPECT_EQ(unused({"scattering.model=oneil", "tables.orders=5", "atmosphere.ozone_du=100"}),
            Lines({"atmosphere.ozone_du, tables.orders have no effect with scattering.model = oneil"}));
  EXPECT_EQ(unused({"terrain.units=degrees"}), Lines({"terrain.units has no effect with terrain.source = procedural"}));
  EXPECT_EQ(unused({"terrain.units=degrees", "terrain.seed=2", "terrain.source=none"}),
            Lines({"terrain.seed, terrain.units have no effect with terrain.source = none"}));
}

TEST(UnusedParams, ShippedScenesHaveNone) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TYNDALL_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "presets") continue;
    config::Settings settings;
    ASSERT_TRUE(config::load(settings, entry.path().string()).ok()) << entry.path();
    EXPECT_EQ(unused_params(settings.effect, settings.scene), Lines()) << entry.path();
    ++scenes;
  }
  EXPECT_GT(scenes, 5);
}

}  // namespace
}  // namespace tyndall::scene
