#include "viewer/scenes/scene_thread.hpp"

#include <chrono>
#include <utility>

#include "viewer/platform/window.hpp"

namespace tyndall::viewer {

template <typename Piece>
void SceneThread::begin(Piece piece) {
  std::promise<SceneResult> promise;
  running_ = promise.get_future();
  thread_ = std::jthread([promise = std::move(promise), piece = std::move(piece)]() mutable {
    promise.set_value(piece());
    Window::wake();
  });
}

void SceneThread::start(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request, bool to_host) {
  begin([work = work_.get(), &host, desc, request, to_host] { return work->create(host, desc, request, to_host); });
}

void SceneThread::launch(const SceneRequest& request) {
  begin([work = work_.get(), request] { return work->run(request); });
}

std::optional<SceneResult> SceneThread::poll() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  SceneResult out = running_.get();
  made_ = work_->exists();
  facts_ = work_->facts();
  return out;
}

}  // namespace tyndall::viewer
