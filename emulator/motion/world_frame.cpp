#include "emulator/motion/world_frame.h"

#include <array>

#include "render/sky/body_source.h"
#include "render/sky/earth_frames.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// km^3/s^2, in the order of BodyId.
constexpr std::array<double, kBodyCount> kGravity_km3_s2 = {22031.868551,  324858.592000,  398600.435507,
                                                            4902.800118,   42828.375816,   126712764.100,
                                                            37940584.8418, 5794556.400000, 6836527.100580};
constexpr double kSunGravity_km3_s2 = 132712440041.279419;

}  // namespace

double gravity_m3_s2(const OrbitCenter& center) {
    return 1e9 * (center.body ? kGravity_km3_s2[index_of(*center.body)] : kSunGravity_km3_s2);
}

TurningAxes WorldFrame::body_fixed(BodyId body) const {
    const bool by_kernels = origin_.source && origin_.source->fixed_from_icrf(body, time_);
    if (body == BodyId::kEarth && !by_kernels) {
        if (!earth_)
            earth_ = {transposed(earth_fixed_from_icrf(time_, origin_.earth)),
                      earth_rate_rad_s(time_, origin_.earth)};
        return *earth_;
    }
    // Other bodies turn about a pole that hardly moves for days, so a difference over a minute is good to
    // 1e-9 of the rate.
    constexpr std::int64_t kStep_ns = 30'000'000'000;
    const Mat3d before = body_fixed_from_icrf(body, time_ + -kStep_ns, origin_),
                after = body_fixed_from_icrf(body, time_ + kStep_ns, origin_);
    const Mat3d turn = transposed(after) * before;
    const Quat q = to_quat(turn);
    const Vec3d sine{q.x, q.y, q.z};
    const double size = length(sine);
    const double angle = 2 * std::atan2(size, q.w);
    const double per_s = 1 / (2 * kStep_ns * kSecondsPerNs);
    const Vec3d rate = size > 0 ? (angle / size * per_s) * sine : Vec3d{};
    return {transposed(body_fixed_from_icrf(body, time_, origin_)), rate};
}

Mat3d WorldFrame::icrf_from_teme() const { return hilcam::icrf_from_teme(time_, origin_.earth); }

TurningAxes WorldFrame::earth_rotated() const {
    return {transposed(earth_rotated_from_icrf(time_, origin_.earth)),
            earth_rate_rad_s(time_, origin_.earth)};
}

StateVector WorldFrame::center(const OrbitCenter& center) const {
    const std::optional<BodyId> home = origin_.center();
    if (!origin_state_) {
        origin_state_ = StateVector{};
        if (origin_.turns()) {
            const TurningAxes axes = body_fixed(*home);
            const Vec3d place = axes.icrf_from_axes * body_fixed_position_m(*home, origin_.place);
            origin_state_ = {place, cross(axes.rate_rad_s, place)};
        }
    }
    StateVector out{-origin_state_->position_m, -origin_state_->velocity_m_s};
    if (center.body && center.body == home) return out;
    const StateVector from = origin_from_sun(time_, origin_);
    StateVector to;
    if (center.body) to = heliocentric(*center.body, time_, origin_);
    out.position_m = out.position_m + (to.position_m - from.position_m);
    out.velocity_m_s = out.velocity_m_s + (to.velocity_m_s - from.velocity_m_s);
    return out;
}

TurningAxes lvlh_axes(const StateVector& s) {
    const double r2 = dot(s.position_m, s.position_m);
    const Vec3d momentum = cross(s.position_m, s.velocity_m_s);
    // Below 1e-9 of the largest possible value, rounding makes the plane meaningless.
    if (!(length(momentum) > 1e-9 * std::sqrt(r2) * length(s.velocity_m_s)) || !(length(momentum) > 0))
        return {};
    const Vec3d z = -normalized(s.position_m), y = -normalized(momentum);
    return {transposed(Mat3d{cross(y, z), y, z}), momentum / r2};
}

}  // namespace hilcam
