#include "render/light/shadow_rays.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

Spectrum passed_through_glass(const FrameView& frame, Vec3f origin_m, Vec3f dir, float until_m) {
    constexpr int kMostSheets = 64;
    Spectrum passed;
    passed.bin.fill(1);
    RayPacket ray;
    HitPacket hit;
    ray.count = 1;
    for (int sheet = 0; sheet < kMostSheets; ++sheet) {
        ray.set(0, origin_m, dir, 0, until_m);
        frame.scene->intersect(ray, Coherence::kIncoherent, hit);
        if (hit.object[0] == HitPacket::kMiss) return passed;
        Vertex vertex;
        if (!make_vertex(frame, hit, 0, origin_m, dir, 0, {}, vertex)) return {};
        if (!vertex.surface.is_glass()) return {};
        passed = passed * sheet_transmittance(vertex.surface, dot(vertex.normal, vertex.view_dir));
        origin_m = vertex.start(false);
        until_m = std::max(0.0f, until_m - hit.distance[0]);
    }
    return {};
}

}  // namespace hilcam
