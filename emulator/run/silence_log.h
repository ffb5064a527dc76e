#pragma once
// Logs, once for each occurrence, that poses have stopped or come again, and that time tags went backwards.
// Owner thread, outside the loop.

#include <cstdint>

#include "emulator/world/clock.h"
#include "emulator/world/pose_watch.h"

namespace hilcam {

class SilenceLog {
  public:
    SilenceLog(const SimulatedClock& clock, const PoseWatch& poses) : clock_(clock), poses_(poses) {}
    // Called periodically while the loops run.
    void look();

  private:
    void look_at_tags(std::int64_t now_ns);

    const SimulatedClock& clock_;
    const PoseWatch& poses_;
    bool stale_ = false;
    TimeTai since_;
    std::uint64_t told_ = 0;
    std::int64_t next_ns_ = 0;  // earliest time of the next line about tags
};

}  // namespace hilcam
