#include "render/frame/recorded_surface.h"

#include "render/frame/frame_setup.h"

namespace hilcam {

RecordedSurface recorded_surface(const FrameSetup& setup, const PixelRecord::Entry& entry) {
    const FrameContext& frame = setup.frame();
    const ShownObject& object = setup.object(entry.object);
    RecordedSurface out;
    out.level = setup.plan(entry.object).level;
    out.level_error_m = out.level < object.error_m.size() ? object.error_m[out.level] : 0.0;
    out.triangles = (*frame.objects)[entry.object]->triangles.size();
    out.distance_m = length(to_double(entry.point_m) - frame.camera_m);
    if (frame.indirect && frame.is_cached[entry.object]) {
        out.probe = frame.indirect->nearest_probe(frame, entry.object, entry.point_m,
                                                  {entry.geometric_normal, entry.surface, entry.back});
        out.probes_apart_m =
            static_cast<double>(frame.indirect->light(entry.object).table().probes().cube_m());
    }
    return out;
}

}  // namespace hilcam
