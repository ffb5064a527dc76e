#pragma once
// The image format: window, binning, pixel format, mirroring, test pattern, chunks, parts. The window is
// always inside the (binned) sensor. With a colour filter array it begins on even pixels and has even sizes,
// so that its pattern stays that of the pixel format. A window that does not fit is refused: clients set the
// offsets to 0 first, as with other cameras.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeImage {
  public:
    explicit GigeImage(GigeCore& core);

    // Returns the step of offsets and sizes.
    static std::uint32_t step(const CameraLimits& limits) { return limits.color_pattern.empty() ? 1 : 2; }
    void reset();  // the whole sensor in the camera's own format, no chunks
    // Follows a change of binning from elsewhere. While the geometry is locked, the window stays, and frames
    // with another binning are not part of the stream.
    void follow_binning();
    // Fits the window into the binned sensor.
    void fit();

  private:
    void add_window();
    void add_camera_settings();
    void add_chunks();
    void add_components();
    struct Span {
        std::uint32_t& offset;
        std::uint32_t& size;
        std::uint32_t most;
    };
    Span columns();
    Span rows();
    gvcp::Status write_size(Span span, std::uint64_t value);
    gvcp::Status write_offset(Span span, std::uint64_t value);
    gvcp::Status write_binning(std::uint64_t x, std::uint64_t y);
    gvcp::Status write_format(std::uint64_t code);
    std::uint32_t payload_bytes() const;

    GigeCore& core_;
    std::uint32_t chunk_selector_ = 0, component_selector_ = 0;
};

}  // namespace hilcam
