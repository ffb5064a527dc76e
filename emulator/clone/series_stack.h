#pragma once
// Series of frames as their mean pictures, and the pixels that work properly in all of them.

#include <functional>
#include <span>
#include <vector>

#include "emulator/clone/frame_checks.h"
#include "emulator/clone/frame_set.h"
#include "sensor/camera_model.h"
#include "sensor/measure/frame_statistics.h"

namespace hilcam {

struct SeriesStack {
    std::vector<double> mean;      // each pixel's mean [DN]
    std::vector<double> variance;  // its variance over time [DN^2]; only the series that is asked for has it
    NumberFacts numbers;

    double mean_of(const PixelSelection& selection) const;
};
// Reads all series once. with_variance: the series that gets variances.
std::vector<SeriesStack> stack_series(const FrameSet& frames, const PixelSelection& whole,
                                      std::size_t with_variance, const std::function<void(double)>& told);

// The pixels that do not work properly, row by row; 1: it has this fault.
struct PixelFaults {
    std::vector<std::uint8_t> noisy;  // its noise in the dark is far above that of the others
    std::vector<std::uint8_t> hot;    // so is its dark current
    std::vector<std::uint8_t> weak;   // its response to light is below half of the others'
    PixelSelection good;              // pixels without these, nor with an odd offset, dark current or gain
    double hot_limit_dn_s = 0;        // excess of dark signal from which a pixel is hot
};
// darks: series at the reference temperature, shortest exposure first; the first one has variances.
PixelFaults find_faults(const FrameSet& frames, std::span<const SeriesStack> stacks,
                        std::span<const std::size_t> darks, const CameraModel& like);

// Returns the colour planes of the sensor, as selections of the whole; one without colour filters.
std::vector<PixelSelection> color_planes(const CameraModel& like, int width, int height);
// Returns the pixels that are in both; both selections are of the whole.
PixelSelection both(PixelSelection a, const PixelSelection& b);
// Returns the good pixels of the colour plane that has most of them.
PixelSelection largest_plane(const PixelSelection& good, const CameraModel& like);
// Returns the flat with the median mean.
std::size_t middle_flat(const FrameSet& frames, std::span<const SeriesStack> stacks);

// Keeps the good pixels of the largest colour plane that are lit within 3 % of the brightest (EMVA 1288,
// section 5.2); if these are less than a tenth, all of the plane.
PixelSelection evenly_lit(const FrameSet& frames, std::span<const SeriesStack> stacks,
                          const PixelSelection& good, const CameraModel& like);

}  // namespace hilcam
