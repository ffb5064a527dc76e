#include "render/frame/possible_world.h"

#include <limits>

#include "render/sky/body_bounds.h"
#include "render/sky/motion_bounds.h"

namespace hilcam {
namespace {

constexpr Vec3d kNowhere_m{std::numeric_limits<double>::quiet_NaN(), 0, 0};
Vec3d away_m(const Pose& camera) {
    return camera.position_world_m - kFarthestPlace_m * (to_matrix(camera.world_from_body) * Vec3d{0, 0, 1});
}

}  // namespace

PossibleWorld::PossibleWorld(std::size_t objects) : is_left_out_(objects) { world_.objects.reserve(objects); }

void PossibleWorld::take(const WorldSnapshot& world) {
    const Pose camera = world_.camera;
    Bodies bodies = world_.bodies;
    left_out_ = take_possible(world.bodies, bodies) ? 0 : 1;
    world_ = world;
    world_.bodies = bodies;
    if (!is_possible(world.camera)) world_.camera = camera, ++left_out_;
    for (Vec3d* rate : {&world_.camera_velocity_m_s, &world_.rows_velocity_m_s, &world_.camera_rate_rad_s})
        if (!is_finite(*rate)) *rate = {}, ++left_out_;
    for (std::size_t i = 0; i < world_.objects.size(); ++i) {
        is_left_out_[i] = !is_possible(world.objects[i]);
        if (is_left_out_[i]) world_.objects[i] = {away_m(world_.camera), {}}, ++left_out_;
    }
}

void PossibleWorld::move_left_out(Vec3d place_m) {
    for (std::size_t i = 0; left_out_ > 0 && i < world_.objects.size(); ++i)
        if (is_left_out_[i] != 0) world_.objects[i].position_world_m = place_m;
}
void PossibleWorld::hide_from_rays() { move_left_out(kNowhere_m); }
void PossibleWorld::put_away() { move_left_out(away_m(world_.camera)); }

}  // namespace hilcam
