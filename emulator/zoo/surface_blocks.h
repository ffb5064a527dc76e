#pragma once
// Finds smooth surfaces in a picture, and counts blocks of them with the wrong brightness.
//
// A pixel shows smooth surface when it and its eight neighbours show one part of one object, the neighbours'
// normals are within 11 degrees of its own, and the neighbours are within some 17 degrees of the plane
// through its point. This is decided by the renderer's truth (render/frame/frame_truth.h), not by the picture
// that is judged.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame/frame_truth.h"
#include "sensor/sensor_noise.h"

namespace hilcam {

struct SurfacePixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> smooth;  // by pixel, row by row
    // An object is here or within kNear_px, the reach of a lens's blur.
    std::vector<std::uint8_t> near_object;
    static constexpr int kNear_px = 8;

    bool is_smooth(int x, int y) const { return smooth[index(x, y)] != 0; }
    bool is_near(int x, int y) const { return near_object[index(x, y)] != 0; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};
// layers: must include object, part, normal and position.
SurfacePixels surface_pixels(const TruthLayers& layers);

// A reference picture for judges: charges [e-], and the error of its mean.
struct KnownPicture {
    const ElectronImage& mean;
    const ElectronImage& dark;  // the picture without light
    const ElectronImage&
        error;  // estimated error of the mean for each pixel, with either sign; squares count
};

// Counts of blocks of 4 x 4 pixels. A block is judged when all of it shows smooth surface and its light in
// the reference exceeds five times a pixel's noise in the dark. If the reference's own error exceeds a
// fortieth of the block's light, the block only counts as `unknown`.
struct BlockCounts {
    std::size_t judged = 0, unknown = 0;
    std::size_t over_10 = 0, over_25 = 0;  // light off by more than 10 and by more than 25 per cent

    BlockCounts& operator+=(const BlockCounts& other) {
        judged += other.judged, unknown += other.unknown;
        over_10 += other.over_10, over_25 += other.over_25;
        return *this;
    }
};
BlockCounts block_counts(const ElectronImage& picture, const KnownPicture& reference,
                         const SurfacePixels& surface, const SensorNoise& noise);

}  // namespace hilcam
