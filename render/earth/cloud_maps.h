#pragma once
// The clouds of one map, or of maps at several instants. Between two instants each place has their mean,
// weighted by time: clouds grow and dissolve in place and do not move. Before the first instant and after the
// last its map stays.

#include <vector>

#include "render/earth/earth_map.h"
#include "render/earth/map_times.h"

namespace hilcam {

// Returns c = b tau / (1 + b tau) for a cloud with `factor` times the thickness.
inline float thickened_cloud(float c, float factor) {
    if (factor == 1) return c;
    return factor * c / (1 - c + factor * c + 1e-6f);
}

class CloudMaps {
  public:
    struct Timed {
        TimeTai at;
        EarthMap map;
    };
    // No map, or one for all times; an empty one counts as none.
    CloudMaps() = default;
    CloudMaps(EarthMap one);
    // HILCAM_CHECK: no map is empty, and each is later than the one before.
    explicit CloudMaps(std::vector<Timed> maps);

    bool empty() const { return maps_.empty(); }
    std::size_t count() const { return maps_.size(); }
    int height() const;  // texels of the finest map; 0: there is none
    std::size_t bytes() const;

    const MapTimes& times() const { return times_; }
    // Returns the means of cloud and cloud top over a footprint, as EarthMap does, and nothing else. number:
    // from 0 to count() - 1. Loop, any thread.
    EarthSample sample(double number, float u, float v, const MapFootprint& footprint) const;
    EarthSample sample(double number, float u, float v, float width) const;

  private:
    std::vector<EarthMap> maps_;
    MapTimes times_;

    template <class Footprint>
    EarthSample mix(double number, float u, float v, const Footprint& footprint) const;
};

}  // namespace hilcam
