#pragma once
// Decides which application controls the camera: the control channel privilege (CCP), its heartbeat, its
// switch-over.
//
// The first application to write a non-zero privilege is the controller, until it writes 0 or is silent for
// longer than the heartbeat time-out. Others (monitors) may read, unless the privilege is exclusive, and get
// ACCESS_DENIED for writes. If the controller has enabled switch-over (CCP bit 2, with control access),
// another application takes its place by writing the privilege with the switch-over key in the upper 16 bits;
// the stream continues.

#include <functional>

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeAccess {
  public:
    struct Effects {
        // Called before a switch-over changes the controller, so that the old one can be notified.
        std::function<void()> switched{};
        std::function<void()> released{};  // no application has control any more
    };
    GigeAccess(GigeCore& core, Effects effects);

    bool controlled() const { return controller_.port != 0; }
    const Endpoint& controller() const { return controller_; }
    bool may_read(const Endpoint& from, std::uint32_t address, std::size_t bytes) const;
    bool may_write(const Endpoint& from, std::uint32_t address) const;

    void heard() { last_heard_ns_ = core_.now_ns; }  // the controller sent something
    // Ends the control of a silent application.
    void tick();
    std::int64_t deadline_ns() const;  // end of the heartbeat time-out; INT64_MAX: none
    void release();
    void reset();  // returns to the state after power-up

  private:
    gvcp::Status write_privilege(std::uint32_t value);
    void take(std::uint32_t privilege);
    bool heartbeat_matters() const;

    GigeCore& core_;
    Effects effects_;
    Endpoint controller_;
    std::uint32_t privilege_ = 0;
    std::uint32_t switchover_key_ = 0;
    std::uint32_t heartbeat_ms_ = 3000;
    std::int64_t last_heard_ns_ = 0;
};

}  // namespace hilcam
