#include "render/lod/coverage_map_painter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "render/vocabulary/fnv.h"

namespace hilcam {
namespace {

// A gap runs along a side if it is free along that side for this many times as long. Any value well above one
// separates gaps from squares.
constexpr float kClear = 2;

struct HashOfTexels {
    std::size_t operator()(const CoverageTexels& texels) const {
        Fnv1a hash;
        for (const std::uint64_t word :
             std::bit_cast<std::array<std::uint64_t, sizeof(texels) / sizeof(std::uint64_t)>>(texels))
            hash.take(word);
        return hash.value();
    }
};

int texel_of(double at, int count) { return std::clamp(static_cast<int>(std::floor(at)), 0, count - 1); }

// A convex polygon with a few corners [texels].
struct Shape {
    std::array<Vec2d, 8> corner;
    std::size_t count = 0;

    // Returns the part in which depth(corner), a linear function, is not negative (Sutherland & Hodgman, CACM
    // 17(1), 1974).
    template <class Depth>
    Shape cut(const Depth& depth) const {
        Shape out;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2d a = corner[i], b = corner[(i + 1) % count];
            const double in_a = depth(a), in_b = depth(b);
            if (in_a >= 0) out.corner[out.count++] = a;
            if ((in_a < 0) == (in_b < 0)) continue;
            const double t = in_a / (in_a - in_b);
            out.corner[out.count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        }
        return out;
    }
    double area() const {
        double twice = 0;
        for (std::size_t i = 0; i < count; ++i)
            twice += corner[i].x * corner[(i + 1) % count].y - corner[(i + 1) % count].x * corner[i].y;
        return std::abs(twice) / 2;
    }
    // Returns least and greatest of a coordinate.
    template <class Of>
    std::pair<double, double> extent(const Of& of) const {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (std::size_t i = 0; i < count; ++i)
            least = std::min(least, of(corner[i])), most = std::max(most, of(corner[i]));
        return {least, most};
    }
};

// Returns the part of a line along the texels' rows inside a triangle, begin and end [texels]; begin > end if
// there is none.
std::pair<double, double> part_in(const std::array<Vec2d, 3>& triangle, double y) {
    double from = std::numeric_limits<double>::infinity(), until = -from;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2d a = triangle[k], b = triangle[(k + 1) % 3];
        const double below = a.y - y, above = b.y - y;
        if (below * above > 0 || below == above) continue;
        const double x = a.x + below / (below - above) * (b.x - a.x);
        from = std::min(from, x), until = std::max(until, x);
    }
    return {from, until};
}

// Returns the texels of a row, first and end, that a triangle fills completely: those inside it at the row's
// top and bottom, because it is convex.
std::pair<int, int> full_texels(const std::array<Vec2d, 3>& triangle, int row) {
    constexpr double kRounding = 1e-6;  // texels
    const auto [top_from, top_until] = part_in(triangle, row);
    const auto [bottom_from, bottom_until] = part_in(triangle, row + 1);
    const double from = std::max(top_from, bottom_from) + kRounding,
                 until = std::min(top_until, bottom_until) - kRounding;
    if (!(from < until)) return {0, 0};
    return {static_cast<int>(std::ceil(from)), static_cast<int>(std::floor(until))};
}

}  // namespace

void CoverageMapPainter::Texel::add(const Texel& other, float weight) {
    for (std::size_t k = 0; k < share.size(); ++k) share[k] += weight * other.share[k];
    for (std::size_t axis = 0; axis < 2; ++axis)
        lean[axis] += weight * other.lean[axis], gap[axis] += weight * other.gap[axis];
    down += weight * other.down;
}

template <class Row>
void CoverageMapPainter::for_each_row(int rows, const Row& row) {
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, kRowsTogether), [&](const auto& range) {
        for (int y = range.begin(); y != range.end(); ++y) row(y);
    });
}

void CoverageMapPainter::begin(CoverageMap& coverage_map) {
    coverage_map_ = &coverage_map;
    columns_ = std::max(1, static_cast<int>(std::ceil(coverage_map.width_m / coverage_map.texel_m)));
    rows_ = std::max(1, static_cast<int>(std::ceil(coverage_map.height_m / coverage_map.texel_m)));
    pieces_.clear();
}

void CoverageMapPainter::add(std::size_t layer, const std::array<Vec3d, 3>& corners) {
    const Vec3d across = to_double(coverage_map_->across), down = to_double(coverage_map_->down);
    Piece& piece = pieces_.emplace_back();
    piece.layer = layer;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d from = (1 / static_cast<double>(coverage_map_->texel_m)) *
                           (corners[i] - to_double(coverage_map_->corner_m));
        piece.corners[i] = {dot(from, across), dot(from, down)};
    }
    const auto [top, bottom] = std::minmax({piece.corners[0].y, piece.corners[1].y, piece.corners[2].y});
    piece.first_row = texel_of(top, rows_), piece.last_row = texel_of(bottom, rows_);
    Vec3d normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
    if (dot(normal, to_double(coverage_map_->normal)) < 0) normal = -normal;
    piece.lean = {static_cast<float>(dot(normal, across)), static_cast<float>(dot(normal, down))};
}

double CoverageMapPainter::fill() {
    texels_.resize(at(0, rows_));
    // By row, so that the sum does not depend on how rows are divided.
    std::vector<Ground> ground(static_cast<std::size_t>(rows_));
    for_each_row(rows_, [&](int y) {
        const std::span<Texel> row(texels_.data() + at(0, y), static_cast<std::size_t>(columns_));
        std::fill(row.begin(), row.end(), Texel{});
        for (const Piece& piece : pieces_)
            if (piece.first_row <= y && y <= piece.last_row) fill_row(piece, y, row);
        ground[static_cast<std::size_t>(y)] = hide_lower(row);
    });
    Ground sum;
    for (const Ground& of_row : ground) sum.all += of_row.all, sum.seen += of_row.seen;
    return sum.all > 0 ? sum.seen / sum.all : 0;
}

void CoverageMapPainter::fill_row(const Piece& piece, int y, std::span<Texel> texels) const {
    Shape whole;
    std::copy(piece.corners.begin(), piece.corners.end(), whole.corner.begin()), whole.count = 3;
    const Shape row = whole.cut([&](Vec2d p) { return p.y - y; }).cut([&](Vec2d p) { return y + 1 - p.y; });
    if (row.count < 3) return;
    const auto put = [&](int x, float area) {
        Texel& texel = texels[static_cast<std::size_t>(x)];
        texel.share[piece.layer] += area;
        if (piece.layer > 0) texel.lean[0] += area * piece.lean.x, texel.lean[1] += area * piece.lean.y;
    };
    const auto cut = [&](int x) {
        const Shape part =
            row.cut([&](Vec2d p) { return p.x - x; }).cut([&](Vec2d p) { return x + 1 - p.x; });
        put(x, static_cast<float>(part.area()));
    };
    const auto [left, right] = row.extent([](Vec2d p) { return p.x; });
    const int first = texel_of(left, columns_), last = texel_of(right, columns_);
    const auto [full, full_end] = full_texels(piece.corners, y);
    const int begin = std::clamp(full, first, last + 1), end = std::clamp(full_end, begin, last + 1);
    for (int x = first; x < begin; ++x) cut(x);
    for (int x = begin; x < end; ++x) put(x, 1);
    for (int x = end; x <= last; ++x) cut(x);
}

// Removes from each layer what those above it cover.
CoverageMapPainter::Ground CoverageMapPainter::hide_lower(std::span<Texel> texels) const {
    Ground out;
    for (Texel& texel : texels) {
        const float whole = std::min(texel.share[0], 1.0f);
        float open = whole, upper = 0;
        for (std::size_t k = coverage_map_->layers; k-- > 0;) {
            if (k > 0) upper += texel.share[k];
            // Layers above cover this one first, as far as it extends.
            texel.share[k] = std::clamp(std::min(texel.share[k], 1.0f) - (whole - open), 0.0f, open);
            open -= texel.share[k];
        }
        const float seen_upper = whole - texel.share[0];
        for (float& lean : texel.lean) lean *= upper > 0 ? seen_upper / upper : 0.0f;
        out.all += static_cast<double>(whole), out.seen += static_cast<double>(texel.share[0]);
    }
    return out;
}

void CoverageMapPainter::finish() {
    find_gaps();
    for (;;) {
        pack();
        if (columns_ == 1 && rows_ == 1) return;
        halve();
    }
}

// Where gaps cross, lines along both sides are free for long; there gaps have the width of their
// continuation.
void CoverageMapPainter::find_gaps() {
    const std::array<std::vector<float>, 2> narrow{narrowness(0), narrowness(1)};
    const auto find_gap = [&](int x, int y) {
        Texel& texel = texels_[at(x, y)];
        const float ground = texel.share[0];
        if (!(ground > 0)) return;
        float across = narrow[0][at(x, y)], along = narrow[1][at(x, y)];
        float down = across > kClear * along ? 1.0f : (along > kClear * across ? 0.0f : 0.5f);
        if (down == 0.5f) {
            const float of_column = narrow_beside(narrow[0], narrow[1], x, y, false),
                        of_row = narrow_beside(narrow[1], narrow[0], x, y, true);
            if (of_column > 0 || of_row > 0) {
                down = of_column > 0 ? (of_row > 0 ? 0.5f : 1.0f) : 0.0f;
                across = of_column, along = of_row;
            }
        }
        texel.down = ground * down;
        texel.gap = {ground * down * across, ground * (1 - down) * along};
    };
    for_each_row(rows_, [&](int y) {
        for (int x = 0; x < columns_; ++x) find_gap(x, y);
    });
}

// Returns the narrowness of a gap that continues from a neighbour along a column or a row; 0: there is none.
float CoverageMapPainter::narrow_beside(const std::vector<float>& of, const std::vector<float>& against,
                                        int column, int row, bool along_rows) const {
    constexpr int kReach = 6;  // texels
    for (int step = 1; step <= kReach; ++step)
        for (const int way : {-step, step}) {
            const int x = along_rows ? column + way : column, y = along_rows ? row : row + way;
            if (x < 0 || y < 0 || x >= columns_ || y >= rows_ || !(texels_[at(x, y)].share[0] > 0)) continue;
            if (of[at(x, y)] > kClear * against[at(x, y)]) return of[at(x, y)];
        }
    return 0;
}

// Returns, by texel, the narrowness of what upper triangles leave free along an axis, from lengths of lines;
// 0: nothing is free.
std::vector<float> CoverageMapPainter::narrowness(std::size_t axis) const {
    std::vector<float> out(texels_.size());
    const int texels = axis == 0 ? columns_ : rows_, across = axis == 0 ? rows_ : columns_;
    const std::vector<Parts> covered = covered_parts(axis, kLinesEach * across);
    for_each_row(across, [&](int row) {
        // By texel along the row: the free share of the lines, and the narrowness times that.
        std::vector<Vec2f> free(static_cast<std::size_t>(texels));
        const auto take = [&](double from, double until, bool at_end) {
            // At the end of a row it is shaded from one side only.
            const double width_m =
                (at_end ? 2 : 1) * (until - from) * static_cast<double>(coverage_map_->texel_m);
            const auto narrow =
                static_cast<float>(std::min(1.0, static_cast<double>(coverage_map_->upper_m) / width_m));
            for (int i = texel_of(from, texels); i <= texel_of(until, texels); ++i) {
                const auto part =
                    static_cast<float>(std::min(until, i + 1.0) - std::max(from, static_cast<double>(i)));
                Vec2f& there = free[static_cast<std::size_t>(i)];
                if (part > 0) there.x += part, there.y += part * narrow;
            }
        };
        for (int line = kLinesEach * row; line < kLinesEach * (row + 1); ++line) {
            double from = 0;
            for (const auto& [begin, end] : covered[static_cast<std::size_t>(line)]) {
                if (begin > from) take(from, begin, from <= 0);
                from = std::max(from, end);
            }
            if (texels > from) take(from, texels, true);
        }
        for (int i = 0; i < texels; ++i) {
            const auto [open, narrow] = free[static_cast<std::size_t>(i)];
            if (open > 0) out[axis == 0 ? at(i, row) : at(row, i)] = narrow / open;
        }
    });
    return out;
}

// Returns the parts of lines along an axis that upper triangles cover, in order.
std::vector<CoverageMapPainter::Parts> CoverageMapPainter::covered_parts(std::size_t axis, int lines) const {
    std::vector<Parts> out(static_cast<std::size_t>(lines));
    for (const Piece& piece : pieces_) {
        if (piece.layer == 0) continue;
        std::array<Vec2d, 3> p = piece.corners;
        if (axis == 1)
            for (Vec2d& corner : p) std::swap(corner.x, corner.y);
        const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
        const int first = std::max(0, static_cast<int>(std::ceil(low * kLinesEach - 0.5))),
                  last = std::min(lines - 1, static_cast<int>(std::floor(high * kLinesEach - 0.5)));
        for (int line = first; line <= last; ++line) {
            const double at = (line + 0.5) / kLinesEach;
            const auto [from, until] = part_in(p, at);
            if (until > from) out[static_cast<std::size_t>(line)].emplace_back(from, until);
        }
    }
    for (Parts& line : out) std::sort(line.begin(), line.end());
    return out;
}

void CoverageMapPainter::pack() {
    CoverageMap::Level& level = coverage_map_->levels_.emplace_back();
    level.columns = columns_, level.rows = rows_;
    const std::size_t each = level.row_of_eights();
    std::vector<CoverageTexels> all(each * static_cast<std::size_t>(rows_));
    for_each_row(rows_, [&](int y) {
        for (std::size_t n = 0; n < each; ++n)
            all[level.eight(static_cast<int>(n), y)] =
                packed(static_cast<int>(n * CoverageTexels::kLanes), y);
    });
    std::unordered_map<CoverageTexels, std::uint32_t, HashOfTexels> numbers;
    for (const CoverageTexels& texels : all) {
        const auto [found, fresh] =
            numbers.try_emplace(texels, static_cast<std::uint32_t>(level.kinds.size()));
        if (fresh) level.kinds.push_back(texels);
        level.eights.push_back(found->second);
    }
    level.kinds.shrink_to_fit();
}

// Packs eight texels of a row.
CoverageTexels CoverageMapPainter::packed(int first, int row) const {
    CoverageTexels out{};
    const auto byte = [](float share) {
        return static_cast<std::uint8_t>(std::clamp(255 * share + 0.5f, 0.0f, 255.0f));
    };
    const auto count = std::min(CoverageTexels::kLanes, static_cast<std::size_t>(columns_ - first));
    for (std::size_t lane = 0; lane < count; ++lane) {
        const Texel& texel = texels_[at(first, row) + lane];
        // Rounded so that their sum is rounded, too.
        float sum = 0;
        int given = 0;
        for (std::size_t k = 0; k < coverage_map_->layers; ++k) {
            sum += texel.share[k];
            const int part = byte(sum) - given;
            out.share[k][lane] = static_cast<std::uint8_t>(std::max(part, 0));
            given += part;
        }
        out.down[lane] = byte(texel.down);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const float lean = std::clamp(texel.lean[axis] / CoverageMap::kMaxLean, -1.0f, 1.0f);
            out.lean[axis][lane] =
                static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(127 * lean)));
            out.gap[axis][lane] = byte(texel.gap[axis]);
        }
    }
    return out;
}

// Halves the resolution: means of four texels.
void CoverageMapPainter::halve() {
    const int columns = (columns_ + 1) / 2, rows = (rows_ + 1) / 2;
    halved_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto mean = [&](int x, int y) {
        Texel sum;
        for (int j = 2 * y; j < std::min(2 * y + 2, rows_); ++j)
            for (int i = 2 * x; i < std::min(2 * x + 2, columns_); ++i) sum.add(texels_[at(i, j)], 0.25f);
        return sum;
    };
    for_each_row(rows, [&](int y) {
        Texel* to = halved_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
        for (int x = 0; x < columns; ++x) to[x] = mean(x, y);
    });
    texels_.swap(halved_);
    columns_ = columns, rows_ = rows;
}

}  // namespace hilcam
