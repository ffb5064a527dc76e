#pragma once
// Measures how large a ZeroMQ message is while it comes: follows the bytes that a peer sends (ZMTP 3.0 and
// 3.1, rfc.zeromq.org/spec/23 and /37) without keeping any. A message is one or more parts (frames with MORE,
// then one without); commands, as the handshake's, are frames of their own. Not followed: security mechanisms
// that encrypt frames, and versions before 3 (libzmq before 4.0, 2013), which are refused.

#include <cstddef>
#include <cstdint>
#include <span>

namespace hilcam {

class ZmtpMeter {
  public:
    struct Limits {
        std::uint64_t bytes;  // bytes of all parts of a message together
        std::size_t parts;
    };
    static constexpr Limits kNoLimits{~std::uint64_t{0}, ~std::size_t{0}};
    // A command is a handshake's or a heartbeat's, of some hundred bytes at most.
    static constexpr std::uint64_t kMaxCommand_bytes = 64 << 10;

    explicit ZmtpMeter(const Limits& limits) : limits_(limits) {}

    // The next bytes, cut anywhere. False, from then on: they are of no ZMTP 3 peer, or of a message above
    // the limits, which is known before its last part comes.
    bool take(std::span<const std::uint8_t> bytes);
    // All messages so far whose last part has begun, and the bytes that all messages' parts have announced;
    // those of the message that goes on.
    std::uint64_t messages() const { return messages_; }
    std::uint64_t announced_bytes() const { return announced_bytes_; }
    std::uint64_t unfinished_bytes() const { return bytes_; }

  private:
    enum class At { kGreeting, kFlags, kLength, kBody };

    bool take_greeting(std::uint8_t byte);
    bool begin_body();

    Limits limits_;
    At at_ = At::kGreeting;
    std::size_t place_ = 0;  // in the greeting, or in a length
    std::uint8_t flags_ = 0;
    std::uint64_t length_ = 0;  // length of the frame; what is left of its body
    std::uint64_t bytes_ = 0;   // bytes of the message so far
    std::size_t parts_ = 0;
    std::uint64_t messages_ = 0, announced_bytes_ = 0;
    bool good_ = true;
};

}  // namespace hilcam
