#include "emulator/motion/attitude_jitter.h"

#include <cmath>

#include "emulator/motion/motion_source.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/random.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(JitterBand& j) {
    return {
        vector3("rms_arcsec", j.rms_rad, kArcsecond_rad, {0, 36000}, "rms jitter about each body axis"),
        number("min_hz", j.min_hz, 1, {0, 1e5}, "lower end of the flat spectrum"),
        number("max_hz", j.max_hz, 1, {1e-6, 1e5}, "upper end of the flat spectrum"),
    };
}

void validate(const JitterBand& j) {
    if (!(j.min_hz < j.max_hz))
        throw InputError("min_hz: found " + std::to_string(j.min_hz) + "; accepted: below max_hz, " +
                         std::to_string(j.max_hz));
}

AttitudeJitter::AttitudeJitter(const JitterBand& band, std::uint64_t seed, std::uint32_t thing, TimeTai start)
    : start_(start) {
    if (!(length(band.rms_rad) > 0)) return;
    const double share = 1 / std::sqrt(static_cast<double>(kSinusoids));
    const auto draw = [&](std::uint32_t i, std::uint32_t axis, double rms_rad, double& amplitude_rad,
                          double& rate_rad_s, double& phase_rad) {
        const auto words = random_words({seed, 0}, RandomPurpose::kAttitude, i, thing * 3 + axis);
        const auto uniform = [&](std::size_t w) { return static_cast<double>(uniform01(words[w])); };
        const double part = (static_cast<double>(i) + uniform(0)) / kSinusoids;
        rate_rad_s = 2 * kPi * (band.min_hz + part * (band.max_hz - band.min_hz));
        // Two Gaussian quadratures with the same deviation have a Rayleigh amplitude and a uniform phase.
        amplitude_rad = rms_rad * share * std::sqrt(-2 * std::log(uniform(1)));
        phase_rad = 2 * kPi * uniform(2);
    };
    for (std::uint32_t i = 0; i < kSinusoids; ++i) {
        Sinusoid s;
        draw(i, 0, band.rms_rad.x, s.amplitude_rad.x, s.rate_rad_s.x, s.phase_rad.x);
        draw(i, 1, band.rms_rad.y, s.amplitude_rad.y, s.rate_rad_s.y, s.phase_rad.y);
        draw(i, 2, band.rms_rad.z, s.amplitude_rad.z, s.rate_rad_s.z, s.phase_rad.z);
        sinusoids_.push_back(s);
    }
}

AttitudeState AttitudeJitter::applied(Quat world_from_body, Vec3d rate_body_rad_s, TimeTai time) const {
    if (sinusoids_.empty()) return {world_from_body, rate_body_rad_s};
    const double t_s = static_cast<double>(time - start_) * kSecondsPerNs;
    Vec3d angle, rate;
    const auto add = [t_s](double amplitude, double frequency, double phase, double& sum, double& sum_rate) {
        const double argument = std::fmod(frequency * t_s, 2 * kPi) + phase;
        sum += amplitude * std::cos(argument);
        sum_rate -= amplitude * frequency * std::sin(argument);
    };
    for (const Sinusoid& s : sinusoids_) {
        add(s.amplitude_rad.x, s.rate_rad_s.x, s.phase_rad.x, angle.x, rate.x);
        add(s.amplitude_rad.y, s.rate_rad_s.y, s.phase_rad.y, angle.y, rate.y);
        add(s.amplitude_rad.z, s.rate_rad_s.z, s.phase_rad.z, angle.z, rate.z);
    }
    const Quat turn = from_rotation_vector(angle);
    return {normalized(world_from_body * turn), to_matrix(conjugate(turn)) * rate_body_rad_s + rate};
}

}  // namespace hilcam
