#pragma once
// Starting and stopping the stream of frames, and what frames are taken with: exposure, gain, rate.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeAcquisition {
  public:
    explicit GigeAcquisition(GigeCore& core);

    void stop();
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

    GigeCore& core_;
    std::uint32_t only_selector_ = 0;  // GainSelector, BlackLevelSelector: All
};

}  // namespace hilcam
