#include "effect/epipolar.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "effect_shaders.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr VkDeviceSize kStateBytes = 16 * sizeof(float);  // of march_state.glsl
constexpr VkDeviceSize kLeastBytes = 256;                 // of buffers that shaders bind but do not use
constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                      VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

struct BufferName {
  const char* name;
  const char* block;  // in the shaders
};
constexpr BufferName kNames[kEpipolarBuffers] = {{"slices", "slice_block"},
                                                 {"shadow_rows", "row_block"},
                                                 {"samples", "sample_block"},
                                                 {"coarse_inscattering", "coarse_block"},
                                                 {"sources", "source_block"},
                                                 {"march_list", "march_list_block"},
                                                 {"broken_blocks", "broken_list_block"},
                                                 {"depth_breaks", "break_list_block"},
                                                 {"corrected_pixels", "corrected_block"},
                                                 {"tree_blocks", "tree_list_block"},
                                                 {"shadow_tree", "tree_block"},
                                                 {"march_states", "state_block"},
                                                 {"reduced_inscattering", "reduced_block"}};

std::size_t index(EpipolarBuffer buffer) { return static_cast<std::size_t>(buffer); }

bool is_downscaled(const Params& params) { return params.scattering.downscale > 1; }

// Slices or samples of the picture that the light is computed for.
std::uint32_t reduced_count(std::uint32_t count, const Params& params) {
  constexpr std::uint32_t kLeast = 32;
  return std::max(count / params.scattering.downscale, kLeast);
}

VkExtent2D reduced_extent(VkExtent2D extent, const Params& params) {
  const std::uint32_t d = params.scattering.downscale;
  return {(extent.width + d - 1) / d, (extent.height + d - 1) / d};
}

bool lists_breaks(const Params& params) {
  return is_downscaled(params) || params.epipolar.correct_depth_breaks.value != 0 || params.epipolar.show_depth_breaks.value != 0;
}

// Which of the pipelines by Extinction; one for both where that of every pixel is a single exponential.
std::uint32_t extinction_index(const Params& params) {
  return is_homogeneous(params.scattering) ? 0 : static_cast<std::uint32_t>(params.scattering.extinction);
}

// Blocks of unwarp.comp over a picture.
VkExtent2D unwarp_blocks(VkExtent2D extent) {
  return {(extent.width + shared::kUnwarpWidth - 1) / shared::kUnwarpWidth, (extent.height + 1) / 2};
}

}  // namespace

std::uint32_t tree_cells(const EffectDesc& desc) {
  return (desc.max_shadow_resolution + shared::kTreeBlock - 1) / shared::kTreeBlock * shared::kTreeBlock;
}

EpipolarSizes epipolar_sizes(const EffectDesc& desc, const Params& params) {
  EpipolarSizes out = {};
  if (params.scattering.technique != Technique::epipolar) return out;
  const VkDeviceSize slices = reduced_count(params.epipolar.slices, params);
  const VkDeviceSize samples = slices * reduced_count(params.epipolar.samples, params);
  const VkDeviceSize rows = slices * desc.max_cascades;
  const VkDeviceSize pixels = VkDeviceSize{desc.max_extent.width} * desc.max_extent.height;
  out[index(EpipolarBuffer::slices)] = slices * sizeof(shared::EpipolarSlice);
  out[index(EpipolarBuffer::rows)] = rows * sizeof(shared::ShadowRow);
  out[index(EpipolarBuffer::samples)] = samples * 16;
  out[index(EpipolarBuffer::coarse)] = samples * 8;
  out[index(EpipolarBuffer::sources)] = samples * 4;
  out[index(EpipolarBuffer::march_list)] = sizeof(shared::WorkList) + samples * 4;
  const VkExtent2D blocks = unwarp_blocks(desc.max_extent);
  const VkDeviceSize squares = VkDeviceSize{blocks.width} * (shared::kUnwarpWidth / 2) * blocks.height;
  out[index(EpipolarBuffer::broken_list)] = sizeof(shared::WorkList) + squares * 4;
  const VkExtent2D reduced = reduced_extent(desc.max_extent, params);
  out[index(EpipolarBuffer::reduced)] =
      is_downscaled(params) ? VkDeviceSize{reduced.width} * reduced.height * (is_homogeneous(params.scattering) ? 16 : 32) : kLeastBytes;
  out[index(EpipolarBuffer::break_list)] = lists_breaks(params) ? sizeof(shared::WorkList) + pixels * 4 : kLeastBytes;
  out[index(EpipolarBuffer::corrected)] = lists_breaks(params) ? pixels * 16 : kLeastBytes;
  const VkDeviceSize number = params.epipolar.min_max_format == MinMaxFormat::float32 ? 8 : 4;
  const VkDeviceSize row_bytes = tree_cells(desc) / shared::kTreeBlock * shared::kTreeNodes * number;
  out[index(EpipolarBuffer::tree_list)] = sizeof(shared::WorkList) + rows * (tree_cells(desc) / shared::kTreeBlock) * 4;
  out[index(EpipolarBuffer::tree)] = params.epipolar.min_max_tree ? rows * row_bytes : kLeastBytes;
  const CascadeProcessing processing = params.shadows.cascade_processing;
  const VkDeviceSize turns = processing == CascadeProcessing::multi_pass_instanced ? desc.max_cascades : 1;
  out[index(EpipolarBuffer::states)] =
      processing == CascadeProcessing::single_pass ? kLeastBytes : samples * turns * kStateBytes;
  return out;
}

const char* epipolar_buffer_name(EpipolarBuffer buffer) { return kNames[index(buffer)].name; }

VkDeviceSize epipolar_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  VkDeviceSize sum = 0;
  for (const VkDeviceSize size : epipolar_sizes(desc, params)) {
    if (size > 0) sum += gpu::buffer_bytes(device, size, kUsage);
  }
  return sum;
}

shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  shared::EpipolarConstants out = {};
  const EpipolarParams& p = params.epipolar;
  out.slices = reduced_count(p.slices, params);
  out.samples = reduced_count(p.samples, params);
  out.downscale = params.scattering.downscale;
  const VkExtent2D reduced = reduced_extent(inputs.extent, params);
  out.reduced_width = reduced.width;
  out.reduced_height = reduced.height;
  out.initial_step = p.initial_step;
  out.epipole_density = p.epipole_density;
  out.threshold = p.refinement_threshold;
  out.optimize_locations = p.optimize_locations.value;
  out.correct_depth_breaks = p.correct_depth_breaks.value;
  out.show_depth_breaks = p.show_depth_breaks.value;
  out.tree_cells = tree_cells(desc);
  out.tree_format = static_cast<std::uint32_t>(p.min_max_format);
  out.cascades = params.scattering.light_shafts ? static_cast<std::uint32_t>(inputs.cascades.size()) : 0;
  out.first_cascade = std::min(inputs.first_marched_cascade, out.cascades);

  // The epipole: the direction to the sun through the camera's matrices, in double.
  const auto row_of = [](const Mat4& m, int row, const double* v) {
    double sum = 0.0;
    for (int col = 0; col < 4; ++col) sum += static_cast<double>(m.m[4 * col + row]) * v[col];
    return sum;
  };
  const Vec3& s = inputs.sun.direction_to_sun;
  const double length = std::sqrt(static_cast<double>(s.x) * s.x + static_cast<double>(s.y) * s.y +
                                  static_cast<double>(s.z) * s.z);
  const double world[3] = {s.x / length, s.y / length, s.z / length};
  double view[4] = {};
  for (int i = 0; i < 3; ++i) {
    // world_from_view is rigid: its transpose takes directions back.
    for (int k = 0; k < 3; ++k) view[i] += static_cast<double>(inputs.camera.world_from_view.m[4 * i + k]) * world[k];
  }
  const double clip_x = row_of(inputs.camera.clip_from_view, 0, view);
  const double clip_y = row_of(inputs.camera.clip_from_view, 1, view);
  const double clip_w = row_of(inputs.camera.clip_from_view, 3, view);
  const double width = inputs.extent.width;
  const double height = inputs.extent.height;
  double x = 0.5 * (clip_x + clip_w) * width;
  double y = 0.5 * (clip_y + clip_w) * height;
  double w = clip_w;
  if (w < 0.0) {
    x = -x;
    y = -y;
    w = -w;
  }
  const double size = std::max({std::abs(x), std::abs(y), w * std::max(width, height), 1e-300});
  x /= size;
  y /= size;
  w /= size;
  if (w < 1e-12) w = 0.0;  // parallel slices
  out.sun_x = static_cast<float>(x);
  out.sun_y = static_cast<float>(y);
  out.sun_w = static_cast<float>(w);

  // Sides that lines from the epipole reach from within the picture; in the order of shared/epipolar.h. Decided by
  // the rounded numbers that the shaders have.
  const double px = static_cast<double>(out.sun_x);
  const double py = static_cast<double>(out.sun_y);
  const double pw = static_cast<double>(out.sun_w);
  const bool ends[4] = {px - 0.5 * pw > 0.0, (height - 0.5) * pw - py > 0.0, (width - 0.5) * pw - px > 0.0,
                        py - 0.5 * pw > 0.0};
  const double lengths[4] = {height - 1.0, width - 1.0, height - 1.0, width - 1.0};
  const bool closed = ends[0] && ends[1] && ends[2] && ends[3];
  out.closed = closed ? 1 : 0;
  out.sun_in_picture = closed ? 1 : 0;
  int first = 0;
  if (!closed) {
    while (first < 3 && !(ends[first] && !ends[(first + 3) % 4])) ++first;
  }
  double along = 0.0;
  float* const starts[4] = {&out.left_start, &out.bottom_start, &out.right_start, &out.top_start};
  for (int i = 0; i < 4; ++i) {
    const int side = (first + i) % 4;
    *starts[side] = ends[side] ? static_cast<float>(along) : -1.0F;
    if (ends[side]) along += lengths[side];
  }
  out.perimeter = static_cast<float>(std::max(along, 1e-3));
  // From an epipole on the border, into the picture.
  const double to_x = 0.5 * width * pw - px;
  const double to_y = 0.5 * height * pw - py;
  const double to = std::hypot(to_x, to_y);
  out.fallback_x = to > 1e-12 ? static_cast<float>(to_x / to) : 1.0F;
  out.fallback_y = to > 1e-12 ? static_cast<float>(to_y / to) : 0.0F;
  return out;
}

Result<void> Epipolar::create(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  device_ = &device;
  desc_ = desc;
  TYNDALL_TRY(create_pipelines());
  return set_params(params);
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
    for (const bool breaks : {false, true}) TYNDALL_TRY(make_of_medium(MediumKind::atmosphere, i, breaks));
  }
  return {};
}

Result<void> Epipolar::make_of_medium(MediumKind medium, std::uint32_t extinction, bool breaks) {
  const bool full = desc_.output_format == OutputFormat::rgba32f;
  const gpu::Constant constants[] = {{0, extinction}, {1, breaks ? 1U : 0U}, {5, static_cast<std::uint32_t>(medium)}};
  const auto make = [&](gpu::Pipeline& out, const gpu::Shader& shader, const char* name) -> Result<void> {
    if (out.pipeline) return {};
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shader, constants));
    out.name = name;
    return {};
  };
  PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
  TYNDALL_TRY(make(of.slice_samples, shaders::slice_samples_comp, "slice_samples"));
  TYNDALL_TRY(make(of.correct_pixels, full ? shaders::correct_pixels_comp_rgba32f : shaders::correct_pixels_comp_rgba16f,
                   "correct_pixels"));
  TYNDALL_TRY(make(of.unwarp[extinction][breaks ? 1 : 0],
                   full ? shaders::unwarp_comp_rgba32f : shaders::unwarp_comp_rgba16f, "unwarp"));
  return make(of.unwarp_pixels[extinction][breaks ? 1 : 0],
              full ? shaders::unwarp_pixels_comp_rgba32f : shaders::unwarp_pixels_comp_rgba16f, "unwarp_pixels");
}

Result<void> Epipolar::make_downscaled(MediumKind medium, std::uint32_t extinction, std::uint32_t downscale) {
  const bool full = desc_.output_format == OutputFormat::rgba32f;
  const gpu::Constant constants[] = {{0, extinction}, {1, 1}, {5, static_cast<std::uint32_t>(medium)}, {6, downscale}};
  const auto make = [&](gpu::Pipeline& out, const gpu::Shader& shader, const char* name) -> Result<void> {
    if (out.pipeline) return {};
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shader, constants));
    out.name = name;
    return {};
  };
  PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
  const std::size_t quarter = downscale / 4;
  TYNDALL_TRY(make(of.unwarp_reduced[quarter], full ? shaders::unwarp_comp_rgba32f : shaders::unwarp_comp_rgba16f, "unwarp_reduced"));
  TYNDALL_TRY(make(of.unwarp_reduced_pixels[quarter],
                   full ? shaders::unwarp_pixels_comp_rgba32f : shaders::unwarp_pixels_comp_rgba16f, "unwarp_reduced_pixels"));
  TYNDALL_TRY(make(of.correct_reduced[quarter], shaders::correct_reduced_comp, "correct_reduced"));
  TYNDALL_TRY(make(of.upscale[extinction][quarter], full ? shaders::upscale_comp_rgba32f : shaders::upscale_comp_rgba16f, "upscale"));
  return make(of.upscale_pixels[extinction][quarter],
              full ? shaders::upscale_pixels_comp_rgba32f : shaders::upscale_pixels_comp_rgba16f, "upscale_pixels");
}

bool Epipolar::walks(const Params& params) {
  if (is_homogeneous(params.scattering)) return params.scattering.single != SingleScattering::none;
  return params.scattering.single != SingleScattering::none ||
         params.scattering.multiple == MultipleScattering::occluded;
}

Result<const gpu::Pipeline*> Epipolar::march(bool tree, bool colors, std::uint32_t mode) {
  gpu::Pipeline& out = march_samples_[tree ? 1 : 0][colors ? 1 : 0][mode];
  if (!out.pipeline) {
    const std::array<gpu::Constant, 4> m = mode_constants(mode);
    const gpu::Constant constants[] = {m[0], m[1], m[2], m[3], {3, tree ? 1U : 0U}, {4, colors ? 1U : 0U},
                                       {8, desc_.counters ? 1U : 0U}};
    TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(*device_, shaders::march_samples_comp, constants));
    out.name = "march_samples";
  }
  return &out;
}

Result<void> Epipolar::prepare(const Params& params) {
  if (params.scattering.technique != Technique::epipolar) return {};
  if (is_homogeneous(params.scattering)) {
    TYNDALL_TRY(make_of_medium(MediumKind::homogeneous, extinction_index(params), lists_breaks(params)));
  }
  if (is_downscaled(params)) TYNDALL_TRY(make_downscaled(params.scattering.medium, extinction_index(params),
                                                             params.scattering.downscale));
  // As record() chooses, for frames with cascades.
  const bool tree = params.epipolar.min_max_tree.value != 0 && walks(params) && params.scattering.light_shafts.value != 0;
  for (const bool colors : {false, true}) {
    if (colors && !desc_.shadow_colors) continue;
    TYNDALL_ASSIGN([[maybe_unused]] const gpu::Pipeline* pipeline, march(tree, colors, mode_index(params.scattering)));
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
        TYNDALL_TRY(take(made, [&]() -> Result<void> {
          TYNDALL_ASSIGN([[maybe_unused]] const gpu::Pipeline* pipeline, march(tree, colors, mode));
          return {};
        }));
      }
    }
  }
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    const PerMedium& of = of_medium_[static_cast<std::size_t>(medium)];
    for (std::uint32_t extinction = 0; extinction < (medium == MediumKind::atmosphere ? 2U : 1U); ++extinction) {
      for (const bool breaks : {false, true}) {
        TYNDALL_TRY(take(static_cast<bool>(of.unwarp_pixels[extinction][breaks ? 1 : 0].pipeline),
                         [&] { return make_of_medium(medium, extinction, breaks); }));
      }
      for (const std::uint32_t downscale : {2U, 4U}) {
        TYNDALL_TRY(take(static_cast<bool>(of.upscale_pixels[extinction][downscale / 4].pipeline),
                         [&] { return make_downscaled(medium, extinction, downscale); }));
      }
    }
  }
  return {};
}

Result<void> Epipolar::set_limits(const EffectDesc& desc, const Params& params) {
  const EffectDesc before = std::exchange(desc_, desc);
  Result<void> done = set_params(params);
  if (!done) desc_ = before;
  return done;
}

Result<void> Epipolar::set_params(const Params& params) {
  const EpipolarSizes sizes = epipolar_sizes(desc_, params);
  // All new buffers first, so that an error changes nothing.
  Buffers fresh = {};
  retired_.reserve(retired_.size() + kEpipolarBuffers);
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) {
    if (sizes[i] == 0 || sizes[i] == buffers_[i].size) continue;
    TYNDALL_ASSIGN(fresh[i], gpu::create_buffer(*device_, kNames[i].name, sizes[i], kUsage, gpu::MemoryKind::device));
  }
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) {
    if (sizes[i] == buffers_[i].size) continue;
    if (buffers_[i].size > 0) retired_.push_back({std::move(buffers_[i]), desc_.frames_in_flight + 1});
    buffers_[i] = std::move(fresh[i]);
  }
  return {};
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
  for (std::size_t i = 0; i < kEpipolarBuffers; ++i) all[used++] = gpu::named_buffer(kNames[i].block, buffers_[i].buffer.get());
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
  const auto run_list = [&](const gpu::Pipeline& pipeline, EpipolarBuffer list, const void* push = nullptr) -> Result<void> {
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
  const bool trees = p.min_max_tree.value != 0 && walking && marched > 0;
  const bool breaks = lists_breaks(params);
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
  empty_lists({EpipolarBuffer::march_list, EpipolarBuffer::broken_list, EpipolarBuffer::break_list,
               EpipolarBuffer::tree_list});
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
  TYNDALL_ASSIGN(const gpu::Pipeline* chosen, this->march(trees, colored, mode));
  const gpu::Pipeline& march = *chosen;
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
    if (p.correct_depth_breaks || is_downscaled(params)) {
      TYNDALL_TRY(run_list(march, EpipolarBuffer::break_list, &of_pixels));
    }
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
    TYNDALL_TRY(run(of.unwarp[extinction][breaks ? 1 : 0], {blocks.width, blocks.height}));
    lists_ready();
    TYNDALL_TRY(run_list(of.unwarp_pixels[extinction][breaks ? 1 : 0], EpipolarBuffer::broken_list));
    if (breaks) TYNDALL_TRY(correct(of.correct_pixels));
  }
  if (p.show_sampling) {
    for (std::uint32_t marked = 0; marked < 2; ++marked) {
      TYNDALL_TRY(run(show_sampling_, {samples, slices}, &marked));
    }
  }
  return {};
}

}  // namespace tyndall
