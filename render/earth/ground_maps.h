#pragma once
// The Earth's surface from one map, or from maps at several instants or of several months. Between two of
// them each place has their mean, weighted by time. A month's map holds in the middle of that month, every
// year. Before the first instant and after the last its map stays.

#include <vector>

#include "render/earth/earth_map.h"
#include "render/earth/map_times.h"

namespace hilcam {

class GroundMaps {
  public:
    struct Timed {
        TimeTai at;
        EarthMap map;
    };
    struct Monthly {
        int month;  // 1: January
        EarthMap map;
    };
    // One map for all times. HILCAM_CHECK: no map is empty, and times increase.
    GroundMaps(EarthMap one);
    explicit GroundMaps(std::vector<Timed> maps);
    explicit GroundMaps(std::vector<Monthly> maps);

    std::size_t count() const { return maps_.size(); }
    const EarthMap& first() const { return maps_.front(); }
    int height() const;  // texels of the finest map
    std::size_t bytes() const;

    const MapTimes& times() const { return times_; }
    // Return the means over a footprint. Loop, any thread.
    EarthSample sample(double number, float u, float v, const MapFootprint& footprint) const;
    EarthSample sample(double number, float u, float v, float width) const;

  private:
    std::vector<EarthMap> maps_;
    MapTimes times_;

    void require_maps() const;
    template <class Footprint>
    EarthSample mix(double number, float u, float v, const Footprint& footprint) const;
};

}  // namespace hilcam
