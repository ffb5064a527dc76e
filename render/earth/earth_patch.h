#pragma once
// A part of a picture in which neighbouring pixels share what changes slowly: aspects at its nodes, 16 pixels apart, linear
// between; places on the map by parabolas through every eighth pixel's. Only the maps are looked at for each pixel.
//
// How far it is from EarthModel::add(), which works out every pixel: tests/unit/emulator/scenario/earth_test.cpp, and docs/earth.md in units of sensor noise.

#include "render/earth/earth_model.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class EarthPatch {
  public:
    static constexpr int kPitch_px = 16, kMostPixels = 64;
    static constexpr int kMostNodes = kMostPixels / kPitch_px + 1;

    // ray_at(x, y): the ray of a place in the picture [px]. At most kMostPixels each way. Loop.
    template <class RayAt>
    void place(const EarthModel& earth, const PixelBox& box, const RayAt& ray_at) {
        earth_ = &earth, box_ = box;
        across_ = (box.x1 - box.x0 + kPitch_px - 1) / kPitch_px + 1;
        const int down = (box.y1 - box.y0 + kPitch_px - 1) / kPitch_px + 1;
        for (int j = 0; j < down; ++j)
            for (int i = 0; i < across_; ++i)
                place_node(j * kMostNodes + i, ray_at(box.x0 + i * kPitch_px, box.y0 + j * kPitch_px));
        for (int j = 0; j < 2 * down - 1; ++j)
            for (int i = 0; i < 2 * across_ - 1; ++i)
                if (i % 2 || j % 2)
                    place_half(j, i, ray_at(box.x0 + i * (kPitch_px / 2), box.y0 + j * (kPitch_px / 2)));
        irradiance_ = ray_at(box.x0, box.y0).irradiance_w_m2_um;
    }
    // Radiance [W m^-2 sr^-1 um^-1] at a place within the box, times weight; false where the nodes about it do not carry: near
    // the limb, at a pole. Loop.
    bool add(float x, float y, const Spectrum& weight, Spectrum& radiance) const;

  private:
    using Node = std::array<float, sizeof(EarthAspect) / sizeof(float)>;
    const EarthModel* earth_ = nullptr;
    PixelBox box_;
    int across_ = 0;
    Spectrum irradiance_;
    std::array<Node, kMostNodes * kMostNodes> nodes_;
    std::array<bool, kMostNodes * kMostNodes> carries_{};
    // Places on the map at every half of the pitch.
    static constexpr int kHalves = 2 * kMostNodes - 1;
    struct MapPlace {
        float u, v;
    };
    std::array<MapPlace, kHalves * kHalves> halves_;

    void place_node(int at, const EarthModel::Ray& ray);
    void place_half(int row, int column, const EarthModel::Ray& ray);
};

}  // namespace hilcam
