#include "io/commands/packet_stream.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "io/commands/ccsds.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::array<std::uint8_t, 4> kSyncMarker = {0x1A, 0xCF, 0xFC, 0x1D};

}  // namespace

PacketStream::PacketStream(const PacketRule& rule, std::size_t read_bytes)
    : rule_(rule), read_bytes_(read_bytes), buffer_(rule.max_bytes + kSyncMarker.size() + read_bytes) {
    HILCAM_CHECK(rule.intact && rule.min_bytes > SpacePacketHeader::kBytes);
}

std::span<std::uint8_t> PacketStream::room() {
    if (begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
    }
    return std::span(buffer_).subspan(end_);
}

void PacketStream::filled(std::size_t bytes) {
    HILCAM_CHECK(bytes <= buffer_.size() - end_);
    end_ += bytes;
}

// Judges the packet that begins at `at`, if there is one. While in step any APID is accepted, and the
// receiver refuses foreign ones; while hunting, only known kinds are.
PacketStream::Verdict PacketStream::judge(std::size_t at, bool known_kind_only, std::size_t& size) const {
    const std::span<const std::uint8_t> bytes(buffer_.data() + at, end_ - at);
    if (bytes.size() < SpacePacketHeader::kBytes) return Verdict::kIncomplete;
    const SpacePacketHeader header = read_packet_header(bytes);
    size = header.total_bytes();
    if (header.version != 0 || size < rule_.min_bytes || size > rule_.max_bytes) return Verdict::kNone;
    const auto identification = static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
    if (known_kind_only && std::find(rule_.identifications.begin(), rule_.identifications.end(),
                                     identification) == rule_.identifications.end())
        return Verdict::kNone;
    if (bytes.size() < size) return Verdict::kIncomplete;
    return rule_.intact(bytes.first(size)) ? Verdict::kIntact : Verdict::kNone;
}

// Returns where an intact packet begins, or end_.
std::size_t PacketStream::find_intact(std::size_t from) const {
    std::size_t size = 0;
    for (std::size_t at = from; at + rule_.min_bytes <= end_; ++at)
        if (judge(at, true, size) == Verdict::kIntact) return at;
    return end_;
}

// Returns false when the bytes may be the beginning of a marker with the rest still to come.
bool PacketStream::skip_marker() {
    while (true) {
        const std::size_t there = std::min(end_ - begin_, kSyncMarker.size());
        if (there == 0 ||
            !std::equal(kSyncMarker.begin(), kSyncMarker.begin() + static_cast<std::ptrdiff_t>(there),
                        buffer_.begin() + static_cast<std::ptrdiff_t>(begin_)))
            return true;
        if (there < kSyncMarker.size()) return false;
        begin_ += kSyncMarker.size();
    }
}

// Returns, once, what broke the step.
PacketStream::Item PacketStream::break_step(std::size_t shown_bytes, std::size_t skip_bytes) {
    const Item item{Item::Kind::kBroken, {buffer_.data() + begin_, shown_bytes}};
    hunting_ = true;
    begin_ += skip_bytes;
    skipped_ += skip_bytes;
    return item;
}

PacketStream::Item PacketStream::next() {
    while (begin_ < end_) {
        if (!skip_marker() || begin_ == end_) return {};
        const std::size_t there = end_ - begin_;
        std::size_t size = 0;
        switch (judge(begin_, hunting_, size)) {
            case Verdict::kIntact: {
                const Item item{Item::Kind::kPacket, {buffer_.data() + begin_, size}};
                begin_ += size;
                hunting_ = false;
                return item;
            }
            case Verdict::kIncomplete: {
                const std::size_t behind = find_intact(begin_ + 1) - begin_;
                if (behind == there) return {};
                if (!hunting_) return break_step(behind, behind);
                begin_ += behind;
                skipped_ += behind;
                break;
            }
            case Verdict::kNone:
                if (!hunting_) return break_step(std::min(there, size), 1);
                ++begin_;
                ++skipped_;
                break;
        }
    }
    return {};
}

PacketStream::Item PacketStream::end() {
    Item item;
    if (begin_ < end_ && !hunting_) item = {Item::Kind::kBroken, {buffer_.data() + begin_, end_ - begin_}};
    skipped_ += end_ - begin_;
    begin_ = end_;
    hunting_ = false;
    return item;
}

}  // namespace hilcam
