#include "io/commands/command_sender.h"

#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxWaiting = 1000;

std::int64_t deadline_after(int timeout_ms) { return monotonic_ns() + std::int64_t{timeout_ms} * 1'000'000; }

}  // namespace

CommandSender::CommandSender(const std::string& endpoint, const DialectConfig& dialect)
    : endpoint_(endpoint),
      dialect_(dialect),
      link_(open_command_link(endpoint)),
      stream_(answer_rule(dialect)) {}

DeviceError CommandSender::silent(int timeout_ms) const {
    const char* const other = dialect_.dialect == Dialect::kCfs ? "hilcam" : "cfs";
    return DeviceError(
        "no acknowledgement from " + endpoint_ + " within " + std::to_string(timeout_ms) +
        " ms; is 'hilcam run' up and listening there, and not in the other dialect (--dialect " + other +
        ")?");
}

bool CommandSender::next_packet(std::span<const std::uint8_t>& packet, std::int64_t deadline_ns) {
    while (true) {
        for (auto item = stream_.next(); item.kind != PacketStream::Item::Kind::kNothing;
             item = stream_.next()) {
            if (item.kind != PacketStream::Item::Kind::kPacket) continue;
            packet = item.bytes;
            return true;
        }
        const std::int64_t left_ns = deadline_ns - monotonic_ns();
        if (left_ns <= 0) return false;
        const CommandLink::Received got =
            link_->receive(stream_.room(), static_cast<int>(left_ns / 1'000'000 + 1));
        if (got.broken) throw DeviceError(endpoint_ + ": nobody is there; is 'hilcam run' up and listening?");
        stream_.filled(got.bytes);
    }
}

Acknowledgement CommandSender::send(const Command& command, int timeout_ms) {
    std::array<std::uint8_t, kMaxPacketBytes> bytes;
    // An answer has only the bits of the sequence number that are sent.
    const std::uint32_t sequence = dialect_.dialect == Dialect::kCfs ? sequence_ & 0x3FFF : sequence_;
    ++sequence_;
    const std::size_t size = encode_command(command, sequence, dialect_, bytes, camera_);
    if (!link_->send(std::span(bytes).first(size))) throw silent(timeout_ms);
    const std::int64_t deadline_ns = deadline_after(timeout_ms);
    std::span<const std::uint8_t> packet;
    // Skips acknowledgements of earlier commands that were given up.
    while (next_packet(packet, deadline_ns)) {
        Acknowledgement acknowledgement;
        Telemetry telemetry;
        if (decode_acknowledgement(packet, dialect_, acknowledgement)) {
            if (acknowledgement.sequence == sequence) return acknowledgement;
        } else if (decode_telemetry(packet, dialect_, telemetry)) {
            waiting_.push_back(telemetry);
            if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
        }
    }
    throw silent(timeout_ms);
}

bool CommandSender::receive(Telemetry& telemetry, int timeout_ms) {
    if (!waiting_.empty()) {
        telemetry = waiting_.front();
        waiting_.pop_front();
        return true;
    }
    const std::int64_t deadline_ns = deadline_after(timeout_ms);
    std::span<const std::uint8_t> packet;
    while (next_packet(packet, deadline_ns))
        if (decode_telemetry(packet, dialect_, telemetry)) return true;
    return false;
}

}  // namespace hilcam
