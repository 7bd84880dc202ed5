// The fixture of every test on a device: a Host with validation and synchronisation validation. A message of
// the validation layer fails the test, whether it comes while the test runs or when its objects and device
// are destroyed; so does a machine without the layer or without a device, because `make check` installs both.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "tyndall/effect.hpp"

#define ASSERT_OK(expression)                                 \
  do {                                                        \
    const auto& ok_result = (expression);                     \
    ASSERT_TRUE(ok_result.ok()) << ok_result.error().message; \
  } while (false)
#define EXPECT_OK(expression)                                 \
  do {                                                        \
    const auto& ok_result = (expression);                     \
    EXPECT_TRUE(ok_result.ok()) << ok_result.error().message; \
  } while (false)

namespace tyndall {

class GpuTest : public testing::Test {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({"", true, &messages_});
    ASSERT_TRUE(host.ok()) << "the GPU tests need a Vulkan 1.3 device and the Khronos validation layer: "
                           << host.error().message;
    host_ = std::move(host).value();
  }

  void TearDown() override {
    host_.reset();
    for (const std::string& message : messages_) ADD_FAILURE() << message;
  }

  [[nodiscard]] gpu::Host& host() { return *host_; }
  [[nodiscard]] DeviceInfo info() const { return device_info(*host_); }

  static DeviceInfo device_info(const gpu::Host& host) {
    const gpu::Device& device = host.device();
    DeviceInfo out;
    out.instance = device.instance;
    out.physical_device = device.physical_device;
    out.device = device.device;
    out.get_instance_proc_addr = host.get_instance_proc_addr();
    return out;
  }

 private:
  std::vector<std::string> messages_;  // outlives the host
  std::unique_ptr<gpu::Host> host_;
};

}  // namespace tyndall
