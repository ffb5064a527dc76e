#include "sensor/stray/stray_light.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(StrayLightConfig& c) {
    return {
        number("veiling_glare_fraction", c.veiling_glare_fraction, 1, {0, 0.9},
               "share of all light that glare spreads over the picture"),
        number("glare_radius_px", c.glare_radius_px, 1, {0, 10000},
               "radius r of the halo r / (r^2 + x^2)^1.5; 0: the glare is uniform"),
        number("ghost_fraction", c.ghost_fraction, 1, {0, 0.5},
               "share of a source's light that goes into its ghost"),
        number("ghost_scale", c.ghost_scale, 1, {-5, 5},
               "the ghost's distance from the principal point over the source's distance; negative: on the "
               "opposite side"),
        number("ghost_radius_px", c.ghost_radius_px, 1, {8, 2000}, "radius of a point's blurred ghost"),
    };
}

namespace {

// Returns the transform of a disk, 2 J1(a) / a with a = 2 pi r f.
double disk_mtf(double frequency, double radius) {
    const double a = 2 * kPi * radius * frequency;
    return a < 1e-6 ? 1 : 2 * std::cyl_bessel_j(1.0, a) / a;
}

// Returns the number of cells across, with a border as wide as the ghost, so that it does not wrap around.
int cells_of(int padded_px, double radius_px, int cell_px) {
    return fft_size((padded_px + static_cast<int>(radius_px)) / cell_px + 2);
}

}  // namespace

Ghost::Ghost(const StrayLightConfig& config, const ImageGeometry& geometry)
    : over_image_(config.ghost_fraction / (1 - config.ghost_fraction)),
      scale_(config.ghost_scale),
      geometry_(geometry),
      cells_(cells_of(geometry.padded_width(), config.ghost_radius_px, kCell_px),
             cells_of(geometry.padded_height(), config.ghost_radius_px, kCell_px),
             {[radius = config.ghost_radius_px / kCell_px](double u, double v) {
                 return std::complex<double>(disk_mtf(std::hypot(u, v), radius));
             }}) {}

void Ghost::clear() {
    for (int y = 0; y < cells_.height(); ++y) std::fill(cells_.row(y).begin(), cells_.row(y).end(), 0.0f);
}

void Ghost::collect(double x_px, double y_px, double electrons) {
    const Vec2d center = geometry_.center_px();
    // Cell (0, 0) begins at the padded image's corner; its value belongs to its centre.
    const double x = (center.x + scale_ * (x_px - center.x) + geometry_.guard_px) / kCell_px - 0.5;
    const double y = (center.y + scale_ * (y_px - center.y) + geometry_.guard_px) / kCell_px - 0.5;
    if (!(x >= 0 && y >= 0 && x < cells_.width() - 1 && y < cells_.height() - 1)) return;
    const auto i = static_cast<std::size_t>(x);
    const int j = static_cast<int>(y);
    const double u = x - static_cast<double>(i), v = y - j;
    const double share = over_image_ * electrons;
    cells_.row(j)[i] += static_cast<float>(share * (1 - u) * (1 - v));
    cells_.row(j)[i + 1] += static_cast<float>(share * u * (1 - v));
    cells_.row(j + 1)[i] += static_cast<float>(share * (1 - u) * v);
    cells_.row(j + 1)[i + 1] += static_cast<float>(share * u * v);
}

void Ghost::spread() { cells_.run(); }

float Ghost::at(int x_px, int y_px) const {
    const float x = (static_cast<float>(x_px + geometry_.guard_px) + 0.5f) / kCell_px - 0.5f;
    const float y = (static_cast<float>(y_px + geometry_.guard_px) + 0.5f) / kCell_px - 0.5f;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 0, cells_.width() - 2);
    const int j = std::clamp(static_cast<int>(std::floor(y)), 0, cells_.height() - 2);
    const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
    const float* top = cells_.row(j).data() + i;
    const float* bottom = cells_.row(j + 1).data() + i;
    const float value = (1 - v) * ((1 - u) * top[0] + u * top[1]) + v * ((1 - u) * bottom[0] + u * bottom[1]);
    return std::max(0.0f, value) / (kCell_px * kCell_px);
}

}  // namespace hilcam
