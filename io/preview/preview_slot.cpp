#include "io/preview/preview_slot.h"

#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace hilcam {

void become_preview_thread() noexcept {
    setpriority(PRIO_PROCESS, 0, kPreviewNiceness);  // Linux: of this thread alone
    pthread_setname_np(pthread_self(), kPreviewThreadName);
}

PreviewSlot::PreviewSlot(std::size_t max_samples, std::chrono::nanoseconds min_interval)
    : min_interval_(min_interval) {
    incoming_.samples.resize(max_samples);
    shown_.samples.resize(max_samples);
}

void PreviewSlot::start() {
    stopping_ = false;
    thread_ = std::thread([this] { hand_over(); });
}

void PreviewSlot::stop() noexcept {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    asked_.notify_all();
    news_.notify_all();
    full_.release();
    if (thread_.joinable()) thread_.join();
}

void PreviewSlot::copy(const DnImage& frame, const FrameRecord& record) noexcept {
    if (frame.pixels() > incoming_.samples.size()) return;
    std::copy(frame.all().begin(), frame.all().end(), incoming_.samples.begin());
    incoming_.width = frame.width(), incoming_.height = frame.height();
    incoming_.record = record;
    copies_.fetch_add(1, std::memory_order_relaxed);
    state_.store(State::kFull, std::memory_order_release);
    full_.release();
}

// A camera that waits for a trigger takes no other frame first, so the wish must change at once. If the loop
// is copying at this moment, that frame arrives and the next one is asked for again.
void PreviewSlot::ask_for_truth(Clock::time_point deadline) {
    truth_until_ = std::max(truth_until_, deadline);
    State plain = State::kWanted;
    state_.compare_exchange_strong(plain, State::kWantedWithTruth, std::memory_order_acq_rel);
}

void PreviewSlot::hand_over() {
    become_preview_thread();
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        asked_.wait(lock, [&] { return stopping_ || Clock::now() < asked_until_; });
        if (stopping_) return;
        const bool with_truth = Clock::now() < truth_until_;
        state_.store(with_truth ? State::kWantedWithTruth : State::kWanted, std::memory_order_release);
        lock.unlock();
        full_.acquire();  // a frame, or stop()
        lock.lock();
        if (state_.load(std::memory_order_acquire) != State::kFull) return;
        std::swap(incoming_, shown_);
        state_.store(State::kIdle, std::memory_order_release);
        news_.notify_all();
        asked_.wait_for(lock, min_interval_, [&] { return stopping_; });
    }
}

}  // namespace hilcam
