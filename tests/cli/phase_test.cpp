// Phase functions of the aerosol on the command line: files, refusals, and the agreement of all models.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "files/csv.hpp"
#include "files/text.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

const std::string kQueries =
    "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n"
    "0,60,50,20\n0,85,70,5\n0,30,80,150\n2000,80,75,60\n100,100,60,30\n0,40,45,4\n9000,95,80,120\n";

class CliPhase : public testing::Test {
 protected:
  // Returns the channels of all results of `probe`.
  std::vector<double> probe(const std::string& model, const std::vector<std::string>& settings,
                            const std::string& err = "") const {
    std::vector<std::string> arguments = {"probe", "--queries", scratch_.write("q.csv", kQueries), "--model", model};
    if (model == "reference") arguments.insert(arguments.end(), {"--orders", "1", "--samples", "30000"});
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err, err);
    std::vector<double> out;
    Result<files::CsvTable> table = files::parse_csv(process.out, "output");
    if (!table) return out;
    for (std::size_t row = 0; row < table.value().rows(); ++row) {
      for (const char* const column : {"L_r", "L_g", "L_b"}) {
        double value = std::nan("");
        static_cast<void>(files::read_number(table.value().field(row, table.value().find(column).front()), value));
        out.push_back(value);
      }
    }
    return out;
  }

  // Writes a table of Henyey and Greenstein's function with these asymmetries at 440, 550 and 680 nm.
  std::string table_of(double blue, double green, double red, double factor = 1.0) const {
    std::string text = "angle_deg,440,550,680\n";
    for (double angle = 0.0; angle <= 180.0; angle += angle < 20.0 ? 0.25 : 1.0) {
      text += files::number_text(angle);
      for (const double g : {blue, green, red}) {
        const double base = 1.0 + g * g - 2.0 * g * std::cos(angle * std::numbers::pi / 180.0);
        text += "," + files::number_text(factor * (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(base, 1.5)));
      }
      text += "\n";
    }
    return scratch_.write("phase.csv", text);
  }

  static void expect_error(const std::vector<std::string>& settings, const std::string& message) {
    std::vector<std::string> arguments = {"params"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 2);
    EXPECT_EQ(process.err, "tyndall: error: " + message + "\n");
  }

  Scratch scratch_;
};

double mean_error(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += std::abs(a[i] / b[i] - 1.0);
  return sum / static_cast<double>(a.size());
}

const std::vector<std::string> kSmall = {"tables.cache=off", "tables.size=8,16,16,4", "tables.orders=2"};

std::vector<std::string> with(std::vector<std::string> more) {
  more.insert(more.end(), kSmall.begin(), kSmall.end());
  return more;
}

// A table of a function that also has a formula gives the same light, in single scattering and in all orders.
TEST_F(CliPhase, ATableOfAFormulaGivesTheSameLight) {
  const std::vector<std::string> formula = with({"atmosphere.mie_phase=henyey-greenstein", "atmosphere.mie_g=0.7"});
  const std::vector<std::string> table =
      with({"atmosphere.mie_phase=table", "atmosphere.phase_table=" + table_of(0.7, 0.7, 0.7)});
  EXPECT_LT(mean_error(probe("single", table), probe("single", formula)), 3e-4);
  EXPECT_LT(mean_error(probe("precomputed", table), probe("precomputed", formula)), 2e-3);
}

TEST_F(CliPhase, SingleScatteringAgreesWithThePathTracer) {
  EXPECT_LT(mean_error(probe("single", {"atmosphere.mie_phase=draine", "atmosphere.droplet_diameter_um=3"}),
                       probe("reference", {"atmosphere.mie_phase=draine", "atmosphere.droplet_diameter_um=3"})),
            5e-3);  // mostly noise of few paths
  const std::vector<std::string> table = {"atmosphere.mie_phase=table",
                                          "atmosphere.phase_table=" + table_of(0.5, 0.7, 0.8)};
  EXPECT_LT(mean_error(probe("single", table), probe("reference", table)), 5e-3);
}

// The channels of a table that depends on the wavelength are those of three functions.
TEST_F(CliPhase, EachChannelHasItsOwnFunction) {
  const std::vector<double> mixed =
      probe("single", {"atmosphere.mie_phase=table", "atmosphere.phase_table=" + table_of(0.4, 0.6, 0.8)});
  const char* const g[] = {"0.8", "0.6", "0.4"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<double> plain =
        probe("single", {"atmosphere.mie_phase=henyey-greenstein", std::string("atmosphere.mie_g=") + g[c]});
    ASSERT_EQ(plain.size(), mixed.size());
    for (std::size_t i = c; i < plain.size(); i += 3) EXPECT_NEAR(mixed[i] / plain[i], 1.0, 2e-3);
  }
}

TEST_F(CliPhase, ACorrectionIsNotedAndAMistakeIsRefused) {
  const std::string file = "atmosphere.phase_table=" + table_of(0.7, 0.7, 0.7, 1.05);
  probe("single", {"atmosphere.mie_phase=table", file},
        "tyndall: note: atmosphere.phase_table: the integral over the sphere was off by 5 % and has been corrected\n");
  expect_error(
      {"atmosphere.mie_phase=table"},
      "atmosphere.phase_table: empty value with atmosphere.mie_phase = table; expected a CSV file of angles and "
      "wavelengths");
  const std::string bad = scratch_.write("bad.csv", "angle_deg,550\n0,0.1\n90,-0.1\n180,0.1\n");
  expect_error({"atmosphere.mie_phase=table", "atmosphere.phase_table=" + bad},
               "atmosphere.phase_table: " + bad +
                   ": phase table: invalid value -0.1 at 90 degrees and 550 nm; expected 0 or more");
  const std::string header = scratch_.write("header.csv", "angle,550\n0,0.1\n");
  expect_error({"atmosphere.mie_phase=table", "atmosphere.phase_table=" + header},
               "atmosphere.phase_table: " + header +
                   ":1: invalid header; expected angle_deg, and then one wavelength in nm for each further column");
  expect_error(
      {"atmosphere.mie_phase=draine", "scattering.model=oneil"},
      "atmosphere.mie_phase: 'draine' is not supported by scattering.model = oneil; expected cornette-shanks or "
      "henyey-greenstein");
}

}  // namespace
}  // namespace tyndall::cli
