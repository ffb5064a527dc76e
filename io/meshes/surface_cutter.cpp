#include "io/meshes/surface_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "io/meshes/mesh_precheck.h"
#include "io/system/confined.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// A corner of a piece of a triangle: its place in the picture [texels], and its barycentric coordinates in
// the triangle.
struct CutCorner {
    double x = 0, y = 0;
    std::array<double, 3> share{};
};

CutCorner between(const CutCorner& a, const CutCorner& b, double t) {
    const auto mix = [t](double from, double to) { return (1 - t) * from + t * to; };
    return {mix(a.x, b.x),
            mix(a.y, b.y),
            {mix(a.share[0], b.share[0]), mix(a.share[1], b.share[1]), mix(a.share[2], b.share[2])}};
}

// A triangle cut by the sides of a rectangle has at most seven corners.
class CutPart {
  public:
    void add(const CutCorner& corner) {
        if (count_ < corners_.size()) corners_[count_++] = corner;
    }
    std::span<const CutCorner> corners() const { return std::span(corners_).first(count_); }

    // Returns the pieces on the two sides of a line x = at, or y = at.
    std::array<CutPart, 2> divided(bool along_x, std::int64_t line) const {
        const auto at = static_cast<double>(line);
        std::array<CutPart, 2> out;
        for (std::size_t i = 0; i < count_; ++i) {
            const CutCorner &a = corners_[i], &b = corners_[(i + 1) % count_];
            const double from = (along_x ? a.x : a.y) - at, to = (along_x ? b.x : b.y) - at;
            if (from <= 0) out[0].add(a);
            if (from >= 0) out[1].add(a);
            if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
                CutCorner on = between(a, b, from / (from - to));
                (along_x ? on.x : on.y) = at;
                out[0].add(on), out[1].add(on);
            }
        }
        return out;
    }

  private:
    std::array<CutCorner, 8> corners_;
    std::size_t count_ = 0;
};

// Texels from x0 up to, and without, x1.
struct Rectangle {
    std::int64_t x0, y0, x1, y1;
};

Rectangle rectangle_about(std::span<const CutCorner> corners) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double x0 = kFar, y0 = kFar, x1 = -kFar, y1 = -kFar;
    for (const CutCorner& c : corners)
        x0 = std::min(x0, c.x), y0 = std::min(y0, c.y), x1 = std::max(x1, c.x), y1 = std::max(y1, c.y);
    const auto below = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
    const auto above = [](double v) { return static_cast<std::int64_t>(std::ceil(v)); };
    const Rectangle r{below(x0), below(y0), above(x1), above(y1)};
    return {r.x0, r.y0, std::max(r.x1, r.x0 + 1), std::max(r.y1, r.y0 + 1)};
}

// Finds where a picture has a single kind.
class KindMap {
  public:
    explicit KindMap(KindPicture picture) : picture_(std::move(picture)), stride_(picture_.width + 1) {
        changes_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(picture_.height + 1), 0);
        for (int y = 0; y < picture_.height; ++y)
            for (int x = 0; x < picture_.width; ++x) {
                const std::uint8_t here = picture_.at(x, y);
                const bool changes = (x + 1 < picture_.width && picture_.at(x + 1, y) != here) ||
                                     (y + 1 < picture_.height && picture_.at(x, y + 1) != here);
                changes_[index(x + 1, y + 1)] = changes_[index(x, y + 1)] + changes_[index(x + 1, y)] -
                                                changes_[index(x, y)] + (changes ? 1u : 0u);
            }
    }
    int width() const { return picture_.width; }
    int height() const { return picture_.height; }
    std::uint8_t at(std::int64_t x, std::int64_t y) const { return picture_.at(x, y); }
    bool is_uniform() const { return changes_.back() == 0; }

    // A line that crosses a rectangle and may be a border: the picture's edge or the rectangle's middle.
    // Nothing when the rectangle has a single kind.
    struct Line {
        bool along_x;
        std::int64_t at;
    };
    std::optional<Line> line_through(const Rectangle& r) const {
        if (is_uniform()) return {};
        if (const auto x = edge_between(r.x0, r.x1, width(), picture_.wrap[0])) return Line{true, *x};
        if (const auto y = edge_between(r.y0, r.y1, height(), picture_.wrap[1])) return Line{false, *y};
        if (has_one_kind(r)) return {};
        const bool wide = r.x1 - r.x0 >= r.y1 - r.y0;
        return wide ? Line{true, (r.x0 + r.x1) / 2} : Line{false, (r.y0 + r.y1) / 2};
    }

  private:
    KindPicture picture_;
    int stride_;
    // Sums, over all texels above and to the left, of those that differ from the next texel to the right or
    // below.
    std::vector<std::uint32_t> changes_;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(x);
    }
    static std::int64_t floor_of(std::int64_t a, std::int64_t b) {
        return a >= 0 ? a / b : -((b - 1 - a) / b);
    }
    // Returns an edge between repeated pictures.
    static std::optional<std::int64_t> edge_between(std::int64_t from, std::int64_t to, std::int64_t size,
                                                    TextureWrap wrap) {
        if (wrap == TextureWrap::kClamp) {
            if (from < 0 && to > 0) return 0;
            if (from < size && to > size) return size;
            return {};
        }
        const std::int64_t first = floor_of(from, size) + 1, last = floor_of(to - 1, size);
        if (first > last) return {};
        return size * ((first + last) / 2);
    }
    // Returns a rectangle that crosses no such edge, as texels of the picture.
    std::array<int, 2> inside(std::int64_t from, std::int64_t to, int size, TextureWrap wrap) const {
        const int a = wrapped(from, size, wrap), b = wrapped(to - 1, size, wrap);
        return {std::min(a, b), std::max(a, b)};
    }
    bool has_one_kind(const Rectangle& r) const {
        const auto [x0, x1] = inside(r.x0, r.x1, width(), picture_.wrap[0]);
        const auto [y0, y1] = inside(r.y0, r.y1, height(), picture_.wrap[1]);
        if (x0 == x1 && y0 == y1) return true;
        // Changes beyond the last column and row do not matter; when there are none inside, these are
        // examined one by one.
        const auto sum = [&](int left, int top, int right, int bottom) {
            return left >= right || top >= bottom
                       ? 0u
                       : changes_[index(right, bottom)] - changes_[index(left, bottom)] -
                             changes_[index(right, top)] + changes_[index(left, top)];
        };
        if (sum(x0, y0, x1, y1) != 0) return false;
        for (int y = y0; y < y1; ++y)
            if (picture_.at(x1, y) != picture_.at(x1, y + 1)) return false;
        for (int x = x0; x < x1; ++x)
            if (picture_.at(x, y1) != picture_.at(x + 1, y1)) return false;
        return picture_.at(x0, y0) == picture_.at(x1, y1) && picture_.at(x0, y0) == picture_.at(x1, y0);
    }
};

class Cutter {
  public:
    // `mesh` stays unchanged until finish().
    Cutter(Mesh& mesh, std::size_t max_more)
        : mesh_(mesh), most_(mesh.triangles.size() + max_more), steps_left_(8 * (most_ + 1)) {}

    void keep(std::size_t triangle, std::int32_t surface) { add(mesh_.triangles[triangle], surface); }
    // False: there would be too many.
    bool cut(std::size_t triangle, const SurfaceCut& how, const KindMap& map) {
        if (map.is_uniform()) {
            keep(triangle, how.surface_of_kind[map.at(0, 0)]);
            return true;
        }
        triangle_ = triangle, map_ = &map;
        pieces_.clear();
        if (!divide(whole(triangle, map))) return false;
        // A triangle of a single kind is left as it is.
        const bool one = std::all_of(pieces_.begin(), pieces_.end(),
                                     [&](const Piece& piece) { return piece.kind == pieces_[0].kind; });
        if (pieces_.empty() || one)
            keep(triangle, how.surface_of_kind[pieces_.empty() ? 0 : pieces_[0].kind]);
        else
            for (const Piece& piece : pieces_) emit(piece.part, how.surface_of_kind[piece.kind]);
        return !is_too_many();
    }
    void finish() {
        const auto append = [](auto& to, const auto& from) {
            if (!to.empty()) to.insert(to.end(), from.begin(), from.end());
        };
        mesh_.vertices_m.insert(mesh_.vertices_m.end(), vertices_m_.begin(), vertices_m_.end());
        append(mesh_.normals, normals_);
        append(mesh_.uvs, uvs_);
        append(mesh_.colors, colors_);
        mesh_.triangles = std::move(triangles_);
        mesh_.surface_of_triangle = std::move(surfaces_);
    }
    bool is_too_many() const { return triangles_.size() + pieces_.size() > most_; }

  private:
    struct Piece {
        CutPart part;
        std::uint8_t kind;
    };
    Mesh& mesh_;
    std::size_t most_, steps_left_;
    std::vector<Vec3f> vertices_m_, normals_, colors_;
    std::vector<Vec2f> uvs_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint16_t> surfaces_;
    std::size_t triangle_ = 0;
    const KindMap* map_ = nullptr;
    std::vector<Piece> pieces_;  // pieces of the present triangle

    void add(const std::array<std::uint32_t, 3>& corners, std::int32_t surface) {
        if (surface == SurfaceCut::kNothing) return;
        triangles_.push_back(corners);
        surfaces_.push_back(static_cast<std::uint16_t>(surface));
    }

    CutPart whole(std::size_t triangle, const KindMap& map) const {
        // With this many repeated pictures, a texel is finer than single precision.
        constexpr double kFarthest = 1e6;
        CutPart out;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f uv = mesh_.uvs[mesh_.triangles[triangle][k]];
            CutCorner corner;
            corner.x = std::clamp(static_cast<double>(uv.x), -kFarthest, kFarthest) * map.width();
            corner.y = std::clamp(static_cast<double>(uv.y), -kFarthest, kFarthest) * map.height();
            corner.share[k] = 1;
            out.add(corner);
        }
        return out;
    }

    // False: there would be too many pieces.
    bool divide(const CutPart& part) {
        if (part.corners().size() < 3) return true;
        if (steps_left_ == 0 || is_too_many()) return false;
        --steps_left_;
        const Rectangle r = rectangle_about(part.corners());
        const auto line = map_->line_through(r);
        if (!line) {
            pieces_.push_back({part, map_->at(r.x0, r.y0)});
            return true;
        }
        const std::array<CutPart, 2> parts = part.divided(line->along_x, line->at);
        return divide(parts[0]) && divide(parts[1]);
    }

    void emit(const CutPart& part, std::int32_t surface) {
        if (surface == SurfaceCut::kNothing) return;
        const auto corners = part.corners();
        const auto first = static_cast<std::uint32_t>(mesh_.vertices_m.size() + vertices_m_.size());
        for (const CutCorner& corner : corners) add_vertex(corner);
        for (std::uint32_t k = 2; k < corners.size(); ++k) {
            const std::array<std::uint32_t, 3> t{first, first + k - 1, first + k};
            const auto at = [&](std::size_t i) { return vertices_m_[t[i] - mesh_.vertices_m.size()]; };
            if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) continue;
            add(t, surface);
        }
    }

    void add_vertex(const CutCorner& corner) {
        const auto& from = mesh_.triangles[triangle_];
        const auto mixed = [&](const std::vector<Vec3f>& of) {
            return to_float(corner.share[0] * to_double(of[from[0]]) +
                            corner.share[1] * to_double(of[from[1]]) +
                            corner.share[2] * to_double(of[from[2]]));
        };
        vertices_m_.push_back(mixed(mesh_.vertices_m));
        if (!mesh_.normals.empty()) normals_.push_back(mixed_normal(mixed(mesh_.normals)));
        if (!mesh_.colors.empty()) colors_.push_back(mixed(mesh_.colors));
        Vec2f uv{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto share = static_cast<float>(corner.share[k]);
            uv.x += share * mesh_.uvs[from[k]].x, uv.y += share * mesh_.uvs[from[k]].y;
        }
        uvs_.push_back(uv);
    }
    // Corners without normals get none.
    Vec3f mixed_normal(Vec3f sum) const {
        for (const std::uint32_t v : mesh_.triangles[triangle_])
            if (mesh_.normals[v] == Vec3f{}) return {};
        const float size = length(sum);
        return size > 1e-6f ? sum / size : Vec3f{};
    }
};

bool try_to_cut(Mesh& mesh, std::span<const SurfaceCut> cuts, int halvings, std::size_t max_more) {
    std::vector<std::uint8_t> is_cut(mesh.surfaces.size());
    for (const SurfaceCut& cut : cuts) is_cut[cut.surface] = 1;
    Cutter cutter(mesh, max_more);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!is_cut[mesh.surface_of_triangle[t]]) cutter.keep(t, mesh.surface_of_triangle[t]);
    // One picture at a time, because together they might be large.
    for (const SurfaceCut& cut : cuts) {
        const KindMap map(kind_picture(cut.source, cut.kinds, halvings));
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            if (mesh.surface_of_triangle[t] == cut.surface && !cutter.cut(t, cut, map)) return false;
    }
    cutter.finish();
    return true;
}

}  // namespace

int cut_surfaces(Mesh& mesh, std::span<const SurfaceCut> cuts, std::size_t max_more) {
    if (cuts.empty()) return 0;
    HILCAM_CHECK(mesh.uvs.size() == mesh.vertices_m.size());
    // A picture of one texel cuts nothing.
    for (int halvings = 0;; ++halvings)
        if (try_to_cut(mesh, cuts, halvings, max_more)) return halvings;
}

int cut_mesh(Mesh& mesh, std::span<const SurfaceCut> cuts) {
    // A mask of a net with 1000 x 1000 openings needs that many more triangles. Without masks, a spacecraft
    // with noise for textures must not grow much.
    constexpr std::size_t kMaxOfMasks = 1'000'000, kMin = 100'000;
    constexpr std::uint64_t kBytesOfPicture =
        200 << 20;  // a picture of 2048 x 2048 kinds with its sums, and its source
    if (cuts.empty()) return 0;
    const bool masks =
        std::any_of(cuts.begin(), cuts.end(), [](const SurfaceCut& c) { return c.source.cutoff > 0; });
    const std::size_t most = masks ? kMaxOfMasks : std::max(kMin, mesh.triangles.size());
    allow_more(kBytesOfPicture + 2 * kBytesPerTriangle * most, 60);
    return cut_surfaces(mesh, cuts, most);
}

}  // namespace hilcam
