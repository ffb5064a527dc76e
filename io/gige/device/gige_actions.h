#pragma once
// ACTION commands: one datagram triggers many cameras at once, now or at a time of the device's clock.
//
// An action is for this camera when its device key and group key match and the group masks have a bit in
// common; other cameras' actions get no answer. It needs a controller, unless the client has enabled
// unconditional actions. Scheduled actions wait in a queue of kQueue. One that comes after its time is
// answered ACTION_LATE, raises that event and is not carried out. A full queue answers OVERFLOW.

#include <array>

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeActions {
  public:
    static constexpr std::size_t kQueue = 16;

    GigeActions(GigeCore& core, std::function<void()> late);

    // Returns the status, or nothing when the action is for other cameras.
    std::optional<gvcp::Status> run(const gvcp::Action& action, bool controlled);
    // Passes actions to the camera shortly before they are due.
    void tick();
    std::int64_t deadline_ns() const;  // INT64_MAX: none
    void reset();

  private:
    gvcp::Status schedule(std::uint64_t device_ns);
    void trigger(std::int64_t at_monotonic_ns);

    GigeCore& core_;
    std::function<void()> late_;
    std::uint32_t device_key_ = 0, group_key_ = 0, group_mask_ = 0;
    std::uint32_t selector_ = 1;
    std::array<std::uint64_t, kQueue> queue_{};  // device times; tick() sorts them
    std::size_t count_ = 0;
};

}  // namespace hilcam
