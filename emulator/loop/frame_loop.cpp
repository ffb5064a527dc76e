#include "emulator/loop/frame_loop.h"

#include <pthread.h>

#include "io/system/monotonic.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

FrameLoop::FrameLoop(const LoopParts& parts)
    : clock_(parts.clock),
      limits_(parts.limits),
      figures_{.missed = MissedExposures(parts.limits.counts_from_frame)},
      render_(parts, figures_),
      sense_(parts, figures_),
      free_(limits_.prefer == LoopPreference::kLatency ? 1 : 2) {
    for (FrameSlot& slot : slots_) render_.prepare(slot);
}

void FrameLoop::start() {
    sense_thread_ = std::thread([this] { sense_frames(); });
    render_thread_ = std::thread([this] { render_frames(); });
}

void FrameLoop::stop() noexcept {
    stopping_.store(true);
    // One thread may end a run while another waits for its end, but a thread can be joined only once.
    const std::lock_guard lock(joining_);
    if (render_thread_.joinable()) render_thread_.join();
    if (sense_thread_.joinable()) sense_thread_.join();
}

void FrameLoop::render_frames() {
    pthread_setname_np(pthread_self(), "render");
    for (std::uint64_t turn = 0;; ++turn) {
        free_.acquire();
        const bool enough = limits_.frames != 0 && turn >= limits_.frames;
        if (enough || !render_.run(slot_of(turn), stopping_)) break;
        rendered_.release();
    }
    render_.close();
    rendered_.release();
}

void FrameLoop::sense_frames() {
    pthread_setname_np(pthread_self(), "sense");
    for (std::uint64_t turn = 0;; ++turn) {
        rendered_.acquire();
        FrameSlot& slot = slot_of(turn);
        if (slot.record.id == 0) break;  // the last release comes without a frame
        if (sense_.run(slot, stopping_)) count_frame(slot.record.quality_level);
        slot.record.id = 0;
        free_.release();
    }
    finished_.store(true);
}

FrameLoop::ProcessorTime FrameLoop::ProcessorTime::now() {
    return {processor_ns(), AheadThread::processor_ns()};
}

// Adds the processor time since the previous frame was published to this frame's level. Part of it was for
// the next frame, which usually has the same level. Times of warm-up frames are not kept.
void FrameLoop::count_frame(std::uint32_t level) {
    const std::int64_t now_ns = processor_ns();
    if (counted_processor_ns_ != 0) {
        figures_.counters.processor_ns_at_level[level].fetch_add(now_ns - counted_processor_ns_,
                                                                 std::memory_order_relaxed);
        figures_.counters.timed_frames_at_level[level].fetch_add(1, std::memory_order_relaxed);
    }
    counted_processor_ns_ = now_ns;
    if (figures_.counters.frames.fetch_add(1, std::memory_order_relaxed) + 1 != limits_.warm_up) return;
    figures_.meters.clear();
    // Takes a lock, once and in benchmarks alone: other runs have no warm-up frames.
    warm_processor_time_ = ProcessorTime::now();
}

}  // namespace hilcam
