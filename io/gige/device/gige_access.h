#pragma once
// Decides who has control of the camera: the control channel privilege (CCP), its heartbeat, its hand-over.
//
// The first application to write a non-zero privilege becomes the controller until it writes 0 or stays
// silent longer than the heartbeat time-out. Others (monitors) may read, unless the privilege is exclusive,
// and get ACCESS_DENIED for writes. A controller that has enabled the switch-over (CCP bit 2, with control
// access) is replaced by an application that writes the privilege with the switch-over key in the upper 16
// bits; the stream goes on.

#include <functional>

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeAccess {
  public:
    struct Effects {
        // Is called before the controller changes by a switch-over: the one before is still to be told.
        std::function<void()> switched{};
        std::function<void()> released{};  // nobody has control any more
    };
    GigeAccess(GigeCore& core, Effects effects);

    bool controlled() const { return controller_.port != 0; }
    const Endpoint& controller() const { return controller_; }
    bool may_read(const Endpoint& from, std::uint32_t address, std::size_t bytes) const;
    bool may_write(const Endpoint& from, std::uint32_t address) const;

    void heard() { last_heard_ns_ = core_.now_ns; }  // the controller spoke
    // Ends the control of an application that fell silent.
    void tick();
    std::int64_t deadline_ns() const;  // deadline of the heartbeat; INT64_MAX: none
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
