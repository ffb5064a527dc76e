#pragma once
// Removes pixels that are far too bright from a picture before it is convolved; they are drawn as points
// instead. In the FFT the Sun would ring along its rows and columns, and wrap around the picture's edges.
// Light up to a limit stays in the picture.

#include <vector>

#include "render/vocabulary/subpixel_light.h"
#include "sensor/convolution/convolve.h"

namespace hilcam {

// The removed light of a pixel, which is drawn as a point.
struct BrightPixel {
    Vec2d position_px;  // in the detector's frame
    double electrons = 0;
    int channel = 0;
};

class BrightPixels {
  public:
    // Pixels of the radiance image: their number, the border on each side in detector pixels, and image
    // pixels across one detector pixel.
    struct Grid {
        int width, height, guard_px, oversampling;
    };
    // illumination: the lens's factors over the image, row by row; must outlive this object. Owner thread.
    BrightPixels(const Grid& grid, double full_well_e, int channels, const std::vector<float>& illumination);

    // The picture of one channel [e-], and the brightest pixel of each row.
    struct Picture {
        Convolver& charge_e;
        std::span<const float> row_peaks_e;
        int channel;
        const SubpixelLight* moments;  // where light falls within pixels; null: unknown
        double exposure_s;
    };
    // Forgets the pixels of the last frame. Loop; so are all functions below.
    void clear() { pixels_.clear(); }
    // Removes light above ten full wells from each pixel. If there is no room for that many pixels, the limit
    // is multiplied by ten until there is. Returns the limit [e-].
    float take_out(const Picture& picture);
    // Returns the removed light of all channels, one channel after the other.
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
