// Formats a study as a self-contained HTML file, as a Markdown page, or as JSON.
#pragma once

#include <string>

#include "validate/color.hpp"
#include "validate/study.hpp"

namespace tyndall::validate {

// The heading of a report.
struct Origin {
  std::string command;  // the command that produces the report
  std::string version;
  std::string device;
};

// Returns a page with all tables and plots.
[[nodiscard]] std::string to_html(const Study& study, const Origin& origin);
// Returns a page with the most important tables, such as docs/generated/accuracy.md.
[[nodiscard]] std::string to_markdown(const Study& study, const ColorTest& colors, const Origin& origin);
// Returns {"command", "version", "device", "rays", "samples", "seed", "orders", "models": [{"name", "orders", "groups":
// [{"atmosphere", "sun", "region", "rays", "mean", "median", "p95", "worst", "noise", "channels": [{"mean", ...}]}],
// "turbid": [{"optical_depth", "ground_albedo", "sun", as for groups}], "turbid_all": [{"sun", as for groups}],
// "sky": [...]}], "colors": [{"color", "sun", "view", "rays", "luminance_mean", "luminance_p95", "duv_mean", "duv_p95",
// "de2000_mean", "de2000_p95", "noise"}]}.
[[nodiscard]] std::string to_json(const Study& study, const ColorTest& colors, const Origin& origin);

}  // namespace tyndall::validate
