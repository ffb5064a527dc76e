#pragma once
// The clouds of one map, or of several instants: between two of them each place has their mean by time, so that clouds
// grow and dissolve where they are and do not move. Before the first instant and after the last its map stays.

#include <vector>

#include "render/earth/earth_map.h"
#include "render/vocabulary/time.h"

namespace hilcam {

class CloudMaps {
  public:
    struct Timed {
        TimeTai at;
        EarthMap map;
    };
    // None, or one at all times; an empty one is none.
    CloudMaps() = default;
    CloudMaps(EarthMap one);
    // HILCAM_CHECK: none is empty, and each is later than the one before.
    explicit CloudMaps(std::vector<Timed> maps);

    bool empty() const { return maps_.empty(); }
    std::size_t count() const { return maps_.size(); }
    int height() const;  // texels of the finest map; 0: there is none
    std::size_t bytes() const;

    // The number of the map of an instant, with the share of the one after it behind the point. Loop, any thread.
    double number_at(TimeTai time) const;
    // Returns the nearest number that sample() takes; 0 of no maps.
    double nearest(double number) const;
    // Cloud and cloud top over a footprint, as EarthMap has them; nothing else. number: from 0 to count() - 1. Loop, any
    // thread.
    EarthSample sample(double number, float u, float v, const MapFootprint& footprint) const;
    EarthSample sample(double number, float u, float v, float width) const;

  private:
    std::vector<Timed> maps_;

    template <class Footprint>
    EarthSample mix(double number, float u, float v, const Footprint& footprint) const;
};

}  // namespace hilcam
