// A scene and the thread that works on it, one piece of work after the other, so that the GUI never waits for it.
// Between two pieces the GUI takes what came of the last one and says what it wishes; meanwhile it has facts() and the
// last picture.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

class SceneThread {
 public:
  // Begins to create the scene.
  void start(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request, bool to_host);
  SceneThread() = default;
  SceneThread(const SceneThread&) = delete;
  SceneThread& operator=(const SceneThread&) = delete;

  // What has been finished, once.
  std::optional<SceneResult> poll();
  [[nodiscard]] bool busy() const { return running_.valid(); }
  [[nodiscard]] bool creating() const { return busy() && !made_; }
  // Whether a piece of work is due, and whether the last frame is that of the wish; only when not busy.
  [[nodiscard]] bool wants(const SceneRequest& request) const { return made_ && work_->wants(request); }
  [[nodiscard]] bool shows(const SceneRequest& request) const { return made_ && work_->shows(request); }
  void launch(const SceneRequest& request);
  // After the last finished piece.
  [[nodiscard]] const SceneFacts& facts() const { return facts_; }

 private:
  template <typename Piece>
  void begin(Piece piece);

  std::unique_ptr<SceneWork> work_ = std::make_unique<SceneWork>();
  bool made_ = false;
  std::future<SceneResult> running_;
  SceneFacts facts_;
  std::jthread thread_;  // the last member: it ends before the others do
};

}  // namespace tyndall::viewer
