#include "viewer/scenes/settings_compare.hpp"

#include <algorithm>
#include <cstring>

#include "files/text.hpp"

namespace tyndall::viewer {
namespace {

const std::byte* at(const config::Row& row, const config::Settings& settings) {
  const auto* base = row.owner == config::Owner::effect ? reinterpret_cast<const std::byte*>(&settings.effect)
                                                        : reinterpret_cast<const std::byte*>(&settings.scene);
  return base + row.info.offset;
}

}  // namespace

bool same_value(const config::Row& row, const config::Settings& a, const config::Settings& b) {
  if (row.info.type == ParamType::string) {
    return *reinterpret_cast<const std::string*>(at(row, a)) == *reinterpret_cast<const std::string*>(at(row, b));
  }
  const std::size_t size = row.info.type == ParamType::dvec3 ? sizeof(double) : sizeof(float);
  return std::memcmp(at(row, a), at(row, b), size * config::component_count(row.info.type)) == 0;
}

bool same_settings(const config::Settings& a, const config::Settings& b) {
  return std::all_of(config::rows().begin(), config::rows().end(),
                     [&](const config::Row& row) { return same_value(row, a, b); });
}

bool same_but_for_tone(const config::Settings& a, const config::Settings& b) {
  return std::all_of(config::rows().begin(), config::rows().end(),
                     [&](const config::Row& row) { return row.info.group == "tonemap" || same_value(row, a, b); });
}

void go_back(config::Settings& settings, const config::Settings& requested, const config::Settings& current) {
  for (const config::Row& row : config::rows()) {
    if (same_value(row, requested, current) || !same_value(row, settings, requested)) continue;
    (void)config::set(settings, row.key(), config::value_text(row, current),
                      row.key());  // cannot fail: it was set before
  }
}

void make_consistent(config::Settings& settings) {
  scene::ShadowParams& shadows = settings.scene.shadows;
  shadows.first_marched = std::min(shadows.first_marched, shadows.cascades - 1);
}

}  // namespace tyndall::viewer
