// A study as documents: one HTML file that needs nothing else, a page of Markdown, JSON.
#pragma once

#include <string>

#include "validate/study.hpp"

namespace tyndall::validate {

// What stands at the head of a report.
struct Origin {
  std::string command;  // that makes it
  std::string version;
  std::string device;
};

// Tables and plots of everything.
[[nodiscard]] std::string to_html(const Study& study, const Origin& origin);
// The tables that matter most: docs/generated/accuracy.md.
[[nodiscard]] std::string to_markdown(const Study& study, const Origin& origin);
// {"command", "version", "device", "rays", "samples", "seed", "orders", "models": [{"name", "orders",
// "groups":
// [{"atmosphere", "sun", "region", "rays", "mean", "median", "p95", "worst", "noise", "channels": [{"mean",
// ...}]}], "turbid": [{"optical_depth", "ground_albedo", "sun", as for groups}], "sky": [...]}]}.
[[nodiscard]] std::string to_json(const Study& study, const Origin& origin);

}  // namespace tyndall::validate
