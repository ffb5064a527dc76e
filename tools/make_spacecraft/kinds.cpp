#include "tools/make_spacecraft/kinds.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "render/vocabulary/units.h"
#include "tools/make_spacecraft/kind_shapes.h"

namespace spacecraft {
namespace {

Vec3d around(double angle_rad, double radius_m, double z_m) {
    return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m};
}

std::vector<Patch> telescope(std::uint32_t seed) {
    std::vector<Patch> p;
    add_shell(p, {"tube", "aluminium_bare", "black_anodised", Placement({0, 0, -1}), 1.2, 1.2, 5.5, 0.03, 6});
    for (const double z : {0.6, 1.8, 3.0})  // baffles inside
        add_shell(p, {"baffles", "black_anodised", "black_anodised", Placement({0, 0, z}), 1.15, 1.0, 0.06,
                      0.01, 0.1});
    add_dish(p, {"mirror", "osr", "cfrp", Placement({0, 0, -0.5}), 1.1, 3.5, 2});
    add_cylinder(p, "secondary", "black_anodised", Placement({0, 0, 3.2}), 0.18, 0.3, 0.2);
    for (int i = 0; i < 4; ++i)
        p.push_back(tube("secondary", "black_anodised", around(i * hilcam::kPi / 2, 0.15, 3.35),
                         around(i * hilcam::kPi / 2, 1.17, 3.35), 0.02, 0.05));
    add_cylinder(p, "equipment", "mli_silvered", Placement({0, 0, -2.6}), 1.55, 1.7, 2);
    const Placement door({0, -1.25, 4.55}, {1, 0, 0}, {0, -0.34, 0.94});
    add_box(p, "door", "aluminium_bare", {door({0, 1.25, 0}), door.x, door.y}, {2.3, 2.4, 0.04}, 0.05);
    for (const double side : {-1.0, 1.0}) {
        p.push_back(tube("arms", "anodised_clear", {side * 1.2, 0, 1}, {side * 1.9, 0, 1}, 0.05, 0.05));
        add_panel(p, "wings", {side * 3.2, 0, 1}, {0, side * 5.5, 0}, {-2.4, 0, 0});
        p.push_back(tube("handrails", "anodised_clear", around(side * 0.8, 1.3, -0.8),
                         around(side * 0.8, 1.3, 4), 0.025, 0.1));
        p.push_back(tube("boom", "cfrp", {0, side * 1.5, -1.5}, {0, side * 2.3, -1.5}, 0.04, 0.05));
        add_dish(p, {"antenna",
                     "white_paint",
                     "white_paint",
                     {{0, side * 2.3, -1.5}, {0, 0, 1}, {side, 0, 0}},
                     0.6,
                     0.5,
                     0.6});
    }
    p.push_back(blanket("aft", "mli_kapton", {-1, 1, -2.65}, {2, 0, 0}, {0, -2, 0}, 2, seed));
    return p;
}

std::vector<Patch> cubesat(std::uint32_t seed) {
    std::vector<Patch> p;
    add_box(p, "frame", "anodised_clear", Placement({0, 0, 0}), {0.1, 0.2263, 0.34}, 0.5);
    for (const double x : {-0.05, 0.05})
        for (const double y : {-0.113, 0.113})
            add_box(p, "rails", "aluminium_bare", Placement({x, y, 0}), {0.009, 0.009, 0.36}, 0.05);
    p.push_back(blanket("foil", "mli_kapton", {0.0505, -0.1, -0.16}, {0, 0.2, 0}, {0, 0, 0.12}, 60, seed));
    for (const double side : {-1.0, 1.0})
        for (int i = 0; i < 2; ++i)
            add_panel(p, "wings", {-0.07, side * (0.23 + 0.22 * i), 0}, {0, 0, 0.32}, {0, side * -0.205, 0},
                      0.003);
    add_panel(p, "body cells", {0.0525, 0.0, 0.08}, {0, 0.2, 0}, {0, 0, 0.16}, 0.003);
    // A camera that can be looked into, with its window.
    add_shell(p, {"baffle", "black_anodised", "black_anodised", Placement({0, 0.04, 0.17}), 0.035, 0.045,
                  0.07, 0.002, 0.5});
    p.push_back(disk("window", "osr", Placement({0, 0.04, 0.172}), 0.033, 0.1));
    add_shell(p, {"tube", "aluminium_bare", "aluminium_bare", Placement({0, -0.06, 0.17}), 0.04, 0.04, 0.11,
                  0.0015, 1});
    p.push_back(sheet("patch antenna", "gold", {-0.052, 0.04, -0.04}, {0, 0, 0.08}, {0, 0.08, 0}, 0.05));
    for (const double side : {-1.0, 1.0})
        p.push_back(
            tube("whips", "aluminium_bare", {0, side * 0.11, -0.175}, {0, side * 0.5, -0.19}, 0.0015, 0.1));
    return p;
}

std::vector<Patch> station(std::uint32_t seed) {
    std::vector<Patch> p;
    add_cylinder(p, "core", "white_paint", Placement({0, 0, -7}), 2.1, 14, 4);
    add_cylinder(p, "laboratory", "aluminium_bare", {{2, 0, 3}, {0, 1, 0}, {0, 0, 1}}, 2.0, 7, 4);
    add_cylinder(p, "node", "mli_silvered", {{-2, 0, 3}, {0, -1, 0}, {0, 0, 1}}, 2.0, 5, 3);
    add_shell(p, {"docking port", "aluminium_bare", "black_anodised", Placement({0, 0, 7}), 1.3, 0.9, 1.6,
                  0.05, 1});
    add_shell(p, {"engine",
                  "aluminium_bare",
                  "black_paint",
                  {{0, 0, -7}, {1, 0, 0}, {0, -1, 0}},
                  0.3,
                  0.8,
                  1.2,
                  0.02,
                  0.5});
    add_truss(p, {"truss", "anodised_clear", {0, -14, -2}, {0, 14, -2}, 1.6, 0.06, 14});
    for (const double y : {-1.0, 1.0})
        for (const double x : {-1.0, 1.0}) {
            p.push_back(
                tube("masts", "aluminium_bare", {0, y * 12.5, -2}, {x * 11, y * 12.5, -2}, 0.12, 0.2));
            for (const double aside : {-1.6, 1.6})
                add_panel(p, "arrays", {x * 6.2, y * 12.5 + aside, -2}, {9.5, 0, 0}, {0, 2.8, 0});
            p.push_back(
                sheet("radiators", "white_paint", {x * 1.2, y * 8 - 1.5, -1.2}, {0, 3, 0}, {0, 0, 5}, 0.1));
        }
    for (int i = 0; i < 6; ++i) {
        const double a = i * hilcam::kPi / 3;
        p.push_back(tube("handrails", "anodised_clear", around(a, 2.2, -6), around(a, 2.2, 0), 0.04, 0.1));
        p.push_back(blanket("shields", "mli_kapton", around(a, 2.16, -6.5),
                            around(a + hilcam::kPi / 2, 1.2, 0), {0, 0, 2.5}, 0.3,
                            seed + static_cast<std::uint32_t>(3 * i)));
    }
    add_dish(
        p, {"antenna", "white_paint", "white_paint", {{0, 2.6, 5.5}, {1, 0, 0}, {0, 0, -1}}, 0.9, 0.7, 0.6});
    return p;
}

std::vector<Patch> lander(std::uint32_t seed) {
    std::vector<Patch> p;
    add_foil_box(p, "body", "mli_kapton", {0, 0, 0.4}, {2.2, 2.2, 0.9}, 1.6, seed);
    add_box(p, "deck", "aluminium_bare", Placement({0, 0, 0.93}), {2.0, 2.0, 0.08}, 0.3);
    for (int i = 0; i < 4; ++i) {
        const double a = hilcam::kPi / 4 + i * hilcam::kPi / 2;
        const Vec3d foot = around(a, 2.6, -1.5);
        p.push_back(tube("legs", "aluminium_bare", around(a, 1.45, 0.6), foot, 0.06, 0.3));
        for (const double side : {-0.35, 0.35})
            p.push_back(tube("legs", "anodised_clear", around(a + side, 1.3, -0.05), around(a, 2.2, -0.9),
                             0.035, 0.1));
        add_dish(p, {"feet", "aluminium_bare", "mli_silvered", Placement(foot), 0.45, 0.8, 0.3});
        const Placement tank(around(a, 0.75, 1.25));
        p.push_back(revolution(
            "tanks", i % 2 == 0 ? "aluminium_bare" : "mli_silvered", tank,
            [](double t) -> std::array<double, 2> {
                return {0.34 * std::sin(hilcam::kPi * t), -0.34 * std::cos(hilcam::kPi * t)};
            },
            24, 12, 1));
    }
    add_shell(p, {"engine",
                  "aluminium_bare",
                  "black_paint",
                  {{0, 0, -0.05}, {1, 0, 0}, {0, -1, 0}},
                  0.12,
                  0.5,
                  0.9,
                  0.01,
                  1});
    add_dish(p, {"antenna",
                 "white_paint",
                 "white_paint",
                 {{0, 0, 1.8}, {0, 0.94, 0.34}, {-1, 0, 0}},
                 0.45,
                 0.35,
                 0.8});
    p.push_back(tube("mast", "cfrp", {0, 0, 0.95}, {0, 0, 1.8}, 0.04, 0.1));
    for (const double side : {-1.0, 1.0})
        add_panel(p, "panels", {side * 1.25, 0, 0.5}, {0, side * 1.8, 0}, {side * -0.15, 0, 0.8});
    return p;
}

std::vector<Patch> bus(std::uint32_t seed) {
    std::vector<Patch> p;
    add_foil_box(p, "body", "mli_kapton", {0, 0, 0}, {1.8, 1.8, 2.6}, 1.2, seed);
    for (const double side : {-1.0, 1.0}) {
        add_box(p, "radiators", "osr", Placement({0, side * 0.96, 0}), {1.5, 0.03, 2.2}, 0.1);
        for (int i = 0; i < 3; ++i)
            add_panel(p, "wings", {0, side * (2.6 + 2.1 * i), 0}, {1.7, 0, 0}, {0, 2.0, 0});
        p.push_back(tube("yokes", "cfrp", {0, side * 0.95, 0}, {0, side * 1.7, 0}, 0.06, 0.1));
        add_shell(p, {"star trackers",
                      "aluminium_bare",
                      "black_anodised",
                      {{side * 0.5, 0.6, 1.3}, {0.9, 0, -0.436 * side}, {0, 1, 0}},
                      0.08,
                      0.14,
                      0.4,
                      0.004,
                      0.5});
        add_box(p, "boxes", "white_paint", Placement({side * 0.55, -0.5, 1.45}), {0.4, 0.5, 0.25}, 0.1);
        add_shell(p, {"horns", "aluminium_bare", "aluminium_bare", Placement({side * 0.25, 0, 1.35}), 0.06,
                      0.2, 0.7, 0.004, 1});
    }
    add_shell(
        p, {"adapter", "aluminium_bare", "aluminium_bare", Placement({0, 0, -1.7}), 0.75, 0.6, 0.4, 0.03, 1});
    add_shell(p, {"engine",
                  "aluminium_bare",
                  "black_paint",
                  {{0, 0, -1.35}, {1, 0, 0}, {0, -1, 0}},
                  0.06,
                  0.3,
                  0.6,
                  0.008,
                  0.6});
    add_cylinder(p, "tank", "aluminium_bare", {{0.95, 0, -0.9}, {0, 1, 0}, {0, 0, 1}}, 0.3, 0.35, 1);
    return p;
}

std::vector<Patch> dish(std::uint32_t seed) {
    std::vector<Patch> p;
    add_dish(p, {"reflector", "gold", "mli_silvered", Placement({0, 0, 0}), 3, 2.4, 8});
    for (int i = 0; i < 3; ++i) {
        const double a = i * 2 * hilcam::kPi / 3;
        p.push_back(tube("tripod", "cfrp", around(a, 2.95, 0.9), around(a, 0.2, 2.3), 0.04, 0.2));
    }
    add_shell(p, {"feed",
                  "aluminium_bare",
                  "aluminium_bare",
                  {{0, 0, 2.7}, {1, 0, 0}, {0, -1, 0}},
                  0.12,
                  0.3,
                  0.5,
                  0.01,
                  1});
    add_cylinder(p, "feed", "mli_kapton", Placement({0, 0, 2.7}), 0.3, 0.4, 0.5);
    for (int i = 0; i < 8; ++i) {
        const double a = i * hilcam::kPi / 4;
        p.push_back(tube("ribs", "aluminium_bare", around(a, 0.4, -0.12), around(a, 2.9, 0.75), 0.05, 0.2));
    }
    add_foil_box(p, "body", "mli_kapton", {0, 0, -1.1}, {1.4, 1.4, 1.6}, 1.5, seed);
    add_truss(p, {"boom", "anodised_clear", {0.7, 0, -1.2}, {4.6, 0, -1.2}, 0.3, 0.02, 8});
    add_panel(p, "panel", {-2.2, 0, -1.4}, {0, 2.6, 0}, {-2.2, 0, 0});
    add_box(p, "instrument", "black_paint", Placement({4.8, 0, -1.2}), {0.4, 0.4, 0.4}, 0.1);
    return p;
}

struct Kind {
    const char* name;
    std::vector<Patch> (*make)(std::uint32_t seed);
};
constexpr std::array kKinds = {
    Kind{"telescope", telescope}, Kind{"cubesat", cubesat}, Kind{"station", station},
    Kind{"lander", lander},       Kind{"bus", bus},         Kind{"dish", dish}};

}  // namespace

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const Kind& kind : kKinds) names.emplace_back(kind.name);
    return names;
}

std::vector<Patch> kind_of_spacecraft(const std::string& kind, std::uint32_t seed) {
    for (const Kind& one : kKinds)
        if (kind == one.name) return one.make(seed);
    throw std::invalid_argument("no such kind of spacecraft: " + kind);
}

std::string kind_scenario(const std::string& name, const std::string& mesh_file,
                          const std::set<std::string>& materials, double size_m) {
    std::string surfaces;
    for (const std::string& material : materials)
        surfaces += "        - {name: " + material + ", material: " + material + "}\n";
    const double away_m = 2.5 * size_m;
    std::array<char, 96> pose;
    std::snprintf(pose.data(), pose.size(), "[%.3g, %.3g, %.3g]", 0.72 * away_m, -0.55 * away_m,
                  0.42 * away_m);
    return "# Made by hilcam-make-spacecraft: a spacecraft that is none, over the sunlit Indian Ocean.\n"
           "name: " +
           name +
           "\n"
           "time_utc: 2026-05-02T03:00:00Z\n"
           "origin: {kind: earth_fixed, longitude_deg: 80, latitude_deg: 0, height_km: 540}\n"
           "camera: inspector_1k\n"
           "camera_pose: {position_m: " +
           pose.data() +
           ", look_at_m: [0, 0, 0], up: [0, 0, 1]}\n"
           "objects:\n"
           "  - name: " +
           name +
           "\n"
           "    mesh: " +
           mesh_file +
           "\n"
           "    pose: {attitude_euler_deg: [20, -35, 50], euler_sequence: 321}\n"
           "    materials:\n"
           "      surfaces:\n" +
           surfaces +
           "atmosphere: {model: precomputed}\n"
           "earth_surface: {map: earth}\n"
           "stars: {catalogue: hipparcos, faintest_magnitude: 8}\n"
           "spectrum_edges_um: [0.40, 0.50, 0.60, 0.72, 0.95]\n"
           "quality: realtime\n"
           "seed: 1\n";
}

}  // namespace spacecraft
