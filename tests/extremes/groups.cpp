#include "tests/extremes/groups.h"

namespace hilcam::extremes {

std::vector<Group> all_groups() {
    return {distance_one_lens(),
            distance_long_lens(),
            distance_of_origin(),
            distance_of_rays(),
            size_of_everything(),
            height_over_the_moon(),
            sun_incidence(),
            sun_phase(),
            sun_distance(),
            meshes(),
            mesh_files(),
            mesh_models(),
            depth_of_paths(),
            rotation_vectors(),
            interpolated_attitudes(),
            half_turns(),
            attitude_commands(),
            propagated_rates(),
            star_trails(),
            smeared_pictures(),
            rolling_rows(),
            exposures(),
            radiances(),
            gains(),
            shot_noise(),
            image_sizes(),
            instants(),
            eclipses(),
            poles(),
            planets()};
}

}  // namespace hilcam::extremes
