// Makes the shading points of what a pixel sees of a coverage map (lod/coverage_map.h): one for each surface.

#include <algorithm>

#include "render/primary/primary_hits.h"
#include "render/shading/sample_offsets.h"

namespace hilcam {
namespace {

// A surface of a coverage map counts if it fills this share of a pixel: for sunlit paint a quarter of the
// noise of a full well of 15,000 electrons.
constexpr float kMinCoverage = 0.002f;

// Returns the moments of light whose middle is shifted by `off_px`.
SubpixelMoments moved(const SubpixelMoments& from, Vec2f off_px) {
    // In a uniform pixel the middle of a half is a quarter of a pixel away.
    return {std::clamp(from.across + 4 * off_px.x, -1.0f, 1.0f),
            std::clamp(from.down + 4 * off_px.y, -1.0f, 1.0f), from.crossed};
}

}  // namespace

// Returns how far rays move along the sides while they rise by one.
Vec2f PrimaryHits::ShownCoverageMap::slopes(Vec3f dir) const {
    const float per_rise = 1 / std::max(dot(dir, normal), 1e-3f);
    return {per_rise * dot(dir, across), per_rise * dot(dir, down)};
}

// Returns a coverage map of the packet's object as the frame shows it.
const PrimaryHits::ShownCoverageMap& PrimaryHits::shown(const CoverageMap& coverage_map) {
    const std::uint32_t object = hits_.object[0];
    if (coverage_map_.is == &coverage_map && coverage_map_.object == object) return coverage_map_;
    const Mat3f& axes = tile_.frame.world_from_body[object];
    coverage_map_ = {&coverage_map,
                     object,
                     axes * coverage_map.normal,
                     axes * coverage_map.across,
                     axes * coverage_map.down,
                     to_double(axes * coverage_map.corner_m),
                     {}};
    coverage_map_.to_sun = coverage_map_.slopes(to_float(tile_.frame.background->sun_world_dir()));
    return coverage_map_;
}

// Returns what the pixel of fragment k sees of the coverage map.
PrimaryHits::CoverageMapPixel PrimaryHits::look_at_coverage_map(std::size_t k, Vec3f view_dir) const {
    const PixelRays pixel = rays_of(fragments_[k]);
    const Vec3d up = to_double(coverage_map_.normal);
    const Vec3d corner_m = coverage_map_.corner_m - to_double(packet_.origin.at(k)) + to_double(origins_[k]) -
                           eye_m(tile_.frame, tile_.box.y0 + fragments_[k].y);
    const double facing = dot(pixel.middle, up), way = dot(corner_m, up) / facing;
    const auto on_plane = [&](Vec3d step) { return way * (step - (dot(step, up) / facing) * pixel.middle); };
    const double per_m = 1 / static_cast<double>(coverage_map_.is->texel_m);
    const auto texels = [&](Vec3d at_m) {
        return Vec2d{per_m * dot(at_m, to_double(coverage_map_.across)),
                     per_m * dot(at_m, to_double(coverage_map_.down))};
    };
    const auto single = [](Vec2d v) { return Vec2f{static_cast<float>(v.x), static_cast<float>(v.y)}; };
    CoverageMapPixel out{way * pixel.middle, on_plane(pixel.right), on_plane(pixel.down), {}};
    const Vec2f to_viewer = coverage_map_.slopes(view_dir);
    out.coverage = coverage_map_.is->coverage(
        {texels(out.middle_m - corner_m), single(texels(out.per_x_m)), single(texels(out.per_y_m))},
        {coverage_map_.to_sun.x - to_viewer.x, coverage_map_.to_sun.y - to_viewer.y});
    return out;
}

// Makes one shading point for each surface of the coverage map in a pixel, with its share of the samples.
// Returns the new number of shading points.
std::size_t PrimaryHits::make_covered_points(std::size_t k, const SurfaceFrame& surface_frame,
                                             std::span<ShadingPoint> points, std::size_t count) {
    const FrameContext& frame = tile_.frame;
    const CoverageMap& coverage_map = *coverage_map_.is;
    const CoverageMapPixel pixel = look_at_coverage_map(k, surface_frame.view_dir);
    const Vec3d eye = eye_m(frame, tile_.box.y0 + fragments_[k].y);
    const CoverageMap::Coverage& coverage = pixel.coverage;
    float shown = 0;
    Vec2f middle_px{};
    for (std::size_t layer = 0; layer < coverage_map.layers; ++layer) {
        if (coverage.share[layer] >= kMinCoverage) shown += coverage.share[layer];
        middle_px.x += coverage.share[layer] * coverage.place[layer].x;
        middle_px.y += coverage.share[layer] * coverage.place[layer].y;
    }
    const SampleMask seen_by = fragments_[k].samples;
    const float samples = frame.samples.weight(seen_by);
    const SubpixelMoments moments = frame.samples.moments(seen_by);
    const float pixel_rad = 1 / static_cast<float>(frame.geometry.focal_length_px);
    const RayWidth width{pixel_rad * static_cast<float>(frame.way_to_start_m()), pixel_rad};
    const auto lane = static_cast<int>(k);
    for (std::size_t layer = 0; layer < coverage_map.layers; ++layer) {
        if (coverage.share[layer] < kMinCoverage) continue;
        ShadingPoint& point = points[count++];
        // The fragment's own hit is on the ground.
        if (layer == 0) {
            make_shading_point(frame, hits_, lane, surface_frame, origins_[k], packet_.dir.at(k), 0, width,
                               point);
            point.sunlit = coverage.lit;
        } else {
            place_shading_point(frame, hits_, lane, surface_frame, origins_[k], packet_.dir.at(k), width,
                                point);
            set_surface(frame, coverage_map.surface[layer], point);
            point.normal =
                normalized(surface_frame.geometric_normal + coverage.lean.x * coverage_map_.across +
                           coverage.lean.y * coverage_map_.down);
        }
        // Rounding may move parts of the coverage map out of its plane by this much.
        point.offset_m += CoverageMap::kLoose * coverage_map.texel_m;
        const Vec2f place = coverage.place[layer];
        const Vec2f off{place.x - 0.5f, place.y - 0.5f};
        point.point_m = to_float(eye + pixel.middle_m + static_cast<double>(off.x) * pixel.per_x_m +
                                 static_cast<double>(off.y) * pixel.per_y_m);
        finish(k, coverage.share[layer] / shown * samples,
               moved(moments, {place.x - middle_px.x, place.y - middle_px.y}), place, point);
    }
    return count;
}

// Returns the directions through a fragment's pixel: its middle, and the steps of one pixel to the right and
// down.
PrimaryHits::PixelRays PrimaryHits::rays_of(const Fragment& fragment) const {
    const FrameContext& frame = tile_.frame;
    const int x = tile_.box.x0 + fragment.x, y = tile_.box.y0 + fragment.y;
    if (const LinearRays* rays = frame.rays->linear())
        return {rays->corner + (x + 0.5) * rays->right + (y + 0.5) * rays->down, rays->right, rays->down};
    const auto at = [&](float px, float py) { return direction_seen(frame, x, y, {px, py}); };
    return {at(0.5f, 0.5f), 2.0 * (at(0.75f, 0.5f) - at(0.25f, 0.5f)),
            2.0 * (at(0.5f, 0.75f) - at(0.5f, 0.25f))};
}

}  // namespace hilcam
