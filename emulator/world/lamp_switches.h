#pragma once
// The brightness of a lamp over time: a step function, by the switches that are known of it, in any order.
//
// A switch holds from its time on, until the next. Before the first of them the lamp is as it was before that
// came. The newest 8 are kept: what is older than those has no effect.

#include <array>
#include <cstddef>

#include "render/vocabulary/time.h"

namespace hilcam {

// A level that holds from an instant on.
struct LampSwitch {
    TimeTai time;
    double level = 0;  // 0: off; 1: as its data sheet says
};

class LampSwitches {
  public:
    static constexpr std::size_t kLength = 8;

    LampSwitches() = default;
    explicit LampSwitches(double level) : before_(level) {}

    // Inserts a switch; of two of the same instant, the later one counts.
    void insert(const LampSwitch& order);
    // Forgets what was known; the lamp goes on from how it was at last.
    void begin_anew();

    double at(TimeTai time) const;
    // The mean over a span of time; of a span without length, that instant's.
    double mean(TimeTai from, TimeTai until) const;

  private:
    std::array<LampSwitch, kLength> switches_;  // by time, oldest first
    std::size_t count_ = 0;
    double before_ = 0;
};

}  // namespace hilcam
