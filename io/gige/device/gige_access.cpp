#include "io/gige/device/gige_access.h"

#include <limits>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace b = bootstrap;
using gvcp::Status;

namespace {

constexpr std::uint32_t kExclusive = 1, kControl = 2, kSwitchover = 4;
constexpr std::uint32_t kMinHeartbeat_ms = 500, kMaxHeartbeat_ms = 600'000;
constexpr std::uint32_t kHeartbeat_ms = 3000;

}  // namespace

GigeAccess::GigeAccess(GigeCore& core, Effects effects) : core_(core), effects_(std::move(effects)) {
    GigeRegisterFile& r = core.registers;
    // Any application may read which one is in control, even when nothing else is readable.
    r.add(
        {.address = b::kControl,
         .read = [this] { return privilege_; },
         .write = [this](std::uint64_t value) { return write_privilege(static_cast<std::uint32_t>(value)); },
         .open = true});
    r.add({.address = b::kPrimaryPort, .read = [this] { return controller_.port; }, .open = true});
    r.add({.address = b::kPrimaryIp, .read = [this] { return controller_.ip; }, .open = true});
    r.variable(b::kHeartbeat, heartbeat_ms_, {kMinHeartbeat_ms, kMaxHeartbeat_ms});
    r.number(
        b::kSwitchoverKey, [] { return 0u; },
        [this](std::uint64_t key) {
            switchover_key_ = key & 0xFFFF;
            return Status::kSuccess;
        });
}

bool GigeAccess::may_read(const Endpoint& from, std::uint32_t address, std::size_t bytes) const {
    if (!(privilege_ & kExclusive) || from == controller_) return true;
    const GigeRegisterFile::Register* r = core_.registers.find(address);
    return r && r->open && bytes <= r->bytes;
}

bool GigeAccess::may_write(const Endpoint& from, std::uint32_t address) const {
    // write_privilege() decides which application may.
    return from == controller_ || address == b::kControl;
}

Status GigeAccess::write_privilege(std::uint32_t value) {
    const std::uint32_t wanted = value & (kExclusive | kControl | kSwitchover);
    const bool asks_for_control = wanted & (kExclusive | kControl);
    if (!controlled() || core_.from == controller_) {
        if (asks_for_control)
            take(wanted);
        else if (controlled())
            release();
        return Status::kSuccess;
    }
    const bool open = (privilege_ & kSwitchover) && !(privilege_ & kExclusive);
    if (!open || !asks_for_control || value >> 16 != switchover_key_) return Status::kAccessDenied;
    if (effects_.switched) effects_.switched();
    take(wanted);
    return Status::kSuccess;
}

void GigeAccess::take(std::uint32_t privilege) {
    privilege_ = privilege;
    controller_ = core_.from;
    heard();
}

void GigeAccess::release() {
    controller_ = {};
    privilege_ = 0;
    switchover_key_ = 0;
    if (effects_.released) effects_.released();
}

void GigeAccess::reset() {
    heartbeat_ms_ = kHeartbeat_ms;
    release();
}

bool GigeAccess::heartbeat_matters() const {
    return controlled() && !(core_.gvcp_config & b::gvcp_config::kHeartbeatDisable);
}

std::int64_t GigeAccess::deadline_ns() const {
    if (!heartbeat_matters()) return std::numeric_limits<std::int64_t>::max();
    return last_heard_ns_ + std::int64_t{heartbeat_ms_} * 1'000'000;
}

void GigeAccess::tick() {
    if (core_.now_ns > deadline_ns()) release();
}

}  // namespace hilcam
