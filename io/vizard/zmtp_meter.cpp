#include "io/vizard/zmtp_meter.h"

#include <algorithm>

namespace hilcam {
namespace {

// ZMTP 3.0: signature FF, 8 bytes of any value, 7F; then the version's number, and 53 bytes more.
constexpr std::size_t kGreeting_bytes = 64, kSignatureEnd = 9, kVersion = 10;
constexpr std::uint8_t kMore = 1, kLong = 2, kCommand = 4;  // a frame's flags

}  // namespace

bool ZmtpMeter::take(std::span<const std::uint8_t> bytes) {
    while (good_ && !bytes.empty()) {
        if (at_ == At::kBody) {
            const std::uint64_t passed = std::min<std::uint64_t>(length_, bytes.size());
            bytes = bytes.subspan(static_cast<std::size_t>(passed));
            length_ -= passed;
            if (length_ == 0) at_ = At::kFlags;
            continue;
        }
        const std::uint8_t byte = bytes.front();
        bytes = bytes.subspan(1);
        if (at_ == At::kGreeting) {
            good_ = take_greeting(byte);
        } else if (at_ == At::kFlags) {
            flags_ = byte;
            length_ = 0, place_ = 0;
            at_ = At::kLength;
        } else {
            length_ = length_ << 8 | byte;
            if (++place_ == ((flags_ & kLong) ? 8u : 1u)) good_ = begin_body();
        }
    }
    return good_;
}

bool ZmtpMeter::take_greeting(std::uint8_t byte) {
    const std::size_t place = place_++;
    if (place_ == kGreeting_bytes) at_ = At::kFlags;
    if (place == 0) return byte == 0xFF;
    if (place == kSignatureEnd) return byte == 0x7F;
    return place != kVersion || byte >= 3;
}

bool ZmtpMeter::begin_body() {
    at_ = length_ > 0 ? At::kBody : At::kFlags;
    if (flags_ & kCommand) return length_ <= std::min(limits_.bytes, kMaxCommand_bytes);
    if (length_ > limits_.bytes - bytes_ || ++parts_ > limits_.parts) return false;
    bytes_ += length_;
    announced_bytes_ += length_;
    if (!(flags_ & kMore)) bytes_ = 0, parts_ = 0, ++messages_;
    return true;
}

}  // namespace hilcam
