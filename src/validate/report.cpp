#include "validate/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/text.hpp"
#include "validate/groups.hpp"
#include "validate/plot.hpp"

namespace tyndall::validate {
namespace {

using files::concat;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr const char* kChannelNames[] = {"red", "green", "blue"};
constexpr const char* kChannelColours[] = {"#d62728", "#2ca02c", "#1f77b4"};
constexpr const char* kModelColours[] = {"#e6850e", "#1f77b4", "#2ca02c", "#9467bd", "#8c564b", "#e377c2", "#17becf"};
constexpr Mark kModelMarks[] = {Mark::dotted, Mark::line, Mark::dashed};

constexpr std::string_view kStyle =
    "body{font:15px/1.5 sans-serif;max-width:75em;margin:2em auto;padding:0 1em;color:#222;background:#fff}"
    "h1,h2{line-height:1.2}h2{margin-top:2em}code{background:#8882;padding:.1em .3em;overflow-wrap:anywhere}"
    "table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;margin:1em 0}"
    "td,th{padding:.15em .6em;text-align:right;border-bottom:1px solid #8884}"
    "td.t,th.t{text-align:left}tr.all td{font-weight:bold}"
    "div.plots{display:flex;flex-wrap:wrap;gap:1em}svg{width:36em;max-width:100%;height:auto}"
    "@media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}}";

std::string cell(std::string_view text) { return concat({"<td>", text, "</td>"}); }
std::string text_cell(std::string_view text) { return concat({"<td class=\"t\">", escaped(text), "</td>"}); }

// Returns "0.10 / 0.20 / 0.30" for the three channels.
std::string channels_cell(const ErrorSummary& errors, double Summary::*value) {
  return cell(concat({percent(errors.channels[0].*value), " / ", percent(errors.channels[1].*value), " / ",
                      percent(errors.channels[2].*value)}));
}

std::string error_cells(const ErrorSummary& e) {
  std::string out = cell(std::to_string(e.channels[0].count));
  if (e.channels[0].count == 0) return out + "<td></td><td></td><td></td><td></td><td></td>";
  for (double Summary::*value : {&Summary::mean, &Summary::median, &Summary::p95, &Summary::worst}) {
    out += channels_cell(e, value);
  }
  return out + cell(percent(e.noise));
}

constexpr std::string_view kErrorHead =
    "<th>rays</th><th>mean, r / g / b</th><th>median</th><th>95 %</th><th>worst</th><th>noise</th></tr>\n";

std::string model_colour(std::size_t m) { return kModelColours[m % std::size(kModelColours)]; }
Mark model_mark(std::size_t m) { return kModelMarks[m % std::size(kModelMarks)]; }

std::string model_list(const Study& study) {
  std::string out = "<table>\n<tr><th class=\"t\">model</th><th class=\"t\">description</th><th class=\"t\">compared "
                    "with</th></tr>\n";
  for (const Model& model : study.models) {
    const std::string orders = model.orders == 1   ? "order 1"
                               : model.orders == 0 ? concat({"orders 1 to ", std::to_string(study.options.orders)})
                                                   : concat({"orders 1 to ", std::to_string(model.orders)});
    out += concat({"<tr>", text_cell(model.name), text_cell(model.meaning), text_cell(orders), "</tr>\n"});
  }
  return out + "</table>\n";
}

std::string error_tables(const Study& study) {
  std::string out;
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    out += concat({"<h3>", escaped(study.models[m].name),
                   "</h3>\n<table>\n<tr><th class=\"t\">atmosphere</th><th class=\"t\">sun</th><th "
                   "class=\"t\">from</th>",
                   kErrorHead});
    for (std::size_t a = 0; a < study.atmospheres.size(); ++a) {
      for (const Group& group : kGroups) {
        const bool all = std::string_view(group.region) == "all";
        out += concat({all ? "<tr class=\"all\">" : "<tr>", text_cell(study.atmospheres[a].name), text_cell(group.sun),
                       text_cell(group.region), error_cells(summarise(study, m, a, group.takes)), "</tr>\n"});
      }
    }
    out += "</table>\n";
  }
  return out;
}

std::string turbid_tables(const Study& study) {
  std::string out =
      concat({"<h2>Turbid atmospheres near the horizon under a low sun</h2>\n<p>Rays from 2 m to 3 km, 0.5 "
              "to 5° above the horizon. The reference has ",
              std::to_string(kTurbidOrdersFactor * study.options.orders),
              " orders of scattering.</p>\n<table>\n<tr>"
              "<th class=\"t\">model</th><th>optical depth</th><th>albedo</th><th class=\"t\">sun</th>",
              kErrorHead});
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    for (const TurbidRow& row : turbid_rows(study, m)) {
      out += concat({row.optical_depth == "all" ? "<tr class=\"all\">" : "<tr>", text_cell(study.models[m].name),
                     cell(row.optical_depth), cell(row.ground_albedo), text_cell(row.sun), error_cells(row.errors),
                     "</tr>\n"});
    }
  }
  return out + "</table>\n";
}

std::string worst_tables(const Study& study) {
  std::string out =
      "<p>The rays with the largest errors of each model, in the columns of <code>tyndall probe</code>.</p>\n";
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    out += concat({"<table>\n<tr><th class=\"t\">", escaped(study.models[m].name),
                   "</th><th>altitude_m</th><th>view_zenith_deg</th><th>sun_zenith_deg</th><th>azimuth_deg</th>"
                   "<th>error, r / g / b</th><th>noise</th></tr>\n"});
    for (const BadRay& bad : worst_rays(study, m, 6)) {
      const RayQuery& q = study.rays[bad.atmosphere].rays[bad.ray].query;
      const Comparison& c = bad.comparison;
      out += concat({"<tr>", text_cell(study.atmospheres[bad.atmosphere].name), cell(fixed(q.altitude_m, 1)),
                     cell(fixed(q.view_zenith_rad * kDegPerRad, 4)), cell(fixed(q.sun_zenith_rad * kDegPerRad, 4)),
                     cell(fixed(q.azimuth_rad * kDegPerRad, 3)),
                     cell(concat({percent(c.error[0]), " / ", percent(c.error[1]), " / ", percent(c.error[2])})),
                     cell(percent(*std::max_element(c.noise.begin(), c.noise.end()))), "</tr>\n"});
    }
    out += "</table>\n";
  }
  return out;
}

// Plots the largest channel's error of every ray over a property of the ray, one dot each.
std::string error_plot(const Study& study, std::string title, Axis x,
                       const std::function<double(const TestRay&)>& abscissa) {
  Plot plot = {std::move(title), std::move(x), {"error, %"}, {}};
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    Series series = {study.models[m].name, model_colour(m), Mark::points, {}};
    for (const RayTest& test : study.rays) {
      for (std::size_t i = 0; i < test.rays.size(); ++i) {
        const Truth right = truth(test.answers.reference[i], study.models[m].orders);
        const double at = abscissa(test.rays[i]);
        if (!is_comparable(right) || !std::isfinite(at)) continue;
        const Rgb error = compare(test.answers.models[m][i], right).error;
        series.points.push_back({at, 100.0 * *std::max_element(error.begin(), error.end())});
      }
    }
    plot.series.push_back(std::move(series));
  }
  fit_logarithmic(plot.y, plot.series, 5);
  return to_svg(plot);
}

std::string error_plots(const Study& study) {
  const auto nowhere = std::numeric_limits<double>::quiet_NaN();
  return error_plot(study, "Error against the sun's elevation", {"elevation of the sun, deg", -6.0, 90.0},
                    [](const TestRay& ray) { return ray.sun_elevation_rad * kDegPerRad; }) +
         error_plot(study, "Error around sunset", {"elevation of the sun, deg", -6.0, 6.0},
                    [=](const TestRay& ray) {
                      const double sun_deg = ray.sun_elevation_rad * kDegPerRad;
                      return sun_deg <= 6.0 ? sun_deg : nowhere;
                    }) +
         error_plot(study, "Error against the view direction (ground and air)", {"view zenith angle, deg", 0.0, 180.0},
                    [=](const TestRay& ray) {
                      return ray.region == Region::space ? nowhere : ray.query.view_zenith_rad * kDegPerRad;
                    }) +
         error_plot(
             study, "Error against the altitude (ground and air)", {"altitude, km", 0.0, 70.0},
             [=](const TestRay& ray) { return ray.region == Region::space ? nowhere : ray.query.altitude_m / 1000.0; });
}

// Plots the reference with error bars and every model, in three channels. In the legend, only models of all orders are
// distinguished by dashes; single scattering is drawn to show what it leaves out.
void add_curves(Plot& plot, const std::vector<double>& x, const Answers& answers, const std::vector<Model>& models) {
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t c = 0; c < 3; ++c) {
      Series series = {c == 1 ? models[m].name : "", kChannelColours[c], model_mark(m), {}};
      for (std::size_t i = 0; i < x.size(); ++i) series.points.push_back({x[i], answers.models[m][i][c]});
      plot.series.push_back(std::move(series));
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    Series series = {concat({"reference, ", kChannelNames[c]}), kChannelColours[c], Mark::points, {}};
    for (std::size_t i = 0; i < x.size(); ++i) {
      series.points.push_back({x[i], answers.reference[i].radiance[c], answers.reference[i].standard_error[c]});
    }
    plot.series.push_back(std::move(series));
  }
}

// Returns the models to draw: of models with equal answers, only the first. Single scattering, which is compared in two
// ways, is drawn once.
std::vector<std::size_t> distinct_models(const Study& study) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    const bool seen = std::any_of(out.begin(), out.end(), [&](std::size_t other) {
      return study.sky.answers.models[other] == study.sky.answers.models[m];
    });
    if (!seen) out.push_back(m);
  }
  return out;
}

Answers only(const Answers& answers, const std::vector<std::size_t>& models) {
  Answers out = {answers.queries, answers.reference, {}};
  for (const std::size_t m : models) out.models.push_back(answers.models[m]);
  return out;
}

std::string curve_plot(std::string title, Axis x_axis, std::string y_label, int decades, const std::vector<double>& x,
                       const Answers& answers, const std::vector<Model>& models) {
  Plot plot = {std::move(title), std::move(x_axis), {std::move(y_label)}, {}};
  add_curves(plot, x, answers, models);
  fit_logarithmic(plot.y, plot.series, decades);
  return to_svg(plot);
}

std::string orders_plot(const Study& study) {
  Plot plot = {"Share of each order in the sky's irradiance (550 nm)",
               {"elevation of the sun, deg", -8.0, 30.0},
               {"share, %", 0.0, 100.0},
               {}};
  for (std::size_t n = 0; n < static_cast<std::size_t>(study.options.orders); ++n) {
    Series series = {concat({"order ", std::to_string(n + 1)}),
                     kModelColours[n % std::size(kModelColours)],
                     n < std::size(kModelColours) ? Mark::line : Mark::dashed,
                     {}};
    for (std::size_t i = 0; i < study.sky.sun_elevation_deg.size(); ++i) {
      const reference::Estimate& estimate = study.sky.answers.reference[i];
      series.points.push_back(
          {study.sky.sun_elevation_deg[i], 100.0 * estimate.order_radiance[n][1] / estimate.radiance[1]});
    }
    plot.series.push_back(std::move(series));
  }
  fit_logarithmic(plot.y, plot.series, 4);
  return to_svg(plot);
}

std::string sky_tables(const Study& study) {
  std::string out = concat({"<table>\n<tr><th class=\"t\">model</th><th class=\"t\">sun</th>", kErrorHead});
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    for (const SkyBand& band : kSkyBands) {
      out += concat({"<tr>", text_cell(study.models[m].name), text_cell(band.sun),
                     error_cells(summarise_sky(study, m, band.low_deg, band.high_deg)), "</tr>\n"});
    }
  }
  return out + "</table>\n";
}

}  // namespace

std::string to_html(const Study& study, const Origin& origin) {
  std::vector<Model> drawn;
  const std::vector<std::size_t> distinct = distinct_models(study);
  for (const std::size_t m : distinct) drawn.push_back(study.models[m]);
  const auto& options = study.options;

  std::string out = concat(
      {"<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Tyndall: models "
       "against the "
       "reference</title>\n<style>",
       kStyle, "</style>\n</head>\n<body>\n<h1>Every model against the reference</h1>\n<p>Generated by <code>",
       escaped(origin.command), "</code> with Tyndall ", escaped(origin.version), " on ", escaped(origin.device),
       ": the path tracer with ", std::to_string(options.samples), " paths per ray, ", std::to_string(options.orders),
       " orders of scattering, seed ", std::to_string(options.seed),
       ".</p>\n<p>The error of a channel is its difference from the reference, divided by the largest channel of the "
       "reference on the same ray, in per cent. "
       "“Noise” is the mean standard error of the reference in the same measure; smaller errors cannot be "
       "measured. Rays are left out if the reference is zero, or if its standard error exceeds 3 %.</p>\n"});
  out += model_list(study);
  out += "<h2>Errors</h2>\n<div class=\"plots\">\n" + error_plots(study) + "</div>\n" + error_tables(study) +
         worst_tables(study) + turbid_tables(study);

  out +=
      "<h2>The sky along the sun's vertical</h2>\n<p>At sea level, from the horizon below the sun (−90°) through the "
      "zenith to the opposite horizon (90°). Radiance is relative to the sun's irradiance. Bars show one standard "
      "error.</p>\n<div "
      "class=\"plots\">\n";
  for (const VerticalTest& test : study.verticals) {
    out += curve_plot(concat({"Sun at ", fixed(test.sun_elevation_deg, 0), "°"}),
                      {"angle from the zenith, deg", -90.0, 90.0}, "radiance / E0, 1/sr", 4, test.angle_deg,
                      only(test.answers, distinct), drawn);
  }
  out += "</div>\n<h2>The irradiance of the sky in twilight</h2>\n<div class=\"plots\">\n";
  out += curve_plot("Irradiance of a horizontal surface", {"elevation of the sun, deg", -8.0, 15.0}, "E / E0", 7,
                    study.sky.sun_elevation_deg, only(study.sky.answers, distinct), drawn);
  out += orders_plot(study) + "</div>\n" + sky_tables(study);
  if (!study.horizons.empty()) {
    out += concat(
        {"<h2>The horizon</h2>\n<p>Parameterisations of the tables, ", fixed(study.horizons[0].altitude_m / 1000.0, 0),
         " km above sea level, 60° to the side of the sun. The horizon is at 0.</p>\n<div class=\"plots\">\n"});
    for (const HorizonTest& test : study.horizons) {
      out += curve_plot(concat({"Sun at ", fixed(test.sun_elevation_deg, 0), "°"}),
                        {"view above the horizon, deg", -4.0, 6.0}, "radiance / E0, 1/sr", 2, test.elevation_deg,
                        test.answers, study.horizon_models);
    }
    out += "</div>\n";
  }
  return out + "</body>\n</html>\n";
}

}  // namespace tyndall::validate
