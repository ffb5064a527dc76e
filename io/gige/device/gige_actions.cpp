#include "io/gige/device/gige_actions.h"

#include <algorithm>
#include <limits>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace b = bootstrap;
namespace reg = feature_register;
using gvcp::Status;

namespace {

// The camera accepts triggers with a time of their own. Passing them on this early makes the instant
// independent of when this thread wakes; keeping them until then lets a stop or reset cancel them.
constexpr std::int64_t kAhead_ns = 20'000'000;

}  // namespace

GigeActions::GigeActions(GigeCore& core, std::function<void()> late) : core_(core), late_(std::move(late)) {
    GigeRegisterFile& r = core.registers;
    r.constant(b::kActionSignals, 1);
    r.constant(b::kActionQueue, kQueue);
    // The device key is a secret between the controller and the senders of actions.
    r.number(
        b::kActionDeviceKey, [] { return 0u; },
        [this](std::uint64_t key) {
            device_key_ = static_cast<std::uint32_t>(key);
            return Status::kSuccess;
        });
    r.variable(b::kActionGroupKey, group_key_, {});
    r.variable(b::kActionGroupMask, group_mask_, {});
    r.variable(reg::kActionSelector, selector_, {1, 1});
}

std::optional<Status> GigeActions::run(const gvcp::Action& action, bool controlled) {
    if (action.device_key != device_key_ || action.group_key != group_key_ ||
        (action.group_mask & group_mask_) == 0)
        return {};
    if (!controlled && !(core_.gvcp_config & b::gvcp_config::kUnconditionalAction))
        return Status::kAccessDenied;
    if (action.at) return schedule(*action.at);
    trigger(0);
    return Status::kSuccess;
}

Status GigeActions::schedule(std::uint64_t device_ns) {
    if (device_ns < core_.device_ns(core_.now_ns)) {
        if (late_) late_();
        return Status::kActionLate;
    }
    if (count_ == kQueue) return Status::kOverflow;
    queue_[count_++] = device_ns;
    tick();
    return Status::kSuccess;
}

void GigeActions::tick() {
    const std::uint64_t until = core_.device_ns(core_.now_ns + kAhead_ns);
    std::sort(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count_));
    while (count_ > 0 && queue_[0] <= until) {
        trigger(core_.clock.monotonic_ns(static_cast<std::int64_t>(queue_[0])));
        std::copy(queue_.begin() + 1, queue_.begin() + static_cast<std::ptrdiff_t>(count_), queue_.begin());
        --count_;
    }
}

// Triggers the camera, which reports with an event whether it takes the trigger.
void GigeActions::trigger(std::int64_t at_monotonic_ns) {
    TriggerOrder order;
    order.source = TriggerSource::kAction1;
    order.at_monotonic_ns = at_monotonic_ns;
    core_.camera.trigger(order);
}

std::int64_t GigeActions::deadline_ns() const {
    if (count_ == 0) return std::numeric_limits<std::int64_t>::max();
    const std::uint64_t next = queue_[0];
    // A time beyond the range of the clock never comes.
    if (next > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        return std::numeric_limits<std::int64_t>::max();
    return core_.clock.monotonic_ns(static_cast<std::int64_t>(next)) - kAhead_ns;
}

void GigeActions::reset() {
    device_key_ = group_key_ = group_mask_ = 0;
    count_ = 0;
}

}  // namespace hilcam
