#pragma once
// The newest frame, from the loop to the preview's threads: copied only when it is asked for.
//
// Two buffers change places: the loop fills one while readers have the other. The loop never waits: it copies
// if and only if a frame is wanted, and somebody who wants another one waits until the last is handed over.

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

// Nice value of the preview's threads, so that neither a viewer nor a flood of requests takes the processor
// from the loop. 0: as others, 19: the least.
inline constexpr int kPreviewNiceness = 15;
// The name by which `top -H` shows them.
inline constexpr const char* kPreviewThreadName = "preview";
// The calling thread is one of the preview's from now on.
void become_preview_thread() noexcept;

class PreviewSlot {
  public:
    struct Frame {
        std::vector<std::uint16_t> samples;
        int width = 0, height = 0;
        FrameRecord record;
    };

    // Room for frames of up to `max_samples`; at most one copy per `min_interval`.
    PreviewSlot(std::size_t max_samples, std::chrono::nanoseconds min_interval);
    ~PreviewSlot() { stop(); }

    void start();
    // Wakes all who wait. Idempotent.
    void stop() noexcept;

    // Loop, one thread: no lock, no allocation.
    void put(const DnImage& frame, const FrameRecord& record) noexcept {
        const State state = state_.load(std::memory_order_acquire);
        if (state == State::kWanted || (state == State::kWantedWithTruth && record.has_truth))
            copy(frame, record);
    }
    // True while a frame is waited for whose truth is told. Loop.
    bool wants_truth() const noexcept {
        return state_.load(std::memory_order_relaxed) == State::kWantedWithTruth;
    }
    // Waits until there is a frame with another id than `after`, then calls read(frame) with the lock held.
    // False when none came in time. with_truth: while it waits, for one whose truth is told; when time is up
    // any will do. Any thread but the loop.
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
    // kIdle and kFull: the hand-over thread owns `incoming_`; else the loop does.
    enum class State : std::uint8_t { kIdle, kWanted, kWantedWithTruth, kFull };

    void copy(const DnImage& frame, const FrameRecord& record) noexcept;
    void hand_over();
    void ask_for_truth(Clock::time_point deadline);

    std::chrono::nanoseconds min_interval_;
    std::atomic<State> state_{State::kIdle};
    Frame incoming_;
    std::counting_semaphore<> full_{0};
    std::atomic<std::uint64_t> copies_{0};

    std::mutex mutex_;  // of what follows
    std::condition_variable asked_, news_;
    Frame shown_;
    Clock::time_point asked_until_{}, truth_until_{};
    bool stopping_ = true;
    std::thread thread_;
};

}  // namespace hilcam
