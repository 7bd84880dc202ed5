// The declarations of parameters (Affects) agree with the consequences of a change: the pipelines and buffers of the
// lists of steps, the tables, and in the demo scene the terrain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "effect/frame_steps.hpp"
#include "effect/froxel_volume.hpp"
#include "effect/tables.hpp"
#include "scene/description/terrain_key.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall {
namespace {

// Returns values of a parameter: every choice, or numbers from all over its range.
std::vector<std::vector<std::uint32_t>> values_of(const ParamInfo& info) {
  const auto words = [](auto... values) {
    std::vector<std::uint32_t> out;
    for (const auto value : {values...}) {
      std::uint32_t word = 0;
      std::memcpy(&word, &value, sizeof word);
      out.push_back(word);
    }
    return out;
  };
  std::vector<std::vector<std::uint32_t>> out;
  const auto low = static_cast<float>(info.min), high = static_cast<float>(info.max);
  switch (info.type) {
    case ParamType::enumeration:
      for (std::uint32_t i = 0; i <= std::count(info.choices.begin(), info.choices.end(), '|'); ++i)
        out.push_back(words(i));
      break;
    case ParamType::flag: return {words(0U), words(1U)};
    case ParamType::uint32:
      if (info.name == "downscale") return {words(1U), words(2U), words(4U)};
      for (const double part : {0.0, 0.1, 0.3, 1.0})
        out.push_back(words(static_cast<std::uint32_t>(info.min + part * (info.max - info.min))));
      break;
    case ParamType::float32:
      if (info.name == "visibility_m") return {words(low), words(5000.0F)};  // at most that of clear air
      return {words(low), words(0.7F * low + 0.3F * high), words(high)};
    case ParamType::vec3: return {words(low, high, low), words(high, high, high)};
    case ParamType::uvec4: return {words(8U, 16U, 16U, 8U), words(16U, 8U, 16U, 8U)};
    default: break;
  }
  return out;
}

// Returns settings in which different parameters matter.
std::vector<Params> settings() {
  std::vector<Params> out(9);
  out[1].scattering.single = SingleScattering::integration;
  out[1].scattering.multiple = MultipleScattering::occluded;
  out[2].scattering.medium = MediumKind::homogeneous;
  out[3].scattering.technique = Technique::brute_force;
  out[4].scattering.downscale = 2;
  out[4].epipolar.correct_depth_breaks = true;
  out[5].scattering.light_shafts = false;
  out[5].epipolar.min_max_tree = false;
  out[6].atmosphere.custom_coefficients = true;
  out[6].scattering.single = SingleScattering::none;
  out[6].scattering.multiple = MultipleScattering::occluded;
  out[6].epipolar.slices = 100;
  out[7].froxels.enabled = true;
  out[8].atmosphere.mie_phase = MiePhase::draine;
  const double angles[] = {0.0, 90.0, 180.0}, nm[] = {550.0}, isotropic[] = {1.0, 1.0, 1.0};
  for (Params& params : out) params.phase_table = PhaseTable::create(angles, nm, isotropic).value();
  return out;
}

struct Requirement {
  bool pipelines = false, buffers = false, tables = false;
};

// Returns everything that a change of this parameter may require. Pipelines that exist already are not counted.
Requirement requirement_of(const ParamInfo& info) {
  EffectDesc desc;
  desc.shadow_colors = true;
  Requirement out;
  for (const Params& base : settings()) {
    const std::vector<PipelineKey> made = pipelines_of_frames(desc, base);
    for (const std::vector<std::uint32_t>& words : values_of(info)) {
      Params changed = base;
      std::memcpy(reinterpret_cast<char*>(&changed) + info.offset, words.data(), 4 * words.size());
      EXPECT_TRUE(check_params(changed).ok()) << info.group << "." << info.name;
      for (const PipelineKey& key : pipelines_of_frames(desc, changed))
        out.pipelines = out.pipelines || std::find(made.begin(), made.end(), key) == made.end();
      out.buffers = out.buffers || frame_buffer_sizes(desc, base).bytes != frame_buffer_sizes(desc, changed).bytes;
      const VkExtent3D volume = froxel_extent(base);
      const VkExtent3D other = froxel_extent(changed);
      out.buffers =
          out.buffers || volume.width != other.width || volume.height != other.height || volume.depth != other.depth;
      out.tables = out.tables || stale_tables(base, changed) != 0;
    }
  }
  return out;
}

TEST(ParamAffects, AgreesWithTheStepsAndTheTables) {
  for (const ParamInfo& info : param_table()) {
    const Requirement needs = requirement_of(info);
    const bool others = needs.buffers || needs.pipelines;
    const Affects expected = needs.tables && others ? Affects::Everything
                             : needs.tables         ? Affects::Tables
                             : needs.buffers        ? Affects::Resources
                             : needs.pipelines      ? Affects::Pipeline
                                                    : Affects::Frame;
    EXPECT_EQ(static_cast<int>(info.affects), static_cast<int>(expected)) << info.group << "." << info.name;
  }
}

// The terrain is reloaded if the planet's radius or a parameter of its group that declares so has changed.
TEST(ParamAffects, TerrainIsStaleWhenItsKeyChanges) {
  using scene::SceneParams;
  const auto group = [](const SceneParams& p) { return scene::terrain_key(p.terrain, {}); };
  std::size_t rows = 0;
  for (const ParamInfo& info : scene::scene_param_table()) {
    if (info.group != "terrain") continue;
    ++rows;
    SceneParams before, after;
    char* const value = reinterpret_cast<char*>(&after) + info.offset;
    if (info.type == ParamType::string) {
      *reinterpret_cast<std::string*>(value) = "other";
    } else {
      ++*value;
    }
    const bool stale = group(before) != group(after);
    EXPECT_EQ(stale, info.affects == Affects::Resources) << info.name;
    EXPECT_TRUE(scene::differs(before, after, "terrain", info.affects)) << info.name;
    EXPECT_FALSE(scene::differs(before, after, "shadows", info.affects)) << info.name;
    EXPECT_FALSE(scene::differs(before, after, "terrain", Affects::Tables)) << info.name;
  }
  EXPECT_EQ(rows, 5U);
}

}  // namespace
}  // namespace tyndall
