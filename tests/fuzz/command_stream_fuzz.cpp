// A stream of any bytes in pieces of any size: every item lies in what came, nothing hangs, and a packet that
// follows is found. The first byte says how large the pieces are, and in which dialect.

#include <algorithm>
#include <array>

#include "io/commands/command_dialect.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

constexpr std::uint64_t kToken = 0x5EED5EED5EED5EED;

bool is_last(std::span<const std::uint8_t> packet, const DialectConfig& dialect) {
    const DecodedCommand decoded = decode_command(packet, dialect);
    const auto* ping = std::get_if<PingCommand>(&decoded.command);
    return decoded.status == CommandStatus::kAccepted && ping && ping->token == kToken;
}

struct Feeder {
    PacketStream stream;
    DialectConfig dialect;
    std::size_t piece;
    std::size_t fed = 0, taken = 0;
    bool last_seen = false;

    void feed(std::span<const std::uint8_t> bytes) {
        while (!bytes.empty()) {
            const std::size_t size = std::min({piece, bytes.size(), stream.room().size()});
            HILCAM_CHECK(size > 0);
            std::copy_n(bytes.begin(), size, stream.room().begin());
            stream.filled(size);
            bytes = bytes.subspan(size);
            fed += size;
            take();
        }
    }
    void take() {
        for (auto item = stream.next(); item.kind != PacketStream::Item::Kind::kNothing;
             item = stream.next()) {
            if (item.kind != PacketStream::Item::Kind::kPacket) continue;
            taken += item.bytes.size();
            last_seen = is_last(item.bytes, dialect);
        }
        HILCAM_CHECK(taken + stream.skipped_bytes() <= fed);
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    DialectConfig dialect;
    if (data[0] & 0x80) dialect.dialect = Dialect::kCfs;
    Feeder feeder{PacketStream(command_rule(dialect), 512), dialect, 1 + std::size_t{data[0] & 0x7Fu} * 4};
    feeder.feed(std::span(data, size).subspan(1));
    // Two in a row: the first may end up in a packet that the bytes above began. The dialect without a CRC
    // can be fooled for longer.
    std::array<std::uint8_t, kMaxPacketBytes> packet;
    const std::size_t packet_bytes = encode_command(PingCommand{kToken}, 1, dialect, packet);
    const std::size_t repeats = dialect.dialect == Dialect::kHilcam ? 2 : 2 + kMaxPacketBytes / packet_bytes;
    for (std::size_t i = 0; i < repeats; ++i) feeder.feed(std::span(packet).first(packet_bytes));
    HILCAM_CHECK(feeder.last_seen);
    feeder.stream.end();
    HILCAM_CHECK(feeder.stream.next().kind == PacketStream::Item::Kind::kNothing);
    return 0;
}
