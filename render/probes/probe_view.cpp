#include "render/probes/probe_view.h"

#include "render/probes/probe_axes.h"
#include "render/scene/surface.h"

namespace hilcam {

std::vector<ProbeRay> rays_of(const TransferTable& table, std::size_t probe) {
    const SurfaceProbe& own = table.probes().probes()[probe];
    const Frame frame(unpack_normal(own.mean_normal));
    std::vector<ProbeRay> rays;
    for (const Vec3f local : transfer_directions(table.directions())) {
        const std::size_t direction = rays.size();
        ProbeRay ray;
        ray.dir = probe_direction(frame, table.turn(probe), local);
        ray.point = table.point_of(direction);
        if (!table.is_live(probe, ray.point))
            ray.meets = ProbeMeets::kBuried;
        else if (dot(ray.dir, unpack_normal(own.geometric[ray.point])) <= 0)
            ray.meets = ProbeMeets::kOwnSide;
        else if (table.is_free(probe, direction))
            ray.meets = ProbeMeets::kNothing;
        rays.push_back(ray);
    }
    for (const TransferTable::Entry entry : table.entries(probe)) {
        rays[entry.direction].meets = ProbeMeets::kProbe;
        rays[entry.direction].probe = entry.probe;
    }
    return rays;
}

}  // namespace hilcam
