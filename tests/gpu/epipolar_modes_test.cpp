// Epipolar sampling in every mode against brute force with the same frame, shadow maps and exposure. Each case has a
// minimum PSNR, about 3 dB below its value or 40 dB if it reaches that. No pixel may be black, negative or not finite.
// Also tests counters, marks and corrections, and changes of parameters between frames in flight.
#include <algorithm>
#include <cmath>
#include <functional>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

using Epipolar = SharedEffect;

const char* name_of(SingleScattering s) {
  return s == SingleScattering::none ? "none" : s == SingleScattering::integration ? "integration" : "table";
}
const char* name_of(MultipleScattering m) {
  return m == MultipleScattering::none ? "none" : m == MultipleScattering::occluded ? "occluded" : "unoccluded";
}

TEST_F(Epipolar, EveryModeIsLikeBruteForce) {
  BoxScene scene;
  scene.extent = {128, 72};
  show(scene);
  for (const SingleScattering single :
       {SingleScattering::none, SingleScattering::integration, SingleScattering::table}) {
    for (const MultipleScattering multiple :
         {MultipleScattering::none, MultipleScattering::occluded, MultipleScattering::unoccluded}) {
      for (const bool shafts : {true, false}) {
        for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
          const bool tables_lit = single == SingleScattering::table || multiple == MultipleScattering::occluded;
          if (sections == LitSections::each && !(shafts && tables_lit)) continue;  // the same as contiguous
          Params params = small_params();
          params.scattering.single = single;
          params.scattering.multiple = multiple;
          params.scattering.light_shafts = shafts;
          params.scattering.sections = sections;
          expect_alike(std::string("single ") + name_of(single) + ", multiple " + name_of(multiple) +
                           (shafts ? ", shafts" : "") + (sections == LitSections::each ? ", each" : ""),
                       params, 40.0);
        }
      }
    }
  }
  // Vary the other parameters, with the strongest shafts.
  const auto with = [&](const char* name, const std::function<void(Params&)>& change, double floor_db) {
    Params params = small_params();
    params.scattering.single = SingleScattering::integration;
    change(params);
    expect_alike(name, params, floor_db);
  };
  with(
      "extinction per pixel", [](Params& p) { p.scattering.extinction = Extinction::per_pixel; }, 42.0);
  with(
      "refinement by depth", [](Params& p) { p.epipolar.refinement = Refinement::depth; }, 43.0);
  with(
      "correct_depth_breaks", [](Params& p) { p.epipolar.correct_depth_breaks = true; }, 41.0);
  with(
      "samples not optimised", [](Params& p) { p.epipolar.optimize_locations = false; }, 43.0);
  with(
      "initial_step 1", [](Params& p) { p.epipolar.initial_step = 1; }, 45.0);
  with(
      "initial_step 256", [](Params& p) { p.epipolar.initial_step = 256; }, 43.0);
  with(
      "epipole_density 32", [](Params& p) { p.epipolar.epipole_density = 32; }, 42.0);
  with(
      "threshold 0.001", [](Params& p) { p.epipolar.refinement_threshold = 0.001F; }, 43.0);
  with(
      "threshold 0.5", [](Params& p) { p.epipolar.refinement_threshold = 0.5F; }, 31.0);
  with(
      "light alone", [](Params& p) { p.scattering.only = true; }, 40.0);
}

TEST_F(Epipolar, TreesFormatsAndOrderOfCascadesChangeNothing) {
  for (const bool reached : {true, false}) {
    BoxScene scene;
    // One map extends beyond the capacity of the trees, the other fits.
    scene.shadow_resolution = reached ? 512 : 1024;
    scene.pitch_deg = reached ? 3.0 : 12.0;
    show(scene);
    for (const bool integrated : {true, false}) {
      Params base = small_params();
      base.scattering.single = integrated ? SingleScattering::integration : SingleScattering::table;
      base.scattering.multiple = MultipleScattering::occluded;
      base.scattering.sections = integrated ? LitSections::each : LitSections::contiguous;
      const std::string where = std::string(integrated ? "integrated" : "tables") + (reached ? "" : ", larger map");
      const Picture picture = draw(base, where);
      // Trees only skip reads of the maps. Every comparison that remains is made at the same place and depth, bit by
      // bit, because all pipelines compute them with one `precise` function, and trees allow for the rounding errors of
      // any Vulkan device. With and without a tree, only the lengths of lit sections are added in other groups, which
      // gave the same stored halves here. Another order of cascades, or another device, may change the square root of a
      // mean source function by one step of half precision, and so the radiance of a pixel by twice that.
      constexpr double kStep = 2.0 / 1024.0;
      const auto same = [&](const char* name, const std::function<void(Params&)>& change) {
        Params params = base;
        change(params);
        const Likeness likeness = compare(draw(params, where + ", " + name), picture, frame().extent);
        const bool ordered = params.shadows.cascade_processing == base.shadows.cascade_processing;
        EXPECT_LE(likeness.worst_relative_error, ordered ? 0.0 : kStep) << where << ", " << name;
        RecordProperty("worst: " + where + ", " + name, std::to_string(likeness.worst_relative_error));
      };
      same("no tree", [](Params& p) { p.epipolar.min_max_tree = false; });
      same("float32", [](Params& p) { p.epipolar.min_max_format = MinMaxFormat::float32; });
      same("multi-pass", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass; });
      same("instanced", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced; });
      same("instanced without tree", [](Params& p) {
        p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
        p.epipolar.min_max_tree = false;
      });
    }
  }
}

// Rays cross many more texels of a map that is much smaller than what its cascade covers than a device may read in one
// invocation, nearly all of them outside the map.
TEST_F(Epipolar, SmallMapsOfLongCascadesLeaveNoPixelBlack) {
  constexpr float kSmaller = 2000.0F;
  BoxScene scene;
  scene.extent = {32, 18};
  scene.pitch_deg = 20.0;
  TestFrame frame = frame_of(scene);
  for (Cascade& cascade : frame.cascades) {
    float* const m = cascade.shadow_from_world.m;
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 4; ++column) m[4 * column + row] *= kSmaller;
      m[12 + row] += 0.5F * (1.0F - kSmaller);
    }
  }
  show(frame);
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
      Params params = small_params();
      params.scattering.medium = medium;
      params.scattering.multiple = MultipleScattering::occluded;
      params.scattering.sections = sections;
      expect_alike("small maps", params, 40.0);
    }
  }
}

TEST_F(Epipolar, CountersReportTheWork) {
  BoxScene scene;
  scene.shadow_resolution = 512;
  show(scene);
  const std::uint64_t pixels = std::uint64_t{scene.extent.width} * scene.extent.height;
  Params params = small_params();
  draw(by_brute_force(params), "brute force");
  const Counters brute = counters();
  EXPECT_EQ(brute.samples_marched, pixels);
  EXPECT_GT(brute.march_steps, pixels);
  EXPECT_GT(brute.shadow_map_fetches, pixels);
  EXPECT_EQ(brute.tree_nodes_visited, 0U);
  EXPECT_EQ(brute.pixels_corrected, 0U);

  // March all samples, so that the counters do not depend on refinement.
  params.epipolar.initial_step = 1;
  draw(params, "tree");
  const Counters tree = counters();
  EXPECT_GT(tree.samples_marched, 0U);
  EXPECT_LE(tree.samples_marched, std::uint64_t{params.epipolar.slices} * params.epipolar.samples);
  EXPECT_GT(tree.tree_nodes_visited, tree.samples_marched);
  EXPECT_GT(tree.pixels_corrected, 0U);
  EXPECT_LT(tree.pixels_corrected, pixels / 20);
  params.epipolar.min_max_tree = false;
  draw(params, "no tree");
  const Counters texels = counters();
  EXPECT_EQ(texels.samples_marched, tree.samples_marched);
  EXPECT_EQ(texels.tree_nodes_visited, 0U);
  EXPECT_GT(texels.shadow_map_fetches, 5 * tree.shadow_map_fetches);
  EXPECT_LT(texels.shadow_map_fetches, brute.shadow_map_fetches);
  RecordProperty("fetches", std::to_string(brute.shadow_map_fetches) + " " + std::to_string(texels.shadow_map_fetches) +
                                " " + std::to_string(tree.shadow_map_fetches));

  // The number of rays does not depend on the order of the cascades.
  params.epipolar.min_max_tree = true;
  for (const CascadeProcessing processing : {CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
    params.shadows.cascade_processing = processing;
    draw(params, "in several passes");
    EXPECT_EQ(counters().samples_marched, tree.samples_marched);
    EXPECT_EQ(counters().shadow_map_fetches, tree.shadow_map_fetches);
  }
  // Without shafts nothing is fetched.
  params = small_params();
  params.scattering.light_shafts = false;
  draw(params, "no shafts");
  EXPECT_EQ(counters().shadow_map_fetches, 0U);
  EXPECT_EQ(counters().tree_nodes_visited, 0U);
  EXPECT_GT(counters().samples_marched, 0U);
}

// Trees are built as far as the rays of marched samples reach. Rays of corrected pixels may be longer.
TEST_F(Epipolar, RaysContinueWhereTreesEnd) {
  BoxScene scene;
  scene.pitch_deg = 0.0;
  scene.sun.elevation_deg = 25.0;
  scene.sun.azimuth_deg = 60.0;
  scene.shadow_resolution = 512;
  show(scene);
  Params params = small_params();
  params.scattering.single = SingleScattering::integration;
  params.epipolar.slices = 512;
  params.epipolar.samples = 32;
  params.epipolar.initial_step = 256;
  params.epipolar.refinement_threshold = 0.1F;
  params.epipolar.correct_depth_breaks = true;
  const Picture with_tree = draw(params, "tree");
  EXPECT_GT(counters().pixels_corrected, 50U);
  params.epipolar.min_max_tree = false;
  constexpr double kSums = 1e-6;  // rounding of sums of the same lengths, divided differently
  EXPECT_LE(compare(draw(params, "no tree"), with_tree, scene.extent).worst_relative_error, kSums);
}

TEST_F(Epipolar, DepthBreaksAreCorrectedAndMarked) {
  BoxScene scene;
  show(scene);
  Params params = small_params();
  params.scattering.single = SingleScattering::integration;
  // With few samples, many pixels at silhouettes have no sample at their depth.
  params.epipolar.slices = 512;
  params.epipolar.samples = 32;
  const Picture reference = draw(by_brute_force(params), "brute force");
  const Picture plain = draw(params, "those unlike all samples");
  const std::uint64_t fewest = counters().pixels_corrected;
  EXPECT_GT(fewest, 20U);
  params.epipolar.correct_depth_breaks = true;
  const Picture corrected = draw(params, "those unlike most samples");
  const std::uint64_t count = counters().pixels_corrected;
  EXPECT_GT(count, fewest);
  EXPECT_LT(count, plain.size() / 4);
  params.epipolar.show_depth_breaks = true;
  const Picture marked = draw(params, "marked");
  EXPECT_EQ(counters().pixels_corrected, count);
  const auto is_mark = [](const glm::dvec3& p) { return p.x == 0.0 && p.z == 0.0 && p.y > 0.0; };
  params.epipolar.correct_depth_breaks = false;
  const Picture fewest_marked = draw(params, "marked, those unlike all samples");
  EXPECT_EQ(counters().pixels_corrected, fewest);

  std::uint64_t green = 0;
  double unlike_all = 0.0;  // mean error of pixels whose depth differs from all their samples
  double before = 0.0;      // mean error, before the correction, of pixels that are corrected only with the parameter
  double after = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (is_mark(fewest_marked[i])) {
      EXPECT_TRUE(is_mark(marked[i])) << i;
      EXPECT_EQ(plain[i], corrected[i]) << i;
    }
    if (!is_mark(marked[i])) {
      // Pixels without a mark are unchanged.
      EXPECT_EQ(marked[i], plain[i]) << i;
      EXPECT_EQ(corrected[i], plain[i]) << i;
      continue;
    }
    ++green;
    const bool always = is_mark(fewest_marked[i]);
    const double error = glm::length(corrected[i] - reference[i]) / glm::length(reference[i]);
    (always ? unlike_all : after) += error / static_cast<double>(always ? fewest : count - fewest);
    if (!always)
      before += glm::length(plain[i] - reference[i]) / glm::length(reference[i]) / static_cast<double>(count - fewest);
    // A pixel at a silhouette has a neighbour at another depth.
    const auto x = static_cast<std::uint32_t>(i % scene.extent.width);
    const auto y = static_cast<std::uint32_t>(i / scene.extent.width);
    const auto depth = [&](std::uint32_t px, std::uint32_t py) {
      const double d = frame().distance_m(px, py);
      return d > 0.0 ? d : 1e9;
    };
    bool edge = false;
    for (int dy = -4; dy <= 4; ++dy) {
      for (int dx = -4; dx <= 4; ++dx) {
        const auto px =
            std::min(x + static_cast<std::uint32_t>(std::max(dx, -static_cast<int>(x))), scene.extent.width - 1);
        const auto py =
            std::min(y + static_cast<std::uint32_t>(std::max(dy, -static_cast<int>(y))), scene.extent.height - 1);
        edge = edge || std::abs(depth(px, py) / depth(x, y) - 1.0) > 0.03;
      }
    }
    EXPECT_TRUE(edge) << x << " " << y;
  }
  EXPECT_EQ(green, count);
  RecordProperty("corrected", std::to_string(fewest) + " and " + std::to_string(count) + " pixels, mean error " +
                                  std::to_string(unlike_all) + ", " + std::to_string(before) + " to " +
                                  std::to_string(after));
  EXPECT_LT(unlike_all, 0.02);
  EXPECT_LT(after, 0.02);
  EXPECT_LT(after, before);
}

TEST_F(Epipolar, SamplesAreShown) {
  BoxScene scene;
  scene.sun.in_view = true;
  scene.sun.x = 0.2;
  scene.sun.y = -0.4;
  scene.pitch_deg = 8.0;
  show(scene);
  Params params = small_params();
  const Picture plain = draw(params, "plain");
  params.epipolar.show_sampling = true;
  const Picture shown = draw(params, "shown");
  std::size_t bright = 0;
  std::size_t dark = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (shown[i] == plain[i]) continue;
    // Marks are pure red.
    EXPECT_GT(shown[i].x, 0.0);
    EXPECT_EQ(shown[i].y, 0.0);
    EXPECT_EQ(shown[i].z, 0.0);
    (shown[i].x > 0.5 ? bright : dark) += 1;
  }
  EXPECT_GT(bright, 50U);
  EXPECT_GT(dark, 50U);
  // The samples closest to the sun and those at the border are marched.
  const std::uint32_t sun_x = 96;
  const std::uint32_t sun_y = 27;
  EXPECT_GT(shown[sun_y * frame().extent.width + sun_x].x, 0.5);
  // If every sample is marched, all marks are bright.
  params.epipolar.initial_step = 1;
  const Picture all = draw(params, "all marched");
  params.epipolar.show_sampling = false;
  const Picture all_plain = draw(params, "all marched, not shown");
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_TRUE(all[i] == all_plain[i] || all[i].x > 0.5) << i;
}

TEST_F(Epipolar, ParametersChangeWhileFramesAreInFlight) {
  const EffectDesc description = desc();
  ASSERT_EQ(description.frames_in_flight, 3U);
  BoxScene scene;
  scene.extent = {48, 27};
  show(scene);
  std::vector<Params> changes;
  const auto add = [&](const std::function<void(Params&)>& change) {
    Params params = small_params();
    change(params);
    changes.push_back(params);
  };
  add([](Params&) {});
  add([](Params& p) { p.epipolar.slices = 32; });
  add([](Params& p) { p.scattering.technique = Technique::brute_force; });
  add([](Params& p) { p.epipolar.min_max_format = MinMaxFormat::float32; });
  add([](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass; });
  add([](Params& p) { p.epipolar.samples = 200; });
  add([](Params& p) { p.epipolar.min_max_tree = false; });
  add([](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced; });
  add([](Params& p) { p.epipolar.correct_depth_breaks = true; });
  add([](Params& p) { p.scattering.enabled = false; });
  add([](Params&) {});
  // Draw each frame alone, for comparison.
  std::vector<Picture> alone;
  for (const Params& params : changes) alone.push_back(draw(params, "alone"));
  bool allocated = false;
  // One submission contains as many frames as may be in flight, with different parameters. The output is the picture of
  // the last one.
  std::uint64_t index = 0;
  for (std::size_t first = 0; first < changes.size(); ++first) {
    const std::size_t last = std::min(first + 2, changes.size() - 1);
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      for (std::size_t i = first; i <= last; ++i) {
        FrameInputs inputs = images().inputs(frame());
        inputs.frame_index = index++;
        gpu::compute_barrier(host().device(), cmd);  // the previous frame wrote the same output
        const Result<void> taken = effect().set_params(changes[i]);
        if (!taken.ok()) return taken.error();
        const Result<void> recorded = effect().record(cmd, inputs);
        if (!recorded.ok()) return recorded.error();
        const Result<MemoryUsage> expected = query_memory(info(), description, changes[i]);
        if (!expected.ok()) return expected.error();
        EXPECT_EQ(effect().memory().persistent, expected.value().persistent) << i;
        allocated = allocated || effect().memory().transient > 0;
      }
      return {};
    }));
    const Result<Picture> output = images().output(host());
    ASSERT_OK(output);
    EXPECT_EQ(output.value(), alone[last]) << first;
  }
  // Replaced buffers are freed once no frame can use them any more.
  EXPECT_TRUE(allocated);
  for (int i = 0; i < 5; ++i) draw(changes.back(), "again");
  EXPECT_EQ(effect().memory().transient, 0U);
}

}  // namespace
}  // namespace tyndall
