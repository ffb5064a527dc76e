#pragma once
// A part of a picture in which neighbouring pixels share what varies slowly: aspects at nodes 8 or 16 pixels
// apart, linear in between, and places on the map by parabolas through twice as many nodes. Each pixel looks
// only at the maps; if their texels are large, every second or fourth pixel does, linear in between.
//
// For its difference from EarthModel::add(), which computes every pixel, see
// tests/unit/io/files/shipped_earth_test.cpp, and docs/earth.md in units of sensor noise.

#include "render/earth/earth_model.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class EarthPatch {
  public:
    static constexpr int kMaxPixels = 64, kFinePitch_px = 8, kWidePitch_px = 16;
    static constexpr int kMaxNodes = kMaxPixels / kFinePitch_px + 1;

    // pitch_px: one of the two; the fine one for a small Earth, so that fewer pixels are left out at its
    // limb. ray_at(x, y): the ray of a place in the picture [px], whole or half. At most kMaxPixels in each
    // direction. Loop.
    template <class RayAt>
    void place(const EarthModel& earth, const PixelBox& box, int pitch_px, const RayAt& ray_at) {
        earth_ = &earth, box_ = box, pitch_px_ = pitch_px;
        across_ = (box.x1 - box.x0 + pitch_px_ - 1) / pitch_px_ + 1;
        down_ = (box.y1 - box.y0 + pitch_px_ - 1) / pitch_px_ + 1;
        for (int j = 0; j < down_; ++j)
            for (int i = 0; i < across_; ++i)
                place_node(j * kMaxNodes + i, ray_at(box.x0 + i * pitch_px_, box.y0 + j * pitch_px_));
        for (int j = 0; j < 2 * down_ - 1; ++j)
            for (int i = 0; i < 2 * across_ - 1; ++i)
                if (i % 2 || j % 2)
                    place_half(j, i, ray_at(box.x0 + i * (pitch_px_ / 2), box.y0 + j * (pitch_px_ / 2)));
        const EarthModel::Ray first = ray_at(box.x0, box.y0);
        irradiance_ = first.irradiance_w_m2_um, moment_ = first.moment;
        choose_steps();
        for (int row = 0; row + 1 < down_; ++row)
            for (int column = 0; column + 1 < across_; ++column)
                if (may_bend({column, row}))
                    check_middle({column, row}, ray_at(box.x0 + (column + 0.5) * pitch_px_,
                                                       box.y0 + (row + 0.5) * pitch_px_));
    }
    // Adds the radiance [W m^-2 sr^-1 um^-1] at a place in the box, times weight. Returns false if the nodes
    // around it cannot be used: near the limb, at a pole, or where light is not linear between them. Loop.
    bool add(float x, float y, const Spectrum& weight, Spectrum& radiance);

  private:
    using Node = std::array<float, sizeof(EarthAspect) / sizeof(float)>;
    const EarthModel* earth_ = nullptr;
    PixelBox box_;
    int pitch_px_ = kWidePitch_px, across_ = 0, down_ = 0;
    Spectrum irradiance_;
    EarthMoment moment_;
    std::array<Node, kMaxNodes * kMaxNodes> nodes_;
    std::array<bool, kMaxNodes * kMaxNodes> carries_;
    // Places on the map at every half pitch.
    static constexpr int kHalves = 2 * kMaxNodes - 1;
    struct MapPlace {
        float u, v;
    };
    std::array<MapPlace, kHalves * kHalves> halves_;

    // Pixels between lookups in the maps, per cell between nodes; 0: the cell cannot be used.
    std::array<int, kMaxNodes * kMaxNodes> step_px_;
    // Lookups at every second pixel's corner, made when they are needed.
    static constexpr int kLooks = kMaxPixels / 2 + 1;
    std::array<Spectrum, kLooks * kLooks> looks_;
    std::array<bool, kLooks * kLooks> looked_;

    struct Cell {
        int column, row;
        std::size_t index() const { return static_cast<std::size_t>(row * kMaxNodes + column); }
    };
    void choose_steps();
    bool may_bend(Cell cell) const;
    void check_middle(Cell cell, const EarthModel::Ray& ray);
    Node between_nodes(Cell cell, float s, float t) const;
    Spectrum look(Cell cell, float s, float t) const;  // s, t: position in the cell, 0..1
    const Spectrum& look_at_corner(Cell cell, int column, int row);
    void place_node(int at, const EarthModel::Ray& ray);
    void place_half(int row, int column, const EarthModel::Ray& ray);
};

}  // namespace hilcam
