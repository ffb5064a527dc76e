#pragma once
// Takes what is far too bright out of a picture before it is convolved, to be drawn as points: in the FFT the Sun would
// ring along its rows and columns and come back over the picture's edges. The limit stays in the picture.

#include <vector>

#include "render/vocabulary/subpixel_light.h"
#include "sensor/convolution/convolve.h"

namespace hilcam {

// A pixel of the picture that is drawn as a point.
struct BrightPixel {
    Vec2d position_px;  // place in the detector's frame
    double electrons = 0;
    int channel = 0;
};

class BrightPixels {
  public:
    // The radiance image's pixels: how many, the border on each side in pixels of the detector, and how many of them
    // are across one of the detector.
    struct Grid {
        int width, height, guard_px, oversampling;
    };
    // illumination: the lens' factors over the image, row by row; outlives it. Owner thread.
    BrightPixels(const Grid& grid, double full_well_e, int channels, const std::vector<float>& illumination);

    // One channel's picture [e-], and the brightest pixel of each of its rows.
    struct Picture {
        Convolver& charge_e;
        std::span<const float> row_peaks_e;
        int channel;
        const SubpixelLight* moments;  // where in them light falls; null: nobody knows
        double exposure_s;
    };
    // Forgets the last frame's. Loop, as all from here on.
    void clear() { pixels_.clear(); }
    // Takes out what is over ten full wells; where that is of more pixels than there is room for, over ten times as much,
    // and so on. Returns the limit [e-].
    float take_out(const Picture& picture);
    // Those of all channels, each channel's after the one before.
    std::span<const BrightPixel> all() const { return pixels_; }

  private:
    Grid grid_;
    float limit_e_;
    const std::vector<float>& illumination_;
    std::vector<BrightPixel> pixels_;

    bool find_over(const Picture& picture, float limit_e, std::size_t before);
    Vec2d place_of(const Picture& picture, int x, int y, float charge_e) const;
    double detector_px(int padded) const { return (padded + 0.5) / grid_.oversampling - grid_.guard_px; }
};

}  // namespace hilcam
