#include "io/ip42/ip42_sink.h"

namespace hilcam {

void Ip42Sink::publish(const DnImage&, const FrameRecord& record) noexcept {
    if (!awaited_.load(std::memory_order_acquire)) return;
    if (record.trigger_sequence != sequence_ || record.exposure_mid.ns != time_ns_) return;
    awaited_.store(false, std::memory_order_relaxed);
    given_.fetch_add(1, std::memory_order_relaxed);
    done_.release();
}

void Ip42Sink::expect(std::uint32_t trigger_sequence, TimeTai exposure_mid) {
    awaited_.store(false, std::memory_order_release);
    done_.take_all();
    sequence_ = trigger_sequence, time_ns_ = exposure_mid.ns;
    awaited_.store(true, std::memory_order_release);
}

SinkReport Ip42Sink::report() const {
    return {.name = name_, .frames = given_.load(), .figures = figures_()};
}

}  // namespace hilcam
