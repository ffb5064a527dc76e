#pragma once
// The Earth's surface by one map, or by several of instants or of months: between two of them each place has their mean by time. Maps of
// months come again each year, a month's in its middle; before the first instant and after the last its map stays.

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
    // One at all times. HILCAM_CHECK: no map is empty, times grow from one to the next.
    GroundMaps(EarthMap one);
    explicit GroundMaps(std::vector<Timed> maps);
    explicit GroundMaps(std::vector<Monthly> maps);

    std::size_t count() const { return maps_.size(); }
    const EarthMap& first() const { return maps_.front(); }
    int height() const;  // texels of the finest map
    std::size_t bytes() const;

    const MapTimes& times() const { return times_; }
    // Means over a footprint. Loop, any thread.
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
