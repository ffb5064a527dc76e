#include "io/gige/device/gige_transport.h"

#include <cmath>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace b = bootstrap;
namespace reg = feature_register;
using gvcp::Status;
using When = GigeRegisterFile::When;

namespace {

std::uint32_t stream_can(const GigeIdentity& id) {
    return b::stream_config::kUnconditional | b::stream_config::kResendDestination |
           (id.multipart ? b::stream_config::kMultipart : 0);
}
constexpr std::size_t kIpAndUdpBytes = 28;
constexpr std::uint64_t kMinThroughput_bytes_s = 100'000, kMaxThroughput_bytes_s = 100'000'000'000;

}  // namespace

GigeTransport::GigeTransport(GigeCore& core, std::function<void()> closed)
    : core_(core), closed_(std::move(closed)) {
    GigeRegisterFile& r = core.registers;
    GigeStreamState& s = core.stream;
    s.packet_bytes = core.identity.packet_bytes;
    const auto tell = [this] { core_.publish_stream(); };
    r.number(
        b::kStreamPort, [&s] { return s.destination.port; },
        [this](std::uint64_t v) { return write_port(v); });
    r.variable(b::kStreamAddress, s.destination.ip, {}, tell);
    r.number(
        b::kPacketSize, [&s] { return (s.do_not_fragment ? b::kDoNotFragment : 0) | s.packet_bytes; },
        [this](std::uint64_t v) { return write_packet_size(v); });
    r.variable(b::kPacketDelay, s.packet_delay_ns, {0, 1'000'000'000}, tell);
    r.number(b::kStreamSourcePort, [this] { return source_port_; });
    r.constant(b::kStreamChannelCapability, stream_can(core.identity));
    r.number(
        b::kStreamConfig,
        [&s] {
            return (s.unconditional ? b::stream_config::kUnconditional : 0) |
                   (s.resend_to_requester ? b::stream_config::kResendDestination : 0) |
                   (s.multipart ? b::stream_config::kMultipart : 0);
        },
        [this](std::uint64_t v) { return write_config(v); });
    r.number(
        b::kGvspConfig, [&s] { return s.extended_ids ? b::kExtendedIds : 0; },
        [this](std::uint64_t v) { return write_extended_ids(v); }, When::kUnlocked);
    add_throughput();
}

void GigeTransport::add_throughput() {
    GigeRegisterFile& r = core_.registers;
    core_.settings.throughput_limit_bytes_s = kMaxThroughput_bytes_s;
    r.number(
        reg::kThroughputMode, [this] { return core_.settings.throughput_limited; },
        [this](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            core_.settings.throughput_limited = on != 0;
            core_.publish_stream();
            return Status::kSuccess;
        });
    r.number64(
        reg::kThroughputLimit, [this] { return core_.settings.throughput_limit_bytes_s; },
        [this](std::uint64_t limit) {
            if (limit < kMinThroughput_bytes_s || limit > kMaxThroughput_bytes_s)
                return Status::kInvalidParameter;
            core_.settings.throughput_limit_bytes_s = limit;
            core_.publish_stream();
            return Status::kSuccess;
        });
}

Status GigeTransport::write_port(std::uint64_t value) {
    core_.stream.destination.port = static_cast<std::uint16_t>(value & 0xFFFF);
    if (core_.stream.destination.port == 0 && closed_) closed_();
    core_.publish_stream();
    return Status::kSuccess;
}

Status GigeTransport::write_packet_size(std::uint64_t value) {
    GigeStreamState& s = core_.stream;
    const auto size = static_cast<std::uint32_t>(value & 0xFFFF);
    if (size < kMinPacketBytes || size > kMaxPacketBytes || size % kPacketStep != 0)
        return Status::kInvalidParameter;
    // Receivers compute a packet's place from the size, so it must not change during a stream.
    if (s.acquiring && size != s.packet_bytes) return Status::kWriteProtect;
    s.packet_bytes = size;
    s.do_not_fragment = value & b::kDoNotFragment;
    core_.publish_stream();
    if (value & b::kFireTest) fire_test_packet(size);
    return Status::kSuccess;
}

void GigeTransport::fire_test_packet(std::uint32_t packet_bytes) {
    if (!core_.stream.open || !core_.effects.test_packet) return;
    const std::size_t bytes = packet_bytes - kIpAndUdpBytes;
    if (const auto most = core_.faults.would_strike(FaultKind::kTestPacketLimit, 0, packet_bytes);
        most && static_cast<double>(packet_bytes) > *most) {
        core_.faults.strikes(FaultKind::kTestPacketLimit, 0, packet_bytes);
        return;
    }
    core_.effects.test_packet(core_.stream, bytes);
}

Status GigeTransport::write_config(std::uint64_t value) {
    namespace c = b::stream_config;
    // Aravis requests multipart from every camera, announced or not; where it is not supported, the bit stays
    // 0.
    if (value & ~std::uint64_t{stream_can(core_.identity) | c::kMultipart}) return Status::kInvalidParameter;
    GigeStreamState& s = core_.stream;
    const bool multipart = core_.identity.multipart && (value & c::kMultipart);
    if (multipart != s.multipart && core_.locked()) return Status::kWriteProtect;
    s.unconditional = value & c::kUnconditional;
    s.resend_to_requester = value & c::kResendDestination;
    s.multipart = multipart;
    core_.publish_stream();
    return Status::kSuccess;
}

Status GigeTransport::write_extended_ids(std::uint64_t value) {
    if (value & ~std::uint64_t{b::kExtendedIds}) return Status::kInvalidParameter;
    core_.stream.extended_ids = value & b::kExtendedIds;
    core_.publish_stream();
    return Status::kSuccess;
}

void GigeTransport::close() {
    core_.stream.destination = {};
    core_.publish_stream();
}

void GigeTransport::reset() {
    GigeStreamState& s = core_.stream;
    s.destination = {};
    s.packet_bytes = core_.identity.packet_bytes;
    s.do_not_fragment = s.extended_ids = s.multipart = s.unconditional = s.resend_to_requester = false;
    s.packet_delay_ns = 0;
    core_.publish_stream();
}

}  // namespace hilcam
