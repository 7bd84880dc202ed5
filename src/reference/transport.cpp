// Paths start at the camera. Every vertex is connected to the sun (next event estimation). The next distance is sampled
// by inverting the optical depth of one channel, and the next direction from one phase function. All channels are
// weighted by the balance heuristic over the possible choices (Veach 1997; Wilkie et al., "Hero wavelength spectral
// sampling", 2014). A channel is chosen with a probability proportional to the light that it scatters on the line,
// which bounds the growth of the sum of the throughputs.
#include "reference/transport.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "math/angles.hpp"
#include "reference/glow.hpp"
#include "reference/random.hpp"

namespace tyndall::reference {
namespace {

// On a line through the planet's shadow, the fractions of the distance samples that are restricted to the part the sun
// reaches, and to the part it reaches with little attenuation (Atmosphere::opaque_radius_m).
constexpr std::array<double, 2> kLitFractions = {0.2, 0.2};

template <std::size_t N>
double sum(const Light<N>& v) {
  double total = v[0];
  for (std::size_t c = 1; c < N; ++c) total += v[c];
  return total;
}

struct Vertex {
  bool ground = false;
  Vec position;
  double r = 0.0;
  Amounts density;
};

// Computes the transmittance from a point in the atmosphere with the given densities to the sun. Returns false if the
// planet hides the sun.
template <std::size_t N>
bool sun_transmittance(const Atmosphere& air, const Vec& position, double r, const Amounts& density, const Vec& sun,
                       Light<N>& transmittance) {
  Amounts integrals;
  if (!sunward_integrals(air, position, r, density, sun, integrals)) return false;
  for (std::size_t c = 0; c < N; ++c) transmittance[c] = air.transmittance(integrals, c);
  return true;
}

// Adds the sunlight that a Lambertian ground reflects; `weight` is the throughput after reflection.
template <std::size_t N>
void add_ground(const Atmosphere& air, const Vertex& v, const Vec& sun, const Light<N>& weight, Light<N>& sums) {
  Light<N> transmittance;
  const double cosine = dot(v.position, sun) / v.r;
  if (cosine <= 0.0 || !sun_transmittance(air, v.position, v.r, v.density, sun, transmittance)) return;
  for (std::size_t c = 0; c < N; ++c) sums[c] += weight[c] * transmittance[c] * cosine / kPi;
}

Vertex ground_vertex(const Atmosphere& air, const Line& line) {
  Vertex v;
  v.ground = true;
  v.position = normalized(line.position(line.end())) * line.ground_radius();
  v.r = line.ground_radius();
  v.density = air.density(v.r);
  return v;
}

// The part of a line outside the shadow of a sphere. `before`, `shadow_end` and `lit` are opacities per channel
// (1 - transmittance, without ozone), counted from the start of the line.
template <std::size_t N>
struct LitPart {
  double fraction = 0.0;  // fraction of the samples that are restricted to this part
  Interval shadow;
  Light<N> before{};      // opacity up to the shadow
  Light<N> shadow_end{};  // opacity up to the end of the shadow
  Light<N> lit{};         // opacity that the lit part contributes

  // Returns what sampling this part adds to the probability density of a position, relative to sampling the whole line.
  [[nodiscard]] double preference(double s, double all, std::size_t channel) const {
    return fraction > 0.0 && !(s > shadow.from && s < shadow.to) ? fraction * all / lit[channel] : 0.0;
  }
};

// Returns the lit part. Its `fraction` is 0 if the line misses the shadow or has no part outside it.
template <std::size_t N>
LitPart<N> lit_part(const Atmosphere& air, const Line& line, const Vec& sun, double radius_m, const Light<N>& all,
                    double fraction) {
  LitPart<N> part;
  part.shadow = line.shadow(sun, radius_m);
  if (!(part.shadow.from < part.shadow.to)) return part;
  part.fraction = fraction;
  const bool begins_lit = part.shadow.from > line.start(), ends_lit = part.shadow.to < line.end();
  Amounts entry, exit;
  if (begins_lit) entry = line.travelled(line.point(part.shadow.from));
  if (ends_lit) exit = line.travelled(line.point(part.shadow.to));
  for (std::size_t c = 0; c < N; ++c) {
    if (begins_lit) part.before[c] = std::max(0.0, -std::expm1(-air.exponential_depth(entry, c)));
    part.shadow_end[c] = ends_lit ? std::min(all[c], -std::expm1(-air.exponential_depth(exit, c))) : all[c];
    part.lit[c] = part.before[c] + all[c] - part.shadow_end[c];
    // A smaller difference is dominated by rounding errors.
    if (all[c] > 0.0 && !(part.lit[c] > 1e-9 * all[c])) part.fraction = 0.0;
  }
  return part;
}

// Samples the point from which light arrives along `line`, and multiplies `weight` by the contribution divided by the
// probability density. Returns false if nothing scatters. `albedo` is that of the ground at the line's end.
template <std::size_t N>
bool sample_event(const Atmosphere& air, const Line& line, const Vec& sun, const Atmosphere::PerChannel& albedo,
                  double u, Light<N>& weight, Vertex& v) {
  Light<N> scattered{}, weighted{};  // scattered: 1 - transmittance per channel; weighted: the same times `weight`
  double reflected = 0.0;
  for (std::size_t c = 0; c < N; ++c) {
    const double negative_opacity = std::expm1(-std::max(0.0, air.exponential_depth(line.total(), c)));
    scattered[c] = -negative_opacity;
    weighted[c] = weight[c] * scattered[c];
    if (line.hits_ground()) reflected += weight[c] * albedo[c] * (1.0 + negative_opacity);
  }
  const double total_weight = sum(weighted);
  if (!(total_weight + reflected > 0.0)) return false;

  const double reflect_share = reflected / (total_weight + reflected);
  if (u < reflect_share) {
    Amounts integrals = line.total();
    integrals.ozone = line.ozone_travelled(line.end());
    for (std::size_t c = 0; c < N; ++c) weight[c] *= albedo[c] * air.transmittance(integrals, c) / reflect_share;
    v = ground_vertex(air, line);
    return true;
  }
  u = (u - reflect_share) / (1.0 - reflect_share);
  if (!(total_weight > 0.0)) return false;

  // Choose the channel to invert in proportion to the light that each will lose on this line.
  u *= total_weight;
  std::size_t channel = 0;
  while (channel + 1 < N && u >= weighted[channel]) u -= weighted[channel++];
  if (!(weighted[channel] > 0.0)) return false;  // rounding at the end of the last channel
  u = std::min(u / weighted[channel], std::nextafter(1.0, 0.0));

  // If part of this line is in the planet's shadow, reserve some samples for the sunlit part.
  std::array<LitPart<N>, 2> lit = {lit_part(air, line, sun, air.radius_m, scattered, kLitFractions[0]),
                                   lit_part(air, line, sun, air.opaque_radius_m, scattered, kLitFractions[1])};
  const double unguided = 1.0 - lit[0].fraction - lit[1].fraction;
  double reached;  // 1 - transmittance at the sample
  if (u < unguided) {
    reached = u / unguided * scattered[channel];
  } else {
    u -= unguided;
    const LitPart<N>& part = u < lit[0].fraction ? lit[0] : lit[1];
    if (u >= lit[0].fraction) u -= lit[0].fraction;
    reached = u / part.fraction * part.lit[channel];
    if (reached > part.before[channel]) reached += part.shadow_end[channel] - part.before[channel];
  }
  const LinePoint p = line.invert(channel, -std::log1p(-std::min(reached, scattered[channel])));
  Amounts integrals = line.travelled(p);
  integrals.ozone = line.ozone_travelled(p.s);

  double density = 0.0;  // probability density of the point, summed over the channels that could have been chosen
  Light<N> contribution{};
  for (std::size_t c = 0; c < N; ++c) {
    if (weight[c] <= 0.0) continue;
    const double transmittance = std::exp(-air.exponential_depth(integrals, c));
    const double preference =
        unguided + lit[0].preference(p.s, scattered[c], c) + lit[1].preference(p.s, scattered[c], c);
    density += weight[c] * air.exponential_depth(p.density, c) * transmittance * preference;
    contribution[c] = weight[c] * transmittance * std::exp(-air.ozone_absorption[c] * integrals.ozone) *
                      (air.rayleigh_scattering[c] * p.density.rayleigh + air.mie_scattering[c] * p.density.mie);
  }
  if (!(density > 0.0)) return false;
  for (std::size_t c = 0; c < N; ++c) {
    weight[c] = contribution[c] * total_weight / density / (1.0 - reflect_share);
  }
  v.ground = false;
  v.position = line.position(p.s);
  v.r = p.r;
  v.density = p.density;
  return true;
}

// Returns the fraction of the scattering at a vertex that is Rayleigh scattering, per channel.
template <std::size_t N>
Light<N> rayleigh_fractions(const Atmosphere& air, const Amounts& density) {
  Light<N> fraction;
  for (std::size_t c = 0; c < N; ++c) {
    const double rayleigh = air.rayleigh_scattering[c] * density.rayleigh;
    const double both = rayleigh + air.mie_scattering[c] * density.mie;
    fraction[c] = both > 0.0 ? rayleigh / both : 0.0;
  }
  return fraction;
}

// Adds the sunlight that a vertex in the atmosphere scatters back along `direction`.
template <std::size_t N>
void add_air(const Atmosphere& air, const Vertex& v, const Vec& sun, const Vec& direction,
             const Light<N>& rayleigh_fraction, const Light<N>& weight, Light<N>& sums) {
  Light<N> transmittance;
  if (!sun_transmittance(air, v.position, v.r, v.density, sun, transmittance)) return;
  const double cosine = dot(direction, sun);
  const double rayleigh = rayleigh_phase(cosine);
  Light<N> mie{};
  air.mie_phase.evaluate(cosine, std::span(mie).first(air.channels));
  for (std::size_t c = 0; c < N; ++c) {
    sums[c] += weight[c] * transmittance[c] * (rayleigh_fraction[c] * rayleigh + (1.0 - rayleigh_fraction[c]) * mie[c]);
  }
}

// Samples the direction in which the path continues from a vertex in the atmosphere.
template <std::size_t N>
Vec sample_direction(const Atmosphere& air, const Vertex& v, const Vec& sun, const Vec& direction,
                     const Light<N>& rayleigh_fraction, PathNumbers& numbers, Light<N>& weight) {
  double rayleigh_weight = 0.0;
  for (std::size_t c = 0; c < N; ++c) rayleigh_weight += weight[c] * rayleigh_fraction[c];
  const double fraction = rayleigh_weight / sum(weight);
  const Glow glow(v.position * (1.0 / v.r), sun);
  double u = numbers.next();
  const double turn = 2.0 * kPi * numbers.next();
  Vec next;
  if (u < glow.fraction) {
    next = glow.sample(u / glow.fraction, turn, [&] { return numbers.random(); });
  } else {
    u = (u - glow.fraction) / (1.0 - glow.fraction);
    double cosine;
    if (u < fraction) {
      cosine = sample_rayleigh(u / fraction);
    } else {
      u = std::min((u - fraction) / (1.0 - fraction), std::nextafter(1.0, 0.0));
      cosine = air.mie_phase.sample(u, [&] { return numbers.random(); });
    }
    next = around(direction, cosine, std::cos(turn), std::sin(turn));
  }
  const double cosine = dot(direction, next);
  const double rayleigh = rayleigh_phase(cosine);
  Light<N> mie{};
  const double mie_density = air.mie_phase.evaluate(cosine, std::span(mie).first(air.channels));
  const double density = (1.0 - glow.fraction) * (fraction * rayleigh + (1.0 - fraction) * mie_density) +
                         glow.fraction * glow.density(next);
  for (std::size_t c = 0; c < N; ++c) {
    weight[c] *= (rayleigh_fraction[c] * rayleigh + (1.0 - rayleigh_fraction[c]) * mie[c]) / density;
  }
  return next;
}

Vec cosine_direction(const Vec& normal, double u, double turn) {
  return around(normal, std::sqrt(1.0 - u), std::cos(2.0 * kPi * turn), std::sin(2.0 * kPi * turn));
}

template <std::size_t N>
void trace_path(const Scene<N>& scene, const Line& first, PathNumbers& numbers, Light<N> weight,
                std::span<Light<N>> sums) {
  const Atmosphere& air = *scene.air;
  std::optional<Line> next;
  const Line* line = &first;
  Vec direction = first.direction();
  for (std::size_t order = 0; order < sums.size(); ++order) {
    // The directly lit ground at the end of the first line needs no sampling (Scene::ground).
    const bool seen = order == 0;
    const bool last = order + 1 == sums.size();
    static constexpr Atmosphere::PerChannel kBlack{};
    const Atmosphere::PerChannel& albedo = seen && (!scene.visible_ground || last) ? kBlack : air.ground_albedo;
    Vertex v;
    if (!sample_event(air, *line, scene.sun, albedo, numbers.next(), weight, v)) return;
    if (v.ground) {
      if (!seen) add_ground(air, v, scene.sun, weight, sums[order]);
      if (last) return;
      const double u = numbers.next();
      direction = cosine_direction(v.position * (1.0 / v.r), u, numbers.next());
    } else {
      const Light<N> rayleigh_fraction = rayleigh_fractions<N>(air, v.density);
      add_air(air, v, scene.sun, direction, rayleigh_fraction, weight, sums[order]);
      if (last) return;
      direction = sample_direction(air, v, scene.sun, direction, rayleigh_fraction, numbers, weight);
    }
    next.emplace(air, v.position, direction);
    line = &*next;
  }
}

}  // namespace

template <std::size_t N>
Scene<N>::Scene(const Atmosphere& atmosphere, const RayQuery& query, const Options& options)
    : air(&atmosphere), sky(query.sky_irradiance), visible_ground(options.visible_ground) {
  transmittance.fill(1.0);
  origin = {0.0, 0.0, atmosphere.radius_m + query.altitude_m};
  // The irradiance of the sky only collects light from upward directions, so its ground may be as high as the query.
  ground_radius_m = atmosphere.radius_m + (sky ? std::min(query.altitude_m, 0.0) : ground_altitude_m(query.altitude_m));
  const double sun_sine = std::sin(query.sun_zenith_rad);
  sun = {sun_sine * std::cos(query.azimuth_rad), sun_sine * std::sin(query.azimuth_rad),
         std::cos(query.sun_zenith_rad)};
  view = sky ? sun : Vec{std::sin(query.view_zenith_rad), 0.0, std::cos(query.view_zenith_rad)};

  // From space the ray starts where it enters the atmosphere.
  const double along = dot(origin, view), r = origin.z;
  const double tangent2 = std::max(0.0, r * r - along * along);
  const double top2 = atmosphere.top_radius_m * atmosphere.top_radius_m;
  Vec start = origin;
  bool inside = true;
  if (r >= atmosphere.top_radius_m) {
    inside = along < 0.0 && tangent2 < top2;
    if (inside) start = origin + view * (-std::sqrt(top2 - tangent2) - along);
  }
  if (inside) {
    const Line line(atmosphere, start, view, ground_radius_m);
    Amounts integrals = line.total();
    integrals.ozone = line.ozone_travelled(line.end());
    for (std::size_t c = 0; c < N; ++c) transmittance[c] = atmosphere.transmittance(integrals, c);
    if (sky && line.hits_ground()) transmittance = {};
    if (!sky && visible_ground && line.hits_ground() && atmosphere.reflects()) {
      Light<N> weight;
      for (std::size_t c = 0; c < N; ++c) weight[c] = transmittance[c] * atmosphere.ground_albedo[c];
      add_ground(atmosphere, ground_vertex(atmosphere, line), sun, weight, ground);
    }
  }
  has_air_ = sky ? r < atmosphere.top_radius_m : inside;
  if (!sky) origin = start;
}

template <std::size_t N>
void trace_block(const Scene<N>& scene, std::uint64_t seed, int log2_count, std::span<Light<N>> means) {
  Generator generator(seed);
  const SobolBlock block(log2_count, generator);
  const std::uint32_t count = 1U << log2_count;
  for (Light<N>& mean : means) mean = {};
  Light<N> white{};
  std::fill_n(white.begin(), scene.air->channels, 1.0);
  std::optional<Line> camera;
  if (!scene.sky) camera.emplace(*scene.air, scene.origin, scene.view, scene.ground_radius_m);
  for (std::uint32_t i = 0; i < count; ++i) {
    PathNumbers numbers(block, i, generator);
    Light<N> weight = white;
    if (scene.sky) {
      const double u = numbers.next();
      camera.emplace(*scene.air, scene.origin, cosine_direction({0.0, 0.0, 1.0}, u, numbers.next()));
      for (double& value : weight) value *= kPi;
    }
    trace_path(scene, *camera, numbers, weight, means);
  }
  for (Light<N>& mean : means) {
    for (double& value : mean) value /= static_cast<double>(count);
  }
}

template struct Scene<3>;
template struct Scene<kMaxWavelengths>;
template void trace_block<3>(const Scene<3>&, std::uint64_t, int, std::span<Light<3>>);
template void trace_block<kMaxWavelengths>(const Scene<kMaxWavelengths>&, std::uint64_t, int,
                                           std::span<Light<kMaxWavelengths>>);

}  // namespace tyndall::reference
