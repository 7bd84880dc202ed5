#include "effect/epipolar.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "effect_shaders.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// Which of the pipelines by Extinction; one for both where that of every pixel is a single exponential.
std::uint32_t extinction_index(const Params& params) {
  return is_homogeneous(params.scattering) ? 0 : static_cast<std::uint32_t>(params.scattering.extinction);
}

std::size_t index(EpipolarBuffer buffer) { return static_cast<std::size_t>(buffer); }

}  // namespace

Result<void> Epipolar::create(const gpu::Device& device, const EffectDesc& desc) {
  device_ = &device;
  desc_ = desc;
  return create_pipelines();
}

Result<void> Epipolar::create_pipelines() {
  const bool full = desc_.output_format == OutputFormat::rgba32f;
  const auto make = [this](gpu::Pipeline& out, const gpu::Shader& shader, const char* name,
                           std::span<const gpu::Constant> constants = {}) -> Result<void> {
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shader, constants));
    out.name = name;
    return {};
  };
  TYNDALL_TRY(make(slice_end_points_, shaders::slice_end_points_comp, "slice_end_points"));
  TYNDALL_TRY(make(slice_directions_, shaders::slice_directions_comp, "slice_directions"));
  TYNDALL_TRY(make(interpolate_samples_, shaders::interpolate_samples_comp, "interpolate_samples"));
  TYNDALL_TRY(make(show_sampling_, full ? shaders::show_sampling_comp_rgba32f : shaders::show_sampling_comp_rgba16f,
                   "show_sampling"));
  for (std::uint32_t i = 0; i < 2; ++i) {
    const gpu::Constant by_criterion[] = {{0, i}};
    TYNDALL_TRY(make(refine_samples_[i], shaders::refine_samples_comp, "refine_samples", by_criterion));
    const gpu::Constant by_format[] = {{0, i}};
    TYNDALL_TRY(make(shadow_tree_[i], shaders::shadow_tree_comp, "shadow_tree", by_format));
    TYNDALL_TRY(make_of_medium(MediumKind::atmosphere, i, Sparsity::none));
  }
  return {};
}

Result<void> Epipolar::make_of_medium(MediumKind medium, std::uint32_t extinction, Sparsity sparsity) {
  const bool full = desc_.output_format == OutputFormat::rgba32f;
  const gpu::Constant constants[] = {
      {0, extinction}, {5, static_cast<std::uint32_t>(medium)}, {9, static_cast<std::uint32_t>(sparsity)}};
  const auto variant = static_cast<std::size_t>(sparsity);
  const auto make = [&](gpu::Pipeline& out, const gpu::Shader& shader, const char* name) -> Result<void> {
    if (out.pipeline) return {};
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shader, constants));
    out.name = name;
    return {};
  };
  PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
  TYNDALL_TRY(make(of.slice_samples, shaders::slice_samples_comp, "slice_samples"));
  TYNDALL_TRY(make(of.correct_pixels,
                   full ? shaders::correct_pixels_comp_rgba32f : shaders::correct_pixels_comp_rgba16f,
                   "correct_pixels"));
  TYNDALL_TRY(make(of.unwarp[extinction][variant], full ? shaders::unwarp_comp_rgba32f : shaders::unwarp_comp_rgba16f,
                   "unwarp"));
  return make(of.unwarp_pixels[extinction][variant],
              full ? shaders::unwarp_pixels_comp_rgba32f : shaders::unwarp_pixels_comp_rgba16f, "unwarp_pixels");
}

Result<void> Epipolar::make_downscaled(MediumKind medium, std::uint32_t extinction, std::uint32_t downscale) {
  const bool full = desc_.output_format == OutputFormat::rgba32f;
  const gpu::Constant constants[] = {{0, extinction}, {5, static_cast<std::uint32_t>(medium)}, {6, downscale}};
  const auto make = [&](gpu::Pipeline& out, const gpu::Shader& shader, const char* name) -> Result<void> {
    if (out.pipeline) return {};
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shader, constants));
    out.name = name;
    return {};
  };
  PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
  const std::size_t quarter = downscale / 4;
  TYNDALL_TRY(make(of.unwarp_reduced[quarter], full ? shaders::unwarp_comp_rgba32f : shaders::unwarp_comp_rgba16f,
                   "unwarp_reduced"));
  TYNDALL_TRY(make(of.unwarp_reduced_pixels[quarter],
                   full ? shaders::unwarp_pixels_comp_rgba32f : shaders::unwarp_pixels_comp_rgba16f,
                   "unwarp_reduced_pixels"));
  TYNDALL_TRY(make(of.correct_reduced[quarter], shaders::correct_reduced_comp, "correct_reduced"));
  TYNDALL_TRY(make(of.upscale[extinction][quarter],
                   full ? shaders::upscale_comp_rgba32f : shaders::upscale_comp_rgba16f, "upscale"));
  return make(of.upscale_pixels[extinction][quarter],
              full ? shaders::upscale_pixels_comp_rgba32f : shaders::upscale_pixels_comp_rgba16f, "upscale_pixels");
}

bool Epipolar::walks(const Params& params) {
  if (is_homogeneous(params.scattering)) return params.scattering.single != SingleScattering::none;
  return params.scattering.single != SingleScattering::none ||
         params.scattering.multiple == MultipleScattering::occluded;
}

bool Epipolar::uses_trees(const Params& params) {
  return params.epipolar.min_max_tree && walks(params) && params.scattering.light_shafts;
}

Result<void> Epipolar::make_march(bool tree, bool colors, std::uint32_t mode) {
  gpu::Pipeline& out = march_samples_[tree ? 1 : 0][colors ? 1 : 0][mode];
  if (out.pipeline) return {};
  const std::array<gpu::Constant, 4> m = mode_constants(mode);
  const gpu::Constant constants[] = {
      m[0], m[1], m[2], m[3], {3, tree ? 1U : 0U}, {4, colors ? 1U : 0U}, {8, desc_.counters ? 1U : 0U}};
  TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shaders::march_samples_comp, constants));
  out.name = "march_samples";
  return {};
}

Result<void> Epipolar::prepare(const EffectDesc& desc, const Params& params) {
  if (params.scattering.technique != Technique::epipolar) return {};
  if (is_homogeneous(params.scattering)) {
    TYNDALL_TRY(make_of_medium(MediumKind::homogeneous, extinction_index(params), Sparsity::none));
  }
  if (may_be_sparse(params)) {
    for (const Sparsity sparsity : {Sparsity::skyline, Sparsity::all}) {
      TYNDALL_TRY(make_of_medium(MediumKind::atmosphere, extinction_index(params), sparsity));
    }
  }
  if (is_downscaled(params))
    TYNDALL_TRY(make_downscaled(params.scattering.medium, extinction_index(params), params.scattering.downscale));
  for (const bool colors : {false, true}) {
    if (colors && !desc.shadow_colors) continue;
    TYNDALL_TRY(make_march(uses_trees(params), colors, mode_index(params.scattering)));
  }
  return {};
}

Result<void> Epipolar::prepare_others(std::uint32_t& budget, Progress& progress) {
  // What is made together counts as one.
  const auto take = [&](bool made, const auto& make) -> Result<void> {
    ++progress.total;
    if (!made && budget == 0) return {};
    if (!made) {
      TYNDALL_TRY(make());
      --budget;
    }
    ++progress.done;
    return {};
  };
  for (std::uint32_t mode = 0; mode < kModeCount; ++mode) {
    if (!mode_exists(mode)) continue;
    for (const bool colors : {false, true}) {
      if (colors && !desc_.shadow_colors) continue;
      for (const bool tree : {false, true}) {
        const bool made = static_cast<bool>(march_samples_[tree ? 1 : 0][colors ? 1 : 0][mode].pipeline);
        TYNDALL_TRY(take(made, [&] { return make_march(tree, colors, mode); }));
      }
    }
  }
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    const PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
    for (std::uint32_t extinction = 0; extinction < (medium == MediumKind::atmosphere ? 2U : 1U); ++extinction) {
      for (std::size_t variant = 0; variant < (medium == MediumKind::atmosphere ? kSparsities : 1); ++variant) {
        TYNDALL_TRY(take(static_cast<bool>(of.unwarp_pixels[extinction][variant].pipeline),
                         [&] { return make_of_medium(medium, extinction, static_cast<Sparsity>(variant)); }));
      }
      for (const std::uint32_t downscale : {2U, 4U}) {
        TYNDALL_TRY(take(static_cast<bool>(of.upscale_pixels[extinction][downscale / 4].pipeline),
                         [&] { return make_downscaled(medium, extinction, downscale); }));
      }
    }
  }
  return {};
}

Result<Epipolar::Pending> Epipolar::plan(const EffectDesc& desc, const Params& params) {
  Pending pending;
  pending.desc = desc;
  const EpipolarSizes sizes = epipolar_sizes(desc, params);
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) {
    pending.replaced[i] = sizes[i] != buffers_[i].size;
    if (sizes[i] == 0 || !pending.replaced[i]) continue;
    const char* name = epipolar_buffer_name(static_cast<EpipolarBuffer>(i));
    TYNDALL_ASSIGN(pending.buffers[i],
                   gpu::create_buffer(*device_, name, sizes[i], kEpipolarUsage, gpu::MemoryKind::device));
  }
  retired_.reserve(retired_.size() + kEpipolarBuffers);  // so that commit() need not allocate
  return pending;
}

void Epipolar::commit(Pending&& pending) noexcept {
  desc_ = pending.desc;
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) {
    if (!pending.replaced[i]) continue;
    if (buffers_[i].size > 0) retired_.push_back({std::move(buffers_[i]), desc_.frames_in_flight * desc_.views + 1});
    buffers_[i] = std::move(pending.buffers[i]);
  }
}

void Epipolar::begin_frame() {
  for (Retired& r : retired_) --r.frames_left;
  std::erase_if(retired_, [](const Retired& r) { return r.frames_left == 0; });
}

VkDeviceSize Epipolar::bytes() const {
  VkDeviceSize sum = 0;
  for (const gpu::Buffer& buffer : buffers_) sum += buffer.bytes;
  return sum;
}

VkDeviceSize Epipolar::retired_bytes() const {
  VkDeviceSize sum = 0;
  for (const Retired& r : retired_) sum += r.buffer.bytes;
  return sum;
}

Result<void> Epipolar::record(VkCommandBuffer cmd, const FrameInputs& inputs, const Params& params,
                              std::span<const gpu::NamedResource> frame_resources, gpu::Timer* timer) {
  constexpr std::size_t kMostFrameResources = 16;
  std::array<gpu::NamedResource, kEpipolarBuffers + kMostFrameResources + 1> all;
  std::size_t used = 0;
  gpu::NamedResource& work = all[used++];  // the list that a pass works through
  for (const gpu::NamedResource& r : frame_resources) all[used++] = r;
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) {
    all[used++] = gpu::named_buffer(epipolar_block_name(static_cast<EpipolarBuffer>(i)), buffers_[i].buffer.get());
  }
  const std::span<const gpu::NamedResource> resources(all.data(), used);

  struct Size {
    std::uint32_t x = 1, y = 1, z = 1;  // invocations, or groups
  };
  // One pass after what it reads has been written.
  const auto begin = [&](const gpu::Pipeline& pipeline, const void* push) -> Result<void> {
    gpu::compute_barrier(*device_, cmd);
    if (timer != nullptr) timer->begin(cmd, pipeline.name);
    const std::string_view missing = gpu::bind(*device_, cmd, pipeline, resources, push);
    if (missing.empty()) return {};
    return Error{ErrorCode::invalid_argument,
                 std::string("nothing is bound to ") + std::string(missing) + " of " + pipeline.name};
  };
  const auto end = [&] {
    if (timer != nullptr) timer->end(cmd);
  };
  const auto run = [&](const gpu::Pipeline& pipeline, Size size, const void* push = nullptr) -> Result<void> {
    const gpu::Label label(*device_, cmd, pipeline.name);
    TYNDALL_TRY(begin(pipeline, push));
    gpu::dispatch(*device_, cmd, pipeline, size.x, size.y, size.z);
    end();
    return {};
  };
  const auto run_list = [&](const gpu::Pipeline& pipeline, EpipolarBuffer list,
                            const void* push = nullptr) -> Result<void> {
    const gpu::Label label(*device_, cmd, pipeline.name);
    work = gpu::named_buffer("work_block", buffers_[index(list)].buffer.get());
    TYNDALL_TRY(begin(pipeline, push));
    device_->vk.CmdDispatchIndirect(cmd, buffers_[index(list)].buffer.get(), 0);
    end();
    return {};
  };

  const EpipolarParams& p = params.epipolar;
  const std::uint32_t slices = reduced_count(p.slices, params);
  const std::uint32_t samples = reduced_count(p.samples, params);
  const std::uint32_t cascades =
      params.scattering.light_shafts ? static_cast<std::uint32_t>(inputs.cascades.size()) : 0;
  const std::uint32_t marched = cascades > 0 ? cascades - inputs.first_marched_cascade : 0;
  const std::uint32_t mode = mode_index(params.scattering);
  const bool walking = walks(params);
  const bool trees = uses_trees(params) && marched > 0;
  CascadeProcessing processing = params.shadows.cascade_processing;
  if (marched == 0 || !walking) processing = CascadeProcessing::single_pass;
  const bool instanced = processing == CascadeProcessing::multi_pass_instanced;

  const auto empty_lists = [&](std::initializer_list<EpipolarBuffer> lists) {
    gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                 VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    for (const EpipolarBuffer list : lists) {
      const bool of_cascades = list == EpipolarBuffer::march_list && instanced;
      const shared::WorkList empty = {0, 1, of_cascades ? marched : 1, 0};
      device_->vk.CmdUpdateBuffer(cmd, buffers_[index(list)].buffer.get(), 0, sizeof empty, &empty);
    }
    gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  };
  empty_lists(
      {EpipolarBuffer::march_list, EpipolarBuffer::broken_list, EpipolarBuffer::break_list, EpipolarBuffer::tree_list});
  const auto lists_ready = [&] {
    gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
  };

  TYNDALL_TRY(run(slice_end_points_, {slices}));
  const PerMedium& of = of_medium_[static_cast<std::size_t>(params.scattering.medium)];
  TYNDALL_TRY(run(of.slice_samples, {samples, slices}));
  const gpu::Pipeline& refine = refine_samples_[static_cast<std::size_t>(p.refinement)];
  TYNDALL_TRY(run(refine, {slices * refine.local_size[0]}));
  if (walking && marched > 0) TYNDALL_TRY(run(slice_directions_, {slices, marched}));
  lists_ready();
  if (trees) {
    TYNDALL_TRY(run_list(shadow_tree_[static_cast<std::size_t>(p.min_max_format)], EpipolarBuffer::tree_list));
  }
  const bool colored = walking && marched > 0 && has_colors(inputs, params);
  // Without cascades none of its invocations looks at a tree.
  const gpu::Pipeline& march = march_samples_[uses_trees(params) ? 1 : 0][colored ? 1 : 0][mode];
  struct MarchPush {
    std::uint32_t processing, turn;
  };
  if (processing == CascadeProcessing::multi_pass) {
    for (std::uint32_t turn = 0; turn < marched; ++turn) {
      const MarchPush push = {shared::kOneCascade, turn};
      TYNDALL_TRY(run_list(march, EpipolarBuffer::march_list, &push));
    }
  } else {
    const MarchPush push = {static_cast<std::uint32_t>(processing), 0};
    TYNDALL_TRY(run_list(march, EpipolarBuffer::march_list, &push));
  }
  if (processing != CascadeProcessing::single_pass) {
    const MarchPush push = {shared::kFinish, instanced ? marched : 1};
    TYNDALL_TRY(run_list(march, EpipolarBuffer::march_list, &push));
  }
  TYNDALL_TRY(run(interpolate_samples_, {samples, slices}));
  const std::uint32_t extinction = extinction_index(params);
  const MarchPush of_pixels = {shared::kPixels, 0};
  // Pixels that no sample fits: marched, and put where they belong.
  const auto correct = [&](const gpu::Pipeline& put) -> Result<void> {
    lists_ready();
    TYNDALL_TRY(run_list(march, EpipolarBuffer::break_list, &of_pixels));
    return run_list(put, EpipolarBuffer::break_list);
  };
  if (is_downscaled(params)) {
    const VkExtent2D reduced = reduced_extent(inputs.extent, params);
    const std::size_t quarter = params.scattering.downscale / 4;
    const VkExtent2D blocks = unwarp_blocks(reduced);
    TYNDALL_TRY(run(of.unwarp_reduced[quarter], {blocks.width, blocks.height}));
    lists_ready();
    TYNDALL_TRY(run_list(of.unwarp_reduced_pixels[quarter], EpipolarBuffer::broken_list));
    TYNDALL_TRY(correct(of.correct_reduced[quarter]));
    empty_lists({EpipolarBuffer::broken_list, EpipolarBuffer::break_list});
    TYNDALL_TRY(run(of.upscale[extinction][quarter], {(inputs.extent.width + 1) / 2, (inputs.extent.height + 1) / 2}));
    lists_ready();
    TYNDALL_TRY(run_list(of.upscale_pixels[extinction][quarter], EpipolarBuffer::broken_list));
    TYNDALL_TRY(correct(of.correct_pixels));
  } else {
    const VkExtent2D blocks = unwarp_blocks(inputs.extent);
    const auto variant = static_cast<std::size_t>(sparsity(inputs.extent, params));
    TYNDALL_TRY(run(of.unwarp[extinction][variant], {blocks.width, blocks.height}));
    lists_ready();
    TYNDALL_TRY(run_list(of.unwarp_pixels[extinction][variant], EpipolarBuffer::broken_list));
    TYNDALL_TRY(correct(of.correct_pixels));
  }
  if (p.show_sampling) {
    for (std::uint32_t marked = 0; marked < 2; ++marked) {
      TYNDALL_TRY(run(show_sampling_, {samples, slices}, &marked));
    }
  }
  return {};
}

}  // namespace tyndall
