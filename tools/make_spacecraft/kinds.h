#pragma once
// Spacecraft of common kinds, none of them a real one: what a renderer of satellites must get right. Each has smooth
// metal beside sunlit panels, and something that is looked into: a tube, a nozzle, a dish.
//
// Body axes and metres as design.h; the long axis is +z. A surface has the name of the shipped material that it is of
// (configs/materials), so a scenario needs no more than those names.

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tools/make_spacecraft/patch.h"

namespace spacecraft {

// Returns the words that kind_of_spacecraft() takes.
std::vector<std::string> kind_names();
// The telescope is an aluminium tube that stands open, the station three modules and a truss, the lander foil on legs with an
// engine, the bus boxes of foil and mirrors, the dish an antenna of 6 m. seed: of the foil's wrinkles. Throws
// std::invalid_argument for another word.
std::vector<Patch> kind_of_spacecraft(const std::string& kind, std::uint32_t seed);

// Returns a scenario's text for a mesh with such surfaces: a file beside it, named as `name`, in the place of
// the shipped scenario mesh_in_orbit. size_m: the camera stands two and a half times so far away.
std::string kind_scenario(const std::string& name, const std::string& mesh_file,
                          const std::set<std::string>& materials, double size_m);

}  // namespace spacecraft
