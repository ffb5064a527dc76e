#pragma once
// Measures the size of ZeroMQ messages as they arrive. It parses the bytes of a peer (ZMTP 3.0 and 3.1,
// rfc.zeromq.org/spec/23 and /37) and keeps none. A message is one or more parts (frames with MORE, then one
// without); commands, such as the handshake's, are frames of their own. Not supported: security mechanisms
// that encrypt frames, and versions before 3 (libzmq before 4.0, 2013), which are refused.

#include <cstddef>
#include <cstdint>
#include <span>

namespace hilcam {

class ZmtpMeter {
  public:
    struct Limits {
        std::uint64_t bytes;  // all parts of a message together
        std::size_t parts;
    };
    static constexpr Limits kNoLimits{~std::uint64_t{0}, ~std::size_t{0}};
    // Commands of handshakes and heartbeats have some hundred bytes at most.
    static constexpr std::uint64_t kMaxCommand_bytes = 64 << 10;

    explicit ZmtpMeter(const Limits& limits) : limits_(limits) {}

    // Takes the next bytes, split anywhere. Returns false, and does so from then on, when the peer does not
    // speak ZMTP 3 or a message exceeds the limits; this is noticed before its last part comes.
    bool take(std::span<const std::uint8_t> bytes);
    // Number of messages with a last part that has begun, bytes announced by the parts of all messages, and
    // bytes of the unfinished message.
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
    std::uint64_t length_ = 0;  // length of the frame, then the rest of its body
    std::uint64_t bytes_ = 0;   // bytes of the message so far
    std::size_t parts_ = 0;
    std::uint64_t messages_ = 0, announced_bytes_ = 0;
    bool good_ = true;
};

}  // namespace hilcam
