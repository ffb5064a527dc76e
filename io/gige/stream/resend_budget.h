#pragma once
// Bounds how many packets of a stream are sent again over time, whoever asks. Each packet that a frame has earns one; what
// is not asked for is saved up to a few frames' worth. So requests at most double a stream's traffic in the long run.
//
// A client that loses a share p of all packets asks for p / (1 - p) of them on average: the budget serves losses of up to
// a half. Example: frames of 73 packets at 30 Hz; four whole frames may be asked for at once, then 2190 packets a second.

#include <algorithm>
#include <cstdint>

namespace hilcam {

class ResendBudget {
  public:
    static constexpr std::uint64_t kSavedFrames = 4;

    // An acquisition begins, whose frames have so many packets each.
    void restart(std::uint64_t packets) { left_ = kSavedFrames * packets; }
    // A frame of so many packets is sent.
    void earn(std::uint64_t packets) { left_ = std::min(left_ + packets, kSavedFrames * packets); }
    void spend(std::uint64_t packets) { left_ -= std::min(left_, packets); }
    std::uint64_t left() const { return left_; }

  private:
    std::uint64_t left_ = 0;
};

}  // namespace hilcam
