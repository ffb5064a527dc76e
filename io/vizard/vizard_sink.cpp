#include "io/vizard/vizard_sink.h"

#include <algorithm>
#include <thread>

namespace hilcam {

void VizardSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    State wanted = State::kWanted;
    if (!state_.compare_exchange_strong(wanted, State::kCopying, std::memory_order_acq_rel)) return;
    // Others may ask for frames, too (commands over UDP), and use the same number.
    if (record.trigger_sequence != sequence_ || record.exposure_mid != time_)
        return state_.store(State::kWanted, std::memory_order_release);
    frame_.reshape(frame.width(), frame.height());
    std::copy(frame.all().begin(), frame.all().end(), frame_.all().begin());
    record_ = record;
    given_.fetch_add(1, std::memory_order_relaxed);
    state_.store(State::kFull, std::memory_order_release);
    full_.release();
}

void VizardSink::expect(std::uint32_t trigger_sequence, TimeTai exposure_mid) {
    forget();
    sequence_ = trigger_sequence, time_ = exposure_mid;
    state_.store(State::kWanted, std::memory_order_release);
}

bool VizardSink::wait_for(std::chrono::nanoseconds patience) {
    const std::int64_t until_ns = monotonic_ns() + patience.count();
    do {  // a release may be that of a cancelled request
        if (!full_.try_acquire_until(until_ns)) return false;
    } while (state_.load(std::memory_order_acquire) != State::kFull);
    return true;
}

void VizardSink::forget() {
    State state = State::kWanted;
    // The wait is short, because a copy takes no longer than a memcpy.
    while (!state_.compare_exchange_strong(state, State::kIdle, std::memory_order_acq_rel) &&
           state == State::kCopying) {
        state = State::kWanted;
        std::this_thread::yield();
    }
    state_.store(State::kIdle, std::memory_order_release);
}

SinkReport VizardSink::report() const { return {.name = name_, .frames = given_.load()}; }

}  // namespace hilcam
