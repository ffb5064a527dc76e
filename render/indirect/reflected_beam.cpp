#include "render/indirect/reflected_beam.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/vocabulary/clones.h"

namespace hilcam {

HILCAM_CLONES void find_places_in_beam(const ReflectedBeam& beam, BeamPlaces& places) {
    using Line = ReflectedBeam::Line;
    const Line d = beam.distance, u = beam.x, v = beam.y;
    const float nearest_m = beam.min_m, width_m = beam.width_m, height_m = beam.height_m;
    const Vec2f margin = beam.margin, margin_m = beam.margin_m;
    for (std::size_t i = 0; i < BeamPlaces::kMax; ++i) {
        const float px = places.x[i], py = places.y[i], pz = places.z[i];
        const auto at = [&](const Line& line) {
            return line.by_place.x * px + line.by_place.y * py + line.by_place.z * pz + line.constant;
        };
        const float away_m = at(d), x = at(u), y = at(v);
        const float more_x = margin_m.x + margin.x * away_m, more_y = margin_m.y + margin.y * away_m;
        const bool sees = (away_m > nearest_m) & (x > -more_x) & (x < width_m + more_x) & (y > -more_y) &
                          (y < height_m + more_y);
        places.in_beam[i] = sees ? 1 : 0;
    }
}

void ReflectedBeams::add(const ReflectedBeam& beam) {
    const std::size_t i = count_++ % kTogether;
    if (i == 0) {
        // No place is so far away: unused entries of a block meet nothing.
        blocks_.emplace_back();
        blocks_.back().min_m.fill(std::numeric_limits<float>::infinity());
    }
    Block& block = blocks_.back();
    const auto set = [i](Lines& lines, const ReflectedBeam::Line& line) {
        lines.by_x[i] = line.by_place.x, lines.by_y[i] = line.by_place.y, lines.by_z[i] = line.by_place.z;
        lines.constant[i] = line.constant;
    };
    set(block.distance, beam.distance), set(block.x, beam.x), set(block.y, beam.y);
    block.min_m[i] = beam.min_m, block.width_m[i] = beam.width_m, block.height_m[i] = beam.height_m;
    block.margin_x[i] = beam.margin.x, block.margin_y[i] = beam.margin.y;
    block.margin_x_m[i] = beam.margin_m.x, block.margin_y_m[i] = beam.margin_m.y;
}

void ReflectedBeams::find(const PlaceBox& box, std::size_t block,
                          std::array<std::uint8_t, kTogether>& meets) const {
    find_in(blocks_[block], box, meets);
}

// Each line is within its value at the box's middle plus or minus the most that half the box adds, plus the
// rounding of a dozen operations on terms as large as `size`.
HILCAM_CLONES void ReflectedBeams::find_in(const Block& block, const PlaceBox& box,
                                           std::array<std::uint8_t, kTogether>& meets) {
    constexpr float kRounding = 16 * std::numeric_limits<float>::epsilon();
    const Vec3f m = box.middle_m, h = box.half_m;
    const Vec3f farthest{std::abs(m.x) + h.x, std::abs(m.y) + h.y, std::abs(m.z) + h.z};
    std::array<std::int32_t, kTogether> met;
    for (std::size_t i = 0; i < kTogether; ++i) {
        struct Span {
            float least, most;
        };
        const auto range = [&](const Lines& l) {
            const float bx = l.by_x[i], by = l.by_y[i], bz = l.by_z[i], c = l.constant[i];
            const float ax = std::abs(bx), ay = std::abs(by), az = std::abs(bz);
            const float middle = bx * m.x + by * m.y + bz * m.z + c;
            const float size = ax * farthest.x + ay * farthest.y + az * farthest.z + std::abs(c);
            const float half = ax * h.x + ay * h.y + az * h.z + kRounding * size;
            return Span{middle - half, middle + half};
        };
        const Span away = range(block.distance), x = range(block.x), y = range(block.y);
        const float more_x = (block.margin_x_m[i] + block.margin_x[i] * away.most) * (1 + kRounding);
        const float more_y = (block.margin_y_m[i] + block.margin_y[i] * away.most) * (1 + kRounding);
        const bool meets_box = (away.most > block.min_m[i]) & (x.most > -more_x) &
                               (x.least < block.width_m[i] + more_x) & (y.most > -more_y) &
                               (y.least < block.height_m[i] + more_y);
        met[i] = meets_box ? 1 : 0;
    }
    for (std::size_t i = 0; i < kTogether; ++i) meets[i] = static_cast<std::uint8_t>(met[i]);
}

}  // namespace hilcam
