#include "io/gige/device/gige_messages.h"

#include <limits>

#include "io/gige/device/gige_registers.h"
#include "io/system/bytes.h"

namespace hilcam {

namespace b = bootstrap;
namespace reg = feature_register;
using gvcp::Status;

GigeMessages::GigeMessages(GigeCore& core) : core_(core) {
    GigeRegisterFile& r = core.registers;
    r.constant(b::kMessageChannels, 1);
    r.number(
        b::kMessagePort, [this] { return destination_.port; },
        [this](std::uint64_t port) {
            destination_.port = static_cast<std::uint16_t>(port & 0xFFFF);
            if (destination_.port == 0) count_ = 0;
            return Status::kSuccess;
        });
    r.variable(b::kMessageAddress, destination_.ip, {});
    r.variable(b::kMessageTimeout, timeout_ms_, {0, 60'000});
    r.variable(b::kMessageRetries, retries_, {0, 100});
    r.number(b::kMessageSourcePort, [this] { return source_port_; });
    r.variable(reg::kEventSelector, selector_, {0, kGigeEvents.size() - 1});
    r.number(
        reg::kEventNotification, [this] { return core_.settings.events >> selector_ & 1u; },
        [this](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            const std::uint32_t bit = 1u << selector_;
            core_.settings.events = on ? core_.settings.events | bit : core_.settings.events & ~bit;
            return Status::kSuccess;
        });
    reset();
}

void GigeMessages::reset() {
    close();
    timeout_ms_ = retries_ = 0;
    core_.settings.events = 0;
    for (std::size_t i = 0; i < kGigeEvents.size(); ++i)
        if (kGigeEvents[i].on_at_power_up) core_.settings.events |= 1u << i;
}

void GigeMessages::close() {
    destination_ = {};
    count_ = 0;
}

bool GigeMessages::wanted(std::uint16_t id) const {
    for (std::size_t i = 0; i < kGigeEvents.size(); ++i)
        if (kGigeEvents[i].id == id) return open() && (core_.settings.events >> i & 1u);
    return false;
}

void GigeMessages::on_event(const CameraEvent& event, std::uint64_t block) {
    const std::uint16_t id = kGigeEvents[place_of(event.kind)].id;
    if (!wanted(id)) return;
    const std::uint64_t time = core_.device_ns(event.monotonic_ns);
    std::array<std::uint8_t, kEventDataBytes> data;
    ByteWriter(data).u64(event.frame).u64(time);
    send({id, block != 0 ? std::uint16_t{0} : gvcp::Event::kNoChannel, block, time}, data);
}

void GigeMessages::on_event(gvcp::Event::Id id) {
    if (wanted(id)) send({id, gvcp::Event::kNoChannel, 0, core_.device_ns(core_.now_ns)}, {});
}

void GigeMessages::send(const gvcp::Event& event, std::span<const std::uint8_t> data) {
    const bool acknowledge = timeout_ms_ != 0;
    if (acknowledge && count_ == kMaxWaiting) {
        ++core_.events_lost;
        return;
    }
    Message message;
    message.request_id = next_id_;
    next_id_ = next_id_ == 0xFFFF ? std::uint16_t{1} : static_cast<std::uint16_t>(next_id_ + 1);
    message.size = gvcp::write_event(event, core_.stream.long_ids(), acknowledge, message.request_id, data,
                                     message.bytes);
    if (!acknowledge) {
        transmit(message);
        return;
    }
    waiting_[(first_ + count_) % kMaxWaiting] = message;
    if (count_++ == 0) next();
}

// Sends the oldest message for the first time.
void GigeMessages::next() {
    if (count_ == 0) return;
    tries_left_ = retries_;
    due_ns_ = core_.now_ns + std::int64_t{timeout_ms_} * 1'000'000;
    transmit(waiting_[first_]);
}

void GigeMessages::transmit(const Message& message) {
    if (core_.effects.send_message && core_.link_is_up())
        core_.effects.send_message(std::span(message.bytes).first(message.size), destination_);
}

void GigeMessages::acknowledged(std::uint16_t request_id, const Endpoint& from) {
    if (count_ == 0 || !(from == destination_) || waiting_[first_].request_id != request_id) return;
    first_ = (first_ + 1) % kMaxWaiting;
    --count_;
    next();
}

void GigeMessages::tick() {
    if (count_ == 0 || core_.now_ns < due_ns_) return;
    if (tries_left_ > 0) {
        --tries_left_;
        due_ns_ = core_.now_ns + std::int64_t{timeout_ms_} * 1'000'000;
        transmit(waiting_[first_]);
        return;
    }
    ++core_.events_lost;
    first_ = (first_ + 1) % kMaxWaiting;
    --count_;
    next();
}

std::int64_t GigeMessages::deadline_ns() const {
    return count_ == 0 ? std::numeric_limits<std::int64_t>::max() : due_ns_;
}

}  // namespace hilcam
