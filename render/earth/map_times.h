#pragma once
// The times of several maps: each holds at an instant, or in the middle of a month of every year. Between two
// of them a place has their mean, weighted by time; before the first instant and after the last its map
// stays.

#include <cstddef>
#include <span>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

class MapTimes {
  public:
    // One map for all times, or none.
    MapTimes() = default;
    // HILCAM_CHECK: each is later than the one before.
    explicit MapTimes(std::span<const TimeTai> instants);
    static MapTimes of_months(std::span<const int> months);  // 1: January

    // Returns an instant's position between the maps: the number of the earlier one, plus the weight of the
    // next one as a fraction. From 0 to the count minus one; for months up to the count, because the first
    // follows the last. Loop, any thread.
    double number_at(TimeTai time) const;
    // Returns the nearest number for which there is a map.
    double nearest(double number) const;

  private:
    std::vector<double>
        times_;  // seconds since the first instant, or fractions of the year; empty: one map or none
    TimeTai first_{};
    bool is_yearly_ = false;
};

}  // namespace hilcam
