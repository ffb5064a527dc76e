#include "render/scene/lamp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

LampBeam LampBeam::of_angle(double full_rad) {
    HILCAM_CHECK(full_rad > 0 && full_rad < kPi);
    LampBeam beam;
    // The logarithm of the cosine by the sine: it keeps its digits where the beam is narrow.
    const double sine = std::sin(0.5 * full_rad);
    beam.power_ = std::log(0.5) / (0.5 * std::log1p(-sine * sine));
    beam.in_front_only_ = true;
    return beam;
}

LampBeam LampBeam::of_table(Table by_angle_rad) {
    HILCAM_CHECK(!by_angle_rad.empty());
    LampBeam beam;
    beam.by_angle_ = std::move(by_angle_rad);
    return beam;
}

double LampBeam::at(Vec3d axis, Vec3d dir) const {
    const double cosine = dot(axis, dir);
    const Vec3d across = cross(axis, dir);
    const double sine_squared = std::min(1.0, dot(across, across));
    if (!by_angle_.empty()) {
        const double theta_rad = std::atan2(std::sqrt(sine_squared), cosine);
        return theta_rad <= by_angle_.x.back() ? by_angle_.at(theta_rad) : 0;
    }
    if (!in_front_only_) return 1;
    return cosine > 0 ? std::exp(power_ * 0.5 * std::log1p(-sine_squared)) : 0;
}

void ShownLamps::resize(std::size_t size) {
    HILCAM_CHECK(size <= kMaxLamps);
    size_ = size;
}

}  // namespace hilcam
