// The HTML page of a report: one file without scripts, with the numbers of report.json.
#include <algorithm>
#include <cstdio>
#include <map>

#include "files/text.hpp"
#include "report_parts.hpp"
#include "validate/plot.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using validate::escaped;
using Json = nlohmann::ordered_json;

std::string shown(const Json& value) {
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_number_float()) {
    char text[40];
    std::snprintf(text, sizeof text, "%.4g", value.get<double>());
    return text;
  }
  return escaped(value.dump());
}

class Page {
 public:
  void heading(const std::string& text) { html_ += concat({"<h2>", escaped(text), "</h2>\n"}); }
  void paragraph(const std::string& text) { html_ += concat({"<p>", escaped(text), "</p>\n"}); }
  void raw(const std::string& text) { html_ += text; }
  void begin_table(const std::vector<std::string>& columns) {
    html_ += "<table><tr>";
    for (const std::string& column : columns) html_ += concat({"<th>", escaped(column), "</th>"});
    html_ += "</tr>\n";
  }
  // Adds a row of cells that are HTML.
  void row(const std::vector<std::string>& cells) {
    html_ += "<tr>";
    for (const std::string& cell : cells) html_ += concat({"<td>", cell, "</td>"});
    html_ += "</tr>\n";
  }
  void end_table() { html_ += "</table>\n"; }
  [[nodiscard]] const std::string& html() const { return html_; }

 private:
  std::string html_;
};

void add_checks(Page& page, const Json& report) {
  page.heading("Correctness");
  page.begin_table({"check", "result", "limit", "measured"});
  for (const Json& check : report["checks"]) {
    std::string values;
    for (const auto& [name, value] : check["values"].items()) {
      values += concat({values.empty() ? "" : ", ", escaped(name), " ", shown(value)});
    }
    const bool passed = check["passed"].get<bool>();
    page.row({shown(check["name"]), passed ? "<b class=good>passed</b>" : "<b class=bad>failed</b>",
              shown(check["limit"]), values});
  }
  page.end_table();
  if (report["checks"].empty()) page.paragraph("No check ran.");
}

std::string size_text(const Json& bench) { return concat({bench["size"][0].dump(), "×", bench["size"][1].dump()}); }

void add_times(Page& page, const Json& report) {
  page.heading("Times of a frame");
  page.paragraph("Medians in milliseconds, after a warm-up by time. The copy baseline only reads depth and colour and "
                 "writes colour: the least that any effect can cost.");
  if (!report.contains("times") || report["times"].empty()) return page.paragraph("Nothing was measured.");
  page.begin_table({"settings", "size", "frames", "effect", "copy baseline", "effect / baseline", "frame"});
  for (const Json& one : report["times"]) {
    const double floor_ms = one["floor_ms"].get<double>();
    page.row({shown(one["name"]), size_text(one), shown(one["frames"]), shown(one["effect_ms"]), shown(one["floor_ms"]),
              floor_ms > 0.0 ? shown(Json(one["effect_ms"].get<double>() / floor_ms)) : "", shown(one["frame_ms"])});
  }
  page.end_table();
  page.heading("Times of the passes");
  for (const Json& one : report["times"]) {
    page.raw(concat({"<details><summary>", shown(one["name"]), ", ", size_text(one), "</summary>\n"}));
    page.begin_table({"pass", "median ms", "p95 ms", "part of the effect"});
    for (const Json& pass : one["passes"]) {
      page.row({shown(pass["name"]), shown(pass["median_ms"]), shown(pass["p95_ms"]),
                pass["in_effect"].get<bool>() ? "yes" : "no"});
    }
    page.end_table();
    page.raw("</details>\n");
  }
}

void add_tables(Page& page, const Json& report) {
  if (!report.contains("tables")) return;
  const Json& tables = report["tables"];
  page.heading("Building the tables");
  page.begin_table({"stage", "ms"});
  for (const Json& stage : tables["stages"]) page.row({shown(stage["name"]), shown(stage["ms"])});
  page.row({"all stages", shown(tables["stages_ms"])});
  page.row({"with submissions", shown(tables["total_ms"])});
  page.end_table();
}

void add_pipelines(Page& page, const Json& report) {
  if (!report.contains("pipelines")) return;
  page.heading("Registers, spills and code sizes");
  page.paragraph("Drivers name these statistics as they like (VK_KHR_pipeline_executable_properties).");
  page.begin_table({"pipeline", "executable", "subgroup", "statistics"});
  for (const Json& pipeline : report["pipelines"]) {
    for (const Json& executable : pipeline["executables"]) {
      std::string statistics;
      for (const auto& [name, value] : executable["statistics"].items()) {
        statistics += concat({statistics.empty() ? "" : ", ", escaped(name), " ", shown(value)});
      }
      page.row({shown(pipeline["name"]), shown(executable["name"]), shown(executable["subgroup_size"]), statistics});
    }
  }
  page.end_table();
}

void add_clocks(Page& page, const Json& report) {
  if (!report.contains("clocks") || report["clocks"]["samples"].empty()) return;
  const Json& clocks = report["clocks"];
  page.heading("Clocks during the run");
  page.paragraph(
      concat({clocks["source"].get<std::string>(), ", ", std::to_string(clocks["samples"].size()), " samples"}));
  page.begin_table({"column", "smallest", "median", "largest"});
  for (std::size_t column = 0; column < clocks["columns"].size(); ++column) {
    std::vector<double> values;
    for (const Json& sample : clocks["samples"]) {
      if (sample[column].is_number()) values.push_back(sample[column].get<double>());
    }
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    page.row({shown(clocks["columns"][column]), shown(Json(values.front())), shown(Json(values[values.size() / 2])),
              shown(Json(values.back()))});
  }
  page.end_table();
}

}  // namespace

std::string report_page(const Json& report) {
  Page page;
  const Json& device = report["device"];
  page.raw(
      "<!DOCTYPE html>\n<html lang=en><meta charset=utf-8><title>Tyndall: GPU report</title>\n<style>"
      "body{font:15px/1.5 sans-serif;max-width:75em;margin:2em auto;padding:0 1em}"
      "table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.2em .6em;text-align:left;vertical-align:top}"
      ".good{color:#070}.bad{color:#b00}img{max-width:48%}</style>\n<h1>Tyndall: GPU report</h1>\n");
  page.begin_table({"", ""});
  page.row({"program", shown(report["program"])});
  if (device.is_object()) {
    for (const auto& [name, value] : device.items()) {
      if (name != "used" && name != "missing") page.row({escaped(name), shown(value)});
    }
  } else {
    page.row({"device", "none could be used"});
  }
  for (const auto& [name, value] : report["system"].items()) page.row({escaped(name), shown(value)});
  page.row({"started", shown(report["started"])});
  page.row({"seconds", concat({shown(report["seconds"]), " of at most ", shown(report["limit_seconds"])})});
  page.end_table();
  if (report["short"].get<bool>())
    page.paragraph("This is the short form, a test of the report. Its times mean nothing, and its comparisons need "
                   "values that were computed with --reference --short.");
  add_checks(page, report);
  page.heading("Left out");
  page.begin_table({"part", "why"});
  for (const Json& part : report["left_out"]) page.row({shown(part["part"]), shown(part["why"])});
  page.end_table();
  if (report["left_out"].empty()) page.paragraph("Nothing.");
  add_times(page, report);
  add_tables(page, report);
  add_pipelines(page, report);
  add_clocks(page, report);
  page.heading("Pictures");
  page.raw("<p>Epipolar sampling, and brute force:</p>\n<img src=epipolar.png alt=\"epipolar sampling\"> "
           "<img src=brute_force.png alt=\"brute force\">\n</html>\n");
  return page.html();
}

}  // namespace tyndall::cli
