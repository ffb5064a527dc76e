#include "tools/make_spacecraft/kind_shapes.h"

#include <array>
#include <cmath>

#include "render/vocabulary/units.h"

namespace spacecraft {
namespace {

// Round walls need so many pieces to look round from near by.
constexpr int kAround = 32;

Patch ring(const Shell& s, double z, double from_m, double to_m) {
    return revolution(
        s.part, s.outside, s.place,
        [=](double t) -> std::array<double, 2> {
            return {from_m + t * (to_m - from_m), z};
        },
        kAround, 1, 0);
}

}  // namespace

void add_shell(std::vector<Patch>& patches, const Shell& s) {
    const double first = s.first_radius_m, last = s.last_radius_m, length = s.length_m, wall = s.wall_m;
    const auto radius = [=](double t) { return first + t * (last - first); };
    patches.push_back(revolution(
        s.part, s.outside, s.place,
        [=](double t) -> std::array<double, 2> {
            return {radius(t), t * length};
        },
        kAround, 4, s.detail));
    patches.push_back(revolution(
        s.part, s.inside, s.place,
        [=](double t) -> std::array<double, 2> {
            return {radius(1 - t) - wall, (1 - t) * length};
        },
        kAround, 4, s.detail));
    patches.push_back(ring(s, 0, first - wall, first));
    patches.push_back(ring(s, length, last, last - wall));
}

void add_cylinder(std::vector<Patch>& patches, const std::string& part, const std::string& material,
                  const Placement& place, double radius_m, double length_m, double detail) {
    patches.push_back(revolution(
        part, material, place,
        [=](double t) -> std::array<double, 2> {
            return {radius_m, t * length_m};
        },
        kAround, 3, detail));
    patches.push_back(
        disk(part, material, {place({0, 0, length_m}), place.x, place.y}, radius_m, 0.1 * detail));
    patches.push_back(disk(part, material, {place.origin, place.x, -place.y}, radius_m, 0.1 * detail));
}

Patch disk(std::string part, std::string material, const Placement& place, double radius_m, double detail) {
    return revolution(
        std::move(part), std::move(material), place,
        [=](double t) -> std::array<double, 2> {
            return {radius_m * (1 - t), 0};
        },
        kAround, 1, detail);
}

void add_dish(std::vector<Patch>& patches, const Dish& d) {
    constexpr double kThick = 0.012;  // of the radius
    const double radius = d.radius_m, focal = d.focal_length_m;
    const auto depth = [=](double r) { return r * r / (4 * focal); };
    patches.push_back(revolution(
        d.part, d.front, d.place,
        [=](double t) -> std::array<double, 2> {
            const double r = radius * (1 - t);
            return {r, depth(r)};
        },
        kAround, 6, d.detail));
    patches.push_back(revolution(
        d.part, d.back, d.place,
        [=](double t) -> std::array<double, 2> {
            const double r = radius * t;
            return {r, depth(r) - kThick * radius};
        },
        kAround, 6, d.detail));
    patches.push_back(revolution(
        d.part, d.back, d.place,
        [=](double t) -> std::array<double, 2> {
            return {radius, depth(radius) - kThick * radius * (1 - t)};
        },
        kAround, 1, 0));
}

void add_panel(std::vector<Patch>& patches, const std::string& part, Vec3d middle, Vec3d along_u,
               Vec3d along_v, double thick_m) {
    const double rim_m = 0.7 * thick_m, lift_m = 0.03 * thick_m;
    const Placement place(middle, normalized(along_u), normalized(along_v));
    const double u = length(along_u), v = length(along_v);
    add_box(patches, part, "cfrp", place, {u, v, thick_m}, 0.01);
    patches.push_back(sheet(part, "solar_cell",
                            place({-0.5 * u + rim_m, -0.5 * v + rim_m, 0.5 * thick_m + lift_m}),
                            (u - 2 * rim_m) * place.x, (v - 2 * rim_m) * place.y, 0.05));
}

void add_truss(std::vector<Patch>& patches, const Truss& t) {
    const Vec3d z = normalized(t.to - t.from);
    const Vec3d x = normalized(std::abs(z.z) < 0.9 ? cross(Vec3d{0, 0, 1}, z) : cross(Vec3d{1, 0, 0}, z));
    const Placement place(t.from, x, cross(z, x));
    const double half = 0.5 * t.width_m, bay_m = length(t.to - t.from) / t.bays;
    const std::array<std::array<double, 2>, 4> corners = {
        {{half, half}, {-half, half}, {-half, -half}, {half, -half}}};
    const auto bar = [&](std::size_t a, double from_m, std::size_t b, double to_m) {
        patches.push_back(tube(t.part, t.material, place({corners[a][0], corners[a][1], from_m}),
                               place({corners[b][0], corners[b][1], to_m}), t.tube_radius_m, 0.02));
    };
    for (std::size_t k = 0; k < corners.size(); ++k) {
        bar(k, 0, k, t.bays * bay_m);
        for (int i = 0; i < t.bays; ++i) {
            bar(k, i * bay_m, (k + 1) % corners.size(), (i + 1) * bay_m);
            bar(k, i * bay_m, (k + 1) % corners.size(), i * bay_m);
        }
        bar(k, t.bays * bay_m, (k + 1) % corners.size(), t.bays * bay_m);
    }
}

void add_foil_box(std::vector<Patch>& patches, const std::string& part, const std::string& material,
                  Vec3d middle, Vec3d size, double detail, std::uint32_t seed) {
    const Vec3d x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    const Vec3d low = middle - 0.5 * size, high = middle + 0.5 * size;
    const auto wall = [&](Vec3d corner, Vec3d u, Vec3d v, std::uint32_t number) {
        patches.push_back(blanket(part, material, corner, u, v, detail, seed + 3 * number));
    };
    wall(low, y, x, 0), wall(low, x, z, 1), wall(low, z, y, 2);
    wall(high, -x, -y, 3), wall(high, -z, -x, 4), wall(high, -y, -z, 5);
}

}  // namespace spacecraft
