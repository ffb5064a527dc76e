#pragma once
// Shadow rays: they test whether a light is visible, sixteen at a time, and through glass if the scene has
// any.

#include <algorithm>
#include <array>
#include <limits>

#include "render/shading/tile.h"

namespace hilcam {

// Returns the transmittance of all glass sheets within `until_m`; zero if the ray meets anything else. dir:
// unit. Loop, any thread.
inline Spectrum passed_through_glass(const FrameContext& frame, Vec3f origin_m, Vec3f dir,
                                     float until_m = std::numeric_limits<float>::infinity()) {
    constexpr int kMaxSheets = 64;
    Spectrum passed;
    passed.bin.fill(1);
    RayPacket ray;
    HitPacket hit;
    ray.count = 1;
    for (int sheet = 0; sheet < kMaxSheets; ++sheet) {
        ray.set(0, origin_m, dir, 0, until_m);
        frame.scene->intersect(ray, Coherence::kIncoherent, hit);
        if (hit.object[0] == HitPacket::kMiss) return passed;
        ShadingPoint point;
        if (!make_shading_point(frame, hit, 0, origin_m, dir, 0, {}, point)) return {};
        if (!point.surface.is_glass()) return {};
        passed = passed * sheet_transmittance(point.surface, dot(point.normal, point.view_dir));
        origin_m = point.start(false);
        until_m = std::max(0.0f, until_m - hit.distance[0]);
    }
    return {};
}

// Payload: what the caller needs to identify a ray. lit(payload, transmittance) is called for every ray that
// gets through, in order; transmittance is null if nothing is in the way.
template <class Payload, class Lit>
class ShadowRays {
  public:
    ShadowRays(const FrameContext& frame, std::uint64_t& counter, Lit lit)
        : frame_(frame), counter_(counter), lit_(std::move(lit)) {
        rays_.count = 0;
    }
    ~ShadowRays() { flush(); }
    ShadowRays(const ShadowRays&) = delete;
    ShadowRays& operator=(const ShadowRays&) = delete;

    // dir: unit. until_m: distance of the light.
    void add(Vec3f origin_m, Vec3f dir, const Payload& payload,
             float until_m = std::numeric_limits<float>::infinity()) {
        payloads_[static_cast<std::size_t>(rays_.count)] = payload;
        rays_.set(rays_.count, origin_m, dir, 0, until_m);
        if (++rays_.count == kPacketSize) flush();
    }

  private:
    const FrameContext& frame_;
    std::uint64_t& counter_;
    Lit lit_;
    RayPacket rays_;
    std::array<Payload, kPacketSize> payloads_;

    void flush() {
        if (rays_.count == 0) return;
        const std::uint32_t blocked = frame_.scene->occluded(rays_);
        counter_ += static_cast<std::uint64_t>(rays_.count);
        for (int i = 0; i < rays_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (!(blocked >> i & 1u)) {
                lit_(payloads_[k], nullptr);
            } else if (frame_.has_glass) {
                const Spectrum passed =
                    passed_through_glass(frame_, {rays_.origin_x[k], rays_.origin_y[k], rays_.origin_z[k]},
                                         {rays_.dir_x[k], rays_.dir_y[k], rays_.dir_z[k]}, rays_.farthest[k]);
                if (max_component(passed) > 0) lit_(payloads_[k], &passed);
            }
        }
        rays_.count = 0;
    }
};

}  // namespace hilcam
