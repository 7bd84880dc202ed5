#include "viewer/scenes/scene_thread.hpp"

#include <chrono>
#include <utility>

#include "viewer/platform/window.hpp"

namespace tyndall::viewer {

template <typename Piece>
void Stage::begin(Piece piece) {
  std::promise<Outcome> promise;
  running_ = promise.get_future();
  thread_ = std::jthread([promise = std::move(promise), piece = std::move(piece)]() mutable {
    promise.set_value(piece());
    Window::wake();
  });
}

void Stage::start(gpu::Host& host, const scene::SceneDesc& desc, const Wish& wish, bool to_host) {
  begin([work = work_.get(), &host, desc, wish, to_host] { return work->create(host, desc, wish, to_host); });
}

void Stage::launch(const Wish& wish) {
  begin([work = work_.get(), wish] { return work->run(wish); });
}

std::optional<Outcome> Stage::poll() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  Outcome out = running_.get();
  made_ = work_->exists();
  facts_ = work_->facts();
  return out;
}

}  // namespace tyndall::viewer
