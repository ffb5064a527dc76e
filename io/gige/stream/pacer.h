#pragma once
// A token bucket that says when the next packets may leave. Packets are paid for with time. A late sender may
// catch up only a little, so that its burst does not overrun a receiver's buffer.

#include <algorithm>
#include <cstdint>

namespace hilcam {

struct Pace {
    double bytes_s = 1e9;
    std::int64_t delay_ns = 0;  // after each packet, in addition
    std::int64_t catch_up_ns = 1'000'000;
};

class Pacer {
  public:
    // Begins a frame; the time without frames is not saved up.
    void begin(const Pace& pace, std::int64_t now_ns) {
        pace_ = pace;
        ready_ns_ = std::max(ready_ns_, now_ns);
    }
    void sent(std::size_t packets, std::size_t bytes, std::int64_t now_ns) {
        ready_ns_ = std::max(ready_ns_, now_ns - pace_.catch_up_ns) +
                    static_cast<std::int64_t>(static_cast<double>(bytes) / pace_.bytes_s * 1e9) +
                    static_cast<std::int64_t>(packets) * pace_.delay_ns;
    }
    std::int64_t ready_ns() const { return ready_ns_; }
    const Pace& pace() const { return pace_; }
    // Returns how many bytes to send at once: a sleep shorter than what they pay for would cost more than it
    // paces.
    std::size_t batch_bytes() const {
        if (pace_.delay_ns > kShortestSleep_ns) return 1;
        return static_cast<std::size_t>(std::clamp(pace_.bytes_s * 0.3e-3, 1.0, 1e9));
    }
    static constexpr std::int64_t kShortestSleep_ns = 50'000;

  private:
    Pace pace_;
    std::int64_t ready_ns_ = 0;
};

}  // namespace hilcam
