#pragma once
// A camera that does nothing but hold settings: for tests of what drives one.

#include "io/contract/camera_control.h"

namespace hilcam {

struct QuietCamera : CameraControl {
    CameraSettings now{.exposure_s = 0.01, .frame_rate_hz = 10};
    std::string pattern;
    bool accepts = true;
    int changes = 0;

    CameraSettings settings() const override { return now; }
    CameraLimits limits() const override {
        CameraLimits limits;
        limits.color_pattern = pattern;
        limits.bits = 12;
        limits.min_exposure_s = 1e-5;
        limits.max_exposure_s = 0.1;
        limits.max_gain_db = 24;
        limits.max_black_level_dn = 1000;
        limits.min_frame_rate_hz = 0.1;
        limits.max_frame_rate_hz = 50;
        limits.has_automatic_exposure = true;
        return limits;
    }
    bool change(const SettingsChange& c) override {
        if (!accepts) return false;
        ++changes;
        if (c.exposure_s) now.exposure_s = *c.exposure_s;
        if (c.gain_db) now.gain_db = *c.gain_db;
        if (c.black_level_dn) now.black_level_dn = *c.black_level_dn;
        if (c.frame_rate_hz) now.frame_rate_hz = *c.frame_rate_hz;
        if (c.automatic_exposure) now.automatic_exposure = *c.automatic_exposure;
        return true;
    }
    TriggerResult trigger(const TriggerOrder&) override { return TriggerResult::kNotArmed; }
};

}  // namespace hilcam
