#pragma once
// Starts and stops the stream of frames, and sets exposure, gain and rate.

#include <functional>

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeAcquisition {
  public:
    explicit GigeAcquisition(GigeCore& core);

    void stop();
    // Sets the function that is called whenever a stream of frames has ended.
    void on_end(std::function<void()> tell) { ended_ = std::move(tell); }
    // Takes the start of a frame's exposure; with ExposureAuto Once, the value may now be found.
    void on_event(const CameraEvent& event);
    // Says that the stream side has delivered the last frame of a counted acquisition.
    void finished(std::uint32_t epoch) {
        if (epoch == core_.stream.epoch) stop();
    }

  private:
    void add_control();
    void add_exposure();
    void add_frame_rate();
    gvcp::Status start();
    gvcp::Status enable_rate(bool on);
    gvcp::Status set_rate(double rate_hz);

    gvcp::Status set_automatic(std::uint64_t mode);

    static constexpr std::uint64_t kTimed = 1;  // SFNC ExposureMode
    enum ExposureAuto : std::uint64_t { kOff, kContinuous, kOnce };
    GigeCore& core_;
    std::function<void()> ended_;
    // For ExposureAuto Once: exposure of the previous frame, number of frames for which it has been steady,
    // and number of frames examined.
    bool finding_ = false;
    double found_s_ = 0;
    int steady_ = 0, looked_at_ = 0;
    std::uint32_t only_selector_ = 0;  // GainSelector, BlackLevelSelector: All
};

}  // namespace hilcam
