#include "render/frame/object_probes.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "render/frame/frame_placer.h"
#include "render/frame/frame_tracer.h"

namespace hilcam {

ObjectProbes::ObjectProbes(const FrameView& frame, std::size_t objects, int samples) {
    for (int slot = 0; slot < tbb::this_task_arena::max_concurrency(); ++slot)
        probes_.push_back(std::make_unique<ObjectProbe>(frame, samples));
    seen_.reserve(objects);
    constexpr std::size_t kMaxCells = ObjectProbe::kMaxCells;
    glimpses_.reserve(objects * kMaxCells * kMaxCells);
}

TileStats ObjectProbes::add_points(const FramePlacer& placer, const FrameTracer& tracer,
                                   const PointField& field, std::vector<PointSource>& points) {
    seen_.clear();
    std::size_t room = 0;
    for (std::size_t i = 0; i < placer.objects(); ++i) {
        if (!placer.is_point(i)) continue;
        const ObjectPlan& plan = placer.plan(i);
        const Vec3d to_object_m =
            placer.world().objects[i].position_world_m - placer.world().camera.position_world_m;
        if (!field.sees(to_object_m / plan.distance_m, plan.distance_m)) continue;
        seen_.push_back({i, room, 0, {}});
        const auto cells = static_cast<std::size_t>(ObjectProbe::cells_across(plan));
        room += cells * cells;
    }
    if (seen_.empty()) return {};
    glimpses_.resize(room);
    for (const auto& probe : probes_) probe->begin(placer.frame());
    tbb::parallel_for(std::size_t{0}, seen_.size(), [&](std::size_t k) {
        const auto slot = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
        Seen& seen = seen_[k];
        seen.count = probes_[slot]->look(placer.world(), seen.object, placer.plan(seen.object),
                                         placer.radius_m(seen.object), tracer.paths(slot),
                                         glimpses_.data() + seen.first, seen.stats);
    });
    TileStats sum;
    for (const Seen& seen : seen_) {
        sum += seen.stats;
        const double distance_m =
            ObjectProbe::before_m(placer.plan(seen.object), placer.radius_m(seen.object));
        for (std::size_t g = seen.first; g < seen.first + seen.count; ++g)
            field.add(glimpses_[g].world_dir, distance_m, glimpses_[g].irradiance_w_m2_um, points,
                      static_cast<std::uint32_t>(seen.object));
    }
    return sum;
}

}  // namespace hilcam
