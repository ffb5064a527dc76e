#pragma once
// The clock of a GigE Vision camera as its configuration wants it: the device's clock, the PTP slave that
// steers it if the source is ptp, and what reports and the log say of both.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"
#include "io/ptp/device_clock.h"
#include "io/ptp/device_clock_config.h"
#include "io/ptp/ptp_slave.h"
#include "render/vocabulary/shared_latest.h"

namespace hilcam {

class CameraClock {
  public:
    CameraClock(const DeviceClockConfig& config, const NetInterface& net);

    const DeviceClock& clock() const { return clock_; }  // the loop reads it
    // Starts the slave's thread, if there is one. link_is_up: see PtpSlave. Owner thread.
    void start(const NetInterface& net, std::function<bool()> link_is_up);
    void stop() noexcept;

    // --- Control thread.
    // Connects the clock with a device that is about to be made.
    void add_to(GigeEffects& effects);
    void move(const NetInterface& net);  // the camera has another address
    // Takes what clients of the device could latch now, for reports.
    void look(const PtpDataSet& now);

    // --- Any thread.
    ClockReport report() const;
    // Returns what happened since the last call. name: the camera's, with which each note begins.
    std::vector<SinkNote> take_notes(const std::string& name);

  private:
    static constexpr std::size_t kMostNotes = 64;

    const DeviceClockConfig config_;
    DeviceClock clock_;
    std::unique_ptr<PtpSlave> slave_;
    SharedLatest<PtpDataSet> state_{PtpDataSet{}};
    std::mutex notes_mutex_;
    std::vector<SinkNote> notes_;  // made by look()
};

}  // namespace hilcam
