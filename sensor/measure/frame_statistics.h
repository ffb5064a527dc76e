#pragma once
// Frames of one scene and one setting are summed up here, pixel by pixel and all together: the raw material
// of emva1288.h. Symbols in comments are those of EMVA Standard 1288, Release 4.0 Linear, 2021.
//
// A selection is a rectangle of the frame and which of its pixels count: those of one colour filter, without
// defects. All figures are in DN. Nothing here knows light, charge or time.

#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image.h"

namespace hilcam {

struct PixelSelection {
    int left = 0, top = 0, width = 0, height = 0;  // [px of the frame]
    std::vector<std::uint8_t> use;                 // pixels of the rectangle, row by row; 1: counts

    PixelSelection() = default;
    PixelSelection(int left_px, int top_px, int width_px, int height_px)
        : left(left_px),
          top(top_px),
          width(width_px),
          height(height_px),
          use(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 1) {}
    std::size_t count() const;
};

// A value and the standard deviation of its error.
struct Measured {
    double value = 0;
    double uncertainty = 0;
};

// Statistics over pairs of frames: mean mu_y and temporal variance sigma_y^2 = mean d^2 / 2, d the difference
// of a pair (section 6.1), which leaves out all that stays from frame to frame. The standard takes (mean d)^2
// off because lamps drift; this lamp does not, and what is common to a frame is noise. A part of the variance
// may be common to a row, another to the frame.
struct TemporalStatistics {
    Measured mean_dn;
    Measured variance_dn2;
    double row_dn2 = 0;    // the part of the variance that is common to a row, the frame's apart
    double frame_dn2 = 0;  // the part that is common to the frame
    int pairs = 0;

    double pixel_dn2() const { return variance_dn2.value - row_dn2 - frame_dn2; }
};

class PairSeries {
  public:
    explicit PairSeries(const PixelSelection& selection) : selection_(selection) {}
    // Two frames of the same setting. Owner thread.
    void add(const DnImage& a, const DnImage& b);
    TemporalStatistics result() const;

  private:
    const PixelSelection& selection_;
    double sum_ = 0, square_ = 0, row_ = 0, frame_ = 0;  // over the pairs
    int pairs_ = 0;
};

// Frames of one setting, added up pixel by pixel.
class FrameStack {
  public:
    explicit FrameStack(const PixelSelection& selection);
    void add(const DnImage& frame);
    int frames() const { return frames_; }
    // Returns the means of the selection's rectangle; pixels that do not count are included.
    std::vector<double> mean_dn() const;
    std::vector<double> temporal_variance_dn2() const;

  private:
    int left_, top_, width_, height_, frames_ = 0;
    std::vector<double> sum_, square_;
};

// Spatial variances s^2 of an image split into what a row, a column and a single pixel has for itself
// (section 8.2: s^2_row, s^2_col, s^2_pixel). May be negative when there is nothing but chance.
struct SpatialParts {
    double total = 0, row = 0, column = 0, pixel = 0;
    double rows = 0, columns = 0, pixels = 0;  // number of values that were averaged
};
SpatialParts spatial_parts(std::span<const double> image, const PixelSelection& selection);

// A surface of low order through the pixels that count: sum over i + j <= order of a_ij x^i y^j, x and y from
// -1 to 1 over the rectangle. For what changes slowly: the lens's shading.
std::vector<double> smooth_surface(std::span<const double> image, const PixelSelection& selection, int order);

// Takes pixels out of the selection that lie farther than `sigmas` standard deviations from the median of
// those that count; the standard deviation is 1.4826 times the median deviation, which outliers do not move
// (Hampel, J. Amer. Statist. Assoc. 69, 1974). Returns how many.
std::size_t exclude_outliers(std::span<const double> image, double sigmas, PixelSelection& selection);

// The reach says what a filter leaves of white noise: sigma^2 of a pixel over the sum of its autocovariances
// with neighbours up to so many columns and rows away, which a filter that passes low frequencies does not
// change. Of the difference of a pair of frames [DN^2].
struct NoiseReach {
    int columns = 0, rows = 0;
};
struct NoiseSums {
    double variance = 0;  // variance of a pixel
    double total = 0;     // sum of its covariances with itself and its neighbours

    // 1 without a filter.
    double bandwidth() const { return variance / total; }
};
NoiseSums noise_sums(const DnImage& a, const DnImage& b, const PixelSelection& selection, NoiseReach reach);

}  // namespace hilcam
