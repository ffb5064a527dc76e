#include "render/frame/unresolved_objects.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_tracer.h"

namespace hilcam {

UnresolvedObjects::UnresolvedObjects(const FrameSetup& setup, int samples) {
    for (int slot = 0; slot < tbb::this_task_arena::max_concurrency(); ++slot)
        by_rays_.push_back(std::make_unique<UnresolvedObject>(setup.frame(), samples));
    if (setup.impostor_capacity()) picture_.emplace(setup.frame(), *setup.impostor_capacity());
    seen_.reserve(setup.objects());
    glimpses_.reserve(setup.objects() * max_points(setup));
}

std::size_t UnresolvedObjects::max_points(const FrameSetup& setup) {
    const double size_px = setup.impostor_capacity() ? kPictured_px : kPoints_px;
    const auto cells = static_cast<std::size_t>(std::ceil(2 * size_px));
    return cells * cells;
}

// Finds the objects with their middle in the padded image, and all that the camera's own rays may meet.
void UnresolvedObjects::find_seen(const FrameSetup& setup, const PointField& field) {
    seen_.clear();
    std::size_t room = 0;
    for (std::size_t i = 0; i < setup.objects(); ++i) {
        const ObjectPlan& plan = setup.plan(i);
        if (setup.is_point(i)) {
            const Vec3d to_object_m =
                setup.world().objects[i].position_world_m - setup.world().camera.position_world_m;
            if (!field.sees(to_object_m / plan.distance_m, plan.distance_m)) continue;
        } else if (!setup.frame().has_impostor[i]) {
            continue;
        }
        seen_.push_back({i, room, picture_ && plan.picture_px > 0, 0, {}});
        const auto cells = static_cast<std::size_t>(ImpostorCamera::cells_across(plan));
        room += cells * cells;
    }
    glimpses_.resize(room);
}

void UnresolvedObjects::look(const FrameSetup& setup, const FrameTracer& tracer, Seen& seen) {
    const auto slot = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
    seen.count =
        by_rays_[slot]->look(setup.world(), seen.object, setup.plan(seen.object), setup.radius_m(seen.object),
                             tracer.paths(slot), glimpses_.data() + seen.first, seen.stats);
}

TileStats UnresolvedObjects::add_points(const FrameSetup& setup, const FrameTracer& tracer,
                                        const PointField& field, std::vector<PointSource>& points) {
    find_seen(setup, field);
    if (seen_.empty()) return {};
    for (const auto& probe : by_rays_) probe->begin(setup.frame());
    tbb::parallel_for(std::size_t{0}, seen_.size(), [&](std::size_t k) {
        if (!seen_[k].pictured) look(setup, tracer, seen_[k]);
    });
    if (picture_) picture_->begin(setup.frame());
    for (Seen& seen : seen_)
        if (seen.pictured && !picture_->look(setup, seen.object, tracer, glimpses_.data() + seen.first,
                                             seen.count, seen.stats))
            look(setup, tracer, seen);
    TileStats sum;
    for (const Seen& seen : seen_) {
        sum += seen.stats;
        const double distance_m =
            ImpostorCamera::before_m(setup.plan(seen.object), setup.radius_m(seen.object));
        for (std::size_t g = seen.first; g < seen.first + seen.count; ++g)
            field.add(glimpses_[g].world_dir, distance_m, glimpses_[g].irradiance_w_m2_um, points,
                      static_cast<std::uint32_t>(seen.object));
    }
    return sum;
}

}  // namespace hilcam
