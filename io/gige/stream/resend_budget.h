#pragma once
// Limits how many packets of a stream are resent over time, whoever asks. Each packet of a frame earns one;
// unused ones are saved up to a few frames' worth. So requests at most double a stream's traffic in the long
// run.
//
// A client that loses a share p of all packets asks for p / (1 - p) of them on average: the budget covers
// losses of up to a half. Example: with frames of 73 packets at 30 Hz, four whole frames may be requested at
// once, then 2190 packets a second.

#include <algorithm>
#include <cstdint>

namespace hilcam {

class ResendBudget {
  public:
    static constexpr std::uint64_t kSavedFrames = 4;

    // Begins an acquisition with this many packets per frame.
    void restart(std::uint64_t packets) { left_ = kSavedFrames * packets; }
    // Counts a frame of this many packets.
    void earn(std::uint64_t packets) { left_ = std::min(left_ + packets, kSavedFrames * packets); }
    void spend(std::uint64_t packets) { left_ -= std::min(left_, packets); }
    std::uint64_t left() const { return left_; }

  private:
    std::uint64_t left_ = 0;
};

}  // namespace hilcam
