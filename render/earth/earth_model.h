#pragma once
// The Earth as a camera in space sees it: land, sea and ice, clouds above them, air around both, and lights
// of cities.
//
// The air bends a ray. The ray ends where it meets the ellipsoid, and passes the cloud whose top it meets
// above that. Clouds are plane layers (cloud_table.h), each texel by itself. The sunlight that they transmit
// is looked up at the cloud in the Sun's direction, so shadows are where they belong. Light is reflected
// between ground and cloud (1 / (1 - A r)). The air (atmosphere.h) above and below a cloud is separate; below
// it, it is dimmed like the ground. Lights shine through cloud and air. docs/earth.md has the details.
//
// shade() has the law. Everything else is either an aspect, which varies slowly over a picture, or in the
// maps.
//
// Not modelled: relief, sea ice that is not on the map, shadows of clouds on clouds, colours of twilight on
// the sides of clouds, moonlight, lightning, airglow.
//
// Body axes (ITRF), metres. Light is per unit of solar irradiance unless the unit says otherwise. const
// functions: loop, any thread.

#include <memory>
#include <string>

#include "render/earth/air_columns.h"
#include "render/earth/cloud_maps.h"
#include "render/earth/cloud_table.h"
#include "render/earth/detail_tiles.h"
#include "render/earth/earth_config.h"
#include "render/earth/earth_map.h"
#include "render/earth/earth_moment.h"
#include "render/earth/ground_maps.h"
#include "render/earth/land.h"
#include "render/earth/land_shape.h"
#include "render/earth/sea.h"

namespace hilcam {

class EarthModel {
  public:
    // air: may be null; must outlive this. clouds: their maps, which replace those of the ground's maps; may
    // be empty if the ground has one map. detail: finer levels of the one map; null: none.
    EarthModel(const EarthConfig& config, GroundMaps ground, CloudMaps clouds, const Atmosphere* air,
               const SpectralGrid& grid, std::shared_ptr<EarthDetail> detail = nullptr);

    struct Ray {
        Vec3d origin_m, dir;  // unit
        Vec3d sun_dir;
        double width_rad = 0;  // width of the ray's cone
        Spectrum irradiance_w_m2_um;
        EarthMoment moment{};
        int looks_across = 1;  // lookups in the maps, in each direction
    };
    // Light is not linear in the maps' values: a single lookup for a pixel with clouds and gaps is 1 to 3 %
    // off. This many lookups in each direction are mostly within 1 %, and always within 2 % (means of 8 x 8
    // px of geo_inspection).
    static constexpr int kLooksOfPixel = 2;
    // Returns the straight ray that meets ground, clouds and air where the bent one does (air_refraction.h).
    // Rays that the other functions take are as a camera sees them, before the air bends them.
    Ray bent(const Ray& ray) const;
    // Returns the height at which a camera far away sees a level.
    double seen_height_m(double height_m) const;
    // Adds weight times the radiance along a ray [W m^-2 sr^-1 um^-1]. Returns true if the ray ends on the
    // ground or in a cloud; otherwise the air on its way has dimmed weight.
    bool add(const Ray& ray, Spectrum& weight, Spectrum& radiance) const {
        return add_bent(bent(ray), weight, radiance);
    }
    bool add_bent(const Ray& ray, Spectrum& weight, Spectrum& radiance) const;  // ray: from bent()
    static constexpr double kHighest_m = 16000;                                 // largest height of clouds
    static constexpr double kCloudLevel_m = 4000;  // the level of clouds beyond the limb
    bool has_clouds() const { return table_ != nullptr; }
    // The same in two steps, for pixels that share an aspect. Returns false if the ray misses or grazes the
    // ground.
    bool aspect_of(const Ray& ray, EarthAspect& aspect) const;
    // The sides of a footprint in texels of the finest map.
    struct Sides {
        float shorter, longer;
    };
    Sides texels_across(const MapFootprint& footprint, const EarthMoment& moment) const;
    // Finds where a ray meets the ground: u, v of EarthMap. Returns false if it does not.
    bool map_place(const Ray& ray, float& u, float& v) const;
    // Radiance for an aspect and the maps, per unit of irradiance [sr^-1], and that of lights [W m^-2 sr^-1
    // um^-1].
    struct Shade {
        Spectrum over_sun_sr, lights_w_m2_sr_um;
    };
    Shade shade(const EarthAspect& aspect, const EarthMoment& moment) const;
    // Returns the mean over equal parts of the footprint, `across` in each direction, fewer if texels are
    // larger.
    Shade shade_by_parts(const EarthAspect& aspect, const EarthMoment& moment, int across) const;
    const GroundMaps& ground() const { return *ground_maps_; }
    // Returns an instant's position between the maps; and the nearest one for which there is a map.
    MapNumbers numbers_at(TimeTai time) const {
        return {cloud_maps_->times().number_at(time), ground_maps_->times().number_at(time)};
    }
    MapNumbers nearest(MapNumbers n) const {
        return {cloud_maps_->times().nearest(n.clouds), ground_maps_->times().nearest(n.ground)};
    }
    // Returns the finer levels of the ground, which one thread at a time may read; null: none.
    const std::shared_ptr<EarthDetail>& detail() const { return detail_; }
    std::size_t detail_bytes() const { return detail_bytes_; }  // memory for tiles of these

    // An upper bound of radiance over irradiance at the body [sr^-1], without glint.
    static constexpr float kMaxOverSun = 0.32f;
    // Returns the light of the whole disk at a phase angle, over (R/d)^2 and the irradiance: geometric albedo
    // times phase function, from `looks` directions. camera_dir, sun_dir: unit, from the centre.
    Spectrum disk_albedo(Vec3d camera_dir, Vec3d sun_dir, int looks) const;

    // The parts that can be left out, so that `hilcam check` can measure the cost of each; and the rest.
    enum class Part { kSurface, kSea, kClouds, kAir, kLights };
    struct PartInfo {
        Part part;
        std::string text;
        std::size_t bytes;
    };
    // Returns the parts that it has, in the order of Part.
    std::vector<PartInfo> parts() const;
    // Returns a copy that lacks a part and shares maps and tables. HILCAM_CHECK: not the surface. Not for the
    // loop.
    EarthModel without(Part part) const;

  private:
    // Shared by copies.
    std::shared_ptr<const GroundMaps> ground_maps_;
    std::shared_ptr<const CloudMaps> cloud_maps_;  // empty: clouds are in the ground's map
    std::shared_ptr<EarthDetail> detail_;
    std::size_t detail_bytes_;
    const Atmosphere* air_;
    std::shared_ptr<const AirColumns> columns_;  // null without air
    std::shared_ptr<const CloudTable> table_;    // null without clouds
    LandBands land_;
    LandShape land_shape_;
    Sea sea_;
    float cloud_factor_;
    Spectrum city_w_m2_sr_um_;  // radiance of the brightest
    int bins_;
    double wind_m_s_, lights_;
    bool glints_ = true;

    bool together() const { return cloud_maps_->empty(); }  // ground and clouds share a map
    template <class Footprint>
    EarthSample ground_sample(const EarthMoment& moment, float u, float v, const Footprint& footprint) const {
        return moment.detail ? moment.detail->sample(ground_maps_->first(), u, v, footprint)
                             : ground_maps_->sample(moment.number.ground, u, v, footprint);
    }
    template <class Footprint>
    EarthSample cloud_sample(const EarthMoment& moment, float u, float v, const Footprint& footprint) const {
        return together() ? ground_sample(moment, u, v, footprint)
                          : cloud_maps_->sample(moment.number.clouds, u, v, footprint);
    }
    struct Place;
    // Needs out.u and out.v.
    void place_air(const Ray& ray, double distance_m, const Place& place, EarthAspect& out) const;
    Atmosphere::Sight air_past(const Ray& ray) const;
    float cloud_of(const EarthSample& sample) const;
    EarthAspect aspect_at(const Ray& ray, double distance_m, double height_m) const;
};

// Makes an invented map of clouds: bands of latitude like those of the mean Earth, shapes from noise. height:
// of the map, a power of two.
EarthMap seeded_clouds(std::uint64_t seed, int height = 1024);

}  // namespace hilcam
