#pragma once
// An 8-bit picture of a frame for the eye: from the camera's black level to a white level found in the frame,
// with gamma 2.2. The frame itself is linear and mostly dark; viewers show its 12-bit numbers in 16 bits as
// black.
//
// White is the 99.5 % quantile of the lit pixels, those brighter than black by more than 1/64 of the range
// from black to saturation. It is at least 1/16 of that range above black, so that a dark frame does not
// become a picture of its noise, and at most saturation. Empty space around a small target does not count,
// and a glint does not darken the rest.
//
// A colour filter array is interpolated bilinearly and balanced, so that a white surface in sunlight looks
// white; its white level is found in the balanced colours. Saturated pixels are white, too. Companded numbers
// are expanded first.

#include <array>
#include <vector>

#include "io/images/picture_codecs.h"
#include "io/images/picture_notes.h"
#include "sensor/auto_exposure.h"

namespace hilcam {

struct ViewLevels {
    double black_dn = 0, white_dn = 4095;
};

class PictureView {
  public:
    explicit PictureView(const PictureRun& run);

    // Returns the levels of a frame. scale: the frame's dn_scale_of(). Any thread, one at a time.
    ViewLevels levels_of(const DnImage& frame, const DnScale& scale) const;
    // Makes the picture; it stays valid until the next call. record: how the frame was taken. Owner thread.
    PictureSamples make(const DnImage& frame, const FrameRecord& record);
    // Returns the picture as PNG with the frame's notes and the levels.
    std::string png(const DnImage& frame, const FrameRecord& record, PictureNotes notes);

  private:
    // Returns the levels of the interpolated, balanced colours.
    ViewLevels levels_of_colors(const DnScale& scale) const;

    const CameraModel model_;
    std::string pattern_;
    std::array<double, 3> balance_ = {1, 1, 1};  // red, green, blue: the smallest is 1
    ViewLevels levels_;
    std::vector<std::uint8_t> samples_;
    std::vector<std::uint16_t> colors_, row_;
};

}  // namespace hilcam
