#pragma once
// Sums over frames of one scene and one setting, for each pixel and over all pixels: the input of emva1288.h.
// Symbols in comments are those of EMVA Standard 1288, Release 4.0 Linear, 2021.
//
// A selection is a rectangle of the frame, with a mask of the pixels that count: those of one colour filter,
// without defects. All figures are in DN. Nothing here knows light, charge or time.

#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image.h"

namespace hilcam {

struct PixelSelection {
    int left = 0, top = 0, width = 0, height = 0;  // [px of the frame]
    std::vector<std::uint8_t> use;                 // mask of the rectangle, row by row; 1: counts

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

// Statistics over pairs of frames: mean mu_y and temporal variance sigma_y^2 = mean d^2 / 2, where d is the
// difference of a pair (section 6.1), so that everything constant cancels. The standard subtracts (mean d)^2
// because lamps drift. The lamp here does not, so what is common to a frame is noise. Parts of the variance
// may be common to a row or to the frame.
struct TemporalStatistics {
    Measured mean_dn;
    Measured variance_dn2;
    double row_dn2 = 0;     // part of the variance that is common to a row, without the frame's part
    double frame_dn2 = 0;   // part of the variance that is common to the frame
    double column_dn2 = 0;  // part that is common to a column; pixel_dn2() includes it
    int pairs = 0;

    double pixel_dn2() const { return variance_dn2.value - row_dn2 - frame_dn2; }
};

class PairSeries {
  public:
    explicit PairSeries(const PixelSelection& selection) : selection_(selection) {}
    // Adds two frames with the same setting. Owner thread.
    void add(const DnImage& a, const DnImage& b);
    TemporalStatistics result() const;

  private:
    const PixelSelection& selection_;
    double sum_ = 0, square_ = 0, row_ = 0, frame_ = 0, column_ = 0;  // sums over the pairs
    int pairs_ = 0;
};

// Returns one standard deviation of the error of row_dn2 or column_dn2: `lines` rows or columns with
// `line_pixels` pixels each.
double line_variance_uncertainty_dn2(const TemporalStatistics& s, double line_dn2, double lines,
                                     double line_pixels);

// Sums of frames with one setting, for each pixel.
class FrameStack {
  public:
    explicit FrameStack(const PixelSelection& selection);
    void add(const DnImage& frame);
    int frames() const { return frames_; }
    // Returns means over the selection's rectangle, including pixels that do not count.
    std::vector<double> mean_dn() const;
    std::vector<double> temporal_variance_dn2() const;

  private:
    int left_, top_, width_, height_, frames_ = 0;
    std::vector<double> sum_, square_;
};

// Spatial variances s^2 of an image, split into the contributions of rows, columns and single pixels (section
// 8.2: s^2_row, s^2_col, s^2_pixel). They may be negative by chance if there is no pattern.
struct SpatialParts {
    double total = 0, row = 0, column = 0, pixel = 0;
    double rows = 0, columns = 0, pixels = 0;  // number of values averaged
};
SpatialParts spatial_parts(std::span<const double> image, const PixelSelection& selection);

// Fits a smooth surface to the pixels that count: sum over i + j <= order of a_ij x^i y^j, with x and y from
// -1 to 1 over the rectangle. For slow changes such as the lens's shading.
std::vector<double> smooth_surface(std::span<const double> image, const PixelSelection& selection, int order);

// Excludes pixels that are farther than `sigmas` standard deviations from the median of those that count. The
// standard deviation is 1.4826 times the median deviation, which outliers do not affect (Hampel, J. Amer.
// Statist. Assoc. 69, 1974). A standard deviation below `least` counts as that, for values that rounding
// makes equal. Returns how many were excluded.
std::size_t exclude_outliers(std::span<const double> image, double sigmas, PixelSelection& selection,
                             double least = 0);

// The effect of a filter on white noise: the variance of a pixel over the sum of its autocovariances with
// neighbours up to some columns and rows away. A low-pass filter does not change that sum. Computed from the
// difference of a pair of frames [DN^2].
struct NoiseReach {
    int columns = 0, rows = 0;
};
struct NoiseSums {
    double variance = 0;  // variance of a pixel
    double total = 0;     // sum of its covariances with itself and its neighbours

    // Returns 1 without a filter.
    double bandwidth() const { return variance / total; }
};
NoiseSums noise_sums(const DnImage& a, const DnImage& b, const PixelSelection& selection, NoiseReach reach);

}  // namespace hilcam
