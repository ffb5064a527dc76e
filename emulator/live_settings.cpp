#include "emulator/live_settings.h"

namespace hilcam {

LiveSettings::LiveSettings(const CameraModel& c)
    : limits_{frame_size(c)[0],      frame_size(c)[1],         c.frame_bits(),
              c.exposure_range_s[0], c.exposure_range_s[1],    c.gain_range_db[0],
              c.gain_range_db[1],    c.frame_rate_range_hz[0], c.frame_rate_range_hz[1]},
      settings_{c.exposure_s, c.gain_db, c.frame_rate_hz, true},
      latest_(settings_) {}

CameraSettings LiveSettings::settings() const {
    const std::lock_guard lock(mutex_);
    return settings_;
}

bool LiveSettings::set(double CameraSettings::*member, double value, double least, double most) {
    if (!(value >= least && value <= most)) return false;
    const std::lock_guard lock(mutex_);
    settings_.*member = value;
    latest_.write(settings_);
    return true;
}

bool LiveSettings::set_exposure_s(double value) {
    return set(&CameraSettings::exposure_s, value, limits_.least_exposure_s, limits_.most_exposure_s);
}
bool LiveSettings::set_gain_db(double value) {
    return set(&CameraSettings::gain_db, value, limits_.least_gain_db, limits_.most_gain_db);
}
bool LiveSettings::set_frame_rate_hz(double value) {
    return set(&CameraSettings::frame_rate_hz, value, limits_.least_frame_rate_hz,
               limits_.most_frame_rate_hz);
}
void LiveSettings::set_running(bool running) {
    const std::lock_guard lock(mutex_);
    settings_.running = running;
    latest_.write(settings_);
}

}  // namespace hilcam
