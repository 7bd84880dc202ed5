// Drivers end a dispatch that takes too long. The steps of tables are therefore bounded whatever the size of the
// tables, and those of brute force for pictures of up to 4 million pixels.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <utility>

#include "effect/frame_steps.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"

namespace tyndall {
namespace {

TEST(StepBounds, BruteForceIsDividedIntoBandsOfRows) {
  Params params;
  params.scattering.technique = Technique::brute_force;
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {64, 63}, {1280, 720}, {3840, 2160}, {16384, 16384}, {3, 16384}}) {
    std::uint32_t next_row = 0;
    const FrameSteps steps = frame_steps({}, params, {extent, 4, 1, false});
    for (const Step& step : steps) {
      EXPECT_EQ(step.push[0], next_row);
      EXPECT_EQ(step.invocations.width, extent.width);
      EXPECT_TRUE(step.invocations.height % 8 == 0 || next_row + step.invocations.height == extent.height);
      if (extent.width * extent.height <= 32 * 131072) {
        EXPECT_LE(step.invocations.width * step.invocations.height, 131072U + 7U * extent.width);
      }
      next_row += step.invocations.height;
    }
    EXPECT_EQ(next_row, extent.height);
    EXPECT_LE(steps.size(), 32U);
  }
}

TEST(StepBounds, TablesOfAnySizeAreBuiltInSmallSteps) {
  constexpr std::uint64_t kMaxInvocations = 131072;
  for (const UVec4 size :
       {UVec4{32, 128, 64, 16}, {4, 4096, 64, 64}, {4, 4, 4096, 4096}, {5, 6, 7, 9}, {4, 256, 65, 5}}) {
    Params params;
    params.tables.size = size;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> next_row;
    for (const Step& step : table_steps(params, kAllTables)) {
      const std::uint32_t* const local = step.pipeline.shader->local_size;
      const auto padded = [](std::uint32_t n, std::uint32_t group) {
        return std::uint64_t{(n + group - 1) / group} * group;
      };
      const VkExtent3D& n = step.invocations;
      EXPECT_LE(padded(n.width, local[0]) * padded(n.height, local[1]) * padded(n.depth, local[2]), kMaxInvocations)
          << step.name;
      const std::string name = step.name;
      if (name != "table_single" && name != "table_high") continue;
      std::uint32_t& next = next_row[{name, step.push[0]}];
      EXPECT_EQ(step.push[1], next);
      next += n.height;
    }
    // Each row has all suns of four angles of one view.
    EXPECT_EQ(next_row.size(), 2 * size.x);
    for (const auto& [step, rows] : next_row) EXPECT_EQ(rows, size.y * ((size.w + 3) / 4)) << step.first;
  }
}

// The froxel volume has an invocation for each column, before the passes that draw the picture but after those that
// need no shadows. The default size is one dispatch.
TEST(StepBounds, FroxelsAreShortDispatchesOfColumns) {
  Params params;
  params.froxels.enabled = true;
  for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
    params.scattering.technique = technique;
    const FrameSteps steps = frame_steps({}, params, {{640, 360}, 4, 1, false});
    const Step& step = steps.of(FramePart::second).front();
    EXPECT_STREQ(step.name, "froxels");
    EXPECT_EQ(step.invocations.width, 160U);
    EXPECT_EQ(step.invocations.height, 90U);
    EXPECT_EQ(step.push[1], 0U);
    EXPECT_EQ(steps.size() == 2 && std::string((steps.end() - 1)->name) == "compose_froxels",
              technique == Technique::froxels);
  }
  params.scattering.enabled = false;
  EXPECT_EQ(frame_steps({}, params, {}).begin()->push[1], 1U);  // fills the volume without the medium
  for (const auto& [columns, rows, slices] :
       {std::array{512U, 512U, 256U}, std::array{8U, 512U, 4U}, std::array{500U, 333U, 255U}}) {
    params.froxels.columns = columns;
    params.froxels.rows = rows;
    params.froxels.slices = slices;
    std::uint32_t next = 0;
    for (const Step& step : frame_steps({}, params, {{640, 360}, 4, 1, false})) {
      if (std::string(step.name) != "froxels") continue;
      EXPECT_EQ(step.push[0], next);
      EXPECT_EQ(step.invocations.width, columns);
      EXPECT_LE(step.invocations.width * step.invocations.height * slices, 512U * 64 * 256);
      next += step.invocations.height;
    }
    EXPECT_EQ(next, rows);
  }
}

}  // namespace
}  // namespace tyndall
