#pragma once
// Keeps the one frame of a camera that the simulator has asked for. The loop copies it; the asking thread
// reads it.
//
// The two threads share it without a lock: expect() gives the buffer to the loop, and the loop gives it back
// with the frame. The loop never waits.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/system/timed_semaphore.h"

namespace hilcam {

class VizardSink : public FrameSink {
  public:
    // width, height: of the largest frame.
    VizardSink(std::string name, int width, int height) : name_(std::move(name)), frame_(width, height) {}

    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override {}
    SinkReport report() const override;

    // Requests the frame of the `expose` with this sequence number and mid-exposure. Asking thread, as all
    // below.
    void expect(std::uint32_t trigger_sequence, TimeTai exposure_mid);
    // Returns true when it has come; frame() and record() are then valid until the next expect().
    bool wait_for(std::chrono::nanoseconds patience);
    // Cancels the request of expect().
    void forget();
    const DnImage& frame() const { return frame_; }
    const FrameRecord& record() const { return record_; }

  private:
    // Owner of the buffer: kIdle and kFull: the asking thread; kWanted: none; kCopying: the loop.
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
