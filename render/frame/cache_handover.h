#pragma once
// Hands cached light (indirect_cache.h) that is made beside the frames to the loop that makes them: by one exchange
// of a pointer, and only once the light that the frames then ask for is solved.

#include <atomic>
#include <memory>

#include "render/indirect/indirect_cache.h"

namespace hilcam {

class CacheHandover {
  public:
    CacheHandover() = default;
    ~CacheHandover() { delete given_.load(std::memory_order_acquire); }
    CacheHandover(const CacheHandover&) = delete;
    CacheHandover& operator=(const CacheHandover&) = delete;

    // One thread, once.
    void give(std::unique_ptr<IndirectCache> made) {
        given_.store(made.release(), std::memory_order_release);
    }
    // Returns the light when it fits the frame that was placed last; null until then. Loop: no lock, nothing
    // is allocated.
    std::unique_ptr<IndirectCache> take(const FrameContext& last, const WorldSnapshot& world) {
        if (!coming_) coming_.reset(given_.exchange(nullptr, std::memory_order_acquire));
        if (!coming_ || !coming_->prepare(last, world)) return nullptr;
        return std::move(coming_);
    }

  private:
    std::atomic<IndirectCache*> given_{nullptr};
    std::unique_ptr<IndirectCache> coming_;  // the loop's; its first frame is being solved
};

}  // namespace hilcam
