#include "viewer/scenes/pictures.hpp"

#include <cstring>
#include <string>
#include <utility>

#include "gpu/try.hpp"
#include "viewer_shaders.hpp"

namespace tyndall::viewer {

namespace {

// Returns whether the window shows the canvas without a gain.
bool as_it_is(const PictureOptions& options) {
  return options.shown == Shown::picture || options.shown == Shown::depth || options.shown == Shown::shadow_map;
}

}  // namespace

View view_of(const PictureOptions& options, VkExtent2D window) {
  View view;
  view.extent = window;
  view.shown = options.shown;
  view.precise = !as_it_is(options) || (options.shown == Shown::picture && options.compare && options.difference);
  // Contains only what the shown view depends on, so that other changes do not cause a redraw.
  if (options.shown == Shown::shadow_map) {
    view.layer = options.layer;
    view.stretch = options.gain;
  }
  if (options.shown >= Shown::single_rayleigh && options.shown <= Shown::high_orders) view.slice = options.slice;
  return view;
}

Pictures::~Pictures() {
  if (host_ != nullptr) host_->wait_idle();
}

Result<void> Pictures::create(gpu::Host& host, VkFormat format) {
  host_ = &host;
  gpu::GraphicsDesc desc;
  desc.name = "present_picture";
  desc.vertex = &shaders::present_vert;
  desc.fragment = &shaders::present_picture_frag;
  desc.color_format = format;
  TYNDALL_ASSIGN(present_, gpu::create_graphics_pipeline(host.device(), desc));
  const gpu::Pipeline* const pipelines[] = {&present_};
  TYNDALL_ASSIGN(sets_, gpu::DescriptorSets::create(host.device(), pipelines, gpu::kFramesInFlight));
  TYNDALL_ASSIGN(sampler_, create_float_sampler(host.device()));
  Picture dark;
  dark.extent = {1, 1};
  dark.format = format_of({.precise = true});
  constexpr float kDark[] = {0.0048F, 0.0070F, 0.0116F, 1.0F};
  dark.texels.resize(sizeof kDark);
  std::memcpy(dark.texels.data(), kDark, sizeof kDark);
  TYNDALL_TRY(take(0, std::move(dark)));
  nothing_ = std::exchange(sides_[0], nullptr);
  return {};
}

Result<void> Pictures::take(std::size_t side, Picture picture) {
  std::shared_ptr<const gpu::Image>& here = sides_.at(side);
  if (picture.image != nullptr) {
    here = std::move(picture.image);
    return {};
  }
  const bool fits = here != nullptr && here->desc.format == picture.format &&
                    here->desc.extent.width == picture.extent.width &&
                    here->desc.extent.height == picture.extent.height;
  if (!fits) {
    TYNDALL_ASSIGN(gpu::Image image,
                   gpu::create_image(host_->device(), {"window_picture",
                                                       picture.format,
                                                       {picture.extent.width, picture.extent.height, 1},
                                                       VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    here = std::make_shared<const gpu::Image>(std::move(image));
  }
  return gpu::upload(*host_, *here, picture.texels.data(), picture.texels.size(),
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Result<void> Pictures::record(VkCommandBuffer cmd, VkExtent2D window, bool two, const PictureOptions& options) {
  const gpu::Device& device = host_->device();
  frame_ = (frame_ + 1) % gpu::kFramesInFlight;
  read_[frame_] = {sides_[0] != nullptr ? sides_[0] : nothing_, two ? sides_[1] : nullptr};
  const gpu::Image& left = *read_[frame_][0];
  const gpu::Image& right = read_[frame_][1] != nullptr ? *read_[frame_][1] : left;
  const bool difference = two && options.difference;
  const struct {
    float divider, line_width, gain;
    std::uint32_t difference;
  } push = {two ? options.divider : 1.0F, 1.0F / static_cast<float>(window.width),
            as_it_is(options) && !difference ? 1.0F : options.gain, difference ? 1U : 0U};
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const gpu::NamedResource resources[] = {gpu::named_image("left_picture", left.view.get(), kRead, sampler_.get()),
                                          gpu::named_image("right_picture", right.view.get(), kRead, sampler_.get())};
  const gpu::Label label(device, cmd, present_.name);
  TYNDALL_TRY(gpu::write_set(device, sets_.get(0, frame_), present_, resources));
  gpu::bind(device, cmd, present_, sets_.get(0, frame_), &push);
  device.vk.CmdDraw(cmd, 3, 1, 0, 0);
  return {};
}

}  // namespace tyndall::viewer
