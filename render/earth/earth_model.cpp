#include "render/earth/earth_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/earth/earth_figure.h"
#include "render/earth/map_looks.h"
#include "render/sky/air_refraction.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kMeanRadius_m = 6371008.8;  // (Moritz, J. Geodesy 74, 128, 2000)
constexpr float kPerPi = static_cast<float>(1 / kPi);
// A ray looks for clouds at this height first, then at their own.
constexpr auto kUsualTop_m = static_cast<float>(EarthModel::kCloudLevel_m);
constexpr float kMinCloud = 2e-3f;

struct MapPlace {
    float u, v;
};
MapPlace map_place(Vec3d normal) {
    return {static_cast<float>(std::atan2(normal.y, normal.x) / (2 * kPi) + 0.5),
            static_cast<float>(0.5 - std::asin(std::clamp(normal.z, -1.0, 1.0)) / kPi)};
}

float by_steps(const EarthAspect::Steps& steps, float c) {
    const float at = std::sqrt(c) * (EarthAspect::kSteps - 1);
    const int low = std::clamp(static_cast<int>(at), 0, EarthAspect::kSteps - 2);
    const auto i = static_cast<std::size_t>(low);
    return steps[i] + (at - static_cast<float>(low)) * (steps[i + 1] - steps[i]);
}

// The mix of surfaces and clouds at one lookup.
struct Mix {
    float water, mirrored, glint_sr;
    float direct, diffuse,
        // Shares of sunlight on the ground (direct beam, scattered by clouds), and of upward light that
        // clouds send back.
        back;
    bool clouded;
    float share, passed;         // light that passes the cloud downwards and upwards
    float high;                  // 0: its top is on the ground; 1: at kHigh_m
    float many, once, from_sky;  // reflection by the cloud
    float shaped;                // share of the land that is not snow: LandShape holds for it
};

// Combines ground, air below the cloud, cloud, and air above it; per bin.
HILCAM_CLONES void mix_light(const EarthAspect& a, const Mix& m, const Spectrum& land,
                             const Spectrum& sea_diffuse, const Spectrum& sea_albedo, Spectrum& out) {
    for (int b = 0; b < kMaxBins; ++b) {
        const float sky = a.sky_low[b] * (1 - m.back) + a.sun_low[b] * m.diffuse;
        // Light is reflected back and forth between ground and cloud.
        const float light =
            (a.sun_low[b] * m.direct + sky) / (1 - (land[b] + m.water * sea_albedo[b]) * m.back);
        const float ground_sr =
            kPerPi * ((land[b] + m.water * sea_diffuse[b]) * light + m.water * m.mirrored * sky +
                      m.shaped * land[b] * (a.land_shape[b] - 1) * m.direct * a.sun_low[b]) +
            m.glint_sr * a.sun_low[b];
        out[b] = a.seen_low[b] * ground_sr;
    }
    if (!m.clouded) {
        out += a.air_low;
        return;
    }
    for (int b = 0; b < kMaxBins; ++b) {
        const auto at_top = [&](const Spectrum& low, const Spectrum& high) {
            return low[b] + m.high * (high[b] - low[b]);
        };
        const float air = at_top(a.air_low, a.air_high);
        const float below = out[b] + m.share * std::max(0.0f, a.air_low[b] - air);
        const float reflected = std::max(0.0f, m.many + m.once * a.once[b]);
        out[b] = air + m.passed * below +
                 at_top(a.seen_low, a.seen_high) * kPerPi *
                     (at_top(a.sun_low, a.sun_high) * reflected + at_top(a.sky_low, a.sky_high) * m.from_sky);
    }
}

// Returns the ellipsoid at a height.
Figure raised(double height_m) {
    return {kEarthFigure.equatorial_radius_m + height_m, kEarthFigure.polar_radius_m + height_m};
}

}  // namespace

// The place where a ray ends.
struct EarthModel::Place {
    Vec3d point_m, normal;
    float mu, mu0, cos_phase;  // zenith cosines of viewer and Sun, cosine of the angle between them
    Place(Vec3d point, Vec3d to_viewer, Vec3d sun)
        : point_m(point),
          normal(earth_normal(point)),
          mu(static_cast<float>(std::max(1e-3, dot(normal, to_viewer)))),
          mu0(static_cast<float>(dot(normal, sun))),
          cos_phase(static_cast<float>(dot(sun, to_viewer))) {}
};

EarthModel::EarthModel(const EarthConfig& config, GroundMaps ground, CloudMaps clouds, const Atmosphere* air,
                       const SpectralGrid& grid, std::shared_ptr<EarthDetail> detail)
    : ground_maps_(std::make_shared<const GroundMaps>(std::move(ground))),
      cloud_maps_(std::make_shared<const CloudMaps>(std::move(clouds))),
      detail_(std::move(detail)),
      detail_bytes_(static_cast<std::size_t>(config.memory_mb) << 20),
      air_(air),
      land_(grid),
      land_shape_(grid),
      sea_(config.wind_m_s, grid),
      cloud_factor_(static_cast<float>(config.cloud_thickness)),
      bins_(grid.size()),
      wind_m_s_(config.wind_m_s),
      lights_(config.lights) {
    HILCAM_CHECK(ground_maps_->count() == 1 || (!cloud_maps_->empty() && !detail_));
    if (air) columns_ = std::make_shared<const AirColumns>(*air, static_cast<double>(EarthAspect::kHigh_m));
    if (cloud_factor_ > 0) table_ = std::make_shared<const CloudTable>(grid);
    // The brightest places of the map: 100 nW cm^-2 sr^-1 from 0.5 to 0.9 um, which VIIRS' day/night band
    // sees over the centres of large cities, to a factor of two (Elvidge et al., Int. J. Remote Sens. 38,
    // 5860, 2017, on the values of its maps). Their spectrum is assumed: mostly high-pressure sodium, some
    // white light-emitting diodes.
    constexpr double kBrightest_w_m2_sr = 100e-9 * 1e4;
    const Curve lamps{{0.40, 0.44, 0.46, 0.49, 0.54, 0.57, 0.59, 0.61, 0.64, 0.70, 0.80, 0.82, 0.84, 0.95},
                      {0.05, 0.15, 0.40, 0.20, 0.45, 0.90, 1.00, 0.85, 0.45, 0.15, 0.15, 0.50, 0.10, 0.05},
                      {}};
    const double band = 0.4 * lamps.mean(0.5, 0.9);
    city_w_m2_sr_um_ = static_cast<float>(config.lights * kBrightest_w_m2_sr / band) * grid.average(lamps);
}

float EarthModel::cloud_of(const EarthSample& sample) const {
    return thickened_cloud(sample.cloud(), cloud_factor_);
}

EarthModel::Ray EarthModel::bent(const Ray& ray) const {
    const AirRefraction* air = air_ ? air_->refraction() : nullptr;
    if (!air) return ray;
    const AirRefraction::Line line = line_within(*air, kEarthFigure, ray.origin_m, ray.dir);
    Ray out = ray;
    out.origin_m = line.origin_m, out.dir = line.dir;
    return out;
}

double EarthModel::seen_height_m(double height_m) const {
    const AirRefraction* air = air_ ? air_->refraction() : nullptr;
    return air ? air->apparent_height_m(height_m) : height_m;
}

void EarthModel::place_air(const Ray& ray, double distance_m, const Place& place, EarthAspect& out) const {
    const float mu0 = std::max(0.0f, place.mu0);
    // From a height the Sun is visible when it is below the level; such light is grazing.
    const float high_mu0 = std::max(0.01f, place.mu0);
    if (!air_) {
        const float lit = place.mu0 > 0 ? 1.0f : 0.0f;
        for (int b = 0; b < bins_; ++b) {
            out.seen_low[b] = out.seen_high[b] = 1;
            out.sun_low[b] = out.sun_high[b] = mu0 * lit;
        }
        return;
    }
    const Vec3d low = stretched(kEarthFigure, place.point_m),
                sun = normalized(stretched(kEarthFigure, ray.sun_dir));
    const Vec3d high = low * (1 + static_cast<double>(EarthAspect::kHigh_m) / length(low));
    out.sun_low = mu0 * air_->sun_transmittance(low, sun);
    out.sun_high = high_mu0 * air_->sun_transmittance(high, sun);
    const Spectrum lift = columns_->lift_at(out.u, out.v);
    const auto sky_at = [&](Vec3d point_m) {
        if (!columns_->by_place()) return air_->sky_irradiance(point_m, sun);
        const AirByPlace::Sky sky = columns_->by_place()->sky_in_parts(point_m, sun);
        return sky.over_black + lift * sky.per_lift;
    };
    out.sky_low = sky_at(low), out.sky_high = sky_at(high);
    const Vec3d origin = stretched(kEarthFigure, ray.origin_m);
    const double top_m = kEarthFigure.equatorial_radius_m + air_->top_m();
    AirColumns::Looks looks;
    if (dot(origin, origin) >= top_m * top_m) {
        looks = columns_->look(place.mu, place.mu0, place.cos_phase, lift);
    } else {
        const Vec3d dir = stretched(kEarthFigure, ray.dir);
        const double per_length = length(dir);
        const auto look = [&](double to_m) {
            return air_->look(origin, dir / per_length, to_m * per_length, sun);
        };
        looks.low = look(distance_m);
        // Clouds above a viewer who is among them are not in front of the ground.
        const double to_high_m =
            intersect_ellipsoid(raised(static_cast<double>(EarthAspect::kHigh_m)), ray.origin_m, ray.dir);
        looks.high = look(std::clamp(to_high_m, 0.0, distance_m));
    }
    out.air_low = looks.low.radiance_sr, out.seen_low = looks.low.transmittance;
    out.air_high = looks.high.radiance_sr, out.seen_high = looks.high.transmittance;
}

// Returns the aspect of a ray that ends at a distance, on the ground or on a level above it.
EarthAspect EarthModel::aspect_at(const Ray& ray, double distance_m, double height_m) const {
    const Place place(ray.origin_m + distance_m * ray.dir, -ray.dir, ray.sun_dir);
    EarthAspect out;
    const MapPlace at = hilcam::map_place(place.normal);
    out.u = at.u, out.v = at.v;
    place_air(ray, distance_m, place, out);
    if (table_) table_->place(place.mu0, place.mu, place.cos_phase, out);
    if (place.mu0 > 0 && glints_)
        out.glint_sr = sea_.glint_sr(place.mu0, place.mu, place.cos_phase) / std::max(0.02f, place.mu0);
    out.mirrored = sea_.sky_mirrored(place.mu);
    out.land_shape = land_shape_.of(std::max(0.0f, place.mu0), place.mu, place.cos_phase);

    // East and north on the level; a step there, as a share of the map.
    const Vec3d n = place.normal;
    const double polar = std::sqrt(n.x * n.x + n.y * n.y);
    const Vec3d east = polar > 0 ? Vec3d{-n.y / polar, n.x / polar, 0} : Vec3d{0, 1, 0},
                north = cross(n, east);
    const double per_u = 1 / (2 * kPi * kMeanRadius_m * std::max(1e-3, polar)),
                 per_v = -1 / (kPi * kMeanRadius_m);
    const auto step = [&](Vec3d level_m, float& u, float& v) {
        u = static_cast<float>(dot(level_m, east) * per_u),
        v = static_cast<float>(dot(level_m, north) * per_v);
    };
    // The ray's cone has its own width across, and is longer by 1 / mu along. Sides are given by east and
    // north, because along and across are undefined for a vertical view.
    const Vec3d along = ray.dir - dot(ray.dir, n) * n;
    const double level = length(along);
    const Vec3d away = level > 1e-9 ? along / level : east;
    const double width_m = ray.width_rad * distance_m;
    const double longer = 1 / std::max(0.02, static_cast<double>(place.mu)) - 1;
    const auto on_level = [&](Vec3d side) { return width_m * (side + (longer * dot(away, side)) * away); };
    step(on_level(east), out.footprint.u1, out.footprint.v1);
    step(on_level(north), out.footprint.u2, out.footprint.v2);
    // How far before its end the ray passes the usual height of clouds, per metre of height, on a sphere.
    constexpr double kTop_m = static_cast<double>(kUsualTop_m);
    const double rmu = kMeanRadius_m * static_cast<double>(place.mu);
    const double back_m = std::sqrt(rmu * rmu + 2 * kMeanRadius_m * kTop_m) - rmu;
    if (!(height_m > 0)) step(-back_m * level / kTop_m * away, out.cloud_u, out.cloud_v);
    const Vec3d sun_level = ray.sun_dir - static_cast<double>(place.mu0) * n;
    step(1 / std::max(0.05, static_cast<double>(place.mu0)) * sun_level, out.shade_u, out.shade_v);
    return out;
}

bool EarthModel::aspect_of(const Ray& seen, EarthAspect& aspect) const {
    const Ray ray = bent(seen);
    const double distance_m = intersect_ellipsoid(kEarthFigure, ray.origin_m, ray.dir);
    if (!(distance_m >= 0)) return false;
    // Sine of 4.6 degrees: above that, pixels that share an aspect differ by 0.31 % of the mean
    // (ShippedEarth.PixelsThatShareAnAspectLookLikeThoseOfTheirOwn).
    constexpr double kGrazing = 0.08;
    if (-dot(earth_normal(ray.origin_m + distance_m * ray.dir), ray.dir) < kGrazing) return false;
    aspect = aspect_at(ray, distance_m, 0);
    return true;
}

EarthModel::Sides EarthModel::texels_across(const MapFootprint& f, const EarthMoment& moment) const {
    const int rows = moment.detail ? moment.detail->shape().rows : ground().height();
    const auto height = static_cast<float>(std::max(rows, cloud_maps_->height()));
    const FootprintEllipse ellipse = ellipse_of(f, {2 * height, height});
    return {ellipse.shorter, ellipse.longer};
}

bool EarthModel::map_place(const Ray& seen, float& u, float& v) const {
    const Ray ray = bent(seen);
    const double distance_m = intersect_ellipsoid(kEarthFigure, ray.origin_m, ray.dir);
    if (!(distance_m >= 0)) return false;
    const MapPlace at = hilcam::map_place(earth_normal(ray.origin_m + distance_m * ray.dir));
    u = at.u, v = at.v;
    return true;
}

EarthModel::Shade EarthModel::shade(const EarthAspect& a, const EarthMoment& moment) const {
    const EarthSample ground = ground_sample(moment, a.u, a.v, a.footprint);
    const Spectrum land = land_.reflectance(ground);
    const float water = ground.water();
    float direct = 1, diffuse = 0, back = 0, cloud = 0, share = 1, passed = 1, high = 0;
    if (table_) {
        // Offsets smaller than a good part of the footprint share its lookup.
        const MapFootprint& f = a.footprint;
        const float seen_as_one = 0.12f * (f.u1 * f.u1 + f.u2 * f.u2 + 0.25f * (f.v1 * f.v1 + f.v2 * f.v2)) /
                                  (kUsualTop_m * kUsualTop_m);
        const bool together = this->together();
        const EarthSample over =
            together && a.cloud_u * a.cloud_u + 0.25f * a.cloud_v * a.cloud_v < seen_as_one
                ? ground
                : cloud_sample(moment, a.u + kUsualTop_m * a.cloud_u, a.v + kUsualTop_m * a.cloud_v,
                               a.footprint);
        cloud = cloud_of(over);
        if (!(cloud > kMinCloud)) cloud = 0;
        // Looks up where the Sun's ray passes the clouds. Light that clouds scatter comes from an area as
        // wide as their height, in both directions.
        const float towards_sun =
            together && a.shade_u * a.shade_u + 0.25f * a.shade_v * a.shade_v < seen_as_one
                ? cloud_of(ground)
                : cloud_of(cloud_sample(moment, a.u + kUsualTop_m * a.shade_u, a.v + kUsualTop_m * a.shade_v,
                                        a.footprint));
        constexpr float kSpread =
            static_cast<float>(2 * static_cast<double>(kUsualTop_m) / (kPi * kMeanRadius_m));
        const bool wide = f.v1 * f.v1 + f.v2 * f.v2 > kSpread * kSpread;
        const float mean = wide && together
                               ? cloud_of(ground)
                               : cloud_of(cloud_sample(moment, a.u, a.v, std::max(kSpread, std::abs(f.v2))));
        direct = by_steps(a.beam, towards_sun);
        share = by_steps(a.lit, mean);
        diffuse = std::max(0.0f, share - by_steps(a.beam, mean));
        back = table_->spherical_albedo(mean);
        if (cloud > 0) {
            passed = by_steps(a.seen, cloud);
            // Air becomes thinner by e over this height; 1 - 1/e at kHigh_m.
            high = (1 - std::exp(-over.cloud_top_m() / EarthAspect::kHigh_m)) * 1.5819767f;
        }
    }
    Mix mix{water,
            a.mirrored,
            water * direct * a.glint_sr,
            direct,
            diffuse,
            back,
            cloud > 0,
            share,
            passed,
            high,
            0,
            0,
            0,
            land_.without_snow(ground)};
    if (cloud > 0) {
        mix.many = by_steps(a.many, cloud), mix.once = by_steps(a.share, cloud);
        mix.from_sky = table_->spherical_albedo(cloud);
    }
    Shade out;
    const float lights = lights_ > 0 ? passed * ground.lights() : 0;
    mix_light(a, mix, land, sea_.diffuse(), sea_.albedo(), out.over_sun_sr);
    if (lights > 0) out.lights_w_m2_sr_um = lights * (city_w_m2_sr_um_ * a.seen_low);
    return out;
}

EarthModel::Shade EarthModel::shade_by_parts(const EarthAspect& aspect, const EarthMoment& moment,
                                             int across) const {
    const MapFootprint& f = aspect.footprint;
    // Finer levels would need four times as many tiles. Texels wider than the footprint cannot distinguish
    // its parts.
    if (moment.detail) across = 1;
    if (across > 1) across = std::min(across, static_cast<int>(std::ceil(texels_across(f, moment).shorter)));
    if (across <= 1) return shade(aspect, moment);
    const float share = 1 / static_cast<float>(across);
    EarthAspect part = aspect;
    part.footprint = {share * f.u1, share * f.v1, share * f.u2, share * f.v2};
    Shade sum;
    for (int i = 0; i < across * across; ++i) {
        const float a = share * (static_cast<float>(i % across) + 0.5f) - 0.5f,
                    b = share * (static_cast<float>(i / across) + 0.5f) - 0.5f;
        part.u = aspect.u + a * f.u1 + b * f.u2, part.v = aspect.v + a * f.v1 + b * f.v2;
        const Shade seen = shade(part, moment);
        sum.over_sun_sr += seen.over_sun_sr, sum.lights_w_m2_sr_um += seen.lights_w_m2_sr_um;
    }
    sum.over_sun_sr = (share * share) * sum.over_sun_sr;
    sum.lights_w_m2_sr_um = (share * share) * sum.lights_w_m2_sr_um;
    return sum;
}

// Returns the air along a ray that misses the ground.
Atmosphere::Sight EarthModel::air_past(const Ray& ray) const {
    const Vec3d origin = stretched(kEarthFigure, ray.origin_m),
                dir = normalized(stretched(kEarthFigure, ray.dir)),
                sun = normalized(stretched(kEarthFigure, ray.sun_dir));
    constexpr double kEndless_m = std::numeric_limits<double>::infinity();
    const std::optional<Atmosphere::Sight> seen = columns_->from_space(origin, dir, kEndless_m, sun);
    return seen ? *seen : air_->look(origin, dir, kEndless_m, sun);
}

bool EarthModel::add_bent(const Ray& ray, Spectrum& weight, Spectrum& radiance) const {
    const double to_ground_m = intersect_ellipsoid(kEarthFigure, ray.origin_m, ray.dir);
    if (to_ground_m >= 0) {
        const Shade seen = shade_by_parts(aspect_at(ray, to_ground_m, 0), ray.moment, ray.looks_across);
        radiance += weight * (ray.irradiance_w_m2_um * seen.over_sun_sr + seen.lights_w_m2_sr_um);
        return true;
    }
    // Beyond the limb there is a cloud above the horizon, or only air.
    const double to_level_m =
        table_ ? intersect_ellipsoid(raised(static_cast<double>(kUsualTop_m)), ray.origin_m, ray.dir) : -1;
    if (to_level_m > 0) {
        EarthAspect aspect = aspect_at(ray, to_level_m, static_cast<double>(kUsualTop_m));
        const float cloud = cloud_of(cloud_sample(ray.moment, aspect.u, aspect.v, aspect.footprint));
        if (cloud > kMinCloud) {
            // There is no ground below it, so no light comes from below.
            aspect.seen.fill(0);
            radiance += weight * ray.irradiance_w_m2_um * shade(aspect, ray.moment).over_sun_sr;
            weight = table_->transmitted(cloud, 0) * (weight * aspect.seen_high);
            return false;
        }
    }
    if (air_) {
        const Atmosphere::Sight air = air_past(ray);
        radiance += weight * ray.irradiance_w_m2_um * air.radiance_sr;
        weight = weight * air.transmittance;
    }
    return false;
}

Spectrum EarthModel::disk_albedo(Vec3d camera_dir, Vec3d sun_dir, int looks) const {
    // Parallel rays over the disk of the Earth and its air, on a spiral of equal areas (Vogel, Math. Biosci.
    // 44, 179, 1979).
    const Vec3d side = normalized(std::abs(camera_dir.z) < 0.9 ? cross(camera_dir, Vec3d{0, 0, 1})
                                                               : cross(camera_dir, Vec3d{1, 0, 0}));
    const Vec3d up = cross(side, camera_dir);
    const double radius_m = kEarthFigure.equatorial_radius_m + (air_ ? 60e3 : 0);
    constexpr double kAway_m = 1e9, kGolden = 0.6180339887498949;
    Spectrum sum;
    for (int i = 0; i < looks; ++i) {
        const double r = radius_m * std::sqrt((i + 0.5) / looks), phi = 2 * kPi * kGolden * i;
        Ray ray{kAway_m * camera_dir + r * std::cos(phi) * side + r * std::sin(phi) * up,
                -camera_dir,
                sun_dir,
                0,
                {}};
        ray.width_rad = radius_m * std::sqrt(kPi / looks) / kAway_m;
        for (int b = 0; b < bins_; ++b) ray.irradiance_w_m2_um[b] = 1;
        Spectrum weight;
        weight.bin.fill(1);
        add(ray, weight, sum);
    }
    const double area = kPi * radius_m * radius_m /
                        (looks * kEarthFigure.equatorial_radius_m * kEarthFigure.equatorial_radius_m);
    return static_cast<float>(area) * sum;
}

}  // namespace hilcam
