#pragma once
// When each of several maps holds: at an instant, or in the middle of a month, again each year. Between two of them a place has their mean by
// time; before the first instant and after the last its map stays.

#include <cstddef>
#include <span>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

class MapTimes {
  public:
    // One map at all times, or none.
    MapTimes() = default;
    // HILCAM_CHECK: each is later than the one before.
    explicit MapTimes(std::span<const TimeTai> instants);
    static MapTimes of_months(std::span<const int> months);  // 1: January

    // Returns the number of the map of an instant, with the share of the one after it behind the point: from 0 to one less than the count; of
    // months to the count, as the first one follows the last. Loop, any thread.
    double number_at(TimeTai time) const;
    // Returns the nearest number that there is.
    double nearest(double number) const;

  private:
    std::vector<double>
        times_;  // seconds since the first instant, or shares of the year; empty: one map or none
    TimeTai first_{};
    bool is_yearly_ = false;
};

}  // namespace hilcam
