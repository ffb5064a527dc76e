#pragma once
// The negotiation of a UVC host with the camera before pictures flow: probe and commit of one uncompressed
// format and one frame size (UVC 1.1, 4.3.1.1). It uses no device.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/uvc/uvc_controls.h"

namespace hilcam {

struct UvcStreamShape {
    int width = 0, height = 0;
    std::vector<std::uint32_t> intervals_100ns;  // rising: the fastest rate first
    std::uint32_t preset_100ns = 0;              // one of them: the camera's own rate
    std::uint32_t max_payload_bytes = 1024;      // size of a USB packet

    std::uint32_t frame_bytes() const {
        return static_cast<std::uint32_t>(2 * width) * static_cast<std::uint32_t>(height);
    }
};
// Returns the camera's own rate, and the rates up to the highest that UVC hosts usually offer, as intervals.
std::vector<std::uint32_t> uvc_intervals(double frame_rate_hz, double max_frame_rate_hz);
std::uint32_t uvc_interval(double frame_rate_hz);

class UvcStream {
  public:
    explicit UvcStream(UvcStreamShape shape);

    // Handles a request to the streaming interface, as UvcControls::setup().
    std::optional<UvcAnswer> setup(std::uint8_t selector, std::uint8_t request, std::uint16_t length);
    // Takes the host's choice. After a commit, returns the frame interval to stream with.
    std::optional<std::uint32_t> data(std::span<const std::uint8_t> bytes);

    const UvcStreamShape& shape() const { return shape_; }

  private:
    static constexpr std::size_t kBytes = 34;  // size of the control in UVC 1.1
    UvcAnswer control(std::uint32_t interval_100ns) const;

    UvcStreamShape shape_;
    std::uint32_t probe_100ns_, commit_100ns_;
    std::uint8_t pending_ = 0;
};

}  // namespace hilcam
