#pragma once
// The Earth as a camera in space sees it: land, sea and ice under clouds, all within the air, and lights of cities.
//
// A ray is bent by the air; it ends on the ground where it meets the ellipsoid, and passes the cloud whose top it meets above that. Clouds are plane
// layers (cloud_table.h), each texel by itself; what they leave of the Sun is looked for at the cloud towards the Sun,
// so shadows lie where they fall. Between ground and cloud light goes up and down (1 / (1 - A r)). The air (atmosphere.h) above a cloud
// and below it are told apart; below it is dimmed as the ground is. Lights shine through cloud and air.
//
// The law stands once, in shade(): everything else is either smooth over a picture, an aspect, or in the maps.
//
// What it does not model: relief, sea ice that the map has not, clouds that shade each other, twilight's colours on the sides of
// clouds, the Moon's light, lightning, airglow.
//
// Body axes (ITRF), metres. Light per unit of solar irradiance unless the unit says otherwise. const functions: loop, any
// thread.

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
    // air: may be null; must outlive this. clouds: their maps where they are not the ground's, whose own are then not looked at; may be
    // empty where the ground has one map. detail: finer levels of the one map; null: none.
    EarthModel(const EarthConfig& config, GroundMaps ground, CloudMaps clouds, const Atmosphere* air,
               const SpectralGrid& grid, std::shared_ptr<EarthDetail> detail = nullptr);

    struct Ray {
        Vec3d origin_m, dir;  // unit
        Vec3d sun_dir;
        double width_rad = 0;  // width of the cone that it stands for
        Spectrum irradiance_w_m2_um;
        EarthMoment moment{};
        int looks_across = 1;  // at the maps
    };
    // Light is not linear in what the maps hold: one look for a pixel of clouds and gaps is 1 to 3 % off. So many looks at
    // its parts, each way, are mostly within 1 %, and within 2 % (means of 8 x 8 px of geo_inspection).
    static constexpr int kLooksOfPixel = 2;
    // Rays are as a camera sees them; the air bends them (air_refraction.h). Returns the straight one that meets ground, clouds and air where
    // such a ray does.
    Ray bent(const Ray& ray) const;
    // Returns the height at which a level seems to be from afar.
    double seen_height_m(double height_m) const;
    // Adds weight times the radiance along a ray [W m^-2 sr^-1 um^-1]. True when it ends on the ground or in a cloud
    // before the sky; else weight is dimmed by what air it met.
    bool add(const Ray& ray, Spectrum& weight, Spectrum& radiance) const;
    static constexpr double kHighest_m = 16000;    // height of clouds
    static constexpr double kCloudLevel_m = 4000;  // level on which clouds stand out beyond the limb
    bool has_clouds() const { return table_ != nullptr; }
    // The same in two steps, for pixels that share an aspect. False where the ground is not met, or grazed.
    bool aspect_of(const Ray& ray, EarthAspect& aspect) const;
    // The sides of a footprint in texels of the finest map.
    struct Sides {
        float shorter, longer;
    };
    Sides texels_across(const MapFootprint& footprint, const EarthMoment& moment) const;
    // Where a ray meets the ground, as EarthMap has it: u, v. False where it does not.
    bool map_place(const Ray& ray, float& u, float& v) const;
    // Radiance by an aspect and the maps, per unit of irradiance [sr^-1], and that of lights [W m^-2 sr^-1 um^-1].
    struct Shade {
        Spectrum over_sun_sr, lights_w_m2_sr_um;
    };
    Shade shade(const EarthAspect& aspect, const EarthMoment& moment) const;
    // The mean of looks at equal parts of the footprint, so many each way, fewer where texels are larger.
    Shade shade_by_parts(const EarthAspect& aspect, const EarthMoment& moment, int across) const;
    const GroundMaps& ground() const { return *ground_maps_; }
    // Returns where an instant lies between the maps; and the nearest place that there is.
    MapNumbers numbers_at(TimeTai time) const {
        return {cloud_maps_->times().number_at(time), ground_maps_->times().number_at(time)};
    }
    MapNumbers nearest(MapNumbers n) const {
        return {cloud_maps_->times().nearest(n.clouds), ground_maps_->times().nearest(n.ground)};
    }
    // Returns the finer levels of the ground, to be read by one thread at a time; null: none.
    const std::shared_ptr<EarthDetail>& detail() const { return detail_; }
    std::size_t detail_bytes() const { return detail_bytes_; }  // memory for their tiles

    // An upper bound of radiance over irradiance at the body [sr^-1]; glint apart.
    static constexpr float kMaxOverSun = 0.32f;
    // Returns what the whole disk sends at a phase angle, over (R/d)^2 and the irradiance: geometric albedo times phase
    // function, from `looks` directions. camera_dir, sun_dir: unit, from the centre.
    Spectrum disk_albedo(Vec3d camera_dir, Vec3d sun_dir, int looks) const;

    // Parts that can be left out, so that `hilcam check` can tell what each costs; and the rest.
    enum class Part { kSurface, kSea, kClouds, kAir, kLights };
    struct PartInfo {
        Part part;
        std::string text;
        std::size_t bytes;
    };
    // Those that it has, in the order of Part.
    std::vector<PartInfo> parts() const;
    // A copy that lacks a part, on the same maps and tables. HILCAM_CHECK: not the surface. Not for the loop.
    EarthModel without(Part part) const;

  private:
    // Shared by copies.
    std::shared_ptr<const GroundMaps> ground_maps_;
    std::shared_ptr<const CloudMaps> cloud_maps_;  // empty: the clouds are the ground map's
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

    bool together() const { return cloud_maps_->empty(); }  // ground and clouds are of one map
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
    // out.u, out.v: set already.
    void place_air(const Ray& ray, double distance_m, const Place& place, EarthAspect& out) const;
    Atmosphere::Sight air_past(const Ray& ray) const;
    float cloud_of(const EarthSample& sample) const;
    EarthAspect aspect_at(const Ray& ray, double distance_m, double height_m) const;
};

// A map of clouds that nobody saw: bands of latitude as the mean Earth has them, shapes from noise. height: of the map, a
// power of two.
EarthMap seeded_clouds(std::uint64_t seed, int height = 1024);

}  // namespace hilcam
