#pragma once
// Makes the texels of a coverage map (coverage_map.h) from triangles, in bands of rows on all threads. The
// result does not depend on their number.

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "render/lod/coverage_map.h"

namespace hilcam {

// One painter can make many coverage maps in succession. Owner thread.
class CoverageMapPainter {
  public:
    // Starts a coverage map, whose rectangle, texel_m and layers are known; its corner is that of the ground.
    void begin(CoverageMap& coverage_map);
    // Adds a triangle of a layer.
    void add(std::size_t layer, const std::array<Vec3d, 3>& corners_m);
    // Fills the texels by the areas of all triangles, and removes from each layer what those above it cover.
    // Returns the share of the ground that remains visible.
    double fill();
    // Makes the coverage map's levels from the texels.
    void finish();

  private:
    static constexpr int kLinesEach = 2;  // lines through each row of texels, along which gaps are measured
    static constexpr int kRowsTogether = 32;

    // A triangle, its place [texels], and its lean along both sides.
    struct Piece {
        std::size_t layer;
        std::array<Vec2d, 3> corners;
        int first_row, last_row;
        Vec2f lean;
    };
    struct Texel {
        std::array<float, CoverageMap::kMaxLayers> share{};  // share that each layer fills
        // The lean of what is on the ground, along both sides, times its share.
        std::array<float, 2> lean{};
        // The share of the ground in gaps that run down; and the narrowness of gaps that run down and across,
        // times their shares.
        float down = 0;
        std::array<float, 2> gap{};

        void add(const Texel& other, float weight);
    };
    // Areas of the ground [texels]: all of it, and the visible part.
    struct Ground {
        double all = 0, seen = 0;
    };
    CoverageMap* coverage_map_ = nullptr;
    int columns_ = 0, rows_ = 0;
    std::vector<Piece> pieces_;
    std::vector<Texel> texels_, halved_;

    using Parts = std::vector<std::pair<double, double>>;  // parts of a line: begin and end [texels]
    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    template <class Row>
    static void for_each_row(int rows, const Row& row);
    void fill_row(const Piece& piece, int y, std::span<Texel> texels) const;
    Ground hide_lower(std::span<Texel> texels) const;
    void find_gaps();
    std::vector<float> narrowness(std::size_t axis) const;
    float narrow_beside(const std::vector<float>& of, const std::vector<float>& against, int column, int row,
                        bool along_rows) const;
    std::vector<Parts> covered_parts(std::size_t axis, int lines) const;
    void pack();
    CoverageTexels packed(int first, int row) const;
    void halve();
};

}  // namespace hilcam
