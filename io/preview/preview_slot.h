#pragma once
// The newest frame, from the loop to the preview's threads, copied only on request.
//
// There are two buffers, one filled by the loop and one read by the threads, which are swapped. The loop
// never waits: it copies only when a frame is wanted. A reader that wants another frame waits for the
// hand-over.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <semaphore>
#include <thread>
#include <vector>

#include "io/contract/frame_sink.h"

namespace hilcam {

// Nice value of the preview's threads, from 0 (as other threads) to 19 (least), so that neither viewers nor a
// flood of requests take the processor from the loop.
inline constexpr int kPreviewNiceness = 15;
// Name in `top -H`.
inline constexpr const char* kPreviewThreadName = "preview";
// Gives the calling thread that name and nice value.
void become_preview_thread() noexcept;

class PreviewSlot {
  public:
    struct Frame {
        std::vector<std::uint16_t> samples;
        int width = 0, height = 0;
        FrameRecord record;
    };

    // Holds frames of up to `max_samples`; makes at most one copy per `min_interval`.
    PreviewSlot(std::size_t max_samples, std::chrono::nanoseconds min_interval);
    ~PreviewSlot() { stop(); }

    void start();
    // Wakes all waiting threads. Idempotent.
    void stop() noexcept;

    // Offers a frame. Loop, one thread: no lock, no allocation.
    void put(const DnImage& frame, const FrameRecord& record) noexcept {
        const State state = state_.load(std::memory_order_acquire);
        if (state == State::kWanted || (state == State::kWantedWithTruth && record.has_truth))
            copy(frame, record);
    }
    // True while a reader waits for a frame with truth. Loop.
    bool wants_truth() const noexcept {
        return state_.load(std::memory_order_relaxed) == State::kWantedWithTruth;
    }
    // Waits for a frame with another id than `after`, then calls read(frame) with the lock held. False when
    // none came in time. with_truth: prefers a frame with truth and accepts any when time is up. Any thread
    // but the loop.
    template <class Read>
    bool wait_for(std::uint64_t after, std::chrono::nanoseconds patience, bool with_truth, Read&& read) {
        std::unique_lock lock(mutex_);
        const auto deadline = Clock::now() + patience;
        asked_until_ = std::max(asked_until_, deadline);
        if (with_truth) ask_for_truth(deadline);
        asked_.notify_all();
        const auto there = [&] { return shown_.width > 0 && shown_.record.id != after; };
        news_.wait_until(lock, deadline,
                         [&] { return stopping_ || (there() && (shown_.record.has_truth || !with_truth)); });
        if (stopping_ || !there()) return false;
        read(static_cast<const Frame&>(shown_));
        return true;
    }
    std::uint64_t copies() const { return copies_.load(std::memory_order_relaxed); }

  private:
    using Clock = std::chrono::steady_clock;
    // The hand-over thread owns `incoming_` in kIdle and kFull, the loop otherwise.
    enum class State : std::uint8_t { kIdle, kWanted, kWantedWithTruth, kFull };

    void copy(const DnImage& frame, const FrameRecord& record) noexcept;
    void hand_over();
    void ask_for_truth(Clock::time_point deadline);

    std::chrono::nanoseconds min_interval_;
    std::atomic<State> state_{State::kIdle};
    Frame incoming_;
    std::counting_semaphore<> full_{0};
    std::atomic<std::uint64_t> copies_{0};

    std::mutex mutex_;  // guards the following members
    std::condition_variable asked_, news_;
    Frame shown_;
    Clock::time_point asked_until_{}, truth_until_{};
    bool stopping_ = true;
    std::thread thread_;
};

}  // namespace hilcam
