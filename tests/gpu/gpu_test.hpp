// The fixture of tests on a device: a Host with validation and synchronisation validation. All tests of a program share
// it, because creating a device takes longer than many tests. A message of the validation layer fails the test that
// caused it. A message about leaked objects at the destruction of the device fails the program. So does a machine
// without the layer or without a device, because `make check` installs both.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "shared_pipelines.hpp"
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

// Destroys the shared device after the last test. Run single tests (--gtest_filter) to find out which one leaks
// objects.
class SharedHost : public testing::Environment {
 public:
  Result<void> make() {
    if (host_ != nullptr) return {};
    Result<std::unique_ptr<gpu::Host>> host =
        gpu::Host::create({"", true, &messages_, &shared_pipelines::get_instance_proc_addr});
    if (!host.ok()) return host.error();
    host_ = std::move(host).value();
    return {};
  }
  void TearDown() override {
    EXPECT_EQ(shared_pipelines::release(), 0U) << "pipelines that have not been destroyed";
    host_.reset();
    report_messages();
  }
  void report_messages() {
    for (const std::string& message : messages_) ADD_FAILURE() << message;
    messages_.clear();
  }
  [[nodiscard]] gpu::Host& host() { return *host_; }
  [[nodiscard]] bool made() const { return host_ != nullptr; }

 private:
  std::vector<std::string> messages_;  // outlives the host
  std::unique_ptr<gpu::Host> host_;
};
// Registered before main(), as GoogleTest requires.
inline SharedHost* const shared_host =
    static_cast<SharedHost*>(testing::AddGlobalTestEnvironment(std::make_unique<SharedHost>().release()));

class GpuTest : public testing::Test {
 protected:
  void SetUp() override {
    const Result<void> made = shared_host->make();
    ASSERT_TRUE(made.ok()) << "the GPU tests need a Vulkan 1.3 device and the Khronos validation layer: "
                           << made.error().message;
  }

  void TearDown() override {
    if (!shared_host->made()) return;
    const std::unique_lock<std::mutex> lock = host().lock();
    vkDeviceWaitIdle(host().device().device);
    shared_host->report_messages();
  }

  [[nodiscard]] static gpu::Host& host() { return shared_host->host(); }
  [[nodiscard]] static DeviceInfo info() { return device_info(host()); }

  static DeviceInfo device_info(const gpu::Host& host) {
    const gpu::Device& device = host.device();
    DeviceInfo out;
    out.instance = device.instance;
    out.physical_device = device.physical_device;
    out.device = device.device;
    out.get_instance_proc_addr = host.get_instance_proc_addr();
    return out;
  }
};

}  // namespace tyndall
