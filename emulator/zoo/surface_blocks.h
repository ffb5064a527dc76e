#pragma once
// The smooth surface in a picture, and how much of it has the wrong brightness.
//
// A pixel shows smooth surface when it and its eight neighbours show one part of one object, their normals lie
// within 11 degrees of its own, and they lie on the plane through its place to within some 17 degrees. That is
// told by the renderer's truth (render/frame/frame_truth.h), so no figure here depends on what is judged.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame/frame_truth.h"
#include "sensor/sensor_noise.h"

namespace hilcam {

struct SurfacePixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> smooth;       // by pixel, row by row
    std::vector<std::uint8_t> near_object;  // an object is there or within kNear_px, as far as a lens blurs
    static constexpr int kNear_px = 8;

    bool is_smooth(int x, int y) const { return smooth[index(x, y)] != 0; }
    bool is_near(int x, int y) const { return near_object[index(x, y)] != 0; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};
// layers: with object, part, normal and position.
SurfacePixels surface_pixels(const TruthLayers& layers);

// A reference picture as its judges need it: charges [e-], and how far its mean may be off.
struct KnownPicture {
    const ElectronImage& mean;
    const ElectronImage& dark;  // the picture without light
    const ElectronImage&
        error;  // an estimate of the mean's own error by pixel, of either sign: squares count
};

// Counts of blocks of 4 x 4 pixels. A block is counted when all of it shows smooth surface and the reference has more light there
// than five times a pixel's noise in the dark. When the reference's own error exceeds a fortieth of the block's light, the block is
// counted as `unknown` only.
struct BlockCounts {
    std::size_t judged = 0, unknown = 0;
    std::size_t over_10 = 0, over_25 = 0;  // blocks whose light is off by more than 10 and 25 per cent

    BlockCounts& operator+=(const BlockCounts& other) {
        judged += other.judged, unknown += other.unknown;
        over_10 += other.over_10, over_25 += other.over_25;
        return *this;
    }
};
BlockCounts block_counts(const ElectronImage& picture, const KnownPicture& reference,
                         const SurfacePixels& surface, const SensorNoise& noise);

}  // namespace hilcam
