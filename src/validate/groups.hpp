// The groups of rays that form the rows of a report's tables.
#pragma once

#include <string>
#include <vector>

#include "validate/study.hpp"

namespace tyndall::validate {

struct Group {
  const char* sun;
  const char* region;
  bool (*takes)(const TestRay& ray);
};

constexpr Group kGroups[] = {
    {"up", "ground", [](const TestRay& r) { return r.band == SunBand::up && r.region == Region::ground; }},
    {"up", "air", [](const TestRay& r) { return r.band == SunBand::up && r.region == Region::air; }},
    {"up", "space", [](const TestRay& r) { return r.band == SunBand::up && r.region == Region::space; }},
    {"up", "all", [](const TestRay& r) { return r.band == SunBand::up; }},
    {"0 to -6 deg", "ground",
     [](const TestRay& r) { return r.band == SunBand::twilight && r.region == Region::ground; }},
    {"0 to -6 deg", "air", [](const TestRay& r) { return r.band == SunBand::twilight && r.region == Region::air; }},
    {"0 to -6 deg", "space", [](const TestRay& r) { return r.band == SunBand::twilight && r.region == Region::space; }},
    {"0 to -6 deg", "all", [](const TestRay& r) { return r.band == SunBand::twilight; }},
};

// A group of rays of the turbid set.
struct TurbidGroup {
  const char* sun;
  bool (*takes)(const TestRay& ray);
};
constexpr TurbidGroup kTurbidGroups[] = {
    {"0.5 to 10 deg", [](const TestRay& r) { return r.band == SunBand::up; }},
    {"0 to -6 deg", [](const TestRay& r) { return r.band == SunBand::twilight; }},
};

// A row of the tables of the turbid set: one of its atmospheres, or all of them together.
struct TurbidRow {
  std::string optical_depth, ground_albedo;  // numbers or "all"
  const char* sun;
  ErrorSummary errors;
};
[[nodiscard]] std::vector<TurbidRow> turbid_rows(const Study& study, std::size_t model);

struct SkyBand {
  const char* sun;
  double low_deg, high_deg;
};
constexpr SkyBand kSkyBands[] = {{"up", 0.001, 90.0}, {"0 to -6 deg", -6.0, 0.0}};

}  // namespace tyndall::validate
