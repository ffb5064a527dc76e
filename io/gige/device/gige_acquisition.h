#pragma once
// Starting and stopping the stream of frames, and what frames are taken with: exposure, gain, rate.

#include <functional>

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeAcquisition {
  public:
    explicit GigeAcquisition(GigeCore& core);

    void stop();
    // Is called when a stream of frames has ended, whoever ended it.
    void on_end(std::function<void()> tell) { ended_ = std::move(tell); }
    // A frame's exposure has begun: automatic exposure that was to find its value once may have found it.
    void on_event(const CameraEvent& event);
    // The stream side has delivered a counted acquisition's last frame.
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

    enum ExposureAuto : std::uint64_t { kOff, kContinuous, kOnce };
    GigeCore& core_;
    std::function<void()> ended_;
    // ExposureAuto Once: the exposure of the frame before, and how many frames it has been steady, of how many.
    bool finding_ = false;
    double found_s_ = 0;
    int steady_ = 0, looked_at_ = 0;
    std::uint32_t only_selector_ = 0;  // GainSelector, BlackLevelSelector: All
};

}  // namespace hilcam
