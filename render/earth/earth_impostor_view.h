#pragma once
// Draws the Earth in a tile of a frame from its impostor (earth_impostor.h).

#include <span>

#include "render/earth/earth_impostor.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class EarthImpostorView {
  public:
    enum class Seen {
        kNothing,  // the Earth is not in the tile
        kPicture,  // look() has the tile
        kRays,     // the tile covers too large an angle for the impostor
    };
    // The camera's position in the Earth's axes; the Earth's middle and cone in the world, apparent.
    struct View {
        Vec3d camera_m;
        Mat3d fixed_from_world;
        Vec3d world_dir;
        double cone_cosine;
    };
    static constexpr std::size_t kNodes = EarthImpostor::kNodes * EarthImpostor::kNodes;
    // Returns the places of a tile whose directions place() needs [px], row by row.
    static std::array<Vec2d, kNodes> nodes(const PixelBox& box);
    // Prepares a tile; the picture must outlive this. dirs: of the nodes, in the world, any length. Loop.
    Seen place(const EarthImpostor& picture, const PixelBox& box, const View& earth,
               const std::array<Vec3d, kNodes>& dirs);
    // Prefetches the block of 4 x 4 px that follows this one in its row. Loop.
    void expect(int block_x, int block_y);
    // Looks up places in the tile, from its corner [px], each of which represents a share of a pixel's width.
    // Loop.
    void look(const EarthImpostor::Floats& x_px, const EarthImpostor::Floats& y_px, std::size_t count,
              float share);
    // Looks up the middles of a block's 4 x 4 pixels, all of them in the tile, and adds their light. pixels:
    // of the tile, row by row. Loop.
    void add_block(int block_x, int block_y, const Spectrum& weight, std::span<Spectrum> pixels);
    // Returns the radiance of a place in the last lookup, for the Sun at 1 AU [W m^-2 sr^-1 um^-1].
    const Spectrum& light(std::size_t place) const { return light_[place]; }

  private:
    const EarthImpostor* picture_ = nullptr;
    PixelBox box_{};
    float per_x_ = 0, per_y_ = 0;
    EarthImpostor::Tile tile_{};
    std::array<Spectrum, EarthImpostor::kCount> light_;
    static constexpr int kSquares = static_cast<int>(EarthImpostor::kCount);
    EarthImpostor::Squares squares_{};  // for a row of blocks
    int squares_y_ = -1;
};

}  // namespace hilcam
