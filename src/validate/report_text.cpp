#include <algorithm>
#include <cmath>

#include "files/text.hpp"
#include "validate/groups.hpp"
#include "validate/plot.hpp"
#include "validate/report.hpp"

namespace tyndall::validate {
namespace {

using files::concat;
using files::quoted_text;

std::string json_number(double value) { return std::isfinite(value) ? files::number_text(value) : "null"; }

std::string json_summary(const Summary& s) {
  return concat({"\"rays\": ", std::to_string(s.count), ", \"mean\": ", json_number(s.mean), ", \"median\": ",
                 json_number(s.median), ", \"p95\": ", json_number(s.p95), ", \"worst\": ", json_number(s.worst)});
}

std::string json_errors(const ErrorSummary& errors) {
  std::string out =
      concat({"\"rays\": ", std::to_string(errors.channels[0].count), ", \"mean\": ", json_number(errors.all.mean),
              ", \"median\": ", json_number(errors.all.median), ", \"p95\": ", json_number(errors.all.p95),
              ", \"worst\": ", json_number(errors.all.worst), ", \"noise\": ", json_number(errors.noise),
              ", \"channels\": ["});
  for (std::size_t c = 0; c < 3; ++c) out += concat({c > 0 ? ", {" : "{", json_summary(errors.channels[c]), "}"});
  return out + "]";
}

std::string json_turbid(const Study& study, std::size_t model) {
  std::string out;
  for (std::size_t a = 0; a < study.turbid.size(); ++a) {
    for (const TurbidGroup& group : kTurbidGroups) {
      out += concat({out.empty() ? "\n" : ",\n", "   {\"optical_depth\": ", json_number(kTurbidAirs[a].optical_depth),
                     ", \"ground_albedo\": ", json_number(kTurbidAirs[a].ground_albedo),
                     ", \"sun\": ", quoted_text(group.sun), ", ",
                     json_errors(summarise_turbid(study, model, a, 1, group.takes)), "}"});
    }
  }
  return out;
}

// All atmospheres of the turbid set together.
std::string json_turbid_all(const Study& study, std::size_t model) {
  std::string out;
  for (const TurbidGroup& group : kTurbidGroups) {
    out += concat({out.empty() ? "\n" : ",\n", "   {\"sun\": ", quoted_text(group.sun), ", ",
                   json_errors(summarise_turbid(study, model, 0, study.turbid.size(), group.takes)), "}"});
  }
  return out;
}

std::string markdown_turbid(const Study& study) {
  std::string out = concat(
      {"\n## Turbid atmospheres near the horizon under a low sun\n\nThe rays start at 2 m to 3 km and point 0.5° to "
       "5° above the horizon. The reference has ",
       std::to_string(kTurbidOrdersFactor * study.options.orders),
       " orders of scattering.\nOnly models with all orders are listed.\n\n"
       "| model | optical depth | albedo | sun | rays | mean | median | 95 % | worst | noise |\n"
       "|---|--:|--:|---|--:|--:|--:|--:|--:|--:|\n"});
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    if (study.models[m].orders != 0) continue;
    for (const TurbidRow& row : turbid_rows(study, m)) {
      const ErrorSummary& e = row.errors;
      out += concat({"| ",  study.models[m].name,
                     " | ", row.optical_depth,
                     " | ", row.ground_albedo,
                     " | ", row.sun,
                     " | ", std::to_string(e.channels[0].count),
                     " | ", percent(e.all.mean),
                     " | ", percent(e.all.median),
                     " | ", percent(e.all.p95),
                     " | ", percent(e.all.worst),
                     " | ", percent(e.noise),
                     " |\n"});
    }
  }
  return out;
}

}  // namespace

std::string to_json(const Study& study, const ColorTest& colors, const Origin& origin) {
  std::string out = concat(
      {"{\n \"command\": ", quoted_text(origin.command), ",\n \"version\": ", quoted_text(origin.version),
       ",\n \"device\": ", quoted_text(origin.device), ",\n \"rays\": ", std::to_string(study.options.rays),
       ",\n \"samples\": ", std::to_string(study.options.samples), ",\n \"seed\": ", std::to_string(study.options.seed),
       ",\n \"orders\": ", std::to_string(study.options.orders), ",\n \"models\": ["});
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    out += concat({m > 0 ? ",\n" : "\n", "  {\"name\": ", quoted_text(study.models[m].name),
                   ", \"orders\": ", std::to_string(study.models[m].orders), ", \"groups\": ["});
    bool first = true;
    for (std::size_t a = 0; a < study.atmospheres.size(); ++a) {
      for (const Group& group : kGroups) {
        out += concat({first ? "\n" : ",\n", "   {\"atmosphere\": ", quoted_text(study.atmospheres[a].name),
                       ", \"sun\": ", quoted_text(group.sun), ", \"region\": ", quoted_text(group.region), ", ",
                       json_errors(summarise(study, m, a, group.takes)), "}"});
        first = false;
      }
    }
    out += concat({"\n  ], \"turbid\": [", json_turbid(study, m), "\n  ], \"turbid_all\": [", json_turbid_all(study, m),
                   "\n  ], \"sky\": ["});
    first = true;
    for (const SkyBand& band : kSkyBands) {
      out += concat({first ? "\n" : ",\n", "   {\"sun\": ", quoted_text(band.sun), ", ",
                     json_errors(summarise_sky(study, m, band.low_deg, band.high_deg)), "}"});
      first = false;
    }
    out += "\n  ]}";
  }
  return concat({out, "\n ],\n ", color_json(colors), "\n}\n"});
}

std::string to_markdown(const Study& study, const ColorTest& colors, const Origin& origin) {
  std::string out =
      concat({"# Accuracy of the models\n\nGenerated by\n\n    ", origin.command, "\n\nwith Tyndall ", origin.version,
              " on ", origin.device,
              ". The models are compared with the path tracer of [reference.md](../reference.md).\n"
              "The error of a channel is its difference from the reference, divided by the largest channel of "
              "the reference on the same\nray. `noise` is the mean standard error of the reference in the same "
              "measure. All errors are in per cent. The rays point\nin all directions, from the ground (0 to "
              "2 km), from inside the atmosphere (2 to 70 km) and from space (100 to 20 000 km).\nThe sun is "
              "above the horizon (up) or at 0° to −6°.\n\n## Models\n\n"
              "| model | description | compared with |\n|---|---|---|\n"});
  for (const Model& model : study.models) {
    out += concat({"| ", model.name, " | ", model.meaning, " | ",
                   model.orders == 0   ? concat({"orders 1 to ", std::to_string(study.options.orders)})
                   : model.orders == 1 ? std::string("order 1")
                                       : concat({"orders 1 to ", std::to_string(model.orders)}),
                   " |\n"});
  }
  out += "\n## Radiance of the sky, the atmosphere and the limb\n\n| model | atmosphere | sun | rays | mean | median | "
         "95 % | worst | noise |\n"
         "|---|---|---|--:|--:|--:|--:|--:|--:|\n";
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    for (std::size_t a = 0; a < study.atmospheres.size(); ++a) {
      for (const Group& group : kGroups) {
        if (std::string_view(group.region) != "all") continue;
        const ErrorSummary e = summarise(study, m, a, group.takes);
        out += concat({"| ", study.models[m].name, " | ", study.atmospheres[a].name, " | ", group.sun, " | ",
                       std::to_string(e.channels[0].count), " | ", percent(e.all.mean), " | ", percent(e.all.median),
                       " | ", percent(e.all.p95), " | ", percent(e.all.worst), " | ", percent(e.noise), " |\n"});
      }
    }
  }
  out += color_markdown(colors);
  out += markdown_turbid(study);
  out += "\n## Irradiance of the sky at sea level\n\n| model | sun | elevations | mean | worst | noise "
         "|\n|---|---|--:|--:|--:|--:|\n";
  for (std::size_t m = 0; m < study.models.size(); ++m) {
    for (const SkyBand& band : kSkyBands) {
      const ErrorSummary e = summarise_sky(study, m, band.low_deg, band.high_deg);
      out += concat({"| ", study.models[m].name, " | ", band.sun, " | ", std::to_string(e.channels[0].count), " | ",
                     percent(e.all.mean), " | ", percent(e.all.worst), " | ", percent(e.noise), " |\n"});
    }
  }
  out += "\n## Contributions of the orders of scattering to the sky's irradiance (550 nm, %)\n\n| sun |";
  std::string rule = "\n|--:|";
  for (int n = 1; n <= study.options.orders; ++n) {
    out += concat({" ", std::to_string(n), " |"});
    rule += "--:|";
  }
  out += rule + "\n";
  for (std::size_t i = 0; i < study.sky.sun_elevation_deg.size(); ++i) {
    const double sun = study.sky.sun_elevation_deg[i];
    if (sun != 60.0 && sun != 30.0 && sun != 10.0 && sun != 4.0 && sun != 0.0 && sun != -3.0 && sun != -6.0) continue;
    out += concat({"| ", fixed(sun, 0), "° |"});
    const reference::Estimate& estimate = study.sky.answers.reference[i];
    for (const Rgb& order : estimate.order_radiance)
      out += concat({" ", percent(order[1] / estimate.radiance[1]), " |"});
    out += "\n";
  }
  return out;
}

}  // namespace tyndall::validate
