#pragma once
// A frame for eyes and viewers: 8 bits, from the camera's black level to a white level taken from the frame,
// by gamma 2.2. The frame itself is linear and mostly dark: a viewer shows 12-bit numbers in 16 bits as
// black.
//
// White is the level below which 99.5 % of the lit pixels lie: of those that are brighter than black by more
// than a 64th of the way from black to saturation. It is never nearer to black than a 16th of that way, so
// that a dark frame does not become a picture of its noise, and never above saturation. Space around a small
// target does not count, and a glint does not darken the rest.
//
// A colour filter array is interpolated (bilinear) and balanced so that a white surface in sunlight is white; its white is
// the level of the balanced colours. What saturates is white, too. Numbers that a camera has companded are taken back first.

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

    // scale: dn_scale_of() the frame. Any thread, one at a time.
    ViewLevels levels_of(const DnImage& frame, const DnScale& scale) const;
    // Valid until the next call. record: how the frame was taken. Owner thread.
    PictureSamples make(const DnImage& frame, const FrameRecord& record);
    // A PNG with the frame's notes and the levels.
    std::string png(const DnImage& frame, const FrameRecord& record, PictureNotes notes);

  private:
    // Those of the interpolated colours, balanced.
    ViewLevels levels_of_colors(const DnScale& scale) const;

    const CameraModel model_;
    std::string pattern_;
    std::array<double, 3> balance_ = {1, 1, 1};  // red, green, blue: the least is 1
    ViewLevels levels_;
    std::vector<std::uint8_t> samples_;
    std::vector<std::uint16_t> colors_, row_;
};

}  // namespace hilcam
