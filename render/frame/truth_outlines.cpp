#include "render/frame/truth_outlines.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/visibility/screen_bounds.h"

namespace hilcam {
namespace {

// The largest number of rays per thing beside the frame; for a larger thing one ray represents a square of
// several pixels.
constexpr double kMaxRaysBeside = 65536;
// Across the bounds of a small thing.
constexpr int kFine = 64;

double area_of(const PixelBox& box) {
    return box.empty() ? 0.0 : static_cast<double>(box.x1 - box.x0) * (box.y1 - box.y0);
}

// Places in the frame, gathered for sixteen rays at a time.
template <class Trace>
class Packets {
  public:
    explicit Packets(const Trace& trace) : trace_(trace) {}

    void add(Vec2d frame_px, double area_px) {
        frame_px_[count_] = frame_px, area_px_[count_] = area_px;
        if (++count_ == frame_px_.size()) flush();
    }
    // Call it after the last one.
    void flush() {
        if (count_ > 0)
            trace_(std::span<const Vec2d>(frame_px_.data(), count_),
                   std::span<const double>(area_px_.data(), count_));
        count_ = 0;
    }

  private:
    const Trace& trace_;
    std::array<Vec2d, kPacketSize> frame_px_;
    std::array<double, kPacketSize> area_px_{};
    std::size_t count_ = 0;
};

std::size_t pixel_number(const FrameRaster& raster, Vec2d frame_px) {
    return static_cast<std::size_t>(frame_px.y) * static_cast<std::size_t>(raster.width_px) +
           static_cast<std::size_t>(frame_px.x);
}

}  // namespace

void TruthOutlines::Outline::add(Vec2d frame_px, double area) {
    area_px += area;
    const int x = static_cast<int>(std::floor(frame_px.x)), y = static_cast<int>(std::floor(frame_px.y));
    x0 = std::min(x0, x), x1 = std::max(x1, x + 1);
    y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
}

void TruthOutlines::Outline::add(const Outline& other) {
    area_px += other.area_px;
    x0 = std::min(x0, other.x0), x1 = std::max(x1, other.x1);
    y0 = std::min(y0, other.y0), y1 = std::max(y1, other.y1);
}

// Returns the bounds of the thing's sphere, in px of the frame, up to a frame's size beside it.
PixelBox TruthOutlines::canvas_bounds(const SeenThing& thing) const {
    const FrameRaster& raster = truth_.raster;
    const int width = raster.width_px, height = raster.height_px;
    const PixelBox canvas{-width, -height, 2 * width, 2 * height};
    // Rows of several instants may meet it anywhere.
    if (!frame_.rays->is_still() || thing.distance_m <= thing.radius_m) return canvas;
    // The picture with a guard band that holds the canvas.
    ImageGeometry wide = frame_.geometry;
    wide.guard_px = 2 * static_cast<int>(std::ceil(
                            std::max(std::abs(raster.x.scale) * width + std::abs(raster.x.offset_px),
                                     std::abs(raster.y.scale) * height + std::abs(raster.y.offset_px))));
    const double sine = thing.radius_m / thing.distance_m;
    const Vec3d to_thing_m = thing.world.position_world_m - world_.camera.position_world_m;
    const PixelBox padded =
        screen_bounds_of_cone(wide, world_.camera, to_thing_m / thing.distance_m, std::sqrt(1 - sine * sine));
    if (padded.empty()) return {};
    const double guard_px = wide.guard_px;
    const Vec2d a = raster.frame_px({padded.x0 - guard_px, padded.y0 - guard_px});
    const Vec2d b = raster.frame_px({padded.x1 - guard_px, padded.y1 - guard_px});
    const auto within = [](double px, int least, int most) {
        return static_cast<int>(std::clamp(px, static_cast<double>(least), static_cast<double>(most)));
    };
    return {within(std::floor(std::min(a.x, b.x)), canvas.x0, canvas.x1),
            within(std::floor(std::min(a.y, b.y)), canvas.y0, canvas.y1),
            within(std::ceil(std::max(a.x, b.x)), canvas.x0, canvas.x1),
            within(std::ceil(std::max(a.y, b.y)), canvas.y0, canvas.y1)};
}

std::uint32_t TruthOutlines::meets_alone(const SeenThing& thing, std::span<const Vec2d> image_px) const {
    std::uint32_t met = 0;
    if (thing.is_body) {
        for (const PlacedBody& body : frame_.background->disks())
            if (truth_id(body.id) == thing.id) met = rays_.meets_body(image_px, body);
    } else {
        for (std::size_t i = 0; i < setup_.objects(); ++i)
            if (owner_of(truth_, i) + 1 == thing.id) met |= rays_.meets_object(image_px, i);
    }
    for (std::size_t k = 0; k < image_px.size(); ++k)
        if ((met >> k & 1u) != 0 && !rays_.exists(image_px[k])) met &= ~(1u << k);
    return met;
}

// Sums what the thing covers at the places that fill(row, packets) gives, for a range of rows. marks: one
// byte for each pixel of the frame, set if it is covered.
template <class Fill>
TruthOutlines::Outline TruthOutlines::covered(const SeenThing& thing, int first_row, int last_row,
                                              const Fill& fill, std::vector<std::uint8_t>* marks) const {
    const auto add_rows = [&](const tbb::blocked_range<int>& range, Outline sum) {
        const auto trace = [&](std::span<const Vec2d> frame_px, std::span<const double> area_px) {
            std::array<Vec2d, kPacketSize> image_px;
            for (std::size_t k = 0; k < frame_px.size(); ++k)
                image_px[k] = truth_.raster.image_px(frame_px[k]);
            const std::uint32_t met = meets_alone(thing, {image_px.data(), frame_px.size()});
            for (std::size_t k = 0; k < frame_px.size(); ++k) {
                if ((met >> k & 1u) == 0) continue;
                sum.add(frame_px[k], area_px[k]);
                if (marks) (*marks)[pixel_number(truth_.raster, frame_px[k])] = 1;
            }
        };
        Packets packets(trace);
        for (int row = range.begin(); row < range.end(); ++row) fill(row, packets);
        packets.flush();
        return sum;
    };
    // Sums of whole numbers: the same in any order.
    return tbb::parallel_reduce(tbb::blocked_range<int>(first_row, last_row, 8), Outline{}, add_rows,
                                [](Outline a, const Outline& b) {
                                    a.add(b);
                                    return a;
                                });
}

// Returns the part inside the frame that is behind other things or under black pixels.
TruthOutlines::Outline TruthOutlines::hidden_part(const SeenThing& thing, const PixelBox& bounds,
                                                  std::vector<std::uint8_t>* marks) const {
    const PixelBox box{std::max(bounds.x0, 0), std::max(bounds.y0, 0),
                       std::min(bounds.x1, truth_.raster.width_px),
                       std::min(bounds.y1, truth_.raster.height_px)};
    if (box.empty()) return {};
    const auto fill = [&](int y, auto& packets) {
        const std::span<const std::uint32_t> ids = std::as_const(truth_.layers.object).row(y);
        for (int x = box.x0; x < box.x1; ++x) {
            const std::uint32_t id = ids[static_cast<std::size_t>(x)];
            if (id == thing.id) continue;
            // Black pixels have had no ray.
            const Vec2d at{x + 0.5, y + 0.5};
            if (id != kSkyId || !rays_.on_image(truth_.raster.image_px(at))) packets.add(at, 1);
        }
    };
    return covered(thing, box.y0, box.y1, fill, marks);
}

// Returns the part in a box beside the frame; rays go through the middles of squares of `step` pixels.
TruthOutlines::Outline TruthOutlines::part_beside(const SeenThing& thing, const PixelBox& box,
                                                  int step) const {
    if (box.empty()) return {};
    const int rows = (box.y1 - box.y0 + step - 1) / step;
    const auto fill = [&](int row, auto& packets) {
        const int y0 = box.y0 + row * step, y1 = std::min(y0 + step, box.y1);
        for (int x0 = box.x0; x0 < box.x1; x0 += step) {
            const int x1 = std::min(x0 + step, box.x1);
            packets.add({0.5 * (x0 + x1), 0.5 * (y0 + y1)}, area_of({x0, y0, x1, y1}));
        }
    };
    return covered(thing, 0, rows, fill, nullptr);
}

// Returns the part in all bounds beside the frame; step: gets the side of the squares.
TruthOutlines::Outline TruthOutlines::parts_beside(const SeenThing& thing, const PixelBox& bounds,
                                                   int& step) const {
    const int width = truth_.raster.width_px, height = truth_.raster.height_px;
    const int y0 = std::max(bounds.y0, 0), y1 = std::min(bounds.y1, height);
    const std::array<PixelBox, 4> beside = {{{bounds.x0, bounds.y0, bounds.x1, std::min(bounds.y1, 0)},
                                             {bounds.x0, std::max(bounds.y0, height), bounds.x1, bounds.y1},
                                             {bounds.x0, y0, std::min(bounds.x1, 0), y1},
                                             {std::max(bounds.x0, width), y0, bounds.x1, y1}}};
    double area_px = 0;
    for (const PixelBox& box : beside) area_px += area_of(box);
    step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area_px / kMaxRaysBeside))));
    Outline all;
    for (const PixelBox& box : beside) all.add(part_beside(thing, box, step));
    return all;
}

// A body drawn as points has none, and neither has ground, which extends only as far as the camera needs.
bool TruthOutlines::has_outline(const SeenThing& thing) const {
    const auto disks = frame_.background->disks();
    if (thing.is_body)
        return std::any_of(disks.begin(), disks.end(),
                           [&](const PlacedBody& body) { return truth_id(body.id) == thing.id; });
    return !setup_.has_terrain() || thing.id != 1 + owner_of(truth_, setup_.objects() - 1);
}

PixelSilhouette TruthOutlines::silhouette_of(const SeenThing& thing, std::vector<std::uint8_t>& marks) const {
    PixelSilhouette out;
    out.thing = thing.id;
    const PixelBox bounds = canvas_bounds(thing);
    if (bounds.empty()) return out;
    std::fill(marks.begin(), marks.end(), std::uint8_t{0});
    Outline all = hidden_part(thing, bounds, &marks);
    if (all.area_px > 0)
        for (std::size_t i = 0; i < marks.size(); ++i)
            if (marks[i] != 0) out.hidden_px.push_back(static_cast<std::uint32_t>(i));
    if (thing.visible_px > 0) all.add(Outline(thing.visible_box_px, static_cast<double>(thing.visible_px)));
    int step = 1;
    all.add(parts_beside(thing, bounds, step));
    out.px = static_cast<std::uint64_t>(all.area_px);
    out.box_px = all.box();
    return out;
}

void TruthOutlines::find_silhouettes() {
    truth_.silhouettes.clear();
    std::vector<std::uint8_t> marks(static_cast<std::size_t>(truth_.raster.width_px) *
                                    static_cast<std::size_t>(truth_.raster.height_px));
    for (const SeenThing& thing : truth_.things)
        if (!thing.is_body && has_outline(thing)) truth_.silhouettes.push_back(silhouette_of(thing, marks));
}

void TruthOutlines::measure(SeenThing& thing) const {
    if (!has_outline(thing)) return;
    const PixelBox bounds = canvas_bounds(thing);
    if (bounds.empty()) return;
    if (bounds.x1 - bounds.x0 <= SeenThing::kSmall_px && bounds.y1 - bounds.y0 <= SeenThing::kSmall_px)
        return measure_small(thing, bounds);

    const int width = truth_.raster.width_px, height = truth_.raster.height_px;
    Outline all = hidden_part(thing, bounds);
    if (thing.visible_px > 0) all.add(Outline(thing.visible_box_px, static_cast<double>(thing.visible_px)));
    int step = 1;
    all.add(parts_beside(thing, bounds, step));
    thing.silhouette_px = all.area_px;
    thing.silhouette_box_px = all.box();
    if (all.area_px <= 0) return;
    thing.visible_fraction = static_cast<double>(thing.visible_px) / all.area_px;
    thing.silhouette_cut = all.x0 - step < -width || all.y0 - step < -height || all.x1 + step > 2 * width ||
                           all.y1 + step > 2 * height;
}

void TruthOutlines::measure_small(SeenThing& thing, const PixelBox& bounds) const {
    const double step_x = static_cast<double>(bounds.x1 - bounds.x0) / kFine;
    const double step_y = static_cast<double>(bounds.y1 - bounds.y0) / kFine;
    Outline all, visible;
    Vec2d sum_px{};
    const auto trace = [&](std::span<const Vec2d> frame_px, std::span<const double> area_px) {
        std::array<Vec2d, kPacketSize> image_px;
        for (std::size_t k = 0; k < frame_px.size(); ++k) image_px[k] = truth_.raster.image_px(frame_px[k]);
        const std::span<const Vec2d> points(image_px.data(), frame_px.size());
        const std::uint32_t met = meets_alone(thing, points);
        if (met == 0) return;
        std::array<RayMet, kPacketSize> first;
        rays_.trace(points, false, first);
        for (std::size_t k = 0; k < points.size(); ++k) {
            if ((met >> k & 1u) == 0) continue;
            const Vec2d at = frame_px[k];
            all.add(at, area_px[k]);
            const bool in_frame = at.x >= 0 && at.y >= 0 && at.x < truth_.raster.width_px &&
                                  at.y < truth_.raster.height_px && rays_.on_image(points[k]);
            if (!in_frame || id_of(truth_, first[k]) != thing.id) continue;
            visible.add(at, area_px[k]);
            sum_px = {sum_px.x + area_px[k] * at.x, sum_px.y + area_px[k] * at.y};
        }
    };
    Packets packets(trace);
    for (int y = 0; y < kFine; ++y)
        for (int x = 0; x < kFine; ++x)
            packets.add({bounds.x0 + (x + 0.5) * step_x, bounds.y0 + (y + 0.5) * step_y}, step_x * step_y);
    packets.flush();
    thing.silhouette_px = all.area_px;
    thing.silhouette_box_px = all.box();
    thing.visible_box_px = visible.box();
    if (visible.area_px > 0)
        thing.visible_center_px = {sum_px.x / visible.area_px, sum_px.y / visible.area_px};
    if (all.area_px > 0) thing.visible_fraction = visible.area_px / all.area_px;
}

}  // namespace hilcam
