#include "emulator/loop/shutter_timing.h"

#include <algorithm>

namespace hilcam {

ShutterTiming::ShutterTiming(const CameraModel& camera)
    : kind_(camera.shutter.kind),
      rows_(window_of(camera).height),
      line_time_s_(camera.shutter.line_time_s),
      stages_(static_cast<double>(camera.shutter.tdi_stages)) {
    for (const SettingsStep& step : camera.sequence)
        longest_step_s_ = std::max(longest_step_s_, step.exposure_s);
}

double ShutterTiming::end_s(double exposure_s) const {
    switch (kind_) {
        case ShutterKind::kRolling:
            return exposure_s + (rows_ - 1) * line_time_s_;
        case ShutterKind::kLineScan:
            return rows_ * line_time_s_;
        case ShutterKind::kGlobal:
        case ShutterKind::kFrameTransfer:
            break;
    }
    return exposure_s;
}

double ShutterTiming::middle_s(double exposure_s) const { return 0.5 * end_s(exposure_s); }

double ShutterTiming::longest_exposure_s(double exposure_s) const {
    return std::max(exposure_s, longest_step_s_);
}

double ShutterTiming::busy_s(double exposure_s) const {
    if (is_fixed()) return rows_ * line_time_s_;
    const double rows_s = kind_ == ShutterKind::kRolling ? rows_ * line_time_s_ : 0;
    return std::max(longest_exposure_s(exposure_s), rows_s);
}

double ShutterTiming::period_s(double frame_rate_hz, double exposure_s) const {
    return is_fixed() ? busy_s(exposure_s) : std::max(1 / frame_rate_hz, busy_s(exposure_s));
}

double ShutterTiming::period_with_readout_s(double max_frame_rate_hz, double exposure_s) const {
    if (is_fixed()) return busy_s(exposure_s);
    const double end = end_s(longest_exposure_s(exposure_s));
    return kind_ == ShutterKind::kRolling ? std::max(end, 1 / max_frame_rate_hz)
                                          : end + 1 / max_frame_rate_hz;
}

}  // namespace hilcam
