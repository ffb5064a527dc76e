#include "emulator/motion/keyframes.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

double seconds_between(const Motion& a, const Motion& b) {
    return static_cast<double>(b.time - a.time) * kSecondsPerNs;
}

Vec3d chord(const Motion& a, const Motion& b) {
    return (b.pose.position_world_m - a.pose.position_world_m) / seconds_between(a, b);
}

// Returns the rotation between two attitudes as a rate in body axes, the short way round.
Vec3d rate_between(const Motion& a, const Motion& b) {
    Quat step = conjugate(a.pose.world_from_body) * b.pose.world_from_body;
    if (step.w < 0) step = {-step.w, -step.x, -step.y, -step.z};
    const Vec3d sine{step.x, step.y, step.z};
    const double size = length(sine);
    const double scale = size > 1e-12 ? 2 * std::atan2(size, step.w) / size : 2;
    return (scale / seconds_between(a, b)) * sine;
}

}  // namespace

Keyframes::Keyframes(const std::vector<Keyframe>& keyframes) {
    if (keyframes.empty()) throw refused("keyframes", "none", "one at least");
    Quat attitude;
    for (const Keyframe& k : keyframes) {
        if (!motions_.empty() && k.time <= motions_.back().time)
            throw InputError("keyframes: times do not rise at number " + std::to_string(motions_.size() + 1));
        if (k.attitude) attitude = *k.attitude;
        motions_.push_back({k.time, {k.position_m, attitude}, k.velocity_m_s.value_or(Vec3d{}), {}});
    }
    const std::size_t count = motions_.size();
    for (std::size_t i = 0; i + 1 < count; ++i)
        motions_[i].rate_body_rad_s = rate_between(motions_[i], motions_[i + 1]);
    for (std::size_t i = 0; i < count && count > 1; ++i) {
        if (keyframes[i].velocity_m_s) continue;
        if (i == 0 || i + 1 == count) {
            const std::size_t first = i == 0 ? 0 : count - 2;
            motions_[i].velocity_world_m_s = chord(motions_[first], motions_[first + 1]);
            continue;
        }
        const double to = seconds_between(motions_[i - 1], motions_[i]),
                     from = seconds_between(motions_[i], motions_[i + 1]);
        motions_[i].velocity_world_m_s =
            (from * chord(motions_[i - 1], motions_[i]) + to * chord(motions_[i], motions_[i + 1])) /
            (to + from);
    }
}

const Motion* Keyframes::before(TimeTai time) const {
    if (time < motions_.front().time || !(time < motions_.back().time)) return nullptr;
    const auto after = std::upper_bound(motions_.begin(), motions_.end(), time,
                                        [](TimeTai t, const Motion& m) { return t < m.time; });
    return &*(after - 1);
}

const Motion& Keyframes::nearest(TimeTai time) const {
    return time < motions_.front().time ? motions_.front() : motions_.back();
}

StateVector Keyframes::state_at(TimeTai time) const {
    const Motion* a = before(time);
    if (!a) return {nearest(time).pose.position_world_m, {}};
    const Motion& b = a[1];
    const double span_s = seconds_between(*a, b);
    const double u = static_cast<double>(time - a->time) * kSecondsPerNs / span_s;
    // The derivative of interpolate()'s cubic.
    const Vec3d step = b.pose.position_world_m - a->pose.position_world_m;
    const Vec3d velocity = (6 * u * (1 - u) / span_s) * step +
                           (1 - 4 * u + 3 * u * u) * a->velocity_world_m_s +
                           (3 * u * u - 2 * u) * b.velocity_world_m_s;
    return {interpolate(*a, b, time).position_world_m, velocity};
}

AttitudeState Keyframes::attitude_at(TimeTai time) const {
    const Motion* a = before(time);
    if (!a) return {nearest(time).pose.world_from_body, {}};
    const double dt_s = static_cast<double>(time - a->time) * kSecondsPerNs;
    return {normalized(a->pose.world_from_body * from_rotation_vector(dt_s * a->rate_body_rad_s)),
            a->rate_body_rad_s};
}

}  // namespace hilcam
