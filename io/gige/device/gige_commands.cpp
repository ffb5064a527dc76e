// GigeDevice: from a datagram to its answer.

#include <algorithm>

#include "io/gige/device/gige_parts.h"
#include "io/gige/device/gige_registers.h"
#include "io/system/bytes.h"

namespace hilcam {

namespace b = bootstrap;
using gvcp::Header;
using gvcp::Status;

namespace {

// The payload that fits into a datagram of 576 bytes after its IP and UDP headers; in registers, 135 read or
// 67 written.
constexpr std::size_t kMaxPayloadBytes = gvcp::kMaxDatagramBytes - 28 - gvcp::kHeaderBytes;
constexpr std::uint32_t kEverybody = 0xFFFFFFFF;  // 255.255.255.255

bool changes_something(std::uint16_t command) {
    return command == gvcp::kWriteRegister || command == gvcp::kWriteMemory || command == gvcp::kForceIp ||
           command == gvcp::kAction;
}
bool is_access(std::uint16_t command) {
    return command >= gvcp::kReadRegister && command <= gvcp::kWriteMemory && command % 2 == 0;
}
bool may_be_broadcast(std::uint16_t command) {
    return command == gvcp::kDiscovery || command == gvcp::kForceIp || command == gvcp::kAction;
}

}  // namespace

// --- messages

std::size_t GigeDevice::handle(std::span<const std::uint8_t> datagram, Endpoint from, std::int64_t now_ns,
                               std::span<std::uint8_t> out, bool broadcast) {
    Parts& my = *parts_;
    tick(now_ns);
    my.core.from = from;
    if (my.core.faults.strikes(FaultKind::kLinkDown, 0)) return 0;
    const std::optional<Header> header = gvcp::read_header(datagram);
    if (!header) {
        const auto acknowledgement = gvcp::read_answer_header(datagram);
        if (acknowledgement &&
            (acknowledgement->code == gvcp::kEvent + 1 || acknowledgement->code == gvcp::kEventData + 1))
            my.messages.acknowledged(acknowledgement->request_id, from);
        return 0;
    }
    if (broadcast && !may_be_broadcast(header->command)) return 0;
    const std::size_t size = answered(*header, datagram, out, broadcast);
    if (my.reset_wanted) reset();
    return size;
}

std::size_t GigeDevice::answered(const Header& header, std::span<const std::uint8_t> datagram,
                                 std::span<std::uint8_t> out, bool broadcast) {
    Parts& my = *parts_;
    GigeCore& core = my.core;
    const std::uint64_t index = my.fault_index(header.request_id);
    if (core.faults.strikes(FaultKind::kControlSilence, 0, index)) return 0;
    if (core.from == my.access.controller() && !core.faults.strikes(FaultKind::kHeartbeatIgnored, 0, index))
        my.access.heard();
    if (header.command == gvcp::kPacketResend) {
        resend(header, datagram.subspan(gvcp::kHeaderBytes));
        return 0;  // answered on the stream
    }
    // The answer to this request may be delayed already.
    const bool announce = core.gvcp_config & b::gvcp_config::kPendingAnswer;
    const auto pending = [&](std::int64_t due_ns) {
        const std::int64_t ms = (due_ns - core.now_ns) / 1'000'000 + 1;
        return announce ? gvcp::write_pending_answer(
                              header.request_id,
                              static_cast<std::uint16_t>(std::clamp<std::int64_t>(ms, 1, 65535)), out)
                        : 0;
    };
    if (const std::int64_t due_ns = my.answers.held_until_ns(core.from, header.request_id))
        return pending(due_ns);
    const bool changes = changes_something(header.command);
    if (changes)
        if (const auto found = my.answers.find(datagram, core.from, core.now_ns, out); found.known)
            return found.bytes;

    Answer a;
    const auto payload = datagram.subspan(gvcp::kHeaderBytes);
    const bool struck_out = is_access(header.command);
    bool ran = false;
    if (header.length != payload.size())
        a.status = Status::kInvalidHeader;
    else if (struck_out && core.faults.strikes(FaultKind::kControlBusy, 0, index))
        a.status = Status::kBusy;
    else if (struck_out && core.faults.strikes(FaultKind::kControlDenied, 0, index))
        a.status = Status::kAccessDenied;
    else
        a = answer(header, payload, out.subspan(gvcp::kHeaderBytes)), ran = true;
    if (a.silent) return 0;
    // Status codes of GEV 2.0 are for clients that know them.
    if (a.status >= Status::kNoReferenceTime && a.status <= Status::kLeaderTrailerOverflow &&
        !(core.gvcp_config & b::gvcp_config::kExtendedStatus20))
        a.status = Status::kGenericError;
    gvcp::write_answer_header({a.status, static_cast<std::uint16_t>(header.command + 1),
                               static_cast<std::uint16_t>(a.bytes), header.request_id},
                              out);
    const bool asked = header.flags & Header::kAcknowledgeFlag || header.command == gvcp::kDiscovery;
    std::size_t size = asked ? gvcp::kHeaderBytes + a.bytes : 0;
    if (changes && ran) my.answers.keep(datagram, core.from, core.now_ns, out.first(size));
    if (size == 0) return 0;
    if (broadcast && header.command != gvcp::kAction && !my.in_subnet(core.from)) {
        if (header.flags & Header::kBroadcastAnswerFlag && core.effects.send_answer)
            core.effects.send_answer(out.first(size), {kEverybody, core.from.port});
        return 0;
    }
    if (const auto ms = core.faults.strikes(FaultKind::kControlSlow, 0, index); ms && *ms > 0) {
        const std::int64_t due_ns = core.now_ns + static_cast<std::int64_t>(*ms * 1e6);
        if (my.answers.hold(core.from, out.first(size), due_ns)) return pending(due_ns);
    }
    return size;
}

GigeDevice::Answer GigeDevice::answer(const Header& header, std::span<const std::uint8_t> payload,
                                      std::span<std::uint8_t> out) {
    switch (header.command) {
        case gvcp::kDiscovery:
            if (!payload.empty()) return {Status::kInvalidParameter};
            return {parts_->core.registers.read(0, out.first(gvcp::kDiscoveryBytes)), gvcp::kDiscoveryBytes};
        case gvcp::kForceIp:
            return force_ip(payload);
        case gvcp::kReadRegister:
            return read_registers(payload, out);
        case gvcp::kReadMemory:
            return read_memory(payload, out);
        case gvcp::kWriteRegister:
            return write_registers(payload, out);
        case gvcp::kWriteMemory:
            return write_memory(payload, out);
        case gvcp::kAction:
            return act(header, payload);
        default:
            return {Status::kNotImplemented};
    }
}

// --- registers

GigeDevice::Answer GigeDevice::read_registers(std::span<const std::uint8_t> payload,
                                              std::span<std::uint8_t> out) {
    const GigeCore& core = parts_->core;
    if (payload.empty() || payload.size() % 4 != 0 || payload.size() > kMaxPayloadBytes)
        return {Status::kInvalidParameter};
    ByteReader in(payload);
    for (std::size_t at = 0; at < payload.size(); at += 4) {
        const std::uint32_t address = in.u32();
        if (!parts_->access.may_read(core.from, address, 4)) return {Status::kAccessDenied, at};
        const Status status = parts_->read(address, out.subspan(at, 4));
        if (status != Status::kSuccess) return {status, at};
    }
    return {Status::kSuccess, payload.size()};
}

GigeDevice::Answer GigeDevice::read_memory(std::span<const std::uint8_t> payload,
                                           std::span<std::uint8_t> out) {
    const auto range = gvcp::read_memory_range(payload);
    if (!range) return {Status::kInvalidParameter};
    if (!parts_->access.may_read(parts_->core.from, range->address, range->bytes))
        return {Status::kAccessDenied};
    ByteWriter(out).u32(range->address);
    const Status status = parts_->read(range->address, out.subspan(4, range->bytes));
    if (status != Status::kSuccess) return {status};
    return {status, std::size_t{4} + range->bytes};
}

GigeDevice::Answer GigeDevice::write_registers(std::span<const std::uint8_t> payload,
                                               std::span<std::uint8_t> out) {
    GigeCore& core = parts_->core;
    const bool fits = !payload.empty() && payload.size() % 8 == 0 && payload.size() <= kMaxPayloadBytes;
    Status status = fits ? Status::kSuccess : Status::kInvalidParameter;
    std::uint16_t done = 0;
    for (std::size_t at = 0; status == Status::kSuccess && at < payload.size(); at += 8) {
        const std::uint32_t address = ByteReader(payload.subspan(at)).u32();
        std::size_t bytes = 0;
        status = parts_->access.may_write(core.from, address)
                     ? parts_->write(address, payload.subspan(at + 4, 4), bytes)
                     : Status::kAccessDenied;
        if (status == Status::kSuccess) ++done;
    }
    // The number of registers written, which is also the index of the one that failed.
    ByteWriter(out).u16(0).u16(done);
    return {status, 4};
}

GigeDevice::Answer GigeDevice::write_memory(std::span<const std::uint8_t> payload,
                                            std::span<std::uint8_t> out) {
    GigeCore& core = parts_->core;
    ByteReader in(payload);
    const std::uint32_t address = in.u32();
    const auto data = in.rest();
    const bool fits = !data.empty() && payload.size() <= kMaxPayloadBytes;
    Status status = fits ? Status::kSuccess : Status::kInvalidParameter;
    std::size_t done = 0;
    if (status == Status::kSuccess)
        status = parts_->access.may_write(core.from, address) ? parts_->write(address, data, done)
                                                              : Status::kAccessDenied;
    ByteWriter(out).u16(0).u16(done);
    return {status, 4};
}

// --- the other commands

GigeDevice::Answer GigeDevice::act(const Header& header, std::span<const std::uint8_t> payload) {
    const auto action = gvcp::read_action(payload, header.flags & Header::kScheduledFlag);
    if (!action) return {Status::kInvalidParameter};
    const std::optional<Status> status = parts_->actions.run(*action, parts_->access.controlled());
    if (!status) return {Status::kSuccess, 0, true};
    return {*status};
}

GigeDevice::Answer GigeDevice::force_ip(std::span<const std::uint8_t> payload) {
    GigeCore& core = parts_->core;
    const auto wanted = gvcp::read_force_ip(payload);
    if (!wanted) return {Status::kInvalidParameter};
    if (wanted->mac != core.identity.mac) return {Status::kSuccess, 0, true};
    if (parts_->access.controlled()) return {Status::kAccessDenied};
    if (wanted->ip == 0) return {};  // configure anew: the machine's address stays
    const std::uint32_t first = wanted->ip >> 24, holes = ~wanted->mask & (~wanted->mask + 1);
    if (first == 0 || first >= 224 || wanted->mask == 0 || holes != 0) return {Status::kInvalidParameter};
    if (wanted->ip != core.identity.ip &&
        !(core.effects.change_address &&
          core.effects.change_address(wanted->ip, wanted->mask, wanted->gateway)))
        return {Status::kGenericError};  // this machine has no such address
    core.identity.ip = wanted->ip, core.identity.mask = wanted->mask, core.identity.gateway = wanted->gateway;
    return {};
}

// Packets are resent to the stream's receiver, whoever asks; so only the receiver and the controller may ask.
// Aravis asks from the socket that receives the stream, other clients from the one in control. In a multicast
// group, any member may ask from the group's port.
bool GigeDevice::may_ask_again() const {
    const GigeCore& core = parts_->core;
    const Endpoint& receiver = core.stream.destination;
    const bool group = receiver.ip >> 28 == 0xE;
    return core.from == parts_->access.controller() || core.from == receiver ||
           (group && core.from.port == receiver.port);
}

void GigeDevice::resend(const Header& header, std::span<const std::uint8_t> payload) {
    const GigeCore& core = parts_->core;
    const auto request = gvcp::read_resend(payload, header.flags & Header::kExtendedFlag);
    if (!request || header.length != payload.size() || request->channel != 0 || !core.stream.open) return;
    if (!may_ask_again()) {
        ++parts_->foreign_resend_requests;
        return;
    }
    if (core.effects.resend) core.effects.resend(*request, core.from);
}

}  // namespace hilcam
