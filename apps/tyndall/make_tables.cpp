#include "make_tables.hpp"

namespace tyndall::cli {

tables::CacheDesc table_cache(const scene::SceneParams& scene) {
  return {scene.tables.cache, std::uint64_t{scene.tables.cache_limit_mib} << 20U};
}

tables::MakeReady make_tables(const scene::SceneParams& scene) {
  tables::MakeReady how;
  how.cache = table_cache(scene);
  how.progress = [bar = std::shared_ptr<Progress>()](tyndall::Progress built) mutable {
    if (!bar) bar = std::make_shared<Progress>("tables");
    bar->update(built.done, built.total);
    if (built.complete()) bar.reset();
  };
  return how;
}

}  // namespace tyndall::cli
