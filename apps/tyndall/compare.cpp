// `tyndall compare`: measures the difference of two images of the same kind. B is the reference.
#include <cmath>

#include "arguments.hpp"
#include "cli.hpp"
#include "files/text.hpp"
#include "image/image.hpp"
#include "image/metrics.hpp"
#include "input_files.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::number_text;

constexpr int kBeyond = 2;
constexpr int kSizesDiffer = 3;
constexpr int kUnreadable = 4;
constexpr double kEqualPsnrDb = 999.0;  // replaces infinity, which JSON does not have

struct Limits {
  std::optional<double> psnr_min;
  std::optional<double> mre_max;
};

std::string size_text(const image::Image& image) {
  return concat({std::to_string(image.width), "x", std::to_string(image.height)});
}

// Returns which value exceeds its limit, or an empty string.
std::string verdict(const image::Metrics& metrics, const Limits& limits) {
  if (metrics.non_finite_a + metrics.non_finite_b > 0) {
    return concat({"tyndall compare: ", std::to_string(metrics.non_finite_a), " values in A and ",
                   std::to_string(metrics.non_finite_b), " in B are not finite; expected none"});
  }
  if (limits.psnr_min && metrics.psnr_db < *limits.psnr_min) {
    return concat({"--psnr-min: psnr_db is ", number_text(metrics.psnr_db), "; expected at least ",
                   number_text(*limits.psnr_min)});
  }
  if (limits.mre_max && metrics.mean_relative_error > *limits.mre_max) {
    return concat({"--mre-max: mean_relative_error is ", number_text(metrics.mean_relative_error),
                   "; expected at most ", number_text(*limits.mre_max)});
  }
  return "";
}

std::string report(const image::Metrics& metrics, const image::File& file, bool within, bool json) {
  const double psnr_db = std::isinf(metrics.psnr_db) ? kEqualPsnrDb : metrics.psnr_db;
  if (!json) {
    std::string text =
        concat({"rmse ", number_text(metrics.rmse), "\npsnr_db ", number_text(psnr_db), "\nmean_relative_error ",
                number_text(metrics.mean_relative_error), "\nmax_abs ", number_text(metrics.max_abs),
                "\ntrimmed_relative_error ", number_text(metrics.trimmed_relative_error), "\n"});
    if (metrics.non_finite_a + metrics.non_finite_b > 0) {
      text += concat(
          {"non_finite ", std::to_string(metrics.non_finite_a), " ", std::to_string(metrics.non_finite_b), "\n"});
    }
    return text;
  }
  return concat({"{\"rmse\": ",
                 number_text(metrics.rmse),
                 ", \"psnr_db\": ",
                 number_text(psnr_db),
                 ", \"mean_relative_error\": ",
                 number_text(metrics.mean_relative_error),
                 ", \"max_abs\": ",
                 number_text(metrics.max_abs),
                 ", \"trimmed_relative_error\": ",
                 number_text(metrics.trimmed_relative_error),
                 ", \"non_finite\": [",
                 std::to_string(metrics.non_finite_a),
                 ", ",
                 std::to_string(metrics.non_finite_b),
                 "], \"size\": [",
                 std::to_string(file.image.width),
                 ", ",
                 std::to_string(file.image.height),
                 "], \"kind\": \"",
                 file.kind == image::FileKind::png ? "png" : "exr",
                 "\", \"within\": ",
                 within ? "true" : "false",
                 "}\n"});
}

Result<void> write_difference(const std::string& path, const image::File& a, const image::File& b) {
  const Result<image::FileKind> kind = image::kind_of_name(path);
  if (!kind) return kind.error();
  const image::Image shown = image::difference(a.image, b.image);
  if (kind.value() == image::FileKind::exr) return image::write_exr(path, shown, {});
  return image::write_png(path, shown, {}, {image::Encoding::srgb, false});
}

}  // namespace

int run_compare(Args args) {
  std::string path_a;
  std::string path_b;
  std::string difference_path;
  Limits limits;
  bool json = false;
  Arguments arguments("compare");
  arguments.positional("A", path_a, true, "image, PNG or EXR");
  arguments.positional("B", path_b, true, "the reference, of the same kind and size");
  arguments.number("--psnr-min", limits.psnr_min, 0.0, 1.0e6, "smallest accepted psnr_db (peak 1)");
  arguments.number("--mre-max", limits.mre_max, 0.0, 1.0e6, "largest accepted mean_relative_error");
  arguments.text("--diff", difference_path, "OUT", "write |A - B| x 16 as a PNG or EXR");
  arguments.flag("--json", json, "print the results as JSON");
  arguments.footer(
      "Exit status: 0 if the difference is within --psnr-min and --mre-max; 1 if the file of --diff cannot be "
      "written; 2 if the\n"
      "difference exceeds a limit, a value is not finite, or the usage is wrong; 3 if the sizes differ; 4 if "
      "a file cannot be\n"
      "read, or the two are of different kinds.\n");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (!difference_path.empty()) {
    if (const Result<image::FileKind> kind = image::kind_of_name(difference_path); !kind) return fail(kind.error());
    const Result<void> apart = check_not_input(difference_path, "--diff", {{"A", path_a}, {"B", path_b}});
    if (!apart) return fail(apart.error());
    if (const Result<void> r = files::check_writable(difference_path); !r) return fail(r.error());
  }

  const Result<image::File> a = image::read(path_a);
  if (!a) return fail(a.error().message, kUnreadable);
  const Result<image::File> b = image::read(path_b);
  if (!b) return fail(b.error().message, kUnreadable);
  if (a.value().kind != b.value().kind) {
    return fail("tyndall compare: A and B are of different kinds; expected two PNG or two EXR files", kUnreadable);
  }
  for (const auto& [path, file] : {std::pair(path_a, &a.value()), std::pair(path_b, &b.value())}) {
    if (!file->note.empty()) note(concat({"'", files::one_line(path, 200), "': ", file->note}));
  }
  if (a.value().image.width != b.value().image.width || a.value().image.height != b.value().image.height) {
    return fail(concat({"tyndall compare: A is ", size_text(a.value().image), " and B is ", size_text(b.value().image),
                        "; expected equal sizes"}),
                kSizesDiffer);
  }
  const image::Metrics metrics = image::compare(a.value().image, b.value().image);
  if (!difference_path.empty()) {
    if (const Result<void> written = write_difference(difference_path, a.value(), b.value()); !written) {
      return fail(written.error());
    }
  }
  const std::string beyond = verdict(metrics, limits);
  if (const int status = print(report(metrics, a.value(), beyond.empty(), json)); status != kDone) return status;
  return beyond.empty() ? kDone : fail(beyond, kBeyond);
}

}  // namespace tyndall::cli
