#include "render/probes/probe_division.h"

#include <algorithm>
#include <numeric>

namespace hilcam {
namespace {

constexpr float kNearly = 0.8f;  // share of all

using Numbers = std::vector<std::size_t>;

// Finds, for each pair of points, whether anything is between them.
class Walls {
  public:
    Walls(std::span<const Vec3f> points_m, const Sight& sight)
        : points_m_(points_m), sight_(sight), known_(points_m.size() * points_m.size()) {}

    bool is_between(std::size_t i, std::size_t j) { return i != j && wall(i, j).has_value(); }
    // Adds both faces of what is between two points.
    void add_faces(std::size_t i, std::size_t j, std::vector<Wall>& out) {
        if (const std::optional<Wall>& there = wall(i, j)) out.push_back(*there);
        const auto [from, to] = std::minmax(i, j);
        if (const std::optional<Wall> back = sight_(points_m_[to], points_m_[from])) out.push_back(*back);
    }

  private:
    std::span<const Vec3f> points_m_;
    const Sight& sight_;
    std::vector<std::optional<std::optional<Wall>>> known_;

    // Returns what is met on the way from the point with the smaller number.
    const std::optional<Wall>& wall(std::size_t i, std::size_t j) {
        const auto [from, to] = std::minmax(i, j);
        std::optional<std::optional<Wall>>& known = known_[from * points_m_.size() + to];
        if (!known) known = sight_(points_m_[from], points_m_[to]);
        return *known;
    }
};

// Removes the point that sees most of the others, together with those that it sees, and returns them.
Numbers take_group(Walls& walls, Numbers& from) {
    Numbers best;
    for (const std::size_t i : from) {
        Numbers seen;
        for (const std::size_t j : from)
            if (!walls.is_between(i, j)) seen.push_back(j);
        if (seen.size() > best.size()) best = seen;
    }
    std::erase_if(from, [&](std::size_t i) { return std::find(best.begin(), best.end(), i) != best.end(); });
    return best;
}

// Returns the share of pairs between the groups that a wall separates.
float share_hidden(Walls& walls, const Numbers& a, const Numbers& b) {
    float hidden = 0;
    for (const std::size_t i : a)
        for (const std::size_t j : b) hidden += walls.is_between(i, j) ? 1.0f : 0.0f;
    return hidden / static_cast<float>(a.size() * b.size());
}

// Returns the plane between two groups, perpendicular to the surface.
std::optional<ProbeDivision> plane_between(Walls& walls, std::span<const Vec3f> points_m,
                                           const Numbers& below, const Numbers& above, Vec3f facing) {
    std::vector<Wall> faces;
    for (const std::size_t i : below)
        for (const std::size_t j : above)
            if (walls.is_between(i, j)) walls.add_faces(i, j, faces);
    const Vec3f way_m = points_m[above.front()] - points_m[below.front()];
    Vec3f along{}, middle_m{};
    for (const Wall& face : faces) {
        const Vec3f flat = face.normal - dot(face.normal, facing) * facing;
        const float size = length(flat);
        if (size > 0) along = along + (dot(flat, way_m) > 0 ? 1 / size : -1 / size) * flat;
        middle_m = middle_m + face.at_m;
    }
    if (!(length(along) > 0)) return std::nullopt;
    along = normalized(along);
    return ProbeDivision{along, dot(along, middle_m) / static_cast<float>(faces.size())};
}

}  // namespace

std::optional<DividedPoints> find_division(std::span<const Vec3f> points_m, Vec3f facing,
                                           const Sight& sight) {
    // Usually there is no wall.
    if (points_m.empty() || std::none_of(points_m.begin() + 1, points_m.end(), [&](Vec3f point_m) {
            return sight(points_m.front(), point_m).has_value();
        }))
        return std::nullopt;
    Walls walls(points_m, sight);
    Numbers rest(points_m.size());
    std::iota(rest.begin(), rest.end(), std::size_t{0});
    DividedPoints out;
    out.below = take_group(walls, rest);
    if (rest.empty()) return std::nullopt;
    out.above = take_group(walls, rest);
    if (share_hidden(walls, out.below, out.above) < kNearly ||
        share_hidden(walls, out.below, out.below) > 1 - kNearly ||
        share_hidden(walls, out.above, out.above) > 1 - kNearly)
        return std::nullopt;
    const std::optional<ProbeDivision> plane = plane_between(walls, points_m, out.below, out.above, facing);
    if (!plane) return std::nullopt;
    out.by = *plane;
    const auto keep = [&](Numbers& group, bool above) {
        const auto count = static_cast<float>(group.size());
        std::erase_if(group, [&](std::size_t i) { return out.by.is_above(points_m[i]) != above; });
        return static_cast<float>(group.size()) >= kNearly * count;
    };
    return keep(out.below, false) && keep(out.above, true) ? std::optional(out) : std::nullopt;
}

}  // namespace hilcam
