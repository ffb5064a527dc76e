#pragma once
// Makes the texels of a mosaic (mosaic.h) of triangles.

#include <array>
#include <utility>
#include <vector>

#include "render/mosaic/mosaic.h"

namespace hilcam {

// Owner thread.
class MosaicPainter {
  public:
    // The mosaic's rectangle, texel_m and layers are known; its corner is the ground's.
    explicit MosaicPainter(Mosaic& mosaic);

    // Adds a triangle of a layer, by the area of each texel that it fills.
    void add(std::size_t layer, const std::array<Vec3d, 3>& corners_m);
    // Ends that: takes from each layer what those above it cover. Returns the share of the ground that is left.
    double hide_lower();
    // Makes the texels, after that.
    void finish();

  private:
    static constexpr int kLinesEach = 2;  // lines through each row of texels, along which gaps are measured
    Mosaic& mosaic_;
    int columns_, rows_;
    std::array<std::vector<float>, Mosaic::kMaxLayers> covered_;  // by texel: the share that a layer fills
    // By texel: how what lies on the ground leans along both sides, times its share.
    std::array<std::vector<float>, 2> lean_;
    // The share of the ground that is in gaps which run down; and how narrow these are, and those that run across, times their
    // shares.
    std::vector<float> down_;
    std::array<std::vector<float>, 2> gap_;
    std::vector<std::array<Vec2d, 3>> upper_;  // triangles above the ground [texels]

    using Parts = std::vector<std::pair<double, double>>;  // parts of a line, begin and end [texels]
    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    void fill(std::size_t layer, const std::array<Vec2d, 3>& triangle, Vec2f lean);
    void find_gaps();
    std::vector<float> narrowness(std::size_t axis) const;
    float narrow_beside(const std::vector<float>& of, const std::vector<float>& against, int column, int row,
                        bool along_rows) const;
    std::vector<Parts> covered_parts(std::size_t axis, int lines) const;
    void pack();
    MosaicTexels packed(int first, int row) const;
    void halve();
};

}  // namespace hilcam
