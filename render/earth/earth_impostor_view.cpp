#include "render/earth/earth_impostor_view.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

std::array<Vec2d, EarthImpostorView::kNodes> EarthImpostorView::nodes(const PixelBox& box) {
    std::array<Vec2d, kNodes> out;
    for (std::size_t i = 0; i < kNodes; ++i)
        out[i] = {box.x0 + 0.5 * static_cast<double>(i % 3) * (box.x1 - box.x0),
                  box.y0 + 0.5 * static_cast<double>(i / 3) * (box.y1 - box.y0)};
    return out;
}

EarthImpostorView::Seen EarthImpostorView::place(const EarthImpostor& picture, const PixelBox& box,
                                                 const View& earth, const std::array<Vec3d, kNodes>& dirs) {
    picture_ = &picture, box_ = box, squares_y_ = -1;
    per_x_ = 1 / static_cast<float>(box.x1 - box.x0), per_y_ = 1 / static_cast<float>(box.y1 - box.y0);
    const auto angle_rad = [](Vec3d a, Vec3d b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); };
    const Vec3d middle = normalized(dirs[kNodes / 2]);
    std::array<Vec3d, kNodes> fixed_dirs;
    double reach_rad = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
        reach_rad = std::max(reach_rad, angle_rad(middle, normalized(dirs[i])));
        fixed_dirs[i] = earth.fixed_from_world * dirs[i];
    }
    // The box of a body beside the field may be the whole picture, but a tile without the Earth has nothing
    // of it.
    if (angle_rad(middle, earth.world_dir) > std::acos(earth.cone_cosine) + reach_rad) return Seen::kNothing;
    // A tile over a large angle is not biquadratic (EarthImpostor::Tile).
    constexpr double kWidest_rad = 0.2;
    if (reach_rad > kWidest_rad) return Seen::kRays;
    tile_ = picture_->tile(earth.camera_m, fixed_dirs);
    return Seen::kPicture;
}

void EarthImpostorView::expect(int block_x, int block_y) {
    const int column = (block_x - box_.x0) / 4, here = column % kSquares;
    if (here == 0 || block_y != squares_y_) {
        EarthImpostor::Floats x, y;
        y.fill(per_y_ * static_cast<float>(block_y - box_.y0 + 2));
        for (int i = 0; i < kSquares; ++i)
            x[static_cast<std::size_t>(i)] = per_x_ * static_cast<float>(4 * (column - here + i) + 2);
        picture_->find_squares(tile_, x, y, squares_);
        squares_y_ = block_y;
        squares_.fetch(static_cast<std::size_t>(here));
    }
    if (here + 1 < kSquares && block_x + 4 < box_.x1) squares_.fetch(static_cast<std::size_t>(here) + 1);
}

void EarthImpostorView::look(const EarthImpostor::Floats& x_px, const EarthImpostor::Floats& y_px,
                             std::size_t count, float share) {
    EarthImpostor::Floats x, y;
    for (std::size_t k = 0; k < EarthImpostor::kCount; ++k) x[k] = per_x_ * x_px[k], y[k] = per_y_ * y_px[k];
    picture_->look(tile_, x, y, count, share, light_);
}

void EarthImpostorView::add_block(int block_x, int block_y, const Spectrum& weight,
                                  std::span<Spectrum> pixels) {
    EarthImpostor::Floats x, y;
    for (std::size_t k = 0; k < EarthImpostor::kCount; ++k) {
        x[k] = static_cast<float>(block_x - box_.x0) + static_cast<float>(k % 4) + 0.5f;
        y[k] = static_cast<float>(block_y - box_.y0) + static_cast<float>(k / 4) + 0.5f;
    }
    look(x, y, EarthImpostor::kCount, 1);
    const int width = box_.x1 - box_.x0;
    Spectrum* row = pixels.data() + (block_y - box_.y0) * width + block_x - box_.x0;
    for (std::size_t k = 0; k < EarthImpostor::kCount; k += 4, row += width)
        for (std::size_t i = 0; i < 4; ++i) row[i] += weight * light_[k + i];
}

}  // namespace hilcam
