// Uses the library without a device: queries that need none, and the error for a missing device.
#include <tyndall/effect.hpp>
#include <tyndall/version.hpp>

#include <cstdio>
#include <cstring>

int main() {
  const tyndall::Requirements needs = tyndall::requirements();
  if (needs.api_version != VK_API_VERSION_1_3 || !needs.device_extensions.empty()) return 1;
  if (tyndall::param_table().empty()) return 2;
  const tyndall::Result<tyndall::Effect> effect = tyndall::Effect::create({}, {}, {});
  if (effect.ok() || effect.error().code != tyndall::ErrorCode::invalid_argument) return 3;
  if (std::strstr(effect.error().message.c_str(), "DeviceInfo") == nullptr) return 4;
  std::printf("tyndall %s: %s\n", TYNDALL_VERSION_STRING, effect.error().message.c_str());
  return 0;
}
