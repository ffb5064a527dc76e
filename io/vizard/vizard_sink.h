#pragma once
// Keeps that frame of a camera which the Vizard side has asked for: it is copied in the loop, and read by who
// waits.
//
// Two threads share it without a lock: expect() hands the buffer to the loop, the loop hands it back with
// the frame in it. The loop never waits.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/system/timed_semaphore.h"

namespace hilcam {

class VizardSink : public FrameSink {
  public:
    // The largest frame's size.
    VizardSink(std::string name, int width, int height) : name_(std::move(name)), frame_(width, height) {}

    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override {}
    SinkReport report() const override;

    // The frame of the `expose` with this sequence number, at this instant. Asking thread, as the rest.
    void expect(std::uint32_t trigger_sequence, TimeTai exposure_mid);
    // True when it is there; then frame() and record() are, until the next expect().
    bool wait_for(std::chrono::nanoseconds patience);
    // It is not wanted any more.
    void forget();
    const DnImage& frame() const { return frame_; }
    const FrameRecord& record() const { return record_; }

  private:
    // kIdle and kFull: the asking thread owns the buffer; kWanted: nobody; kCopying: the loop.
    enum class State : std::uint8_t { kIdle, kWanted, kCopying, kFull };

    std::string name_;
    std::atomic<State> state_{State::kIdle};
    std::uint32_t sequence_ = 0;
    TimeTai time_;
    DnImage frame_;
    FrameRecord record_;
    TimedSemaphore full_;
    std::atomic<std::uint64_t> given_{0};
};

}  // namespace hilcam
