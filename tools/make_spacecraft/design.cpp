#include "tools/make_spacecraft/design.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "tools/make_spacecraft/shapes.h"

namespace spacecraft {
namespace {

constexpr double kPi = hilcam::kPi;
constexpr Vec3d kBus{2.4, 2.2, 3.6};
constexpr double kX = kBus.x / 2, kY = kBus.y / 2, kZ = kBus.z / 2;
// Triangles per square metre and unit of detail are relative; crumpled foil needs the most.
constexpr double kFoil = 3.0;

struct Builder {
    DesignOptions options;
    std::vector<Patch> patches;
    std::uint32_t next_seed;

    // A wall covered with blankets about 0.8 m wide, with a tape strip over each seam.
    void foil_wall(const std::string& material, Vec3d corner, Vec3d along_u, Vec3d along_v) {
        const int columns = std::max(1, static_cast<int>(std::lround(length(along_u) / 0.8)));
        const int rows = std::max(1, static_cast<int>(std::lround(length(along_v) / 0.9)));
        const Vec3d du = along_u / columns, dv = along_v / rows;
        const Vec3d out = 0.012 * normalized(cross(along_u, along_v));
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                patches.push_back(
                    blanket("bus", material, corner + i * du + j * dv, du, dv, kFoil, next_seed));
                next_seed += 3;
            }
        const Vec3d half_u = 0.012 * normalized(along_u), half_v = 0.012 * normalized(along_v);
        for (int i = 1; i < columns; ++i)
            patches.push_back(
                sheet("bus", "tape", corner + i * du - half_u + 1.3 * out, 2.0 * half_u, along_v, 0.01));
        for (int j = 1; j < rows; ++j)
            patches.push_back(
                sheet("bus", "tape", corner + j * dv - half_v + 1.3 * out, along_u, 2.0 * half_v, 0.01));
    }

    // A radiator of optical solar reflectors: square mirrors with gaps over a white panel.
    void radiator(double y, double outward) {
        const double width = kBus.x - 0.3, height = kBus.z - 0.5;
        const Vec3d corner{-outward * width / 2, y + outward * 0.03, -height / 2};
        const Vec3d along_u{outward * width, 0, 0}, along_v{0, 0, height};
        // u x v must point along +y or -y: (x, z) gives -y.
        const bool flip = cross(along_u, along_v).y * outward < 0;
        const Vec3d start = flip ? corner + along_u : corner;
        const Vec3d u = flip ? -along_u : along_u;
        patches.push_back(sheet("radiator", "white_paint", start, u, along_v, 0.05));
        const int columns = options.triangles < 20000 ? 3 : 24, rows = options.triangles < 20000 ? 4 : 36;
        const double gap = 0.004;
        const Vec3d lift{0, outward * 0.003, 0};
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const Vec3d du = u / columns, dv = along_v / rows;
                // Tiles are glued by hand: each is tilted by up to 0.1 deg.
                const double tilt = 0.0017 * (lattice_value(options.seed + 77, i, j) - 0.5) * length(dv);
                patches.push_back(
                    sheet("radiator", "osr",
                          start + i * du + j * dv + gap * normalized(du) + gap * normalized(dv) + lift,
                          du - 2 * gap * normalized(du), dv - 2 * gap * normalized(dv) + Vec3d{0, tilt, 0},
                          0.0004));
            }
    }

    void bus() {
        add_box(patches, "bus", "aluminium", Placement({0, 0, 0}), kBus, 0.01);
        foil_wall("mli_gold", {kX, -kY, -kZ}, {0, kBus.y, 0}, {0, 0, kBus.z});
        foil_wall("mli_gold", {-kX, kY, -kZ}, {0, -kBus.y, 0}, {0, 0, kBus.z});
        foil_wall("mli_gold", {-kX, kY, -kZ}, {kBus.x, 0, 0}, {0, -kBus.y, 0});
        foil_wall("mli_black", {-kX, -kY, kZ}, {kBus.x, 0, 0}, {0, kBus.y, 0});
        foil_wall("mli_gold", {-kX, -kY, -kZ}, {kBus.x, 0, 0}, {0, 0, kBus.z});
        foil_wall("mli_gold", {kX, kY, -kZ}, {-kBus.x, 0, 0}, {0, 0, kBus.z});
        radiator(kY, 1);
        radiator(-kY, -1);
        // Handrails on the two foil walls.
        for (const double s : {-1.0, 1.0})
            for (const double y : {-0.7, 0.7}) {
                const double x = s * (kX + 0.09);
                patches.push_back(tube("bus", "aluminium", {x, y, -1.2}, {x, y, 1.2}, 0.012, 0.02));
                for (const double z : {-1.2, 0.0, 1.2})
                    patches.push_back(tube("bus", "aluminium", {s * kX, y, z}, {x, y, z}, 0.01, 0.005));
            }
    }

    void propulsion() {
        // Bell of the apogee engine (radius grows with the square root, as a parabolic nozzle's) inside and
        // outside.
        const Placement down{{0, 0, -kZ - 0.02}, {1, 0, 0}, {0, -1, 0}};
        const auto bell = [](double t) -> std::array<double, 2> {
            return {0.05 + 0.21 * std::sqrt(t), 0.08 + 0.52 * t};
        };
        patches.push_back(revolution("engine", "nozzle", down, bell, 16, 6, 0.4));
        patches.push_back(revolution(
            "engine", "nozzle", down,
            [=](double t) {
                const auto p = bell(1 - t);
                return std::array<double, 2>{p[0] - 0.004, p[1]};
            },
            16, 6, 0.4));
        const auto ring = [](double t) -> std::array<double, 2> {
            const double a = 2 * kPi * t;
            return {0.6 + 0.03 * std::cos(a), 0.12 + 0.12 * std::sin(a)};
        };
        patches.push_back(revolution("engine", "aluminium", down, ring, 24, 4, 0.4));
        for (const double sx : {-1.0, 1.0})
            for (const double sy : {-1.0, 1.0})
                for (const double lift : {0.0, 0.16}) {
                    const Placement at{
                        {sx * (kX - 0.15), sy * (kY - 0.15 - lift), -kZ - 0.03}, {1, 0, 0}, {0, -1, 0}};
                    patches.push_back(revolution(
                        "thrusters", "nozzle", at,
                        [](double t) -> std::array<double, 2> {
                            return {0.012 + 0.03 * std::sqrt(t), 0.02 + 0.1 * t};
                        },
                        8, 2, 0.02));
                    add_box(patches, "thrusters", "aluminium", Placement(at.origin), {0.09, 0.09, 0.06},
                            0.002);
                }
    }

    // An offset paraboloid on an arm at +x or -x, its feed on the Earth deck.
    void dish(double side) {
        const double radius = 1.1, focal = 1.5;
        const double tilt = side * 0.32;
        const Placement place{
            {side * (kX + 1.35), 0, kZ - 0.3}, {std::cos(tilt), 0, std::sin(tilt)}, {0, 1, 0}};
        const auto bowl = [=](double t) -> std::array<double, 2> {
            const double r = radius * t;
            return {r, r * r / (4 * focal)};
        };
        patches.push_back(revolution(
            "dish", "dish_white", place, [=](double t) { return bowl(1 - t); }, 24, 6, 2.0));
        patches.push_back(revolution(
            "dish", "panel_back", place,
            [=](double t) {
                const auto p = bowl(t);
                return std::array<double, 2>{p[0], p[1] - 0.025};
            },
            24, 6, 1.0));
        const double rim = radius * radius / (4 * focal);
        patches.push_back(revolution(
            "dish", "dish_white", place,
            [=](double t) -> std::array<double, 2> {
                return {radius, rim - 0.025 * (1 - t)};
            },
            24, 1, 0.05));
        for (int i = 0; i < 6; ++i) {
            const double a = i * kPi / 3;
            patches.push_back(tube("dish", "cfrp", place({0, 0, -0.12}),
                                   place({0.85 * std::cos(a), 0.85 * std::sin(a), 0.09}), 0.018, 0.02));
        }
        patches.push_back(
            tube("dish", "cfrp", {side * kX, 0.35, kZ - 0.7}, place({0, 0, -0.12}), 0.035, 0.05));
        patches.push_back(
            tube("dish", "cfrp", {side * kX, -0.35, kZ - 0.7}, place({0, 0, -0.12}), 0.035, 0.05));
        const Vec3d feed{side * 0.75, 0, kZ + 0.55};
        const Vec3d aim = normalized(place({0, 0, 0.1}) - feed);
        const Vec3d across = normalized(cross(Vec3d{0, 1, 0}, aim));
        for (const double y : {-0.22, 0.0, 0.22})
            patches.push_back(revolution(
                "feeds", "aluminium", {feed + Vec3d{0, y, 0}, across, cross(aim, across)},
                [](double t) -> std::array<double, 2> {
                    return {0.03 + 0.06 * t, 0.3 * t - 0.15};
                },
                10, 2, 0.05));
        add_box(patches, "feeds", "mli_silver", Placement({side * 0.72, 0, kZ + 0.3}), {0.3, 0.75, 0.45},
                0.02);
    }

    void deck() {
        patches.push_back(tube("mast", "cfrp", {0, 0, kZ}, {0, 0, kZ + 1.6}, 0.05, 0.1));
        patches.push_back(revolution(
            "mast", "white_paint", Placement({0, 0, kZ + 1.6}),
            [](double t) -> std::array<double, 2> {
                return {0.05 + 0.1 * t, 0.35 * t};
            },
            12, 2, 0.1));
        for (int i = 0; i < 4; ++i) {
            const double a = i * kPi / 2 + kPi / 4;
            patches.push_back(tube("mast", "cfrp", {0.45 * std::cos(a), 0.45 * std::sin(a), kZ},
                                   {0, 0, kZ + 1.1}, 0.015, 0.03));
            patches.push_back(revolution(
                "horns", "aluminium", Placement({0.9 * std::cos(a), 0.75 * std::sin(a), kZ + 0.05}),
                [](double t) -> std::array<double, 2> {
                    return {0.04 + 0.07 * t, 0.4 * t};
                },
                12, 2, 0.06));
        }
        for (const double s : {-1.0, 1.0}) {
            const double lean = 0.6;
            patches.push_back(revolution(
                "star_trackers", "baffle_black",
                {{s * 0.25, s * 0.7, kZ + 0.1}, {0, 0, 1}, {s * std::cos(lean), -s * std::sin(lean), 0}},
                [](double t) -> std::array<double, 2> {
                    return {0.05 + 0.05 * t, 0.3 * t};
                },
                12, 2, 0.05));
            add_box(patches, "boxes", "mli_silver", Placement({-s * 0.6, s * 0.6, kZ + 0.12}),
                    {0.4, 0.35, 0.22}, 0.02);
        }
    }

    void panel(const std::string& part, const Placement& wing, double near, double along, double outward) {
        const double width = 2.4, thickness = 0.028;
        const Vec3d middle{0, outward * (near + along / 2), 0};
        add_box(patches, part, "panel_back", {wing(middle), wing.x, wing.y}, {width, along, thickness}, 0.02);
        const double top = thickness / 2 + 0.0008;
        if (options.triangles < 20000) {
            patches.push_back(sheet(part, "solar_cell", wing(middle + Vec3d{-width / 2, -along / 2, top}),
                                    width * wing.x, along * wing.y, 0.05));
            return;
        }
        patches.push_back(sheet(part, "cell_substrate", wing(middle + Vec3d{-width / 2, -along / 2, top}),
                                width * wing.x, along * wing.y, 0.05));
        const int columns = 15, rows = 18;
        const double cell_x = (width - 0.06) / columns, cell_y = (along - 0.06) / rows, gap = 0.0025;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const Vec3d corner = middle + Vec3d{-width / 2 + 0.03 + i * cell_x + gap,
                                                    -along / 2 + 0.03 + j * cell_y + gap, top + 0.0006};
                // Cells lie within a tenth of a degree of their panel.
                const double a =
                    0.0035 * (lattice_value(options.seed + 5, i + 100 * j, std::lround(near * 10)) - 0.5);
                const double b =
                    0.0035 * (lattice_value(options.seed + 6, i + 100 * j, std::lround(near * 10)) - 0.5);
                const Vec3d du{cell_x - 2 * gap, 0, a * cell_x}, dv{0, cell_y - 2 * gap, b * cell_y};
                patches.push_back(sheet(part, "solar_cell", wing(corner), wing(corner + du) - wing(corner),
                                        wing(corner + dv) - wing(corner), 0.006));
                for (const double bar : {0.3, 0.7}) {
                    const Vec3d start = corner + bar * du + Vec3d{0, 0, 0.0004};
                    patches.push_back(sheet(part, "busbar", wing(start), 0.0015 * wing.x,
                                            wing(start + dv) - wing(start), 0));
                }
            }
    }

    void wing(double outward) {
        const std::string part = outward > 0 ? "wing_north" : "wing_south";
        const double c = std::cos(options.wing_angle_rad), s = std::sin(options.wing_angle_rad);
        // Rotation about y that turns +z towards +x.
        const Placement place{{0, outward * kY, 0}, {c, 0, -s}, {0, 1, 0}};
        const double root = 0.25, yoke = 1.7, along = 2.45, hinge = 0.05;
        patches.push_back(
            tube(part, "aluminium", place({0, 0, 0}), place({0, outward * root, 0}), 0.09, 0.05));
        for (const double x : {-1.0, 1.0})
            patches.push_back(tube(part, "cfrp", place({0, outward * root, 0}),
                                   place({x * 1.0, outward * yoke, 0}), 0.035, 0.05));
        patches.push_back(tube(part, "cfrp", place({-1.05, outward * yoke, 0}),
                               place({1.05, outward * yoke, 0}), 0.035, 0.05));
        for (int i = 0; i < 4; ++i) {
            const double near = yoke + hinge + i * (along + hinge);
            panel(part, place, near, along, outward);
            for (const double x : {-0.8, 0.8})
                add_box(patches, part, "aluminium", Placement(place({x, outward * (near - hinge / 2), 0})),
                        {0.12, 0.09, 0.05}, 0.001);
        }
    }
};

}  // namespace

std::vector<Patch> design(const DesignOptions& options) {
    Builder builder{options, {}, options.seed * 1000};
    builder.bus();
    builder.propulsion();
    builder.dish(1);
    builder.dish(-1);
    builder.deck();
    builder.wing(1);
    builder.wing(-1);
    return std::move(builder.patches);
}

}  // namespace spacecraft
