#pragma once
// Hands an indirect cache (indirect_cache.h) that another thread has built to the loop, by one atomic
// exchange of a pointer. The loop starts to use it only when the light for the current frames is solved.

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

    // Called by one thread, once.
    void give(std::unique_ptr<IndirectCache> made) {
        given_.store(made.release(), std::memory_order_release);
    }
    // Returns the cache when its light for the frame that was placed last is solved; null until then. Loop:
    // no lock, no allocation.
    std::unique_ptr<IndirectCache> take(const FrameContext& last, const WorldSnapshot& world) {
        if (!coming_) coming_.reset(given_.exchange(nullptr, std::memory_order_acquire));
        if (!coming_ || !coming_->prepare(last, world)) return nullptr;
        return std::move(coming_);
    }

  private:
    std::atomic<IndirectCache*> given_{nullptr};
    std::unique_ptr<IndirectCache> coming_;  // owned by the loop while its first frame is being solved
};

}  // namespace hilcam
