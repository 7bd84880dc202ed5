// The rows of the tables of the turbid set.
#include "validate/groups.hpp"

#include "validate/plot.hpp"

namespace tyndall::validate {

std::vector<TurbidRow> turbid_rows(const Study& study, std::size_t model) {
  std::vector<TurbidRow> rows;
  for (std::size_t a = 0; a < study.turbid.size(); ++a) {
    const TurbidAir& air = kTurbidAirs[a];
    for (const TurbidGroup& group : kTurbidGroups) {
      rows.push_back({fixed(air.optical_depth, 2), fixed(air.ground_albedo, 1), group.sun,
                      summarise_turbid(study, model, a, 1, group.takes)});
    }
  }
  for (const TurbidGroup& group : kTurbidGroups) {
    rows.push_back({"all", "all", group.sun, summarise_turbid(study, model, 0, study.turbid.size(), group.takes)});
  }
  return rows;
}

}  // namespace tyndall::validate
