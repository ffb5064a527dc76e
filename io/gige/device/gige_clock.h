#pragma once
// The clock's registers: time stamps, PtpEnable and what can be read of PTP. 1 tick = 1 ns. The time comes
// from the source of the configuration (io/ptp/device_clock_config.h):
//
//  tai   CLOCK_MONOTONIC since the last reset of the time stamp or, with PTP enabled, the machine's
//        CLOCK_TAI, which a daemon keeps (ptp4l with phc2sys, or chrony). The clock steps when the machine's
//        does. The data set is the kernel's. PtpStatus:
//         Disabled      PTP is not enabled
//         Listening     the kernel's clock is not synchronised (adjtimex: STA_UNSYNC)
//         Uncalibrated  it is, but CLOCK_TAI has no offset to UTC: times are UTC, not TAI
//         Slave         it is, and CLOCK_TAI is TAI
//  ptp   a clock of the device's own, which a PTP slave steers with PTP enabled (io/ptp/ptp_port.h)
//  free  such a clock without PTP, which cannot be enabled
//
// A latched data set is of one instant.

#include "io/gige/device/gige_core.h"

namespace hilcam {

// Reads the kernel's clocks.
GigeSystemClock read_system_clock();

class GigeClock {
  public:
    explicit GigeClock(GigeCore& core);

    void set_ptp(bool enabled);  // GVCP configuration
    // Follows the machine's clock; lets the device's own clock age.
    void tick();
    void reset();
    PtpDataSet data_set() const;

  private:
    bool ptp() const;
    bool follows_machine() const { return core_.identity.clock_source == ClockSource::kTai; }
    void add_time_stamp();
    void add_data_set();
    PtpState machine_state() const;
    PtpDataSet machine_data_set() const;
    // Sets the device's clock to CLOCK_MONOTONIC and this.
    void set_offset(std::int64_t offset_ns);

    GigeCore& core_;
    GigeSystemClock system_;
    bool was_reset_ = false;  // the time stamp, by a client
    std::uint32_t machine_steps_ = 0;
    std::uint64_t latched_ = 0;
    PtpDataSet latched_set_;
};

}  // namespace hilcam
