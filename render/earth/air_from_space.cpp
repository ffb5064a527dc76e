#include "render/earth/air_from_space.h"

#include "render/earth/air_columns.h"

namespace hilcam {
namespace {

class AirFromSpace final : public Atmosphere {
  public:
    explicit AirFromSpace(std::unique_ptr<Atmosphere> air)
        : air_(std::move(air)), columns_(*air_, std::nullopt) {}

    double top_m() const override { return air_->top_m(); }
    Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        const std::optional<Sight> seen = columns_.from_space(origin_m, dir, distance_m, sun_dir);
        return seen ? *seen : air_->look(origin_m, dir, distance_m, sun_dir);
    }
    Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const override {
        return air_->sun_transmittance(point_m, sun_dir);
    }
    Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const override {
        return air_->sky_irradiance(point_m, sun_dir);
    }
    std::string missing(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const override {
        return air_->missing(origin_m, dir, distance_m, sun_dir);
    }
    std::uint64_t rays_outside() const override { return air_->rays_outside(); }
    const AirRefraction* refraction() const override { return air_->refraction(); }
    std::string describe() const override { return air_->describe() + ", from space by a table"; }

  private:
    std::unique_ptr<Atmosphere> air_;
    AirColumns columns_;
};

}  // namespace

std::unique_ptr<Atmosphere> looked_up_from_space(std::unique_ptr<Atmosphere> air) {
    return std::make_unique<AirFromSpace>(std::move(air));
}

}  // namespace hilcam
