#include "emulator/motion/ephemeris.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/node_polynomial.h"

namespace hilcam {
namespace {

// A window of samples around an instant. Time is counted from its middle in units of half its width, so that
// time differences are neither huge nor tiny and divided differences keep their digits.
template <class Sample>
struct Window {
    std::span<const Sample> samples;
    TimeTai middle;
    double half_s;

    double scaled(TimeTai time) const { return static_cast<double>(time - middle) * kSecondsPerNs / half_s; }
};

template <class Sample>
Window<Sample> window_of(const std::vector<Sample>& all, TimeTai time, std::size_t count) {
    const auto after =
        std::upper_bound(all.begin(), all.end(), time, [](TimeTai t, const Sample& s) { return t < s.time; });
    const std::size_t start = window_start(static_cast<std::size_t>(after - all.begin()), count, all.size());
    const std::span<const Sample> samples(all.data() + start, count);
    const std::int64_t length_ns = samples.back().time - samples.front().time;
    return {samples, samples.front().time + length_ns / 2,
            0.5 * static_cast<double>(length_ns) * kSecondsPerNs};
}

// Returns the interpolation for a message that does not specify one.
Interpolation chosen(const OemSegment& s) {
    if (s.interpolation.method != InterpolationMethod::kUnsaid) return s.interpolation;
    const int most = static_cast<int>(std::min<std::size_t>(4, s.states.size()));
    return {InterpolationMethod::kHermite, 2 * most - 1};
}

StateVector hermite(const Window<StateSample>& w, TimeTai time) {
    std::array<Node<3>, kMaxNodes> nodes;
    for (std::size_t i = 0; i < w.samples.size(); ++i) {
        const Vec3d& p = w.samples[i].position_m;
        const Vec3d v = w.half_s * w.samples[i].velocity_m_s;
        nodes[i] = {w.scaled(w.samples[i].time), {p.x, p.y, p.z}, {v.x, v.y, v.z}};
    }
    const auto out = polynomial_at<3>({nodes.data(), w.samples.size()}, true, w.scaled(time));
    return {{out.value[0], out.value[1], out.value[2]},
            Vec3d{out.rate[0], out.rate[1], out.rate[2]} / w.half_s};
}

StateVector lagrange(const Window<StateSample>& w, TimeTai time) {
    std::array<Node<6>, kMaxNodes> nodes;
    for (std::size_t i = 0; i < w.samples.size(); ++i) {
        const Vec3d& p = w.samples[i].position_m;
        const Vec3d& v = w.samples[i].velocity_m_s;
        nodes[i] = {w.scaled(w.samples[i].time), {p.x, p.y, p.z, v.x, v.y, v.z}, {}};
    }
    const auto out = polynomial_at<6>({nodes.data(), w.samples.size()}, false, w.scaled(time)).value;
    return {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
}

// Turns at a constant rate between two attitudes.
ReferenceAttitude turned(const AttitudeSample& a, const AttitudeSample& b, TimeTai time) {
    const double span_s = static_cast<double>(b.time - a.time) * kSecondsPerNs;
    const double u = static_cast<double>(time - a.time) * kSecondsPerNs / span_s;
    Quat step = conjugate(a.reference_from_body) * b.reference_from_body;
    if (step.w < 0) step = {-step.w, -step.x, -step.y, -step.z};
    const Vec3d sine{step.x, step.y, step.z};
    const double size = length(sine);
    // angle / sin(angle / 2) tends to 2.
    const Vec3d turn = (size > 1e-12 ? 2 * std::atan2(size, step.w) / size : 2.0) * sine;
    return {normalized(a.reference_from_body * from_rotation_vector(u * turn)), turn / span_s};
}

}  // namespace

StateVector interpolate_state(const OemSegment& s, TimeTai time) {
    const Interpolation how = chosen(s);
    const auto count = static_cast<std::size_t>(interpolation_nodes(how));
    const Window<StateSample> w = window_of(s.states, time, count);
    return how.method == InterpolationMethod::kHermite ? hermite(w, time) : lagrange(w, time);
}

ReferenceAttitude interpolate_attitude(const AemSegment& s, TimeTai time) {
    const auto count = static_cast<std::size_t>(interpolation_nodes(s));
    const Window<AttitudeSample> w = window_of(s.attitudes, time, count);
    const InterpolationMethod method = s.interpolation.method;
    if (method == InterpolationMethod::kUnsaid || method == InterpolationMethod::kLinear)
        return turned(w.samples[0], w.samples[1], time);
    const bool with_rates = method == InterpolationMethod::kHermite && s.has_rates;
    std::array<Node<4>, kMaxNodes> nodes;
    for (std::size_t i = 0; i < w.samples.size(); ++i) {
        const Quat& q = w.samples[i].reference_from_body;
        const Vec3d half = (0.5 * w.half_s) * w.samples[i].rate_body_rad_s;
        const Quat rate = q * Quat{0, half.x, half.y, half.z};  // dq/dt = q omega / 2
        nodes[i] = {w.scaled(w.samples[i].time), {q.w, q.x, q.y, q.z}, {rate.w, rate.x, rate.y, rate.z}};
    }
    const auto out = polynomial_at<4>({nodes.data(), w.samples.size()}, with_rates, w.scaled(time));
    const Quat q{out.value[0], out.value[1], out.value[2], out.value[3]};
    const double size = norm(q);
    const Quat unit = normalized(q);
    // omega = 2 q* dq/dt. The part of dq/dt along q only changes the norm and is left out.
    const Quat w2 = conjugate(unit) * Quat{out.rate[0], out.rate[1], out.rate[2], out.rate[3]};
    return {unit, Vec3d{w2.x, w2.y, w2.z} * (2 / (size * w.half_s))};
}

}  // namespace hilcam
