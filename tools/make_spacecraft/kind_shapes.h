#pragma once
// Parts that several kinds of spacecraft have (kinds.h).

#include <cstdint>
#include <string>
#include <vector>

#include "tools/make_spacecraft/shapes.h"

namespace spacecraft {

// A wall of revolution with an outside, an inside and two rims: a tube, a cone or a nozzle that can be looked into.
struct Shell {
    std::string part, outside, inside;  // inside, outside: materials
    Placement place;
    double first_radius_m, last_radius_m, length_m, wall_m;
    double detail = 1;
};
void add_shell(std::vector<Patch>& patches, const Shell& shell);

// A closed cylinder.
void add_cylinder(std::vector<Patch>& patches, const std::string& part, const std::string& material,
                  const Placement& place, double radius_m, double length_m, double detail);

// A round plate that faces the placement's +z.
Patch disk(std::string part, std::string material, const Placement& place, double radius_m, double detail);

// A paraboloid that opens along the placement's +z, with its back.
struct Dish {
    std::string part, front, back;  // front, back: materials
    Placement place;
    double radius_m, focal_length_m;
    double detail = 1;
};
void add_dish(std::vector<Patch>& patches, const Dish& dish);

// A flat panel of solar cells; they face along_u x along_v. Its back and rim are carbon fibre.
void add_panel(std::vector<Patch>& patches, const std::string& part, Vec3d middle, Vec3d along_u,
               Vec3d along_v, double thick_m = 0.03);

// A truss of four longerons between two points, with diagonals in every bay.
struct Truss {
    std::string part, material;
    Vec3d from, to;
    double width_m, tube_radius_m;
    int bays;
};
void add_truss(std::vector<Patch>& patches, const Truss& truss);

// A box whose six walls are wrinkled foil.
void add_foil_box(std::vector<Patch>& patches, const std::string& part, const std::string& material,
                  Vec3d middle, Vec3d size, double detail, std::uint32_t seed);

}  // namespace spacecraft
