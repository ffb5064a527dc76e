#pragma once
// The device's clock, with 1 tick = 1 ns. It is CLOCK_MONOTONIC since the last reset of the time stamp or,
// with PTP enabled, the machine's CLOCK_TAI. The camera does not implement PTP: a daemon (ptp4l with phc2sys,
// or chrony) keeps the machine's clock, and PtpStatus reports the kernel's state:
//  Disabled      PTP is not enabled
//  Listening     the kernel's clock is not synchronised (adjtimex: STA_UNSYNC)
//  Uncalibrated  it is, but CLOCK_TAI has no offset to UTC: times are UTC, not TAI
//  Slave         it is, and CLOCK_TAI is TAI
// With PTP the clock steps when the machine's does.

#include "io/gige/device/gige_core.h"

namespace hilcam {

// Reads the kernel's clocks.
GigeSystemClock read_system_clock();

enum class PtpStatus : std::uint32_t {  // IEEE 1588's port states
    kInitializing = 1,
    kFaulty,
    kDisabled,
    kListening,
    kPreMaster,
    kMaster,
    kPassive,
    kUncalibrated,
    kSlave,
};

class GigeClock {
  public:
    explicit GigeClock(GigeCore& core);

    void set_ptp(bool enabled);  // GVCP configuration
    // Follows the machine's clock.
    void tick();
    void reset();

  private:
    bool ptp() const;
    PtpStatus status() const;
    void set_offset(std::int64_t offset_ns);

    GigeCore& core_;
    GigeSystemClock system_;
    std::uint64_t latched_ = 0;
};

}  // namespace hilcam
