#include "render/probes/flat_mirrors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "render/lod/plane_rectangle.h"

namespace hilcam {
namespace {

constexpr double kSamePlane = 0.999986;  // cosine of 0.3 degrees
// Cosine of a degree: limit between corner normals and their triangle's.
constexpr float kMirrorCorner = 0.99985f;
// Mirrors smaller than this share of the object's squared radius reflect too little, and so do those that
// fill less than this share of their rectangle, such as bars.
constexpr double kMinArea = 1e-2, kMinMirrorFilled = 0.2;
// The number of largest parts that are examined, each with everything in its plane.
constexpr std::size_t kMaxMirrorSeeds = 64;

// Triangles in one plane, up to insignificant digits.
struct PlanePart {
    std::uint64_t key = 0;
    std::uint16_t surface = 0;
    Vec3d area;    // sum of area vectors, all on one side
    Vec3d middle;  // area-weighted mean of positions; until then a sum
    double area_m2 = 0;
    int mirror = -1;
};

struct MirrorTriangle {
    Vec3f a, b, c;
    Vec3d area;  // vector
};

// Returns the one of two opposite vectors that points up, or else along y, or else along x.
Vec3d upwards(Vec3d v) {
    const bool down = v.z < 0 || (v.z == 0 && (v.y < 0 || (v.y == 0 && v.x < 0)));
    return down ? -v : v;
}

bool is_curved(const PackedTriangle& triangle, Vec3d normal) {
    if (triangle.flat) return false;
    return std::any_of(triangle.corner_normals.begin(), triangle.corner_normals.end(),
                       [&](std::uint32_t packed) {
                           return std::abs(dot(unpack_normal(packed), to_float(normal))) < kMirrorCorner;
                       });
}

// Takes the smallest of the rectangles along an edge of the largest triangle.
void lay_out(std::span<const MirrorTriangle> triangles, Vec3d normal, Vec3d middle, FlatMirror& out) {
    const MirrorTriangle& largest = *std::max_element(triangles.begin(), triangles.end(),
                                                      [](const MirrorTriangle& a, const MirrorTriangle& b) {
                                                          return dot(a.area, a.area) < dot(b.area, b.area);
                                                      });
    const auto edge = [](Vec3f from, Vec3f to) { return to_double(to) - to_double(from); };
    const std::array<Vec3d, 3> edges{edge(largest.a, largest.b), edge(largest.b, largest.c),
                                     edge(largest.a, largest.c)};
    std::vector<std::array<Vec3d, 3>> corners;
    for (const MirrorTriangle& t : triangles)
        corners.push_back({to_double(t.a), to_double(t.b), to_double(t.c)});
    const PlaneRectangle r = smallest_rectangle(corners, edges, normal);
    out.across = to_float(r.across), out.down = to_float(r.down), out.normal = to_float(normal);
    out.width_m = static_cast<float>(r.width()), out.height_m = static_cast<float>(r.height());
    out.corner_m =
        to_float(dot(middle, normal) * normal + r.x0 * to_double(out.across) + r.y0 * to_double(out.down));
}

class MirrorFinder {
  public:
    MirrorFinder(const MeshView& mesh, const ObjectSurfaces& surfaces, std::span<const float> throws)
        : mesh_(mesh),
          surfaces_(surfaces),
          throws_(throws),
          tolerance_m_(std::max(1e-3, 1e-4 * surfaces.radius_m)) {}

    std::vector<FlatMirror> find() {
        sort_into_parts();
        join_parts();
        const std::vector<std::vector<MirrorTriangle>> of = triangles();
        std::vector<FlatMirror> out;
        for (std::size_t m = 0; m < mirrors_.size() && out.size() < kMaxFlatMirrors; ++m) {
            FlatMirror mirror;
            lay_out(of[m], normalized(mirrors_[m].area), mirrors_[m].middle, mirror);
            const double whole_m2 =
                static_cast<double>(mirror.width_m) * static_cast<double>(mirror.height_m);
            if (!(mirrors_[m].area_m2 > kMinMirrorFilled * whole_m2)) continue;
            mirror.surface = mirrors_[m].surface;
            mirror.area_m2 = static_cast<float>(mirrors_[m].area_m2);
            mirror.tolerance_m = static_cast<float>(2 * tolerance_m_);
            for (const MirrorTriangle& t : of[m]) mirror.draw(t.a, t.b, t.c);
            mirror.sum_up();
            out.push_back(std::move(mirror));
        }
        return out;
    }

  private:
    struct Mirror {
        std::uint16_t surface;
        Vec3d area, middle;
        double area_m2 = 0, thrown_m2 = 0;
        std::vector<std::size_t> parts;
    };
    const MeshView& mesh_;
    const ObjectSurfaces& surfaces_;
    std::span<const float> throws_;
    double tolerance_m_;
    std::vector<PlanePart> parts_;
    std::unordered_map<std::uint64_t, std::size_t> part_of_;  // by key
    std::vector<Mirror> mirrors_;

    // Calls visit(surface, triangle, key) for all flat triangles that mirror.
    template <class Visit>
    void for_each_triangle(const Visit& visit) const {
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const PackedTriangle& packed = surfaces_.triangles[i];
            if (!(throws_[packed.surface] > 0)) continue;
            const auto& corner = mesh_.triangles[i];
            MirrorTriangle t{
                mesh_.vertices_m[corner[0]], mesh_.vertices_m[corner[1]], mesh_.vertices_m[corner[2]], {}};
            const Vec3d a = to_double(t.a);
            t.area = upwards(0.5 * cross(to_double(t.b) - a, to_double(t.c) - a));
            const double area_m2 = length(t.area);
            if (!(area_m2 > 1e-12)) continue;
            const Vec3d normal = t.area / area_m2;
            if (!is_curved(packed, normal)) visit(packed.surface, t, key_of(packed.surface, normal, a));
        }
    }

    // Steps of a fifth of a degree of the normal, and of the tolerance of the plane's distance from the
    // origin.
    std::uint64_t key_of(std::uint16_t surface, Vec3d normal, Vec3d place) const {
        const auto step = [](double x, double size, std::uint64_t mask) {
            return static_cast<std::uint64_t>(std::llround(x / size)) & mask;
        };
        constexpr double kStep = 1.0 / 256;
        return std::uint64_t{surface} << 52 | step(normal.x, kStep, 0x3FF) << 42 |
               step(normal.y, kStep, 0x3FF) << 32 | step(normal.z, kStep, 0x3FF) << 22 |
               step(dot(normal, place), tolerance_m_, 0x3FFFFF);
    }

    void sort_into_parts() {
        for_each_triangle([&](std::uint16_t surface, const MirrorTriangle& t, std::uint64_t key) {
            const auto [found, added] = part_of_.try_emplace(key, parts_.size());
            if (added) parts_.emplace_back().key = key;
            PlanePart& part = parts_[found->second];
            const double area_m2 = length(t.area);
            part.surface = surface;
            part.area = part.area + t.area;
            part.middle = part.middle + area_m2 / 3 * (to_double(t.a) + to_double(t.b) + to_double(t.c));
            part.area_m2 += area_m2;
        });
        for (PlanePart& part : parts_) part.middle = part.middle / part.area_m2;
        // The largest first; equal ones by key, so that the mesh's order does not matter.
        std::sort(parts_.begin(), parts_.end(), [](const PlanePart& a, const PlanePart& b) {
            return a.area_m2 != b.area_m2 ? a.area_m2 > b.area_m2 : a.key < b.key;
        });
        for (std::size_t p = 0; p < parts_.size(); ++p) part_of_[parts_[p].key] = p;
    }

    void join_parts() {
        std::size_t seeds = 0;
        for (std::size_t s = 0; s < parts_.size() && seeds < kMaxMirrorSeeds; ++s) {
            const PlanePart& seed = parts_[s];
            if (seed.mirror >= 0) continue;
            ++seeds;
            const Vec3d normal = normalized(seed.area);
            Mirror mirror{seed.surface, {}, {}, 0, 0, {}};
            for (std::size_t p = s; p < parts_.size(); ++p) {
                PlanePart& part = parts_[p];
                const double cosine = dot(part.area, normal);
                if (part.mirror >= 0 || part.surface != seed.surface ||
                    std::abs(cosine) < kSamePlane * length(part.area) ||
                    std::abs(dot(part.middle - seed.middle, normal)) > tolerance_m_)
                    continue;
                part.mirror = 0;
                mirror.parts.push_back(p);
                mirror.area = mirror.area + (cosine < 0 ? -1.0 : 1.0) * part.area;
                mirror.middle = mirror.middle + part.area_m2 * part.middle;
                mirror.area_m2 += part.area_m2;
            }
            mirror.middle = mirror.middle / mirror.area_m2;
            mirror.thrown_m2 = mirror.area_m2 * static_cast<double>(throws_[seed.surface]);
            if (mirror.area_m2 > kMinArea * surfaces_.radius_m * surfaces_.radius_m)
                mirrors_.push_back(std::move(mirror));
        }
        std::stable_sort(mirrors_.begin(), mirrors_.end(),
                         [](const Mirror& a, const Mirror& b) { return a.thrown_m2 > b.thrown_m2; });
        for (PlanePart& part : parts_) part.mirror = -1;
        for (std::size_t m = 0; m < mirrors_.size(); ++m)
            for (const std::size_t p : mirrors_[m].parts) parts_[p].mirror = static_cast<int>(m);
    }

    // Returns the triangles of each mirror.
    std::vector<std::vector<MirrorTriangle>> triangles() const {
        std::vector<std::vector<MirrorTriangle>> out(mirrors_.size());
        for_each_triangle([&](std::uint16_t, const MirrorTriangle& t, std::uint64_t key) {
            const int mirror = parts_[part_of_.at(key)].mirror;
            if (mirror >= 0) out[static_cast<std::size_t>(mirror)].push_back(t);
        });
        return out;
    }
};

}  // namespace

std::vector<FlatMirror> find_flat_mirrors(const MeshView& mesh, const ObjectSurfaces& surfaces,
                                          std::span<const float> throws) {
    if (std::none_of(throws.begin(), throws.end(), [](float share) { return share > 0; })) return {};
    return MirrorFinder(mesh, surfaces, throws).find();
}

void FlatMirror::draw(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const double cells_x = kCells / static_cast<double>(width_m),
                 cells_y = kCells / static_cast<double>(height_m);
    const auto place = [&](Vec3f at) {
        const Vec3d from = to_double(at) - to_double(corner_m);
        return Vec2d{cells_x * dot(from, to_double(across)), cells_y * dot(from, to_double(down))};
    };
    const std::array<Vec2d, 3> p{place(a), place(b), place(c)};
    // Twice the area of the triangle formed by a side and a place: all have one sign inside.
    const auto side = [&](std::size_t i, double x, double y) {
        const Vec2d u = p[i], v = p[(i + 1) % 3];
        return (v.x - u.x) * (y - u.y) - (v.y - u.y) * (x - u.x);
    };
    const auto cell = [](double x) { return std::clamp(static_cast<int>(std::floor(x)), 0, kCells - 1); };
    const int x0 = cell(std::min({p[0].x, p[1].x, p[2].x})), x1 = cell(std::max({p[0].x, p[1].x, p[2].x}));
    const int y0 = cell(std::min({p[0].y, p[1].y, p[2].y})), y1 = cell(std::max({p[0].y, p[1].y, p[2].y}));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const double s0 = side(0, x + 0.5, y + 0.5), s1 = side(1, x + 0.5, y + 0.5),
                         s2 = side(2, x + 0.5, y + 0.5);
            // A place on an edge belongs to both triangles.
            if ((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0))
                sums_[static_cast<std::size_t>((y + 1) * (kCells + 1) + x + 1)] = 1;
        }
}

// Starts from all filled cells at once and moves outwards, ring by ring.
void FlatMirror::find_nearest() {
    constexpr std::size_t kAll = std::size_t{kCells} * kCells;
    static_assert(kAll - 1 <= 0xFFFF);
    nearest_.assign(kAll, 0);
    std::vector<std::uint8_t> known(kAll);
    std::vector<std::uint16_t> ring;
    for (std::size_t i = 0; i < kAll; ++i)
        if (sums_[(i / kCells + 1) * (kCells + 1) + i % kCells + 1] != 0)
            known[i] = 1, nearest_[i] = static_cast<std::uint16_t>(i), ring.push_back(nearest_[i]);
    for (std::vector<std::uint16_t> next; !ring.empty(); std::swap(ring, next), next.clear())
        for (const std::uint16_t cell : ring) {
            const int x = cell % kCells, y = cell / kCells;
            for (int row = std::max(0, y - 1); row <= std::min(kCells - 1, y + 1); ++row)
                for (int column = std::max(0, x - 1); column <= std::min(kCells - 1, x + 1); ++column) {
                    const auto beside = static_cast<std::size_t>(row * kCells + column);
                    if (std::exchange(known[beside], 1) != 0) continue;
                    nearest_[beside] = nearest_[cell], next.push_back(static_cast<std::uint16_t>(beside));
                }
        }
}

Vec2f FlatMirror::middle_within(Vec2f middle_m, Vec2f size_m) const {
    const auto middle = [](float at, float size, float whole) {
        return 0.5f * (std::clamp(at - 0.5f * size, 0.0f, whole) + std::clamp(at + 0.5f * size, 0.0f, whole));
    };
    return {middle(middle_m.x, size_m.x, width_m), middle(middle_m.y, size_m.y, height_m)};
}

Vec2f FlatMirror::nearest_filled(Vec2f place_m) const {
    const auto cell = [](float at, float size) {
        return static_cast<std::size_t>(std::clamp(at / size, 0.0f, static_cast<float>(kCells - 1)));
    };
    const Vec2f size_m = cell_m();
    const std::uint16_t found = nearest_[cell(place_m.y, size_m.y) * kCells + cell(place_m.x, size_m.x)];
    return {(static_cast<float>(found % kCells) + 0.5f) * size_m.x,
            (static_cast<float>(found / kCells) + 0.5f) * size_m.y};
}

void FlatMirror::sum_up() {
    find_nearest();
    constexpr std::size_t kRow = kCells + 1;
    for (std::size_t y = 1; y <= kCells; ++y)
        for (std::size_t x = 1; x <= kCells; ++x) {
            std::uint32_t* at = &sums_[y * kRow + x];
            *at += at[-1] + *(at - kRow) - *(at - kRow - 1);
        }
}

// Returns the sum over everything to the left and above a place in cells, with each cell's value spread
// evenly over it.
double FlatMirror::sum_to(double x, double y) const {
    x = std::clamp(x, 0.0, static_cast<double>(kCells)), y = std::clamp(y, 0.0, static_cast<double>(kCells));
    const int i = std::min(static_cast<int>(x), kCells - 1), k = std::min(static_cast<int>(y), kCells - 1);
    const double u = x - i, v = y - k;
    const std::uint32_t* at = &sums_[static_cast<std::size_t>(k * (kCells + 1) + i)];
    const auto value = [&](std::size_t step) { return static_cast<double>(at[step]); };
    return (1 - v) * ((1 - u) * value(0) + u * value(1)) +
           v * ((1 - u) * value(kCells + 1) + u * value(kCells + 2));
}

float FlatMirror::filled(Vec2f middle_m, Vec2f size_m) const {
    struct Cells {
        double from, to;
    };
    const auto range = [](float middle, float size, float whole) {  // in cells
        const double per_m = kCells / static_cast<double>(whole), at = per_m * static_cast<double>(middle);
        const double half = 0.5 * std::max(1.0, per_m * static_cast<double>(size));
        return Cells{at - half, at + half};
    };
    const Cells x = range(middle_m.x, size_m.x, width_m), y = range(middle_m.y, size_m.y, height_m);
    if (x.to <= 0 || y.to <= 0 || x.from >= kCells || y.from >= kCells) return 0;
    const double sum =
        sum_to(x.to, y.to) - sum_to(x.from, y.to) - sum_to(x.to, y.from) + sum_to(x.from, y.from);
    return static_cast<float>(std::max(0.0, sum) / ((x.to - x.from) * (y.to - y.from)));
}

bool FlatMirror::holds(Vec3f point_m, Vec3f normal_there) const {
    const Vec3f from = point_m - corner_m;
    return std::abs(dot(normal_there, normal)) > kMirrorCorner &&
           std::abs(dot(from, normal)) < 2 * tolerance_m &&
           filled({dot(from, across), dot(from, down)}, {4 * cell_m().x, 4 * cell_m().y}) > 0;
}

}  // namespace hilcam
