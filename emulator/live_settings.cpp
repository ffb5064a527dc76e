#include "emulator/live_settings.h"

#include "emulator/shutter_timing.h"

namespace hilcam {

namespace {

CameraLimits limits_of(const CameraModel& c) {
    const auto [width, height] = frame_size(c);
    CameraLimits limits{width,
                        height,
                        c.frame_bits(),
                        c.exposure_range_s[0],
                        c.exposure_range_s[1],
                        c.gain_range_db[0],
                        c.gain_range_db[1],
                        c.frame_rate_range_hz[0],
                        c.frame_rate_range_hz[1]};
    const ShutterTiming timing(c);
    limits.exposure_is_own = timing.is_fixed() || c.auto_exposure.on || !c.sequence.empty();
    limits.gain_is_own = !c.sequence.empty();
    limits.frame_rate_is_own = timing.is_fixed();
    if (timing.is_fixed()) {
        limits.least_exposure_s = limits.most_exposure_s = timing.exposure_s(c.exposure_s);
        limits.least_frame_rate_hz = limits.most_frame_rate_hz = 1 / timing.period_s(0, 0);
    }
    return limits;
}

CameraSettings at_power_up(const CameraModel& c) {
    const ShutterTiming timing(c);
    return {timing.exposure_s(c.exposure_s), c.gain_db,
            timing.is_fixed() ? 1 / timing.period_s(0, 0) : c.frame_rate_hz, true};
}

}  // namespace

LiveSettings::LiveSettings(const CameraModel& c)
    : limits_(limits_of(c)),
      settings_(at_power_up(c)),
      latest_(settings_),
      own_exposure_s_(settings_.exposure_s),
      own_gain_db_(settings_.gain_db) {}

CameraSettings LiveSettings::settings() const {
    const std::lock_guard lock(mutex_);
    CameraSettings now = settings_;
    if (limits_.exposure_is_own) now.exposure_s = own_exposure_s_.load(std::memory_order_relaxed);
    if (limits_.gain_is_own) now.gain_db = own_gain_db_.load(std::memory_order_relaxed);
    return now;
}

bool LiveSettings::set(double CameraSettings::*member, double value, double least, double most) {
    if (!(value >= least && value <= most)) return false;
    const std::lock_guard lock(mutex_);
    settings_.*member = value;
    latest_.write(settings_);
    return true;
}

bool LiveSettings::set_exposure_s(double value) {
    return !limits_.exposure_is_own &&
           set(&CameraSettings::exposure_s, value, limits_.least_exposure_s, limits_.most_exposure_s);
}
bool LiveSettings::set_gain_db(double value) {
    return !limits_.gain_is_own &&
           set(&CameraSettings::gain_db, value, limits_.least_gain_db, limits_.most_gain_db);
}
bool LiveSettings::set_frame_rate_hz(double value) {
    return !limits_.frame_rate_is_own && set(&CameraSettings::frame_rate_hz, value,
                                             limits_.least_frame_rate_hz, limits_.most_frame_rate_hz);
}
void LiveSettings::set_running(bool running) {
    const std::lock_guard lock(mutex_);
    settings_.running = running;
    latest_.write(settings_);
}

}  // namespace hilcam
