// `tyndall render`: renders one frame or a sequence of the demo scene.
#include <cmath>

#include "arguments.hpp"
#include "batch.hpp"
#include "cli.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "image/image.hpp"
#include "interruption.hpp"
#include "make_tables.hpp"
#include "picture_units.hpp"
#include "scene/description/camera_exposure.hpp"
#include "scene/scene.hpp"
#include "tables/pipeline_store.hpp"

namespace tyndall::cli {
namespace {

// Returns the settings and the frame's exposure.
image::Metadata metadata_of(const scene::Scene& scene, const config::Settings& settings, const PictureUnits& units,
                            image::FileKind kind) {
  image::Metadata list = kind == image::FileKind::exr ? units.metadata(settings) : config::metadata(settings);
  const scene::Scene::Exposure exposure = scene.exposure();
  list.emplace_back("tyndall.frame.exposure", files::number_text(exposure.scale));
  if (exposure.ev100) list.emplace_back("tyndall.frame.ev100", files::number_text(*exposure.ev100));
  return list;
}

Result<void> write_frame(scene::Scene& scene, const std::string& path, const config::Settings& settings,
                         const PictureUnits& units) {
  const Result<image::FileKind> kind = image::kind_of_name(path);
  if (!kind) return kind.error();
  if (kind.value() == image::FileKind::exr) {
    Result<image::Image> radiance = scene.radiance();
    if (!radiance) return std::move(radiance).error();
    units.convert(radiance.value());
    return image::write_exr(path, radiance.value(), metadata_of(scene, settings, units, kind.value()),
                            units.exr(image::ExrContent::radiance));
  }
  const Result<image::Image> display = scene.display();
  if (!display) return display.error();
  return image::write_png(path, display.value(), metadata_of(scene, settings, units, kind.value()));
}

Result<void> check_units(PictureUnits& units, const CommonOptions& options) {
  const Result<image::FileKind> kind = image::kind_of_name(options.output);
  if (!kind) return kind.error();
  return kind.value() == image::FileKind::png ? units.check_png() : units.resolve(options.settings);
}

// Sets the place of a flight by date from the elevation file if the scene file has none.
Result<void> find_place(scene::CameraPath& path, const scene::Scene& scene) {
  if (!path.has_dates() || !path.place_text.empty()) return {};
  if (!scene.place()) {
    return files::input_error("a path with dates has no place, and the elevation file has no coordinates on Earth",
                              "[playback]", "expected place = \"LAT,LON\"");
  }
  path.place = *scene.place();
  return {};
}

// Returns whether the exposure of a frame depends on the frames before it.
bool adapts(const CommonOptions& options) {
  const scene::TonemapParams& tonemap = options.settings.scene.tonemap;
  return options.frames > 1 && scene::is_auto_exposed(tonemap) && tonemap.light_adaptation.value != 0;
}

// Starts the batch of the frames of this run.
Result<Batch> begin_batch(const CommonOptions& options, const BatchOptions& batch, double time_step,
                          const PictureUnits& units) {
  BatchDesc desc = {batch, "render", "frames", options.output, options.frames, batch.shard.items(options.frames), {}};
  if (batch.active()) {
    desc.inputs = common_inputs(options);
    desc.inputs.emplace_back("--size", size_text(options.size));
    desc.inputs.emplace_back("--time-step", files::number_text(time_step));
    units.add_inputs(desc.inputs);
  }
  return Batch::begin(std::move(desc));
}

}  // namespace

int run_render(Args args) {
  CommonOptions options;
  double time_step = 1.0 / 30.0;
  PictureUnits units;
  BatchOptions batch_options;
  Interruption interruption;
  Arguments arguments("render");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kFrames | kOutput);
  arguments.number("--time-step", time_step, 0.0, 1.0e6, "seconds between the frames of a sequence");
  units.add_options(arguments);
  add_batch_options(arguments, batch_options, "frames");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  if (Result<void> r = check_output(options, {".png", ".exr"}); !r) return fail(r.error());
  if (Result<void> r = check_units(units, options); !r) return fail(r.error());
  if (batch_options.active()) {
    if (Result<void> r = check_batch_output(options.output); !r) return fail(r.error());
    if (adapts(options)) {
      note("tonemap.light_adaptation has no effect with --shard and --resume; each frame is exposed independently");
    }
  }
  Result<Batch> batch = begin_batch(options, batch_options, time_step, units);
  if (!batch) return fail(batch.error());
  interruption.describe_by(batch.value().describe());
  if (batch.value().numbers().empty()) {
    const Result<void> ended = batch.value().end();
    return ended ? kDone : fail(ended.error());
  }

  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, false});
  if (!host) return fail(host.error());
  batch.value().set_device(host.value()->device_name());
  const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
  if (!pipelines.note().empty()) note(pipelines.note());
  scene::SceneDesc desc;
  desc.extent = {options.size.width, options.size.height};
  desc.pipeline_threads = gpu::Host::pipeline_threads();
  desc.make_tables = make_tables(options.settings.scene);
  Result<std::unique_ptr<scene::Scene>> scene =
      scene::Scene::create(*host.value(), desc, options.settings.effect, options.settings.scene);
  if (!scene) return fail_input(scene.error());
  if (Result<void> r = find_place(options.settings.path, *scene.value()); !r) return fail(r.error());
  Progress progress("render");
  std::size_t drawn = 0;
  for (const std::uint64_t number : batch.value().numbers()) {
    progress.update(drawn++, batch.value().numbers().size());
    const auto frame = static_cast<std::uint32_t>(number);
    const std::string path = frame_path(options.output, frame);
    const double seconds = frame * time_step;
    config::Settings now = options.settings;
    now.scene =
        scene::pose_at(now.path, seconds, options.settings.scene, static_cast<double>(now.effect.planet.radius_m));
    if (Result<void> r = scene.value()->set_scene(now.scene); !r) return fail(r.error());
    // A shard does not draw the frames that this one would adapt from.
    const std::optional<double> step_s = batch_options.active() ? std::optional<double>(0.0) : std::nullopt;
    if (Result<void> r = scene.value()->render(seconds, false, step_s); !r) return fail(r.error());
    if (Result<void> r = write_frame(*scene.value(), path, now, units); !r) return fail(r.error());
    if (Result<void> r = batch.value().finished(number, {path}); !r) return fail(r.error());
  }
  if (Result<void> r = batch.value().end(); !r) return fail(r.error());
  for (const std::string& text : scene.value()->notes()) note(text);
  return kDone;
}

}  // namespace tyndall::cli
