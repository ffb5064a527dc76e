#pragma once
// Finds lost, duplicate and late packets from a sender's sequence numbers. Pure.

#include <algorithm>
#include <cstdint>

namespace hilcam {

// Remembers the 64 numbers up to the newest. bits: length of a sequence number in a packet, after which it
// wraps. A number further back, a 0 out of turn, or one so far ahead that no link loses that many, means that
// the sender has restarted; nothing is then lost.
class SequenceWindow {
  public:
    explicit SequenceWindow(int bits = 32) : mask_(bits >= 32 ? 0xFFFFFFFFu : (1u << bits) - 1) {}

    struct Finding {
        enum class Kind : std::uint8_t {
            kNext,       // the expected number, or the first of all
            kGap,        // `lost` numbers are missing before it
            kLate,       // counted as lost, and has come after all
            kDuplicate,  // seen before
        } kind = Kind::kNext;
        std::uint32_t lost = 0;
    };
    Finding take(std::uint32_t sequence);

  private:
    std::uint32_t mask_;
    std::uint32_t newest_ = 0;
    std::uint64_t seen_ = 0;  // bit i: newest_ - i was seen; 0: none yet
};

inline SequenceWindow::Finding SequenceWindow::take(std::uint32_t sequence) {
    using Kind = Finding::Kind;
    sequence &= mask_;
    const std::uint32_t ahead = (sequence - newest_) & mask_;
    const std::uint32_t behind = (newest_ - sequence) & mask_;
    const bool anew = sequence == 0 && ahead > 64;
    if (seen_ != 0 && !anew && behind < 64) {
        const std::uint64_t bit = std::uint64_t{1} << behind;
        const bool known = (seen_ & bit) != 0;
        seen_ |= bit;
        return {known ? Kind::kDuplicate : Kind::kLate};
    }
    // Half of all numbers are ahead; the rest are too old to be late. A sender that starts from its clock can
    // begin anywhere.
    constexpr std::uint32_t kMaxLost = 1u << 20;
    if (seen_ != 0 && !anew && ahead <= std::min(mask_ / 2, kMaxLost)) {
        newest_ = sequence;
        seen_ = (ahead < 64 ? seen_ << ahead : 0) | 1;
        return ahead == 1 ? Finding{Kind::kNext} : Finding{Kind::kGap, ahead - 1};
    }
    newest_ = sequence;
    // Numbers before the first are not missing.
    seen_ = ~std::uint64_t{0};
    return {Kind::kNext};
}

}  // namespace hilcam
