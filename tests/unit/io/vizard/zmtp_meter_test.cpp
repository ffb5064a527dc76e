#include "io/vizard/zmtp_meter.h"

#include <gtest/gtest.h>

#include <string>

namespace hilcam {
namespace {

// A peer's bytes, written by hand after rfc.zeromq.org/spec/23.
class Peer {
  public:
    explicit Peer(char version = 3) {
        bytes_.resize(64);
        bytes_[0] = '\xFF', bytes_[9] = '\x7F', bytes_[10] = version;
    }
    Peer& frame(std::uint8_t flags, std::size_t size) {
        bytes_ += static_cast<char>(flags | (size > 255 ? 2 : 0));
        for (int i = size > 255 ? 7 : 0; i >= 0; --i) bytes_ += static_cast<char>(size >> 8 * i & 0xFF);
        bytes_.append(size, '\xFF');  // no body is taken for flags
        return *this;
    }
    Peer& part(std::size_t size) { return frame(1, size); }
    Peer& last(std::size_t size) { return frame(0, size); }
    Peer& command(std::size_t size) { return frame(4, size); }

    // In pieces of so many bytes.
    bool passes(std::size_t piece) const {
        ZmtpMeter meter({1000, 5});
        return told_to(meter, piece);
    }
    bool told_to(ZmtpMeter& meter, std::size_t piece) const {
        const auto* at = reinterpret_cast<const std::uint8_t*>(bytes_.data());
        bool good = true;
        for (std::size_t i = 0; i < bytes_.size(); i += piece)
            good = meter.take({at + i, std::min(piece, bytes_.size() - i)});
        return good;
    }
    void expect(bool passes) const {
        for (const std::size_t piece : {1u, 7u, 100'000u}) EXPECT_EQ(this->passes(piece), passes) << piece;
    }

  private:
    std::string bytes_;
};

TEST(ZmtpMeter, MessagesUpToTheLimitPassOneAfterTheOther) {
    Peer peer;
    peer.command(25);
    for (int i = 0; i < 3; ++i) peer.part(0).part(300).part(600).part(100).last(0);
    for (int i = 0; i < 3; ++i) peer.last(1000);
    peer.expect(true);
}

TEST(ZmtpMeter, AMessageIsItsPartsTogether) {
    Peer().part(500).part(500).last(1).expect(false);
    Peer().part(500).command(100).last(501).expect(false);
    Peer().last(1001).expect(false);
    Peer().part(0).part(0).part(0).part(0).part(0).part(0).expect(false);
    Peer().command(1001).expect(false);
}

TEST(ZmtpMeter, MessagesAndTheirBytesAreCounted) {
    Peer peer;
    peer.command(25).part(300).command(9).last(0).last(7).part(600).part(40);
    for (const std::size_t piece : {1u, 7u, 100'000u}) {
        ZmtpMeter meter(ZmtpMeter::kNoLimits);
        EXPECT_TRUE(peer.told_to(meter, piece));
        EXPECT_EQ(meter.messages(), 2u);
        EXPECT_EQ(meter.announced_bytes(), 947u);
        EXPECT_EQ(meter.unfinished_bytes(), 640u);
    }
}

TEST(ZmtpMeter, ACommandIsShortWhateverMessagesMayBe) {
    ZmtpMeter meter(ZmtpMeter::kNoLimits), other(ZmtpMeter::kNoLimits);
    EXPECT_TRUE(Peer().command(64 << 10).told_to(meter, 4096));
    EXPECT_FALSE(Peer().command((64 << 10) + 1).told_to(other, 4096));
}

// Told by its length alone, before a byte of it is there.
TEST(ZmtpMeter, AnEndlessPartIsRefusedAtItsBeginning) {
    ZmtpMeter meter({1000, 5});
    std::uint8_t greeting[64] = {0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0x7F, 3};
    EXPECT_TRUE(meter.take(greeting));
    const std::uint8_t header[] = {1, 10, 0, 0,    0,    0,    0,    0,    0,   0,
                                   0, 0,  3, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    EXPECT_TRUE(meter.take(header));
    const std::uint8_t rest[] = {0xFF, 0xFF};
    EXPECT_FALSE(meter.take(rest));
}

TEST(ZmtpMeter, WhatIsNoZmtp3IsRefused) {
    Peer(1).expect(false);
    ZmtpMeter meter({1000, 5});
    const std::uint8_t words[] = {'G', 'E', 'T'};
    EXPECT_FALSE(meter.take(words));
    EXPECT_FALSE(meter.take({}));
}

}  // namespace
}  // namespace hilcam
