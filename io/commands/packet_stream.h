#pragma once
// Cuts a stream of bytes into Space Packets, whatever pieces it comes in: TCP, Unix sockets, USB bulk pipes,
// datagrams. Pure: bytes in, packets out.
//
// In step, a packet begins where the one before ended, perhaps behind the four bytes of a CCSDS attached sync
// marker (0x1ACFFC1D, CCSDS 131.0-B); its header says how long it is. What cannot be a packet, or fails its
// check, is given out once as broken, and the stream hunts: byte by byte for the next header of a known kind
// whose whole packet passes its check. A wrong length field cannot hold the stream up: while a packet is
// incomplete, an intact one further on ends the wait for it.
//
// Memory is bounded: one buffer, allocated at construction. One thread.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

// What packets of a stream look like.
struct PacketRule {
    std::span<const std::uint16_t> identifications;  // a packet's first two bytes, when hunting
    std::size_t min_bytes = 7;
    std::size_t max_bytes = 65542;
    // Does a whole packet pass its check?
    bool (*intact)(std::span<const std::uint8_t> packet) = nullptr;
};

class PacketStream {
  public:
    static constexpr std::size_t kReadBytes = 16384;
    // `read_bytes`: the most that one read brings.
    explicit PacketStream(const PacketRule& rule, std::size_t read_bytes = kReadBytes);

    // Where the next read may put its bytes, at least `read_bytes` when next() has just given nothing; then
    // filled() says how many came. Items given out before are gone.
    std::span<std::uint8_t> room();
    void filled(std::size_t bytes);

    struct Item {
        enum class Kind : std::uint8_t { kNothing, kPacket, kBroken } kind = Kind::kNothing;
        std::span<const std::uint8_t> bytes{};
    };
    // The next whole packet, or what broke the step; nothing: more bytes are needed.
    Item next();
    // No more bytes come (a datagram's end, a hang-up): next() first, until it gives nothing. What is left,
    // as broken; in step again.
    Item end();

    // Bytes so far that belonged to no packet, sync markers apart.
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
