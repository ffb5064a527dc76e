#pragma once
// A camera without a picture that takes every trigger and keeps it.

#include <vector>

#include "io/contract/camera_control.h"

namespace hilcam {

class WiredCamera : public CameraControl {
  public:
    CameraSettings s{
        .exposure_s = 0.001, .frame_rate_hz = 30, .triggered = true, .trigger_source = TriggerSource::kLine0};
    CameraLimits l{.min_exposure_s = 1e-5, .max_exposure_s = 0.5};
    std::vector<TriggerOrder> orders;
    TriggerResult result = TriggerResult::kTaken;
    std::int64_t ready_ns = 0;

    CameraSettings settings() const override { return s; }
    CameraLimits limits() const override { return l; }
    bool change(const SettingsChange& c) override { return apply(c, s), true; }
    TriggerResult trigger(const TriggerOrder& order) override {
        if (order.source != s.trigger_source) return TriggerResult::kNotArmed;
        orders.push_back(order);
        return result;
    }
    std::int64_t trigger_ready_ns() const override { return s.triggered ? ready_ns : kNeverReady_ns; }
};

inline constexpr std::int64_t kMicrosecond_ns = 1'000, kMilli_ns = 1'000'000;

}  // namespace hilcam
