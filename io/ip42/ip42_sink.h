#pragma once
// Knows when the frame that 42 waits for is done: sensed, and given to the outputs before this one.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/system/timed_semaphore.h"

namespace hilcam {

class Ip42Sink : public FrameSink {
  public:
    using Figures = std::function<std::vector<std::pair<std::string, double>>()>;
    // figures: for the report.
    Ip42Sink(std::string name, Figures figures) : name_(std::move(name)), figures_(std::move(figures)) {}

    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override {}
    SinkReport report() const override;

    // Awaits the frame of the `expose` with this sequence number and mid-exposure. Asking thread, as
    // wait_until().
    void expect(std::uint32_t trigger_sequence, TimeTai exposure_mid);
    // Returns true when the frame has come, and false at that time.
    bool wait_until(std::int64_t monotonic_ns) { return done_.try_acquire_until(monotonic_ns); }

  private:
    std::string name_;
    Figures figures_;
    // Others may expose, too (commands over UDP), and use the same number.
    std::atomic<std::uint32_t> sequence_{0};
    std::atomic<std::int64_t> time_ns_{0};
    std::atomic<bool> awaited_{false};  // publishes the two above
    TimedSemaphore done_;
    std::atomic<std::uint64_t> given_{0};
};

}  // namespace hilcam
