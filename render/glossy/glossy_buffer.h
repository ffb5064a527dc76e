#pragma once
// The facet lobes of a frame that rays follow, and what the rays have met.
//
// A lobe has one ray or a few, along directions to its visible normals. The result also serves the lobes of
// the pixels around it (glossy_reuse.h), so rays stay here until all tiles have been traced. Each part of the
// frame has room of its own, so a frame does not depend on the order of its parts. A lobe with its rays takes
// about 500 bytes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "render/planetshine/planetshine.h"
#include "render/visibility/pixel_samples.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/subpixel_light.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A shading point that the camera sees, with a facet lobe that rays follow.
struct GlossyPoint {
    Vec3f point_m, normal, view_dir;  // ray space, world axes
    Vec3f geometric_normal, start_m;  // rays start at start_m
    float alpha;                      // GGX width
    std::uint32_t object;
    std::uint16_t surface;
    bool back;               // side of the surface's triangles
    std::uint32_t pixel;     // in the part
    std::uint32_t triangle;  // in the object's level of detail
    float footprint_m;       // width of a pixel there
    SubpixelMoments moments;
    float weight_samples;  // samples (16 per pixel) that see it
    SampleMask samples;    // samples of the visibility buffer; 0: seen by a ray
    // Light: as it reaches the pixel, times the samples that see the point.
    Spectrum weight;  // factor on uniform radiance
    Spectrum cached;  // light of other surfaces along the cache's directions
    std::array<Spectrum, Planetshine::kMaxBodies> bodies;  // light of bodies if nothing is in the way
    // Share of each that the cache's directions find unblocked.
    std::array<float, Planetshine::kMaxBodies> free{};
    float directions;      // effective number of directions that bring `cached`
    float probes_apart_m;  // distance between the probes that `cached` comes from
    float per_light = 1;   // radiance of what one of its rays has met, per unit of GlossyRay::light
    float share;           // weight of what rays find against the cache, 0 to 1
    int reach_px;          // rays of pixels nearer than this are used: 8 or 4
    int sent = 0;          // rays along it, with those that would have gone below its surface
};

// Where a ray starts: all that decides whether a lobe takes it, apart from the rest, as most are not taken.
struct GlossyStart {
    Vec3f point_m, normal;  // those of its lobe
    std::uint32_t object;
    std::uint16_t surface;
    bool back;
    std::uint32_t next;  // next ray of the same pixel, in the frame

    bool on_surface_of(const GlossyPoint& lobe) const {
        return object == lobe.object && surface == lobe.surface && back == lobe.back;
    }
};

// A ray along a lobe.
struct alignas(64) GlossyRay {
    // Radiance of what it has met; until it is linked, divided by the per_light of its point.
    Spectrum light;
    Vec3f met_m;           // the place that it has met, ray space; its direction if it has met nothing
    float per_density_sr;  // 1 / density of its direction
    std::array<float, Planetshine::kMaxBodies>
        towards{};                 // radiance of each body along the ray, hidden or not
    std::uint32_t point : 31 = 0;  // number of its point in the frame
    std::uint32_t free : 1 = 1;    // it has met nothing

    void set_met(Vec3f place_m) { met_m = place_m, free = 0; }
};
static_assert(sizeof(GlossyRay) == 64);

class GlossyBuffer {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    // The lobes and rays of one part of the frame. One thread at a time.
    class Part {
      public:
        // Null if there is no room.
        GlossyPoint* add_point() {
            return point_count_ < points_.size() ? new (&points_[point_count_++]) GlossyPoint : nullptr;
        }
        // Adds a ray of the point that was added last.
        GlossyRay* add_ray(const GlossyPoint& of);
        std::span<GlossyPoint> points() { return points_.first(point_count_); }
        std::span<const GlossyPoint> points() const { return points_.first(point_count_); }
        const PixelBox& box() const { return box_; }
        float share() const { return share_; }
        // Returns the point of a ray; both belong to this part.
        const GlossyPoint& point_of(const GlossyRay& ray) const { return points_[ray.point - first_point_]; }

      private:
        friend class GlossyBuffer;
        PixelBox box_{};
        float share_ = 1;
        std::span<GlossyPoint> points_;
        std::span<GlossyRay> rays_;
        std::size_t point_count_ = 0, ray_count_ = 0;
        std::uint32_t first_point_ = 0, first_ray_ = 0;
        std::size_t linked_ = 0;  // rays that for_each_ray() visits
    };

    GlossyBuffer() = default;
    // Allocates the parts of a frame for at most this many lobes each, and four rays a lobe on average. Owner
    // thread.
    GlossyBuffer(int width_px, int height_px, std::size_t parts, std::size_t lobes);

    std::size_t parts() const { return parts_.size(); }
    const Part& part(std::size_t number) const { return parts_[number]; }
    // Empties a part. share: part of a pixel that one of its samples represents. Loop; different threads may
    // do different parts.
    Part& begin(std::size_t number, const PixelBox& box, float share);
    // Empties a part that has no lobes in this frame.
    void skip(std::size_t number);
    // Connects a part's rays to their pixels; those that are new must be finished.
    void link(Part& part);

    // Calls visit(start, ray) for the rays of a pixel, in an order that depends only on the frame. Any
    // thread, after link().
    template <class Visit>
    void for_each_ray(int x, int y, const Visit& visit) const {
        for (std::uint32_t r = first_of_pixel_[index(x, y)]; r != kNone; r = starts_[r].next)
            visit(starts_[r], rays_[r]);
    }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;
    // Memory for objects that are constructed when they are added. The kernel neither touches nor counts
    // pages that no lobe has used, unless all memory is locked.
    struct Unmap {
        std::size_t bytes;
        void operator()(void* room) const;
    };
    std::unique_ptr<GlossyPoint[], Unmap> points_;
    std::unique_ptr<GlossyRay[], Unmap> rays_;
    std::unique_ptr<GlossyStart[], Unmap> starts_;  // by ray
    std::vector<std::uint32_t> first_of_pixel_;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    void clear_pixels(const PixelBox& box);
    template <class T>
    static std::unique_ptr<T[], Unmap> room_for(std::size_t count);
};

}  // namespace hilcam
