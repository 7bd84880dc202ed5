#include "validate_part.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "files/text.hpp"

namespace tyndall::cli {
namespace {

using nlohmann::json;
using validate::Rgb;

// JSON has no infinity and no NaN: these become text.
json json_of(double value) { return std::isfinite(value) ? json(value) : json(files::number_text(value)); }

json json_of(const Rgb& rgb) { return {json_of(rgb[0]), json_of(rgb[1]), json_of(rgb[2])}; }

json json_of(const std::vector<Rgb>& list) {
  json out = json::array();
  for (const Rgb& rgb : list) out.push_back(json_of(rgb));
  return out;
}

// The readers throw an exception of the JSON library for another form.
double number_of(const json& value) {
  if (!value.is_string()) return value.get<double>();
  const std::string text = value.get<std::string>();
  if (text == "nan" || text == "-nan") return std::nan("");
  if (text == "inf") return INFINITY;
  if (text == "-inf") return -INFINITY;
  throw std::out_of_range("number");
}

const json& array_of(const json& value) {
  if (!value.is_array()) throw std::out_of_range("array");
  return value;
}

Rgb rgb_of(const json& value) {
  if (array_of(value).size() != 3) throw std::out_of_range("colour");
  return {number_of(value[0]), number_of(value[1]), number_of(value[2])};
}

std::vector<Rgb> list_of(const json& value) {
  std::vector<Rgb> out;
  for (const json& rgb : array_of(value)) out.push_back(rgb_of(rgb));
  return out;
}

// Conversions of negative or fractional numbers would not report them.
std::uint64_t count_of(const json& value) {
  if (!value.is_number_unsigned()) throw std::out_of_range("count");
  return value.get<std::uint64_t>();
}

}  // namespace

std::string part_json(const validate::StudyPart& rays, const validate::ColorPart& colors) {
  json out;
  out["rays"] = json::array();
  for (const validate::Answered& ray : rays) {
    out["rays"].push_back({{"radiance", json_of(ray.reference.radiance)},
                           {"standard_error", json_of(ray.reference.standard_error)},
                           {"transmittance", json_of(ray.reference.transmittance)},
                           {"samples", ray.reference.samples},
                           {"orders", json_of(ray.reference.order_radiance)},
                           {"order_errors", json_of(ray.reference.order_standard_error)},
                           {"models", json_of(ray.models)}});
  }
  out["colors"] = json::array();
  for (const validate::ColorAnswered& ray : colors) {
    out["colors"].push_back(
        {{"reference", json_of(ray.reference)}, {"noise", json_of(ray.noise)}, {"models", json_of(ray.models)}});
  }
  return out.dump() + "\n";
}

Result<void> parse_part(std::string_view text, std::string_view name, validate::StudyPart& rays,
                        validate::ColorPart& colors) {
  const json read = json::parse(text, nullptr, false);
  try {
    for (const json& ray : array_of(read.at("rays"))) {
      validate::Answered answered;
      answered.reference.radiance = rgb_of(ray.at("radiance"));
      answered.reference.standard_error = rgb_of(ray.at("standard_error"));
      answered.reference.transmittance = rgb_of(ray.at("transmittance"));
      answered.reference.samples = count_of(ray.at("samples"));
      answered.reference.order_radiance = list_of(ray.at("orders"));
      answered.reference.order_standard_error = list_of(ray.at("order_errors"));
      answered.models = list_of(ray.at("models"));
      rays.push_back(std::move(answered));
    }
    for (const json& ray : array_of(read.at("colors"))) {
      colors.push_back({rgb_of(ray.at("reference")), number_of(ray.at("noise")), list_of(ray.at("models"))});
    }
  } catch (const std::exception&) {
    return files::input_error("it is damaged", files::one_line(name, 200), "expected the file of a shard of validate");
  }
  return {};
}

}  // namespace tyndall::cli
