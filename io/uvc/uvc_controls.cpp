#include "io/uvc/uvc_controls.h"

#include <linux/usb/video.h>

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

constexpr double kExposureUnit_s = 100e-6;
constexpr double kGainUnit_db = 0.1;
constexpr std::int64_t kManual = 1, kAperturePriority = 8;
constexpr std::uint8_t kCanGet = 1, kCanSet = 2;

std::int64_t up(double value) { return static_cast<std::int64_t>(std::ceil(value - 1e-9)); }
std::int64_t down(double value) { return static_cast<std::int64_t>(std::floor(value + 1e-9)); }

UvcAnswer number(std::int64_t value, std::size_t bytes) {
    UvcAnswer answer;
    answer.size = bytes;
    for (std::size_t i = 0; i < bytes; ++i)
        answer.bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    return answer;
}

}  // namespace

UvcControls::Numbers UvcControls::numbers_of(Control control) const {
    const CameraSettings s = camera_.settings();
    const CameraLimits l = camera_.limits();
    switch (control) {
        case Control::kAutoExposure: {
            const auto mode = [](bool automatic) { return automatic ? kAperturePriority : kManual; };
            // GET_RES of this control is the set of supported modes.
            const std::int64_t modes = l.has_automatic_exposure ? kManual | kAperturePriority : kManual;
            return {mode(s.automatic_exposure), kManual, modes, modes, mode(initial_.automatic_exposure), 1,
                    l.has_automatic_exposure};
        }
        case Control::kExposure: {
            const auto ticks = [](double seconds) {
                return std::max<std::int64_t>(1, std::llround(seconds / kExposureUnit_s));
            };
            return {ticks(s.exposure_s),
                    std::max<std::int64_t>(1, up(l.min_exposure_s / kExposureUnit_s)),
                    std::max<std::int64_t>(1, down(l.max_exposure_s / kExposureUnit_s)),
                    1,
                    ticks(initial_.exposure_s),
                    4,
                    !l.exposure_is_own};
        }
        case Control::kGain:
            // The control is unsigned: a gain below the camera file's own is not offered.
            return {std::max<std::int64_t>(0, std::llround(s.gain_db / kGainUnit_db)),
                    std::max<std::int64_t>(0, up(l.min_gain_db / kGainUnit_db)),
                    std::max<std::int64_t>(0, down(l.max_gain_db / kGainUnit_db)),
                    1,
                    std::max<std::int64_t>(0, std::llround(initial_.gain_db / kGainUnit_db)),
                    2,
                    !l.gain_is_own};
        case Control::kBrightness:
            return {std::llround(s.black_level_dn),
                    0,
                    std::min<std::int64_t>(32767, down(l.max_black_level_dn)),
                    1,
                    std::llround(initial_.black_level_dn),
                    2,
                    true};
        case Control::kNone:
            break;
    }
    return {};
}

std::optional<UvcAnswer> UvcControls::refuse(Error error) {
    error_ = error;
    ++refusals_;
    return std::nullopt;
}

std::optional<UvcAnswer> UvcControls::setup(std::uint8_t unit, std::uint8_t selector, std::uint8_t request) {
    pending_ = Control::kNone;
    if (unit == 0 && selector == UVC_VC_REQUEST_ERROR_CODE_CONTROL) {
        if (request == UVC_GET_INFO) return number(kCanGet, 1);
        if (request == UVC_GET_CUR) return number(static_cast<std::int64_t>(error_), 1);
        return refuse(Error::kInvalidRequest);
    }
    if (unit != kUvcCameraTerminal && unit != kUvcProcessingUnit) return refuse(Error::kInvalidUnit);
    Control control = Control::kNone;
    if (unit == kUvcCameraTerminal && selector == UVC_CT_AE_MODE_CONTROL) control = Control::kAutoExposure;
    if (unit == kUvcCameraTerminal && selector == UVC_CT_EXPOSURE_TIME_ABSOLUTE_CONTROL)
        control = Control::kExposure;
    if (unit == kUvcProcessingUnit && selector == UVC_PU_GAIN_CONTROL) control = Control::kGain;
    if (unit == kUvcProcessingUnit && selector == UVC_PU_BRIGHTNESS_CONTROL) control = Control::kBrightness;
    if (control == Control::kNone) return refuse(Error::kInvalidControl);

    const Numbers n = numbers_of(control);
    error_ = Error::kNone;
    switch (request) {
        case UVC_GET_CUR:
            return number(n.now, n.bytes);
        case UVC_GET_MIN:
            return number(n.least, n.bytes);
        case UVC_GET_MAX:
            return number(n.most, n.bytes);
        case UVC_GET_RES:
            return number(n.step, n.bytes);
        case UVC_GET_DEF:
            return number(n.preset, n.bytes);
        case UVC_GET_LEN:
            return number(static_cast<std::int64_t>(n.bytes), 2);
        case UVC_GET_INFO:
            return number(n.settable ? kCanGet | kCanSet : kCanGet, 1);
        case UVC_SET_CUR:
            if (!n.settable) return refuse(Error::kWrongState);
            pending_ = control;
            return UvcAnswer{};
        default:
            return refuse(Error::kInvalidRequest);
    }
}

bool UvcControls::data(std::span<const std::uint8_t> bytes) {
    const Control control = pending_;
    pending_ = Control::kNone;
    const Numbers n = numbers_of(control);
    if (control == Control::kNone || bytes.size() < n.bytes) {
        refuse(Error::kInvalidRequest);
        return false;
    }
    std::int64_t value = 0;
    for (std::size_t i = 0; i < n.bytes; ++i) value |= std::int64_t{bytes[i]} << (8 * i);
    if (control == Control::kBrightness) value = static_cast<std::int16_t>(value);
    if (!apply(control, value)) {
        refuse(Error::kOutOfRange);
        return false;
    }
    ++changes_;
    return true;
}

bool UvcControls::apply(Control control, std::int64_t value) {
    SettingsChange change;
    switch (control) {
        case Control::kAutoExposure:
            if (value != kManual && value != kAperturePriority) return false;
            change.automatic_exposure = value == kAperturePriority;
            break;
        case Control::kExposure:
            change.exposure_s = static_cast<double>(value) * kExposureUnit_s;
            break;
        case Control::kGain:
            change.gain_db = static_cast<double>(value) * kGainUnit_db;
            break;
        case Control::kBrightness:
            change.black_level_dn = static_cast<double>(value);
            break;
        case Control::kNone:
            return false;
    }
    return camera_.change(change);
}

}  // namespace hilcam
