// The parts of a report: statistics, rays, plots, and a whole study with models whose errors are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/atmosphere.hpp"
#include "validate/color.hpp"
#include "validate/groups.hpp"
#include "validate/parts.hpp"
#include "validate/plot.hpp"
#include "validate/rays.hpp"
#include "validate/report.hpp"
#include "validate/statistics.hpp"

namespace tyndall::validate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 6360000.0, kHeight = 80000.0;

TEST(ValidateStatistics, QuantilesByRank) {
  std::vector<double> values;
  for (int i = 1; i <= 20; ++i) values.push_back(21 - i);
  values.push_back(std::numeric_limits<double>::quiet_NaN());
  const Summary s = summarise(values);
  EXPECT_EQ(s.count, 20U);
  EXPECT_DOUBLE_EQ(s.mean, 10.5);
  EXPECT_EQ(s.median, 10.0);
  EXPECT_EQ(s.p95, 19.0);
  EXPECT_EQ(s.worst, 20.0);
  EXPECT_EQ(summarise(std::vector<double>()).count, 0U);
  EXPECT_EQ(summarise({3.0}).median, 3.0);
}

TEST(ValidateStatistics, ErrorsAreRelativeToTheLargestChannel) {
  const Rgb error = relative_error({1.0, 2.5, 4.0}, {1.1, 2.0, 5.0});
  EXPECT_NEAR(error[0], 0.02, 1e-12);
  EXPECT_NEAR(error[1], 0.1, 1e-12);
  EXPECT_NEAR(error[2], 0.2, 1e-12);
  EXPECT_FALSE(std::isfinite(relative_error({1, 1, 1}, {0, 0, 0})[0]));
  const Comparison two[] = {{{0.1, 0.2, 0.3}, {0.01, 0.01, 0.01}}, {{0.3, 0.2, 0.1}, {0.03, 0.03, 0.03}}};
  const ErrorSummary e = summarise(two);
  EXPECT_NEAR(e.channels[0].mean, 0.2, 1e-12);
  EXPECT_NEAR(e.all.worst, 0.3, 1e-12);
  EXPECT_NEAR(e.noise, 0.02, 1e-12);
}

TEST(ValidateStatistics, TruthIsTheSumOfTheFirstOrders) {
  reference::Estimate estimate;
  estimate.radiance = {7, 7, 7};
  estimate.standard_error = {0.5, 0.5, 0.5};
  estimate.order_radiance = {{4, 4, 4}, {2, 2, 2}, {1, 1, 1}};
  estimate.order_standard_error = {{0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}, {1, 1, 1}};
  EXPECT_EQ(truth(estimate, 1).value[0], 4.0);
  EXPECT_EQ(truth(estimate, 2).value[0], 6.0);
  EXPECT_NEAR(truth(estimate, 2).standard_error[0], 0.5, 1e-12);
  EXPECT_EQ(truth(estimate, 0).value[0], 7.0);
  EXPECT_EQ(truth(estimate, 3).standard_error[0], 0.5);
  EXPECT_FALSE(is_comparable({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(is_comparable({{1, 0, 0}, {0, 0.04, 0}}));
  EXPECT_TRUE(is_comparable({{1, 0, 0}, {0, 0.02, 0}}));
}

TEST(ValidateRays, AreInTheirGroupsAndEvenlySpread) {
  for (const Region region : {Region::ground, Region::air, Region::space}) {
    for (const SunBand band : {SunBand::up, SunBand::twilight}) {
      const std::vector<TestRay> rays = make_rays(region, band, 200, 5, kRadius, kHeight);
      ASSERT_EQ(rays.size(), 200U);
      int halves[3] = {};
      for (const TestRay& ray : rays) {
        const RayQuery& q = ray.query;
        const double sun_deg = ray.sun_elevation_rad * 180.0 / kPi;
        EXPECT_GE(sun_deg, band == SunBand::up ? 0.0 : -6.0);
        EXPECT_LE(sun_deg, band == SunBand::up ? 90.0 : 0.0);
        EXPECT_TRUE(q.view_zenith_rad >= 0.0 && q.view_zenith_rad <= kPi);
        EXPECT_TRUE(q.sun_zenith_rad >= 0.0 && q.sun_zenith_rad <= kPi);
        EXPECT_TRUE(q.azimuth_rad >= 0.0 && q.azimuth_rad <= kPi);
        if (region == Region::ground) {
          EXPECT_LE(q.altitude_m, 2000.0);
          EXPECT_LE(q.view_zenith_rad, 0.5 * kPi);
        } else if (region == Region::air) {
          EXPECT_TRUE(q.altitude_m >= 2000.0 && q.altitude_m <= 70000.0);
        } else {
          EXPECT_TRUE(q.altitude_m >= 1e5 && q.altitude_m <= 2.001e7);
          // All of them hit the atmosphere.
          EXPECT_LE((kRadius + q.altitude_m) * std::sin(q.view_zenith_rad), kRadius + 60001.0);
          EXPECT_GT(q.view_zenith_rad, 0.5 * kPi);
        }
        halves[0] += ray.sun_elevation_rad > (band == SunBand::up ? 0.25 * kPi : -kPi / 60.0) ? 1 : 0;
        halves[1] += q.azimuth_rad > 0.5 * kPi ? 1 : 0;
        halves[2] += region == Region::air && q.view_zenith_rad > 0.5 * kPi ? 1 : 0;
      }
      EXPECT_NEAR(halves[0], 100, 1);
      if (region != Region::space) {
        EXPECT_NEAR(halves[1], 100, 1);
      }
      if (region == Region::air) {
        EXPECT_NEAR(halves[2], 100, 1);
      }
    }
  }
  EXPECT_NE(make_rays(Region::air, SunBand::up, 5, 7, kRadius, kHeight)[4].query.altitude_m,
            make_rays(Region::air, SunBand::up, 5, 8, kRadius, kHeight)[4].query.altitude_m);
}

TEST(ValidateRays, TurbidSetIsNearTheHorizonUnderLowSuns) {
  for (const SunBand band : {SunBand::up, SunBand::twilight}) {
    const std::vector<TestRay> rays = make_horizon_rays(band, 50, 5, kRadius, kHeight);
    ASSERT_EQ(rays.size(), 50U);
    for (const TestRay& ray : rays) {
      const double sun_deg = ray.sun_elevation_rad * 180.0 / kPi;
      EXPECT_TRUE(band == SunBand::up ? sun_deg >= 0.5 && sun_deg <= 10.0 : sun_deg >= -6.0 && sun_deg <= 0.0);
      EXPECT_TRUE(ray.query.altitude_m >= 2.0 && ray.query.altitude_m <= 3000.0);
      const double horizon = 0.5 * kPi + std::acos(kRadius / (kRadius + ray.query.altitude_m));
      const double above_deg = (horizon - ray.query.view_zenith_rad) * 180.0 / kPi;
      EXPECT_TRUE(above_deg >= 0.5 - 1e-9 && above_deg <= 5.0 + 1e-9) << above_deg;
    }
  }
}

TEST(ValidateRays, TurbidAtmospheresHaveTheirOpticalDepth) {
  Params params;
  params.atmosphere.aerosol_absorption = 0.3F;
  for (const TurbidAir& air : kTurbidAirs) {
    const Params turbid = turbid_params(params, air);
    const AtmosphereParams& a = turbid.atmosphere;
    EXPECT_NEAR(2e-5 * (1.0 + a.aerosol_absorption) * a.aerosol_density * a.mie_scale_height_m, air.optical_depth,
                1e-6);
    EXPECT_FLOAT_EQ(turbid.planet.ground_albedo.y, static_cast<float>(air.ground_albedo));
  }
  params.atmosphere.aerosol_density = 0.0F;
  EXPECT_EQ(turbid_params(params, kTurbidAirs[0]).atmosphere.aerosol_density, 0.0F);
}

TEST(ValidateRays, TheSunIsGivenAtTheVisiblePosition) {
  for (const TestRay& ray : make_rays(Region::space, SunBand::twilight, 100, 3, kRadius, kHeight)) {
    const RayQuery& q = ray.query;
    // In coordinates with x along the azimuth of the view and y up, find the point where the ray meets the ground, or
    // its perigee if it misses the ground.
    const double r = kRadius + q.altitude_m;
    const double vx = std::sin(q.view_zenith_rad);
    const double vy = std::cos(q.view_zenith_rad);
    const double b = r * vy;
    const double discriminant = kRadius * kRadius - r * r + b * b;
    const double d = -b - (discriminant > 0.0 ? std::sqrt(discriminant) : 0.0);
    const double px = d * vx;
    const double py = r + d * vy;
    const double sx = std::sin(q.sun_zenith_rad) * std::cos(q.azimuth_rad);
    const double sy = std::cos(q.sun_zenith_rad);
    EXPECT_NEAR(std::asin((px * sx + py * sy) / std::hypot(px, py)), ray.sun_elevation_rad, 1e-6);
  }
}

TEST(ValidatePlot, TextIsEscapedAndNumbersAreFixed) {
  EXPECT_EQ(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(fixed(-0.04, 1), "0.0");
  EXPECT_EQ(fixed(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed(12345.678, 0), "12346");
}

// Expects that every element is closed, in the right order.
void expect_balanced(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = text.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag.ends_with('/') || tag.starts_with('!') || name == "meta") continue;
    if (!tag.starts_with('/')) {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ("/" + open.back(), tag);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

TEST(ValidatePlot, ValuesStandWhereTheyShould) {
  Plot plot = {"t <1>", {"x", 0.0, 10.0}, {"y", 1.0, 100.0, true}, {}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plot.series.push_back({"points", "#000000", Mark::points, {{5.0, 10.0, 1.0}, {nan, 1.0}, {11.0, 10.0}, {5.0, nan}}});
  plot.series.push_back({"line", "#ff0000", Mark::dashed, {{0.0, 1.0}, {1.0, nan}, {2.0, 10.0}, {10.0, 0.0}}});
  const std::string svg = to_svg(plot);
  expect_balanced(svg);
  // The middle of both axes: 66 + (560 - 14 - 66) / 2, 30 + (340 - 46 - 30) / 2. The second circle is in the legend.
  EXPECT_NE(svg.find("<circle cx=\"306.0\" cy=\"162.0\""), std::string::npos);
  EXPECT_EQ(std::count(svg.begin(), svg.end(), 'M'), 2);
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
  EXPECT_EQ(circles, 2U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("t &lt;1&gt;"), std::string::npos);

  Axis axis;
  fit_logarithmic(axis, {{"", "", Mark::line, {{0, 3e-6}, {0, 0.0}, {0, 20.0}, {0, nan}}}}, 4);
  EXPECT_DOUBLE_EQ(axis.max, 100.0);
  EXPECT_DOUBLE_EQ(axis.min, 0.01);
  fit_logarithmic(axis, {}, 4);
  EXPECT_LT(axis.min, axis.max);
}

// Returns a model that is the reference with other random numbers, as many paths, and brighter by a factor.
Model tracer(std::string name, int orders, double factor) {
  return {std::move(name), "the reference & <itself>", orders,
          [=](const Params& params, std::span<const RayQuery> queries) -> Result<std::vector<Rgb>> {
            reference::Options options;
            options.samples = 400;
            const bool turbid = params.atmosphere.aerosol_density != Params().atmosphere.aerosol_density;
            if (turbid && orders != 0) options.samples *= kTurbidSamplesFactor;  // only those are compared below
            options.orders = orders == 0 ? 4 : orders;
            options.seed = 99;
            const auto found = reference::trace(params, queries, options);
            if (!found) return found.error();
            std::vector<Rgb> out;
            for (const reference::Estimate& e : found.value()) {
              out.push_back({factor * e.radiance[0], factor * e.radiance[1], factor * e.radiance[2]});
            }
            return out;
          }};
}

TEST(ValidateStudy, AtmospheresDifferHoweverTheyAreDescribed) {
  Params given, depth, visibility;
  depth.atmosphere.aerosol_optical_depth = 0.1F;
  visibility.atmosphere.visibility_m = 60.0e3F;
  depth.atmosphere.ozone_du = visibility.atmosphere.ozone_du = 300.0F;
  for (const Params& params : {given, depth, visibility}) {
    const std::vector<Atmosphere> all = atmospheres(params);
    ASSERT_EQ(all.size(), 3U);
    const reference::Atmosphere first(all[0].params), turbid(all[1].params), clear(all[2].params);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(turbid.mie_extinction[c] / first.mie_extinction[c], 5.0, 1e-4);
      EXPECT_GT(first.ozone_absorption[c], 0.0);
      EXPECT_EQ(clear.ozone_absorption[c], 0.0);
    }
  }
}

// Expects two rows for each turbid atmosphere, by day and in twilight, and two for all of them together.
void expect_totals(const std::vector<TurbidRow>& rows) {
  ASSERT_EQ(rows.size(), 2 * std::size(kTurbidAirs) + 2);
  for (const std::size_t sun : {0U, 1U}) {
    std::size_t rays = 0;
    double sum = 0.0, worst = 0.0;
    for (std::size_t i = sun; i < rows.size() - 2; i += 2) {
      const Summary& errors = rows[i].errors.all;
      rays += errors.count;
      sum += static_cast<double>(errors.count) * errors.mean;
      worst = std::max(worst, errors.worst);
    }
    const TurbidRow& all = rows[rows.size() - 2 + sun];
    EXPECT_EQ(all.optical_depth, "all");
    EXPECT_STREQ(all.sun, rows[sun].sun);
    EXPECT_EQ(all.errors.all.count, rays);
    EXPECT_NEAR(all.errors.all.mean * static_cast<double>(rays), sum, 1e-9);
    EXPECT_EQ(all.errors.all.worst, worst);
  }
}

TEST(ValidateStudy, FindsAllErrorsAndNoOthers) {
  Options options;
  options.rays = 72;
  options.samples = 400;
  options.orders = 4;
  const std::vector<Model> models = {tracer("first", 1, 1.0), tracer("all", 0, 1.0), tracer("brighter", 0, 1.5)};
  double progress = 0.0;
  const auto count = [&](double done) {
    EXPECT_GE(done, progress);
    progress = done;
  };
  const Result<Study> study = run_study({}, options, models, {tracer("at the horizon", 0, 1.0)}, count);
  ASSERT_TRUE(study.ok());
  EXPECT_NEAR(progress, 1.0, 1e-9);
  ASSERT_EQ(study.value().rays.size(), 3U);
  EXPECT_EQ(study.value().rays[2].rays.size(), 24U);
  EXPECT_EQ(study.value().horizons.size(), 2U);
  const auto up = [](const TestRay& ray) { return ray.band == SunBand::up; };
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t m = 0; m < 2; ++m) {
      const ErrorSummary e = summarise(study.value(), m, a, up);
      EXPECT_GE(e.channels[0].count, 6U);  // some are too noisy with so few paths
      // Model and reference have noise of equal size, on average 0.8 standard errors each.
      EXPECT_LT(e.all.mean, 3.0 * e.noise + 1e-6) << m << ' ' << a;
    }
    // The model is 50 % too bright. Errors are relative to the largest channel, so their mean is lower.
    const ErrorSummary wrong = summarise(study.value(), 2, a, up);
    EXPECT_GT(wrong.all.mean, 0.15);
    EXPECT_NEAR(wrong.all.worst, 0.5, 0.15);
  }
  // The model of order 1 on the turbid set.
  ASSERT_EQ(study.value().turbid.size(), std::size(kTurbidAirs));
  for (std::size_t air = 0; air < std::size(kTurbidAirs); ++air) {
    const ErrorSummary first = summarise_turbid(study.value(), 0, air, 1, up);
    EXPECT_LT(first.all.mean, 3.0 * first.noise + 1e-6) << air;
  }
  expect_totals(turbid_rows(study.value(), 0));
  EXPECT_LT(summarise_sky(study.value(), 1, 0.001, 90.0).all.mean, 0.05);
  EXPECT_GT(summarise_sky(study.value(), 2, 0.001, 90.0).all.mean, 0.15);

  const Origin origin = {"tyndall validate <&>", "1.2.3", "a device"};
  const std::string html = to_html(study.value(), origin);
  expect_balanced(html);
  EXPECT_NE(html.find("tyndall validate &lt;&amp;&gt;"), std::string::npos);
  EXPECT_NE(html.find("a device"), std::string::npos);
  // The page loads nothing and runs no script.
  for (const char* const foreign : {"<script", "<img", "<link", "src=", "href=", "url(h", "@import"}) {
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  }
  EXPECT_EQ(html.find("nan"), std::string::npos);
  const Color white = {1.0, 1.0, 1.0};
  const ColorTest colors = {
      {"rgb"}, {{30.0, 5.0, 90.0}, {30.0, 60.0, 90.0}}, {white, white}, {0.01, 0.01}, {{white, {1.1, 1.1, 1.1}}}};
  const std::string page = to_markdown(study.value(), colors, origin);
  EXPECT_NE(page.find("| rgb | 60° to 14° | 30° to 90° | 10.00 | 10.00 | 0.0000 |"), std::string::npos) << page;
  EXPECT_LT(page.find("    tyndall validate <&>\n"), page.find("## Models"));
  EXPECT_NE(page.find("| all | 0.50 | 0.2 | 0 to -6 deg |"), std::string::npos);
  EXPECT_EQ(page.find("| first | 0.50 | 0.2 |"), std::string::npos);  // compared with order 1 only
  EXPECT_NE(html.find("Turbid atmospheres near the horizon"), std::string::npos);
  EXPECT_NE(to_json(study.value(), colors, origin).find("\"optical_depth\": 0.3"), std::string::npos);
  EXPECT_EQ(page.find("| nan"), std::string::npos);

  const Result<Study> again = run_study({}, options, models, {tracer("at the horizon", 0, 1.0)}, [](double) {});
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(to_html(again.value(), origin), html);
  EXPECT_EQ(to_json(again.value(), colors, origin), to_json(study.value(), colors, origin));
}

TEST(ValidateStudy, PartsGiveTheSameReport) {
  Options options;
  options.rays = 18;
  options.samples = 40;
  options.orders = 2;
  // Unlike a path tracer, it does not depend on which other rays there are.
  const auto answer = [](const Params&, std::span<const RayQuery> queries) -> Result<std::vector<Rgb>> {
    std::vector<Rgb> out;
    for (const RayQuery& q : queries) out.push_back({0.1 * q.view_zenith_rad, 0.1 * q.sun_zenith_rad, 0.2});
    return out;
  };
  const std::vector<Model> models = {{"first", "", 1, answer}, {"all", "", 0, answer}};
  const std::vector<Model> horizon = {{"at the horizon", "", 0, answer}};
  const auto ignore = [](double) {};
  const Result<Study> whole = run_study({}, options, models, horizon, ignore);
  ASSERT_TRUE(whole.ok());
  std::vector<StudyPart> parts;
  std::size_t count = color_rays().size();
  for (std::uint64_t i = 0; i < 3; ++i) {
    Result<StudyPart> part = run_study_part({}, options, models, horizon, {i, 3}, ignore);
    ASSERT_TRUE(part.ok());
    count += part.value().size();
    parts.push_back(std::move(part).value());
  }
  EXPECT_EQ(count, count_queries({}, options, true));
  const Result<Study> joined = join_study({}, options, models, horizon, parts);
  ASSERT_TRUE(joined.ok());
  EXPECT_EQ(to_html(joined.value(), {}), to_html(whole.value(), {}));
  parts[1].pop_back();
  EXPECT_FALSE(join_study({}, options, models, horizon, parts).ok());
  EXPECT_FALSE(join_study({}, options, models, {}, {}).ok());
}

TEST(ValidateStudy, AFailingModelEndsIt) {
  Options options;
  options.rays = 18;
  options.samples = 2;
  const Model broken = {"broken", "", 0, [](const Params&, std::span<const RayQuery>) -> Result<std::vector<Rgb>> {
                          return Error{ErrorCode::device_lost, "gone"};
                        }};
  const Result<Study> study = run_study({}, options, {broken}, {}, [](double) {});
  ASSERT_FALSE(study.ok());
  EXPECT_EQ(study.error().message, "gone");
}

// Pairs 1, 2, 7, 9, 17 and 25 of the test data of Sharma, Wu and Dalal (2005), table 1.
TEST(ValidateColor, Ciede2000OfThePublishedPairs) {
  struct Pair {
    std::array<double, 3> a, b;
    double expected;
  };
  const Pair pairs[] = {{{50.0, 2.6772, -79.7751}, {50.0, 0.0, -82.7485}, 2.0425},
                        {{50.0, 3.1571, -77.2803}, {50.0, 0.0, -82.7485}, 2.8615},
                        {{50.0, 0.0, 0.0}, {50.0, -1.0, 2.0}, 2.3669},
                        {{50.0, 2.49, -0.001}, {50.0, -2.49, 0.0009}, 7.1792},
                        {{50.0, 2.5, 0.0}, {73.0, 25.0, -18.0}, 27.1492},
                        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644}};
  for (const Pair& pair : pairs) {
    EXPECT_NEAR(ciede2000(pair.a, pair.b), pair.expected, 5e-5);
    EXPECT_NEAR(ciede2000(pair.b, pair.a), pair.expected, 5e-5);
  }
}

TEST(ValidateColor, ErrorsOfColours) {
  const Color color = {0.2, 0.3, 0.5};
  const ColorError none = color_error(color, color, 1.0);
  EXPECT_EQ(none.luminance, 0.0);
  EXPECT_EQ(none.chromaticity, 0.0);
  EXPECT_EQ(none.difference, 0.0);
  const ColorError brighter = color_error({0.22, 0.33, 0.55}, color, 1.0);
  EXPECT_NEAR(brighter.luminance, 0.1, 1e-9);
  EXPECT_NEAR(brighter.chromaticity, 0.0, 1e-9);
  EXPECT_GT(brighter.difference, 1.0);
  EXPECT_GT(color_error({0.25, 0.3, 0.5}, color, 1.0).chromaticity, 0.005);
}

}  // namespace
}  // namespace tyndall::validate
