#pragma once
// Maps USB Video Class controls (UVC 1.1, USB-IF 2005, 4.2.2) to the camera's settings: class requests in,
// answers out. It calls CameraControl and no device.
//
//  auto-exposure mode          1 manual, 8 aperture priority: the camera's automatic exposure
//  exposure time, absolute     [100 us]
//  gain                        [0.1 dB]
//  brightness                  black level [DN]
//
// Kernels before 6.4 show hosts only the first and the last (uvc_gadget.h). All numbers are little-endian.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "io/contract/camera_control.h"

namespace hilcam {

// The units that the kernel's UVC function describes.
inline constexpr std::uint8_t kUvcCameraTerminal = 1;
inline constexpr std::uint8_t kUvcProcessingUnit = 2;

struct UvcAnswer {
    std::array<std::uint8_t, 60> bytes{};
    std::size_t size = 0;
};

class UvcControls {
  public:
    explicit UvcControls(CameraControl& camera) : camera_(camera) {}

    // Handles a request to a unit of the control interface (0: the interface itself). An empty answer to
    // SET_CUR means that the data follow through data(). Nothing: the request is refused (a stall), and the
    // Request Error Code Control has the reason.
    std::optional<UvcAnswer> setup(std::uint8_t unit, std::uint8_t selector, std::uint8_t request);
    // Takes the data of the last SET_CUR. False: refused, and nothing has changed.
    bool data(std::span<const std::uint8_t> bytes);

    std::uint64_t changes() const { return changes_; }
    std::uint64_t refusals() const { return refusals_; }

  private:
    enum class Control : std::uint8_t { kNone, kAutoExposure, kExposure, kGain, kBrightness };
    struct Numbers {
        std::int64_t now = 0, least = 0, most = 0, step = 1, preset = 0;
        std::size_t bytes = 2;
        bool settable = true;
    };
    // UVC 1.1, 4.2.1.2: Request Error Code Control.
    enum class Error : std::uint8_t {
        kNone = 0,
        kWrongState = 2,
        kOutOfRange = 4,
        kInvalidUnit = 5,
        kInvalidControl = 6,
        kInvalidRequest = 7
    };

    Numbers numbers_of(Control control) const;
    std::optional<UvcAnswer> refuse(Error error);
    bool apply(Control control, std::int64_t value);

    CameraControl& camera_;
    CameraSettings initial_ = camera_.settings();
    Control pending_ = Control::kNone;
    Error error_ = Error::kNone;
    std::uint64_t changes_ = 0, refusals_ = 0;
};

}  // namespace hilcam
