#pragma once
// The Earth in a tile of a frame, as the picture of it that is kept has it (render/earth/earth_impostor.h).

#include <span>

#include "render/earth/earth_impostor.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class EarthImpostorView {
  public:
    enum class Seen {
        kNothing,  // the Earth is not in the tile
        kPicture,  // look() has it
        kRays,     // the tile is too wide against the sky for the picture
    };
    // The camera's place in the Earth's axes, and the Earth's middle and cone in the world's, as the camera sees them.
    struct View {
        Vec3d camera_m;
        Mat3d fixed_from_world;
        Vec3d world_dir;
        double cone_cosine;
    };
    static constexpr std::size_t kNodes = EarthImpostor::kNodes * EarthImpostor::kNodes;
    // The places of a tile whose directions place() needs [px], row by row.
    static std::array<Vec2d, kNodes> nodes(const PixelBox& box);
    // Places the picture, which outlives this, in a tile. dirs: the nodes', in the world, of any length. Loop.
    Seen place(const EarthImpostor& picture, const PixelBox& box, const View& earth,
               const std::array<Vec3d, kNodes>& dirs);
    // Has the memory of the block of 4 x 4 px that follows this one in its row on its way. Loop.
    void expect(int block_x, int block_y);
    // Looks at places of the tile, from its corner [px], each of which stands for a share of a pixel's width. Loop.
    void look(const EarthImpostor::Floats& x_px, const EarthImpostor::Floats& y_px, std::size_t count,
              float share);
    // Looks at the middles of a block's 4 x 4 pixels, all of them the tile's, and adds what is there. pixels: the tile's, row by row.
    // Loop.
    void add_block(int block_x, int block_y, const Spectrum& weight, std::span<Spectrum> pixels);
    // Radiance of the place that was looked at last, for the Sun at 1 AU [W m^-2 sr^-1 um^-1].
    const Spectrum& light(std::size_t place) const { return light_[place]; }

  private:
    const EarthImpostor* picture_ = nullptr;
    PixelBox box_{};
    float per_x_ = 0, per_y_ = 0;
    EarthImpostor::Tile tile_{};
    std::array<Spectrum, EarthImpostor::kCount> light_;
    static constexpr int kSquares = static_cast<int>(EarthImpostor::kCount);
    EarthImpostor::Squares squares_{};  // a row of blocks
    int squares_y_ = -1;
};

}  // namespace hilcam
