#pragma once
// Hands kept light (kept_scene.h) that is made beside the frames to the loop that makes them: by one exchange
// of a pointer, and only once the light that the frames then ask for is solved.

#include <atomic>
#include <memory>

#include "render/indirect/kept_scene.h"

namespace hilcam {

class KeptHandover {
  public:
    KeptHandover() = default;
    ~KeptHandover() { delete given_.load(std::memory_order_acquire); }
    KeptHandover(const KeptHandover&) = delete;
    KeptHandover& operator=(const KeptHandover&) = delete;

    // One thread, once.
    void give(std::unique_ptr<KeptScene> made) { given_.store(made.release(), std::memory_order_release); }
    // Returns the light when it fits the frame that was placed last; null until then. Loop: no lock, nothing
    // is allocated.
    std::unique_ptr<KeptScene> take(const FrameView& last, const WorldSnapshot& world) {
        if (!coming_) coming_.reset(given_.exchange(nullptr, std::memory_order_acquire));
        if (!coming_ || !coming_->prepare(last, world)) return nullptr;
        return std::move(coming_);
    }

  private:
    std::atomic<KeptScene*> given_{nullptr};
    std::unique_ptr<KeptScene> coming_;  // the loop's; its first frame is being solved
};

}  // namespace hilcam
