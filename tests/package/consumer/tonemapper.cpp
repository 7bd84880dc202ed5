// Uses tone mapping without the effect and without a device.
#include <tyndall/post.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace tyndall;
  const Result<post::ToneMapper> mapper = post::ToneMapper::create({});
  if (mapper.ok() || mapper.error().code != ErrorCode::invalid_argument) return 1;
  post::TonemapSettings settings;
  settings.op = post::Operator::reinhard;
  const auto dark = post::tonemapped(settings, 1.0, {0.1, 0.1, 0.1});
  const auto bright = post::tonemapped(settings, 1.0, {10.0, 10.0, 10.0});
  if (!(dark[1] > 0.0 && dark[1] < bright[1] && bright[1] <= 1.0)) return 2;
  std::printf("0.1 -> %.3f, 10 -> %.3f\n", dark[1], bright[1]);
  return 0;
}
