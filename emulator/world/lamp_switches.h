#pragma once
// The brightness of a lamp over time: a step function, from switches that arrive in any order.
//
// A switch holds from its time until the next one. Before the first known switch, the lamp has the level that
// it had before that one arrived. The newest 8 are kept; older ones have no effect.

#include <array>
#include <cstddef>

#include "render/vocabulary/time.h"

namespace hilcam {

// A level that is valid from an instant on.
struct LampSwitch {
    TimeTai time;
    double level = 0;  // 0: off; 1: as in its data sheet
};

class LampSwitches {
  public:
    static constexpr std::size_t kLength = 8;

    LampSwitches() = default;
    explicit LampSwitches(double level) : before_(level) {}

    // Inserts a switch. The later call counts if two switches have the same instant.
    void insert(const LampSwitch& order);
    // Forgets all switches; the lamp keeps its latest level.
    void begin_anew();

    double at(TimeTai time) const;
    // Returns the mean over a span of time; for a span without length, the level at that instant.
    double mean(TimeTai from, TimeTai until) const;

  private:
    std::array<LampSwitch, kLength> switches_;  // by time, oldest first
    std::size_t count_ = 0;
    double before_ = 0;
};

}  // namespace hilcam
