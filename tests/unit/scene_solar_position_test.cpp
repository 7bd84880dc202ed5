// The sun by place and time, against published positions and against general properties.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scene/description/lunar_position.hpp"
#include "scene/description/placed_sun.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::scene {
namespace {

double time_of(const std::string& text) {
  const Result<double> read = parse_time(text, "--time");
  EXPECT_TRUE(read.ok()) << (read ? text : read.error().message);
  return read ? read.value() : 0.0;
}

SolarPosition sun(double latitude_deg, double longitude_deg, const std::string& time, double altitude_m = 0.0) {
  return solar_position({latitude_deg, longitude_deg}, time_of(time), altitude_m);
}

// Returns the apparent ecliptic longitude from right ascension and declination: tan(lambda) = y / x on the ecliptic.
double longitude_deg(const SolarPosition& p, double obliquity_deg) {
  const double rad = std::acos(-1.0) / 180.0;
  const double x = std::cos(p.declination_deg * rad) * std::cos(p.right_ascension_deg * rad);
  const double y = std::cos(p.declination_deg * rad) * std::sin(p.right_ascension_deg * rad);
  const double z = std::sin(p.declination_deg * rad);
  return std::atan2(y * std::cos(obliquity_deg * rad) + z * std::sin(obliquity_deg * rad), x) / rad;
}

TEST(PlacedSun, RefractionIsThatOfTheLiterature) {
  // Reda and Andreas (2003), table A5.1, for 820 mbar and 11 degrees Celsius instead of 1010 and 10.
  EXPECT_NEAR(refraction_deg(39.872046), 0.016332 * (1010.0 / 820.0) * (284.0 / 283.0), 1e-4);
  // Bennett (1982) gives 34.5 arc minutes for an object that is seen at the horizon.
  EXPECT_NEAR(refraction_deg(-34.5 / 60.0), 34.5 / 60.0, 0.01);
  EXPECT_NEAR(refraction_deg(90.0), 0.0, 1e-5);
  EXPECT_EQ(refraction_deg(-5.0), 0.0);
  EXPECT_EQ(refraction_deg(-90.0), 0.0);
  double before = -90.0 + refraction_deg(-90.0);
  for (double h = -90.0; h <= 90.0; h += 0.05) {
    const double seen = h + refraction_deg(h);
    EXPECT_TRUE(std::isfinite(seen) && seen >= before) << h;  // the order of elevations does not change
    before = seen;
  }
}

TEST(PlacedSun, RefractionFlattensTheDisc) {
  // On the horizon, refraction flattens the discs of sun and moon by about a sixth.
  EXPECT_NEAR(refraction_flattening(0.0, 0.2667), 0.83, 0.02);
  EXPECT_NEAR(refraction_flattening(10.0, 0.2667), 0.99, 0.005);
  EXPECT_NEAR(refraction_flattening(89.0, 0.2667), 1.0, 1e-3);
}

// Meeus, "Astronomical Algorithms" (1998), examples 47.a and 48.a: 1992 April 12, 0 h TD.
TEST(Moon, ItStandsWhereItWasPublished) {
  const LunarPosition moon = lunar_position({0.0, 0.0}, 2448724.5 - delta_t_s(1992.28) / 86400.0);
  EXPECT_NEAR(moon.right_ascension_deg, 134.688470, 0.02);
  EXPECT_NEAR(moon.declination_deg, 13.768368, 0.02);
  EXPECT_NEAR(moon.distance_km, 368409.7, 40.0);
  EXPECT_NEAR(moon.phase_angle_deg, 69.0756, 0.02);
}

TEST(Moon, ParallaxAndSizeFollowItsDistance) {
  // Two observers on opposite sides of the Earth would see a distant body at elevations whose sum is 0. For the moon,
  // the sum is lower by the parallax.
  const double day = time_of("2026-01-03T10:00Z");  // a full moon
  const LunarPosition here = lunar_position({20.0, 30.0}, day);
  const LunarPosition there = lunar_position({-20.0, -150.0}, day);
  const double h = 0.5 * (here.elevation_deg - there.elevation_deg) * std::acos(-1.0) / 180.0;
  const double parallax = 2.0 * 6378.14 / here.distance_km * std::cos(h) * 180.0 / std::acos(-1.0);
  EXPECT_NEAR(here.elevation_deg + there.elevation_deg, -parallax, 0.02);
  EXPECT_LT(here.phase_angle_deg, 10.0);
  EXPECT_NEAR(here.angular_radius_deg, 0.2725 * std::asin(6378.14 / here.distance_km) * 180.0 / std::acos(-1.0), 0.006);
}

// Krisciunas and Schaefer (1991); a full moon gives 0.2 to 0.4 lux, a half moon a tenth of that.
TEST(Moon, ItsLightFollowsThePhase) {
  EXPECT_NEAR(moon_illuminance(7.0), 0.264, 0.003);
  EXPECT_NEAR(moon_illuminance(0.0), 0.423, 0.01);
  EXPECT_NEAR(moon_illuminance(90.0), 0.0285, 0.001);
  EXPECT_EQ(moon_illuminance(-30.0), moon_illuminance(30.0));
  MoonParams moon;
  moon.angular_radius_deg = 0.2591F;
  EXPECT_NEAR(moon_irradiance_ratio(moon, -1.0), 0.423 / 133183.0, 1e-7);
  EXPECT_NEAR(moon_irradiance_ratio(moon, 0.0), 0.0285 / 133183.0, 1e-8);
}

TEST(Moon, ByDateItReplacesTheAngles) {
  MoonParams moon;
  moon.by_date = true;
  SunParams sun;
  EXPECT_FALSE(placed_moon(moon, sun, std::nullopt).ok());
  sun.time = "2026-01-03T22:00Z";
  EXPECT_FALSE(placed_moon(moon, sun, std::nullopt).ok());
  sun.place = "47,8";
  const Result<MoonParams> placed = placed_moon(moon, sun, std::nullopt);
  ASSERT_TRUE(placed.ok());
  const LunarPosition expected = lunar_position({47.0, 8.0}, time_of("2026-01-03T22:00Z"));
  EXPECT_NEAR(placed.value().elevation_deg, expected.elevation_deg, 1e-4);
  EXPECT_NEAR(placed.value().azimuth_deg, expected.azimuth_deg, 1e-4);
  EXPECT_GT(expected.elevation_deg, 30.0);  // a full moon in winter stands high at night
}

TEST(PlacedSun, TimeAndPlaceReplaceTheAngles) {
  SunParams sun;
  sun.time = "2003-10-17T12:30:30-07:00";
  EXPECT_FALSE(placed_sun(sun, std::nullopt).ok());
  const Result<SunParams> by_file = placed_sun(sun, Place{39.742476, -105.1786});
  ASSERT_TRUE(by_file.ok());
  EXPECT_NEAR(by_file.value().elevation_deg, 39.872, 2e-3);
  EXPECT_NEAR(by_file.value().azimuth_deg, 194.340, 2e-3);
  sun.place = "-39.742476,74.8214";  // the opposite point of the Earth
  const Result<SunParams> opposite = placed_sun(sun, Place{39.742476, -105.1786});
  ASSERT_TRUE(opposite.ok());
  EXPECT_NEAR(opposite.value().elevation_deg, -39.872, 0.01);
  sun.refraction = true;
  sun.place = "39.742476,-105.1786";
  const Result<SunParams> raised = placed_sun(sun, std::nullopt);
  ASSERT_TRUE(raised.ok());
  EXPECT_NEAR(raised.value().elevation_deg, 39.872 + 0.020, 2e-3);
  sun.time.clear();
  sun.elevation_deg = 0.0F;
  ASSERT_TRUE(placed_sun(sun, std::nullopt).ok());
  EXPECT_NEAR(placed_sun(sun, std::nullopt).value().elevation_deg, 0.483, 1e-3);
  EXPECT_EQ(placed_sun(sun, std::nullopt).value().azimuth_deg, sun.azimuth_deg);
  for (const char* const wrong : {"noon", "2003-10-17", "1803-10-17T12:30:30Z"}) {
    sun.time = wrong;
    const Result<SunParams> refused = placed_sun(sun, std::nullopt);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message.find("sun.time: '"), 0U) << refused.error().message;
  }
}

// Reda and Andreas (2003), table A5.1: Golden, Colorado. The zenith angle with refraction is 50.11162; refraction there
// is 0.016332 for 820 mbar and 11 degrees Celsius.
TEST(SolarPosition, WorkedExampleOfTheReport) {
  const SolarPosition p = sun(39.742476, -105.1786, "2003-10-17T12:30:30-07:00", 1830.14);
  EXPECT_NEAR(90.0 - p.elevation_deg, 50.11162 + 0.016332, 2e-4);
  EXPECT_NEAR(p.azimuth_deg, 194.34024, 4e-4);
  EXPECT_NEAR(p.right_ascension_deg, 202.22741, 2e-4);
  EXPECT_NEAR(p.declination_deg, -9.31434, 2e-4);
  EXPECT_NEAR(p.distance_au, 0.9965422974, 2e-5);  // terms below 1e-5 are left out
}

// Meeus, "Astronomical Algorithms" (1998), example 25.b: 1992 October 13, 0h of dynamical time, which was 59
// s ahead of universal time.
TEST(SolarPosition, MeeusExample25) {
  const SolarPosition p = sun(0.0, 0.0, "1992-10-12T23:59:01Z");
  EXPECT_NEAR(p.right_ascension_deg, 198.378178, 3e-4);
  EXPECT_NEAR(p.declination_deg, -7.783817, 3e-4);
  EXPECT_NEAR(p.distance_au, 0.99760775, 2e-5);
}

// Apparent longitudes 0, 90, 180 and 270 deg at the published instants, to the minute (0.0007 deg): "Earth's
// Seasons" of the U.S. Naval Observatory; 1962: Meeus, example 27.b (June 21, 21:24:42 of dynamical time, 34
// s ahead).
TEST(SolarPosition, EquinoxesAndSolstices) {
  const struct {
    const char* time;
    double longitude_deg;
  } instants[] = {
      {"1962-06-21T21:24:08Z", 90.0}, {"2000-03-20T07:35Z", 0.0},   {"2000-06-21T01:48Z", 90.0},
      {"2000-09-22T17:27Z", 180.0},   {"2000-12-21T13:37Z", 270.0}, {"2010-03-20T17:32Z", 0.0},
      {"2024-03-20T03:06Z", 0.0},     {"2024-06-20T20:51Z", 90.0},  {"2024-09-22T12:44Z", 180.0},
      {"2024-12-21T09:20Z", 270.0},
  };
  for (const auto& instant : instants) {
    const SolarPosition p = sun(0.0, 0.0, instant.time);
    const double difference = std::remainder(longitude_deg(p, 23.4385) - instant.longitude_deg, 360.0);
    EXPECT_NEAR(difference, 0.0, 1.2e-3) << instant.time;
  }
}

TEST(SolarPosition, InvariantsHold) {
  // Solar noon is midway between equal elevations, up to the change of declination.
  double best = -90.0;
  double noon = 0.0;
  const double day = time_of("2021-06-21T00:00Z");
  for (int minute = 0; minute < 1440; ++minute) {
    const double elevation = solar_position({48.0, 11.0}, day + minute / 1440.0).elevation_deg;
    if (elevation > best) {
      best = elevation;
      noon = day + minute / 1440.0;
    }
  }
  EXPECT_NEAR(best, 90.0 - 48.0 + 23.436, 0.01);
  EXPECT_NEAR(solar_position({48.0, 11.0}, noon).azimuth_deg, 180.0, 0.5);
  const double before = solar_position({48.0, 11.0}, noon - 0.2).elevation_deg;
  EXPECT_NEAR(before, solar_position({48.0, 11.0}, noon + 0.2).elevation_deg, 0.1);

  // At the equinox the sun rises in the east, sets in the west, and passes the zenith of the equator.
  EXPECT_NEAR(sun(30.0, 0.0, "2024-03-20T06:07:30Z").azimuth_deg, 90.0, 0.3);
  EXPECT_NEAR(sun(30.0, 0.0, "2024-03-20T18:07:30Z").azimuth_deg, 270.0, 0.3);
  EXPECT_GT(sun(0.0, 0.0, "2024-03-20T12:07:30Z").elevation_deg, 89.7);

  // Midnight sun in the north, polar night in the south; at the poles the elevation changes slowly.
  for (int hour = 0; hour < 24; ++hour) {
    const double when = day + hour / 24.0;
    EXPECT_GT(solar_position({69.6, 18.9}, when).elevation_deg, 2.0) << hour;
    EXPECT_LT(solar_position({-69.6, 18.9}, when).elevation_deg, -2.0) << hour;
    EXPECT_NEAR(solar_position({90.0, 0.0}, when).elevation_deg, 23.436, 0.004) << hour;
    EXPECT_NEAR(solar_position({-90.0, 0.0}, when).elevation_deg, -23.436 - 0.0024, 0.004) << hour;
  }
  // The place rotates with the Earth: 15 degrees per hour, apart from the sun's own motion.
  EXPECT_NEAR(sun(40.0, 0.0, "2024-05-01T12:00Z").elevation_deg, sun(40.0, -15.0, "2024-05-01T13:00Z").elevation_deg,
              0.02);
  EXPECT_NEAR(sun(40.0, 180.0, "2024-05-01T03:00Z").azimuth_deg, sun(40.0, -180.0, "2024-05-01T03:00Z").azimuth_deg,
              1e-9);
}

TEST(SolarPosition, DynamicalTime) {
  // Observed values in s (Meeus, table 10.A, and the International Earth Rotation Service).
  for (const auto& [year, seconds] : {std::pair(1900.0, -2.8), std::pair(1950.0, 29.1), std::pair(1977.0, 47.5),
                                      std::pair(2000.0, 63.8), std::pair(2010.0, 66.1)}) {
    EXPECT_NEAR(delta_t_s(year), seconds, 1.0) << year;
  }
  // The pieces are continuous; one second changes the sun's longitude by 0.00001 degrees.
  for (const double year : {1920.0, 1941.0, 1961.0, 1986.0, 2005.0, 2050.0}) {
    EXPECT_NEAR(delta_t_s(year - 1e-9), delta_t_s(year), 1.0) << year;
  }
}

TEST(SolarPosition, TimesAreRead) {
  EXPECT_EQ(time_of("2000-01-01T12:00:00Z"), 2451545.0);
  EXPECT_EQ(time_of("2000-01-01T12:00Z"), 2451545.0);
  EXPECT_EQ(time_of("2000-01-01 12:00:00z"), 2451545.0);
  EXPECT_EQ(time_of("2000-01-01T05:00:00-07:00"), 2451545.0);
  EXPECT_EQ(time_of("2000-01-02T01:30:00+1330"), 2451545.0);
  EXPECT_EQ(time_of("2000-01-01T13:00:00+01"), 2451545.0);
  EXPECT_NEAR(time_of("2000-01-01T12:00:00.25Z"), 2451545.0 + 0.25 / 86400.0, 1e-9);
  EXPECT_NEAR(time_of("2000-01-01T12:00:00,25Z"), 2451545.0 + 0.25 / 86400.0, 1e-9);
  // Meeus, chapter 7.
  EXPECT_EQ(time_of("1987-01-27T00:00Z"), 2446822.5);
  EXPECT_EQ(time_of("1987-06-19T12:00Z"), 2446966.0);
  EXPECT_EQ(time_of("1900-01-01T00:00Z"), 2415020.5);
  EXPECT_EQ(time_of("2024-03-01T00:00Z") - time_of("2024-02-29T00:00Z"), 1.0);
  EXPECT_EQ(time_of("2100-03-01T00:00Z") - time_of("2100-02-28T00:00Z"), 1.0);
}

TEST(SolarPosition, TimesAreRefused) {
  const auto message = [](const std::string& text) {
    const Result<double> read = parse_time(text, "--time");
    return read ? std::string("fine") : read.error().message;
  };
  EXPECT_EQ(message("2023-02-29T00:00Z"),
            "--time: '2023-02-29T00:00Z' has no such day; expected 01 to 28 in that month");
  EXPECT_EQ(message("2100-02-29T00:00Z"),
            "--time: '2100-02-29T00:00Z' has no such day; expected 01 to 28 in that month");
  EXPECT_EQ(message("2024-06-01T12:00"),
            "--time: '2024-06-01T12:00' has no offset from UTC; expected Z or an offset such as +01:00 at "
            "the end");
  EXPECT_EQ(message("1899-12-31T23:59Z"),
            "--time: '1899-12-31T23:59Z' is out of range; expected the years 1900 to 2100");
  for (const char* const text : {"",
                                 "now",
                                 "2024-06-01",
                                 "2024-6-1T12:00Z",
                                 "2024-06-01T12Z",
                                 "2024-06-01T12:00:Z",
                                 "2024-06-01T12:00:00.Z",
                                 "2024-06-01T12:00Z ",
                                 "2024-06-01T12:00+",
                                 "2024-06-01T12:00+1",
                                 "2024-06-01T12:00+25:00",
                                 "2024-06-01T12:00+01:60",
                                 "2024-06-01T12:00Z+01:00",
                                 "2024-13-01T12:00Z",
                                 "2024-00-01T12:00Z",
                                 "2024-06-31T12:00Z",
                                 "2024-06-00T12:00Z",
                                 "2024-06-01T24:01Z",
                                 "2024-06-01T24:00:00.5Z",
                                 "2024-06-01T25:00Z",
                                 "2024-06-01T12:60Z",
                                 "2024-06-01T12:00:60Z",
                                 "20240601T120000Z",
                                 "-2024-06-01T12:00Z",
                                 "2101-01-01T00:00Z",
                                 "99999-01-01T00:00Z"}) {
    EXPECT_NE(message(text), "fine") << text;
  }
}

TEST(SolarPosition, TheEndOfADayAndLeapSeconds) {
  const auto day = [](const char* text) { return parse_time(text, "--time").value(); };
  EXPECT_EQ(day("2024-06-01T24:00:00Z"), day("2024-06-02T00:00:00Z"));
  EXPECT_EQ(day("2024-12-31T24:00+01:00"), day("2025-01-01T00:00+01:00"));
  EXPECT_EQ(day("2016-12-31T23:59:60Z"), day("2017-01-01T00:00:00Z"));
}

TEST(SolarPosition, Places) {
  const Result<Place> place = parse_place(" 47.5, -122.25", "--at");
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place.value().latitude_deg, 47.5);
  EXPECT_EQ(place.value().longitude_deg, -122.25);
  EXPECT_EQ(parse_place("0,237.75", "--at").value().longitude_deg, -122.25);
  EXPECT_EQ(parse_place("0,180", "--at").value().longitude_deg, 180.0);
  EXPECT_EQ(parse_place("0,-190", "--at").value().longitude_deg, 170.0);
  for (const char* const text :
       {"", "47", "47,", ",8", "47,8,9", "47;8", "91,0", "-90.01,0", "0,360.5", "0,-361", "nan,0", "inf,0", "47N,8E"}) {
    const Result<Place> refused = parse_place(text, "--at");
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_NE(refused.error().message.find("; expected LAT,LON in degrees"), std::string::npos);
  }
}

}  // namespace
}  // namespace tyndall::scene
