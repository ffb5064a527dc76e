#pragma once
// Splits a stream of bytes into Space Packets, in whatever pieces it arrives: TCP, Unix sockets, USB bulk
// pipes, datagrams. Pure: bytes in, packets out.
//
// While in step, a packet begins where the previous one ended, optionally after the four bytes of a CCSDS
// attached sync marker (0x1ACFFC1D, CCSDS 131.0-B), and its header gives its length. Bytes that cannot be a
// packet, or that fail their check, are given out once as broken. Then the stream hunts, byte by byte, for
// the next header of a known kind with a whole packet that passes its check. A wrong length field cannot
// stall the stream: an intact packet further on ends the wait for an incomplete one.
//
// Memory is bounded: one buffer, allocated at construction. One thread.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

// The form of packets in a stream.
struct PacketRule {
    std::span<const std::uint16_t> identifications;  // first two bytes of a packet, for hunting
    std::size_t min_bytes = 7;
    std::size_t max_bytes = 65542;
    // True when a whole packet passes its check.
    bool (*intact)(std::span<const std::uint8_t> packet) = nullptr;
};

class PacketStream {
  public:
    static constexpr std::size_t kReadBytes = 16384;
    // read_bytes: the most that one read brings.
    explicit PacketStream(const PacketRule& rule, std::size_t read_bytes = kReadBytes);

    // Returns the room for the bytes of the next read, at least `read_bytes` if next() has just returned
    // nothing; filled() then says how many came. Invalidates the items given out before.
    std::span<std::uint8_t> room();
    void filled(std::size_t bytes);

    struct Item {
        enum class Kind : std::uint8_t { kNothing, kPacket, kBroken } kind = Kind::kNothing;
        std::span<const std::uint8_t> bytes{};
    };
    // Returns the next whole packet, or what broke the step; nothing when more bytes are needed.
    Item next();
    // Ends the input, of a datagram or a connection, after next() has returned nothing. Returns the rest as
    // broken; the stream is in step again.
    Item end();

    // Returns how many bytes belonged to no packet, without sync markers.
    std::uint64_t skipped_bytes() const { return skipped_; }

  private:
    enum class Verdict : std::uint8_t { kIntact, kIncomplete, kNone };
    Verdict judge(std::size_t at, bool known_kind_only, std::size_t& size) const;
    std::size_t find_intact(std::size_t from) const;
    bool skip_marker();
    Item break_step(std::size_t shown_bytes, std::size_t skip_bytes);

    PacketRule rule_;
    std::size_t read_bytes_;
    std::vector<std::uint8_t> buffer_;
    std::size_t begin_ = 0, end_ = 0;
    bool hunting_ = false;
    std::uint64_t skipped_ = 0;
};

}  // namespace hilcam
