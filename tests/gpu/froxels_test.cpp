// The froxel volume against brute force: at the points of the volume, as a picture, and through the look-up of
// tyndall/atmosphere.glsl. All cases share an effect.
#include "atmosphere_points.hpp"
#include "shared_effect.hpp"

namespace tyndall {
namespace {

// Returns the distance of slice k of n, as docs/froxels.md documents it.
double distance_of(const FroxelParams& p, std::uint32_t k) {
  const double x = static_cast<double>(k) / (p.slices - 1);
  return p.near_m * (std::pow(1.0 + static_cast<double>(p.far_m) / p.near_m, x) - 1.0);
}

class Froxels : public SharedEffect {
 protected:
  // Returns parameters with a volume that has one column for each pixel.
  static Params params_for(VkExtent2D extent) {
    Params out = small_params();
    out.froxels.enabled = true;
    out.froxels.columns = extent.width;
    out.froxels.rows = extent.height;
    out.froxels.slices = 32;
    out.froxels.far_m = 60000.0F;
    out.scattering.scale = 1.0F;
    out.scattering.only = true;
    return out;
  }
  static Params composed(Params params) {
    params.scattering.technique = Technique::froxels;
    return params;
  }
  // Compares the light and the transmittance of a slice with brute force to surfaces at its distance.
  void expect_slice(const std::string& name, TestFrame frame, const Params& params, std::uint32_t slice) {
    const double distance = distance_of(params.froxels, slice);
    frame.distance_m = [distance](std::uint32_t, std::uint32_t) { return distance; };
    show(frame);
    for (const bool only : {true, false}) {
      Params p = params;
      p.scattering.only = only;
      // Without shadows, the difference is that of half floats. With them, the reads of a shadow map begin elsewhere.
      expect_alike(name + (only ? ", light" : ", with background"), composed(p), 50.0);
    }
  }
};

BoxScene small_scene() {
  BoxScene scene;
  scene.extent = {48, 28};
  return scene;
}

// Returns a scene in which all rays are above the horizon. The volume ends at the planet, while brute force would march
// on to a surface below it.
BoxScene view_of_the_sky() {
  BoxScene scene = small_scene();
  scene.pitch_deg = 26.0;
  return scene;
}

TEST_F(Froxels, EverySliceIsLikeBruteForce) {
  TestFrame frame = frame_of(view_of_the_sky());
  frame.background = Vec3(0.3F);
  for (const bool integrated : {true, false}) {
    Params params = params_for(frame.extent);
    params.scattering.single = integrated ? SingleScattering::integration : SingleScattering::table;
    params.scattering.multiple = integrated ? MultipleScattering::occluded : MultipleScattering::unoccluded;
    for (const std::uint32_t slice : {3U, 17U, 31U}) {
      expect_slice((integrated ? "integrated, slice " : "from tables, slice ") + std::to_string(slice), frame, params,
                   slice);
    }
  }
  Params params = params_for(frame.extent);
  params.scattering.sections = LitSections::each;
  expect_slice("each section", frame, params, 25);
  params.scattering.medium = MediumKind::homogeneous;
  expect_slice("homogeneous medium", frame, params, 25);
  params = params_for(frame.extent);
  params.scattering.light_shafts = false;
  expect_slice("without shafts", frame, params, 25);
  frame.first_marched = 1;
  expect_slice("from the second cascade", frame, params_for(frame.extent), 25);
}

TEST_F(Froxels, PictureIsLikeBruteForce) {
  for (const double sun_elevation_deg : {9.0, 40.0, -3.0}) {
    BoxScene scene = small_scene();
    scene.extent = {96, 54};
    scene.sun.elevation_deg = sun_elevation_deg;
    show(scene);
    Params params = params_for(scene.extent);
    params.scattering.only = false;
    params.froxels.slices = 64;
    expect_alike("own resolution, sun at " + std::to_string(sun_elevation_deg), composed(params), 40.0);
  }
  // Beyond a short volume, the light has no shadows; the sky has none in any case.
  BoxScene scene = small_scene();
  scene.cascades = 0;
  show(scene);
  Params params = composed(params_for(scene.extent));
  params.froxels.far_m = 3000.0F;
  for (const SingleScattering single : {SingleScattering::integration, SingleScattering::table}) {
    params.scattering.single = single;
    expect_alike("short volume", params, 50.0);
  }
  params.scattering.medium = MediumKind::homogeneous;
  expect_alike("short volume of a homogeneous medium", params, 50.0);
}

// Returns a query of the volume at a distance for each pixel.
std::vector<Query> queries_at(const VkExtent2D& extent, double distance) {
  std::vector<Query> queries;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      queries.push_back(query(froxel, {(x + 0.5) / extent.width, (y + 0.5) / extent.height, distance}, {}));
    }
  }
  return queries;
}

TEST_F(Froxels, EnginesReadThemBesideAnyTechnique) {
  TestFrame frame = frame_of(view_of_the_sky());
  frame.irradiance = Vec3(2.0F, 3.0F, 4.0F);
  show(frame);
  Params params = params_for(frame.extent);
  params.scattering.light_shafts = false;
  draw(params, "epipolar with a volume");
  AtmosphereInputs inputs;
  inputs.sun.irradiance = frame.irradiance;
  const double distance = distance_of(params.froxels, 20);
  const std::vector<Query> queries = queries_at(frame.extent, distance);
  EXPECT_EQ(atmosphere_images(effect()).count, 6U);
  EXPECT_EQ(atmosphere_images(effect(), 1).count, 4U);  // there is one view
  const std::vector<Answer> looked_up = evaluate_points(host(), effect(), params, inputs, queries);
  frame.distance_m = [distance](std::uint32_t, std::uint32_t) { return distance; };
  show(frame);
  const Picture light = draw(by_brute_force(params), "brute force", true);
  for (std::size_t i = 0; i < light.size(); ++i) {
    ASSERT_LE(relative_error(looked_up[i].light, light[i]), 0.003) << "column " << i;
    const RayAngles ray = frame.ray(i % frame.extent.width, i / frame.extent.width, 6360000.0);
    const glm::dvec3 transmittance = true_transmittance(params, ray, distance);
    ASSERT_LE(relative_error(looked_up[i].transmittance, transmittance), 0.003) << "column " << i;
  }
  // Without the medium, the volume is empty.
  Params off = params;
  off.scattering.enabled = false;
  draw(off, "without the medium", true);
  for (const Answer& answer : evaluate_points(host(), effect(), off, inputs, queries)) {
    ASSERT_EQ(answer.light, glm::dvec3(0.0));
    ASSERT_EQ(answer.transmittance, glm::dvec3(1.0));
  }
}

// The light in the volume of a homogeneous medium, with the colour of the sunlight that arrives there.
TEST_F(Froxels, EnginesReadAMediumWithColouredSunlight) {
  TestFrame frame = frame_of(view_of_the_sky());
  show(frame);
  Params params = params_for(frame.extent);
  params.scattering.light_shafts = false;
  params.scattering.medium = MediumKind::homogeneous;
  params.homogeneous_medium.sunlight = {0.5F, 0.25F, 0.125F};
  draw(params, "homogeneous medium with a volume");
  AtmosphereInputs inputs;
  inputs.sun.irradiance = frame.irradiance;
  const double distance = distance_of(params.froxels, 20);
  const std::vector<Query> queries = queries_at(frame.extent, distance);
  const std::vector<Answer> looked_up = evaluate_points(host(), effect(), params, inputs, queries);
  frame.distance_m = [distance](std::uint32_t, std::uint32_t) { return distance; };
  show(frame);
  const Picture light = draw(by_brute_force(params), "brute force", true);
  for (std::size_t i = 0; i < light.size(); ++i) {
    ASSERT_GT(light[i].x, 0.0);
    ASSERT_LE(relative_error(looked_up[i].light, light[i]), 0.003) << "column " << i;
  }
}

TEST_F(Froxels, MemoryFollowsTheirSize) {
  show(small_scene());
  Params params = small_params();
  const auto memory_of = [&](const Params& p) {
    EXPECT_OK(effect().set_params(p));
    // Old images are freed when no frame can use them any more.
    for (int frame = 0; frame < 8; ++frame) draw(p, "frame", true);
    const Result<MemoryUsage> planned = query_memory(info(), desc(), p);
    EXPECT_OK(planned);
    EXPECT_EQ(planned.value().persistent, effect().memory().persistent);
    EXPECT_EQ(effect().memory().transient, 0U);
    VkDeviceSize sum = 0;
    for (const ResourceMemory& resource : effect().resources()) sum += resource.bytes;
    EXPECT_EQ(sum, effect().memory().persistent);
    return planned.value().persistent;
  };
  const VkDeviceSize without = memory_of(params);
  params.froxels.enabled = true;
  params.froxels.columns = 64;
  params.froxels.rows = 32;
  params.froxels.slices = 16;
  EXPECT_GE(memory_of(params), without + 2U * 64 * 32 * 16 * 8);
  params.froxels.enabled = false;
  EXPECT_EQ(memory_of(params), without);
}

}  // namespace
}  // namespace tyndall
