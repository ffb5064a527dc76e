#include "render/visibility/screen_mask.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

int blocks_in(int pixels) { return (pixels + ScreenMask::kBlock_px - 1) / ScreenMask::kBlock_px; }

}  // namespace

ScreenMask::ScreenMask(const ImageGeometry& geometry)
    : geometry_(geometry),
      across_(blocks_in(geometry.padded_width())),
      down_(blocks_in(geometry.padded_height())),
      blocks_(static_cast<std::size_t>(across_ * down_)) {}

void ScreenMask::place(const ImageGeometry& geometry) {
    geometry_ = geometry;
    across_ = blocks_in(geometry.padded_width()), down_ = blocks_in(geometry.padded_height());
    HILCAM_CHECK(static_cast<std::size_t>(across_ * down_) <= blocks_.size());
    clear();
}

void ScreenMask::clear() { std::fill(blocks_.begin(), blocks_.end(), std::uint8_t{0}); }

void ScreenMask::fill() { std::fill(blocks_.begin(), blocks_.end(), std::uint8_t{1}); }

bool ScreenMask::add(const Pose& camera, const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m) {
    const Mat3d camera_from_world = transposed(to_matrix(camera.world_from_body));
    const Mat3d camera_from_body = camera_from_world * to_matrix(object.world_from_body);
    const Mat3d axes = transposed(camera_from_body);  // rows: the body's axes in camera axes
    const Vec3d offset_m = camera_from_world * (object.position_world_m - camera.position_world_m);
    bool any_marked = false;
    for (const auto& [min_m, max_m] : boxes_m) {
        const Vec3d from = camera_from_body * to_double(min_m) + offset_m;
        const Vec3d size = to_double(max_m) - to_double(min_m);
        const std::array<Vec3d, 3> edges = {size.x * axes.x, size.y * axes.y, size.z * axes.z};
        double min_x = 1e300, min_y = 1e300, max_x = -1e300, max_y = -1e300;
        int in_front = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            Vec3d p = from;
            if (corner & 1u) p = p + edges[0];
            if (corner & 2u) p = p + edges[1];
            if (corner & 4u) p = p + edges[2];
            if (!(p.z > 1e-9 * (std::abs(p.x) + std::abs(p.y)))) continue;
            ++in_front;
            const double x = p.x / p.z, y = p.y / p.z;
            min_x = std::min(min_x, x), max_x = std::max(max_x, x);
            min_y = std::min(min_y, y), max_y = std::max(max_y, y);
        }
        if (in_front == 0) continue;
        // A box that crosses the camera's plane has no outline.
        if (in_front < 8) {
            fill();
            return true;
        }
        any_marked |= mark({min_x, min_y}, {max_x, max_y});
    }
    return any_marked;
}

// least, most: corners of the box's outline on the plane at distance 1.
bool ScreenMask::mark(Vec2d least, Vec2d most) {
    double min_x = 1e300, min_y = 1e300, max_x = -1e300, max_y = -1e300;
    const auto grow = [&](double x, double y) {
        const Vec2d px = geometry_.project_px({x, y, 1});
        min_x = std::min(min_x, px.x), max_x = std::max(max_x, px.x);
        min_y = std::min(min_y, px.y), max_y = std::max(max_y, px.y);
    };
    // A lens bends the outline: its sides are sampled in steps, with a margin for the curve between them.
    const int steps = geometry_.distortion.none() ? 1 : 8;
    for (int i = 0; i <= steps; ++i) {
        const double u = static_cast<double>(i) / steps;
        const double x = least.x + u * (most.x - least.x), y = least.y + u * (most.y - least.y);
        grow(x, least.y), grow(x, most.y), grow(least.x, y), grow(most.x, y);
    }
    if (steps > 1) {
        const double margin = 0.02 * std::max(max_x - min_x, max_y - min_y);
        min_x -= margin, min_y -= margin, max_x += margin, max_y += margin;
    }
    // A quarter of a pixel covers the rounding of rays to single precision.
    const auto block = [&](double px, int blocks) {
        const double at = std::floor((px + geometry_.guard_px) / kBlock_px);
        return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(blocks)));
    };
    const int x0 = std::max(0, block(min_x - 0.25, across_));
    const int x1 = std::min(across_ - 1, block(max_x + 0.25, across_));
    const int y0 = std::max(0, block(min_y - 0.25, down_));
    const int y1 = std::min(down_ - 1, block(max_y + 0.25, down_));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) blocks_[static_cast<std::size_t>(y * across_ + x)] = 1;
    return x0 <= x1 && y0 <= y1;
}

bool ScreenMask::any(const PixelBox& box) const {
    for (int y = box.y0 / kBlock_px; y * kBlock_px < box.y1; ++y)
        for (int x = box.x0 / kBlock_px; x * kBlock_px < box.x1; ++x)
            if (blocks_[static_cast<std::size_t>(y * across_ + x)] != 0) return true;
    return false;
}

}  // namespace hilcam
