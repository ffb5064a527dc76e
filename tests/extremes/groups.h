#pragma once
// The suite's tables, by the file that makes them.

#include <vector>

#include "tests/extremes/group.h"

namespace hilcam::extremes {

// distance.cpp
Group distance_one_lens();
Group distance_long_lens();
Group distance_of_origin();
Group distance_of_rays();
// size.cpp
Group size_of_everything();
Group height_over_the_moon();
// sunlight.cpp
Group sun_incidence();
Group sun_phase();
Group sun_distance();
// meshes.cpp
Group meshes();
Group mesh_files();
Group mesh_models();
// depth.cpp
Group depth_of_paths();
// attitude.cpp
Group rotation_vectors();
Group interpolated_attitudes();
Group half_turns();
Group attitude_commands();
// rates.cpp
Group propagated_rates();
Group star_trails();
Group smeared_pictures();
Group rolling_rows();
// signal.cpp
Group exposures();
Group radiances();
Group gains();
Group shot_noise();
// image_size.cpp
Group image_sizes();
// time.cpp
Group instants();
Group eclipses();
Group poles();
Group planets();

// In the order of extremes.csv.
std::vector<Group> all_groups();

}  // namespace hilcam::extremes
