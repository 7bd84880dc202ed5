// `tyndall probe`: tables, results, and every mistake in a table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "effect/medium.hpp"
#include "files/csv.hpp"
#include "files/text.hpp"
#include "models/single_scattering.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

constexpr double kRadPerDeg = 0.017453292519943295;
const std::string kHeader = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n";

class CliProbe : public testing::Test {
 protected:
  // Returns the table that `probe` prints for these queries, with the model `single` by default. Empty after a failure,
  // which is reported.
  files::CsvTable probe(const std::string& queries, std::vector<std::string> more = {}) const {
    if (std::find(more.begin(), more.end(), "--model") == more.end()) more.insert(more.end(), {"--model", "single"});
    more.insert(more.begin(), {"probe", "--queries", scratch_.write("q.csv", queries)});
    const ProcessResult process = run_tyndall(more);
    EXPECT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err, "");
    Result<files::CsvTable> table = files::parse_csv(process.out, "output");
    EXPECT_TRUE(table.ok());
    return table.ok() ? std::move(table).value() : files::CsvTable();
  }
  static double number(const files::CsvTable& table, std::size_t row, const std::string& column) {
    const std::vector<std::size_t> found = table.find(column);
    double value = std::numeric_limits<double>::quiet_NaN();
    if (found.size() == 1 && row < table.rows()) {
      static_cast<void>(files::read_number(table.field(row, found.front()), value));
    }
    return value;
  }

  Scratch scratch_;
};

TEST_F(CliProbe, EveryFormOfTableIsReadAndItsColumnsAreCopied) {
  // The table has another order of columns, an extra column, quoted fields with a comma, a quote and a line end, CRLF,
  // a byte order mark and blank lines, and does not end with a line end.
  const files::CsvTable table =
      probe("\xEF\xBB\xBF\r\nid, azimuth_deg ,\"view_zenith_deg\",sun_zenith_deg,altitude_m\r\n"
            "\"a,\"\"b\",30,60,+3e1,0\r\n\r\n   \r\n\"two\nlines\",-30, \"60\" ,30.0,0\r\nlast,,sky,30,0");
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_EQ(table.header[0], "id");
  EXPECT_EQ(table.header[1], " azimuth_deg ");
  EXPECT_EQ(table.header[2], "\"view_zenith_deg\"");
  EXPECT_EQ(table.field(0, 0), "\"a,\"\"b\"");
  EXPECT_EQ(table.field(0, 3), "+3e1");
  EXPECT_EQ(table.field(1, 0), "\"two\nlines\"");
  EXPECT_EQ(table.field(2, 2), "sky");
  ASSERT_EQ(table.header.size(), 11U);
  for (const char* const column : {"L_r", "L_g", "L_b", "T_r", "T_g", "T_b"}) {
    EXPECT_GT(number(table, 0, column), 0.0);
    // The atmosphere is symmetric about the sun's plane.
    EXPECT_EQ(number(table, 0, column), number(table, 1, column)) << column;
  }
  // Result columns of an earlier run are replaced, so that a result can be used as a query table.
  const std::string again = std::string(*table.text);
  EXPECT_EQ(*probe(again).text, again);
}

// Tables of pandas have a first column without a name.
TEST_F(CliProbe, AFirstColumnWithoutANameIsCopied) {
  const files::CsvTable table = probe(",altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n7,0,60,30,30\n");
  ASSERT_EQ(table.header.size(), 11U);
  EXPECT_EQ(table.header[0], "");
  EXPECT_EQ(table.header[1], "altitude_m");
  EXPECT_EQ(table.field(0, 0), "7");
  EXPECT_GT(number(table, 0, "L_b"), 0.0);
}

// Every batch of rays has the results of the same rays in another batch.
TEST_F(CliProbe, ManyRaysThroughTheTables) {
  constexpr int kDifferent = 90, kRows = 66000;
  std::string text = kHeader;
  for (int i = 0; i < kRows; ++i) text += "0," + std::to_string(i % kDifferent) + ",30,40\n";
  const files::CsvTable table = probe(text, {"--model", "precomputed", "--set", "tables.size=8,32,16,8"});
  ASSERT_EQ(table.rows(), std::size_t{kRows});
  const std::size_t column = table.find("L_g").front();
  for (std::size_t i = kDifferent; i < table.rows(); ++i) {
    ASSERT_EQ(table.field(i, column), table.field(i - kDifferent, column)) << i;
  }
  EXPECT_NE(table.field(0, column), table.field(1, column));
}

TEST_F(CliProbe, SingleIsTheIntegralAndTheSkyItsIrradiance) {
  const shared::Medium medium = medium_from_params({});
  const files::CsvTable table =
      probe(kHeader + "0,30,60,0\n8000,95,88,170\n400000,100,40,20\n400000,60,40,20\n3000,sky,70,0\n");
  const double rays[3][4] = {{0, 30, 60, 0}, {8000, 95, 88, 170}, {400000, 100, 40, 20}};
  const char* const channels = "rgb";
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string l = std::string("L_") + channels[c];
    const std::string t = std::string("T_") + channels[c];
    for (std::size_t row = 0; row < 3; ++row) {
      const double* ray = rays[row];
      const models::Answer truth = models::single_scattering(
          medium, models::ray_from_angles(ray[0], ray[1] * kRadPerDeg, ray[2] * kRadPerDeg, ray[3] * kRadPerDeg));
      // The device computes in single precision; tests/gpu/probe_test.cpp covers the whole range.
      EXPECT_NEAR(number(table, row, l), truth.radiance[c], 2e-3 * truth.radiance[c]) << row;
      EXPECT_NEAR(number(table, row, t), truth.transmittance[c], 2e-3 * truth.transmittance[c]) << row;
    }
    // This ray goes into space, where nothing scatters.
    EXPECT_EQ(number(table, 3, l), 0.0);
    EXPECT_EQ(number(table, 3, t), 1.0);
    // Doubles are printed with all digits.
    const double cos_sun = std::cos(70.0 * kRadPerDeg);
    EXPECT_EQ(number(table, 4, l), models::single_sky_irradiance(medium, 3000.0, cos_sun)[c]);
    EXPECT_EQ(number(table, 4, t), models::sun_transmittance(medium, 3000.0, cos_sun)[c]);
  }
}

TEST_F(CliProbe, ReferenceAgreesWithSingleWithinItsError) {
  const std::string queries =
      kHeader + "0,30,60,0\n8000,95,88,170\n3000,sky,70,0\n-400,80,70,90\n-400,93,60,40\n0,100,40,0\n";
  const std::vector<std::string> one = {"--model", "reference", "--orders", "1", "--samples", "20000"};
  const files::CsvTable reference = probe(queries, one);
  const files::CsvTable single = probe(queries);
  ASSERT_EQ(reference.header.size(), 13U);
  for (const char* const channel : {"r", "g", "b"}) {
    const std::string l = std::string("L_") + channel;
    for (std::size_t row = 0; row < 5; ++row) {
      const double error = number(reference, row, std::string("stderr_") + channel);
      EXPECT_GT(error, 0.0);
      // Five standard errors (a chance of one in a million each), and 0.2 % for single precision.
      EXPECT_NEAR(number(reference, row, l), number(single, row, l), 5.0 * error + 2e-3 * number(single, row, l));
    }
  }
  EXPECT_EQ(*probe(queries, one).text, *reference.text);
  std::vector<std::string> seeded = one;
  seeded.insert(seeded.end(), {"--seed", "2"});
  EXPECT_NE(*probe(queries, seeded).text, *reference.text);
  // The ground at the end of a ray is lit in the reference, and black in single scattering.
  const auto lit_ground = [&](const std::string& model) {
    return number(probe(kHeader + "0,180,40,0\n",
                        {"--model", model, "--samples", "64", "--orders", "1", "--set", "planet.ground_albedo=0.5"}),
                  0, "L_g");
  };
  EXPECT_EQ(lit_ground("single"), 0.0);
  EXPECT_GT(lit_ground("reference"), 0.05);
}

TEST_F(CliProbe, ParametersAndScenesApply) {
  const std::string queries = kHeader + "0,30,60,0\n";
  const files::CsvTable none =
      probe(queries, {"--set", "atmosphere.custom_coefficients=true", "--set", "atmosphere.rayleigh_scattering=0,0,0",
                      "--set", "atmosphere.aerosol_density=0", "--set", "atmosphere.ozone_absorption=0,0,0"});
  EXPECT_EQ(number(none, 0, "L_b"), 0.0);
  EXPECT_EQ(number(none, 0, "T_b"), 1.0);
  const std::string scene = scratch_.write("scene.toml", "[atmosphere]\naerosol_density = 5.0\n");
  EXPECT_LT(number(probe(queries, {scene}), 0, "T_r"), number(probe(queries), 0, "T_r"));
  // The radiance scale of a scene does not apply to probe.
  EXPECT_EQ(*probe(queries, {"--set", "scattering.scale=2"}).text, *probe(queries).text);
}

TEST_F(CliProbe, ThickAtmospheresAreNoted) {
  const std::string path = scratch_.write("queries.csv", kHeader + "0,30,60,0\n");
  const auto notes = [&](const std::string& visibility_m, const std::string& model, const std::string& more) {
    return run_tyndall({"probe", "--queries", path, "--model", model, "--set", "atmosphere.single_scattering_albedo=1",
                        "--set", "atmosphere.visibility_m=" + visibility_m, "--set", more, "--set",
                        "tables.size=8,16,8,8"})
        .err;
  };
  const std::string other = "planet.ground_albedo=0.1";
  EXPECT_EQ(notes("5000", "precomputed", other), "");
  EXPECT_NE(notes("1000", "precomputed", other).find("vertical optical depth of 4.9"), std::string::npos);
  EXPECT_NE(notes("1000", "precomputed", "scattering.multiple=none").find("vertical optical depth of 4.9"),
            std::string::npos);
  EXPECT_EQ(notes("1000", "single", other), "");  // reads no tables
  // The aerosol of an atmosphere whose top is far below its scale height.
  EXPECT_EQ(run_tyndall({"probe", "--queries", path, "--model", "single", "--set", "atmosphere.height_m=1000", "--set",
                         "atmosphere.mie_scale_height_m=100000", "--set", "atmosphere.aerosol_optical_depth=0.01"})
                .err,
            "");
}

TEST_F(CliProbe, HighAtmospheresAreNoted) {
  const std::string path = scratch_.write("queries.csv", kHeader + "0,30,60,0\n");
  const ProcessResult small =
      run_tyndall({"probe", "--queries", path, "--model", "single", "--set", "planet.radius_m=10000"});
  EXPECT_EQ(small.status, 0);
  EXPECT_NE(small.err.find("is more than 0.16 of planet.radius_m"), std::string::npos) << small.err;
}

// What --set assigns without effect is noted, and a scene that chooses another model.
TEST_F(CliProbe, AssignmentsWithoutEffectAreNoted) {
  const std::string path = scratch_.write("queries.csv", kHeader + "0,30,60,0\n");
  const auto note = [&](const std::string& assignment) {
    return run_tyndall({"probe", "--queries", path, "--model", "single", "--set", assignment}).err;
  };
  EXPECT_NE(note("sun.elevation_deg=70").find("sun.elevation_deg has no effect here"), std::string::npos);
  EXPECT_NE(note("camera.altitude_m=900").find("camera.altitude_m has no effect here"), std::string::npos);
  EXPECT_NE(note("scattering.medium=homogeneous").find("--model homogeneous-medium computes this model"),
            std::string::npos);
  EXPECT_NE(note("scattering.model=oneil").find("scattering.model = oneil has no effect here; --model oneil"),
            std::string::npos);
  EXPECT_EQ(note("atmosphere.aerosol_density=2"), "");
}

// An eye exactly at sea level looks at the ground below it from a distance of 0.
TEST_F(CliProbe, AnEyeOnTheGroundSeesIt) {
  const std::string queries = kHeader + "0,100,40,0\n0.001,100,40,0\n0,180,40,0\n";
  const files::CsvTable seen =
      probe(queries, {"--model", "precomputed", "--set", "planet.ground_albedo=0.5", "--set", "tables.size=8,32,16,8"});
  EXPECT_GT(number(seen, 1, "L_g"), 0.1);
  EXPECT_NEAR(number(seen, 0, "L_g"), number(seen, 1, "L_g"), 1e-4);
  EXPECT_NEAR(number(seen, 2, "L_g"), number(seen, 1, "L_g"), 1e-4);
}

TEST_F(CliProbe, WritesAFileOrJson) {
  const std::string queries = scratch_.write("q.csv", kHeader + "0,30,60,0\n0,sky,60,0\n");
  const std::string file = scratch_.at("r.csv");
  const ProcessResult process = run_tyndall({"probe", "--queries", queries, "-o", file, "--json", "--model", "single"});
  ASSERT_EQ(process.status, 0) << process.err;
  EXPECT_EQ(contents_of(file), run_tyndall({"probe", "--queries", queries, "--model", "single"}).out);
  const nlohmann::json document = nlohmann::json::parse(process.out);
  EXPECT_EQ(document["model"], "single");
  ASSERT_EQ(document["answers"].size(), 2U);
  EXPECT_GT(document["answers"][0]["L"][2].get<double>(), 0.0);
  // A single block of samples has no standard error: infinite in a table, null in JSON.
  const std::vector<std::string> rough = {"probe", "--queries", queries, "--model", "reference", "--samples", "1"};
  std::vector<std::string> rough_json = rough;
  rough_json.emplace_back("--json");
  EXPECT_TRUE(nlohmann::json::parse(run_tyndall(rough_json).out)["answers"][0]["stderr"][0].is_null());
  EXPECT_NE(run_tyndall(rough).out.find(",inf"), std::string::npos);
  EXPECT_EQ(*probe(kHeader).text, "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg,L_r,L_g,L_b,T_r,T_g,T_b\n");
}

TEST_F(CliProbe, BadTablesAreNamedByLineAndColumn) {
  const std::pair<std::string, std::string> tables[] = {
      {"", "FILE: no header line; expected a line with the names of the columns"},
      {"\r\n \n", "FILE: no header line; expected a line with the names of the columns"},
      {"altitude_m,view_zenith_deg,sun_zenith_deg\n0,0,0\n",
       "FILE: no column 'azimuth_deg'; expected altitude_m, view_zenith_deg, sun_zenith_deg, azimuth_deg"},
      {"altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg,altitude_m\n",
       "FILE: several columns 'altitude_m'; expected altitude_m, view_zenith_deg, sun_zenith_deg, azimuth_deg, once "
       "each"},
      {kHeader + "0,0,0,0\n\n0,0,O,0\n", "FILE:4: column 'sun_zenith_deg': 'O' is not a number; expected 0 to 180 deg"},
      {kHeader + "0,0,,0\n", "FILE:2: column 'sun_zenith_deg': '' is not a number; expected 0 to 180 deg"},
      {kHeader + "0,Sky,0,0\n",
       "FILE:2: column 'view_zenith_deg': 'Sky' is not a number; expected 0 to 180 deg, or sky"},
      {kHeader + "nan,0,0,0\n",
       "FILE:2: column 'altitude_m': 'nan' is not a finite number; expected -11000 to 1e+09 m"},
      {kHeader + "0,0,0,inf\n", "FILE:2: column 'azimuth_deg': 'inf' is not a finite number; expected -360 to 360 deg"},
      {kHeader + "0,180.001,0,0\n",
       "FILE:2: column 'view_zenith_deg': '180.001' is out of range; expected 0 to 180 deg, or sky"},
      {kHeader + "0,0,-0.1,0\n", "FILE:2: column 'sun_zenith_deg': '-0.1' is out of range; expected 0 to 180 deg"},
      {kHeader + "-11001,0,0,0\n", "FILE:2: column 'altitude_m': '-11001' is out of range; expected -11000 to 1e+09 m"},
      {kHeader + "1e999,0,0,0\n", "FILE:2: column 'altitude_m': '1e999' is out of range; expected -11000 to 1e+09 m"},
      {kHeader + "0,0,0\n", "FILE:2: 3 fields; expected 4, as in the header"},
      {kHeader + "0,0,0,0,0\n", "FILE:2: 5 fields; expected 4, as in the header"},
      {kHeader + "0,0,0,\"0\n0,0,0,0\n", "FILE:2: a quoted field does not end; expected a closing '\"'"},
      {kHeader + "0,0,0,\"0\"1\n", "FILE:2: text after a closing quote; expected a comma or the end of the line"},
      {kHeader + std::string("0,0,0,0\0\n", 9), "FILE: not a text file; expected comma-separated text"},
  };
  for (const auto& [text, message] : tables) {
    const std::string path = scratch_.write("bad.csv", text);
    std::string expected = message;
    expected.replace(expected.find("FILE"), 4, path);
    const ProcessResult process = run_tyndall({"probe", "--queries", path, "-o", scratch_.at("r.csv")});
    EXPECT_EQ(process.status, 2) << expected;
    EXPECT_EQ(process.out, "");
    EXPECT_EQ(process.err, "tyndall: error: " + expected + "\n");
  }
  EXPECT_FALSE(std::filesystem::exists(scratch_.at("r.csv")));
}

// Every model gives finite results for an eye at the sea floor. The planet must be large enough for that depth.
TEST_F(CliProbe, EyesFarBelowSeaLevel) {
  std::string queries = kHeader;
  for (const char* const altitude : {"-430", "-11000"}) {
    for (const char* const view : {"0", "89.9", "90.1", "95", "180", "sky"}) {
      for (const char* const sun : {"40", "89.9", "97"}) {
        queries += std::string(altitude) + "," + view + "," + sun + ",60\n";
      }
    }
  }
  for (const char* const model : {"single", "homogeneous", "homogeneous-medium", "reference"}) {
    const files::CsvTable table = probe(
        queries, {"--model", model, "--samples", "256", "--orders", "3", "--set", "atmosphere.ozone_absorption=0,0,0"});
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (const char* const column : {"L_r", "L_g", "L_b", "T_r", "T_g", "T_b"}) {
        const double value = number(table, row, column);
        EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << model << " " << row << " " << column;
      }
    }
  }
  const std::string path = scratch_.write("deep.csv", kHeader + "0,0,0,0\n-2000,0,0,0\n");
  const ProcessResult process =
      run_tyndall({"probe", "--queries", path, "--model", "single", "--set", "planet.radius_m=4000", "--set",
                   "atmosphere.rayleigh_scale_height_m=500", "--set", "atmosphere.mie_scale_height_m=500"});
  EXPECT_EQ(process.status, 2);
  EXPECT_EQ(process.err,
            "tyndall: error: " + path +
                ":3: column 'altitude_m': an eye at -2000 m is too deep inside the planet; expected at least minus a "
                "quarter of planet.radius_m, -1000 m\n");
}

TEST_F(CliProbe, BadUsage) {
  const std::string queries = scratch_.write("q.csv", kHeader + "0,30,60,0\n");
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{}, "tyndall probe: missing queries; expected --queries FILE"},
      {{"--queries", "/nonexistent.csv"},
       "'/nonexistent.csv': cannot read: No such file or directory; expected a readable file"},
      {{"--queries", "/"}, "'/': cannot read: Is a directory; expected a readable file"},
      {{"--queries", queries, "--orders", "0"}, "--orders: invalid count '0'; expected a whole number, 1 to 256"},
      {{"--queries", queries, "--orders", "257"}, "--orders: invalid count '257'; expected a whole number, 1 to 256"},
      {{"--queries", queries, "--samples", "0"},
       "--samples: invalid count '0'; expected a whole number, 1 to 4294967295"},
      {{"--queries", queries, "--seed", "-1"}, "--seed: invalid count '-1'; expected a whole number, 0 to 4294967295"},
  };
  for (const auto& [more, message] : cases) {
    std::vector<std::string> arguments = {"probe"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 2) << message;
    EXPECT_EQ(process.err, "tyndall: error: " + message + "\n");
  }
  // The error for an unknown model lists the known ones.
  const ProcessResult model = run_tyndall({"probe", "--queries", queries, "--model", "onil"});
  EXPECT_EQ(model.status, 2);
  EXPECT_EQ(model.err.rfind("tyndall: error: --model: unknown value 'onil'; expected one of ", 0), 0U) << model.err;
  for (const char* const name : {"precomputed", "single", "reference"}) {
    EXPECT_NE(model.err.find(name), std::string::npos) << name;
  }
}

TEST_F(CliProbe, OutputsThatCannotBeWritten) {
  const std::string queries = scratch_.write("q.csv", kHeader + "0,30,60,0\n");
  for (const std::string& output : {scratch_.at("none/r.csv"), scratch_.at(""), std::string("/dev/full")}) {
    const ProcessResult process = run_tyndall({"probe", "--queries", queries, "--model", "single", "-o", output});
    EXPECT_EQ(process.status, 1) << output;
    EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1) << process.err;
    EXPECT_NE(process.err.find(": cannot "), std::string::npos) << process.err;
  }
  EXPECT_EQ(run_tyndall({"probe", "--queries", queries, "--model", "single"}, "/dev/full").status, 1);
  // A failed run leaves an existing result untouched.
  const std::string old = scratch_.write("old.csv", "old");
  EXPECT_EQ(run_tyndall({"probe", "--queries", queries, "-o", old, "--device", "no such"}).status, 2);
  EXPECT_EQ(contents_of(old), "old");
}

TEST_F(CliProbe, AMillionLines) {
  std::string text = kHeader;
  // Rays that miss the atmosphere take little time on the device, so this measures the table's own time and memory.
  for (int i = 0; i < 1000000; ++i) text += "100000,1,30," + std::to_string(i % 360) + "\n";
  const std::string out = scratch_.at("r.csv");
  const ProcessResult process =
      run_tyndall({"probe", "--model", "single", "--queries", scratch_.write("big.csv", text), "-o", out});
  ASSERT_EQ(process.status, 0) << process.err;
  const std::string written = contents_of(out);
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), 1000001);
  EXPECT_TRUE(written.ends_with("100000,1,30,279,0,0,0,1,1,1\n")) << written.substr(written.size() - 60);
}

// The columns X, Y and Z of models with four wavelengths agree with the path tracer with forty. Models with three
// channels refuse spectral colours.
TEST_F(CliProbe, SpectralColours) {
  const std::string queries = kHeader + "0,60,80,30\n0,sky,60,\n";
  const std::vector<std::string> spectral = {"--set", "scattering.color=spectral"};
  const files::CsvTable single = probe(queries, spectral);
  ASSERT_EQ(single.rows(), 2U);
  ASSERT_EQ(single.header.size(), 13U);
  std::vector<std::string> traced = spectral;
  traced.insert(traced.end(), {"--model", "reference", "--orders", "1", "--samples", "4000"});
  const files::CsvTable reference = probe(queries, traced);
  ASSERT_EQ(reference.header.size(), 16U);
  for (std::size_t row = 0; row < 2; ++row) {
    const double noise = 4.0 * 683.0 * number(reference, row, "stderr_g") / number(reference, row, "Y");
    for (const char* const column : {"X", "Y", "Z"}) {
      EXPECT_NEAR(number(single, row, column) / number(reference, row, column), 1.0, 0.01 + noise) << row << column;
    }
    // Y is the luminance of the colour.
    EXPECT_NEAR(number(single, row, "Y") / 683.0,
                0.2126729 * number(single, row, "L_r") + 0.7151522 * number(single, row, "L_g") +
                    0.0721750 * number(single, row, "L_b"),
                1e-5 * number(single, row, "Y"));
    for (const char* const column : {"T_r", "T_g", "T_b"}) {
      EXPECT_NEAR(number(single, row, column), number(reference, row, column), 0.005) << row << column;
    }
  }
  for (const char* const model : {"oneil", "oneil-table", "homogeneous"}) {
    const ProcessResult process = run_tyndall({"probe", "--queries", scratch_.write("q.csv", queries), "--model", model,
                                               "--set", "scattering.color=spectral"});
    EXPECT_EQ(process.status, 2) << model;
    EXPECT_NE(process.err.find("scattering.color: 'spectral' is not supported by the model '" + std::string(model)),
              std::string::npos)
        << process.err;
  }
  const ProcessResult scene = run_tyndall(
      {"render", "-o", scratch_.at("a.png"), "--set", "scattering.color=spectral", "--set", "scattering.model=oneil"});
  EXPECT_EQ(scene.status, 2);
  EXPECT_NE(scene.err.find("scattering.color"), std::string::npos) << scene.err;
}

}  // namespace
}  // namespace tyndall::cli
