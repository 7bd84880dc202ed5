// Runs the work on a scene on a thread of its own, one piece after the other, so that the GUI never waits for it.
// Between two pieces the GUI takes the result of the last one and sends the next request; meanwhile it has facts() and
// the last picture.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

class SceneThread {
 public:
  // Starts to create the scene.
  void start(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request, bool to_host);
  SceneThread() = default;
  SceneThread(const SceneThread&) = delete;
  SceneThread& operator=(const SceneThread&) = delete;

  // Returns the result of a finished piece, once.
  std::optional<SceneResult> poll();
  [[nodiscard]] bool busy() const { return running_.valid(); }
  [[nodiscard]] bool creating() const { return busy() && !made_; }
  // Return whether a piece of work is due for the request, and whether the last frame shows the request. Not to be
  // called while busy().
  [[nodiscard]] bool wants(const SceneRequest& request) const { return made_ && work_->wants(request); }
  [[nodiscard]] bool shows(const SceneRequest& request) const { return made_ && work_->shows(request); }
  void launch(const SceneRequest& request);
  // Returns the state after the last finished piece.
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
