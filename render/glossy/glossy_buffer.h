#pragma once
// The facet lobes of a frame that rays follow, and what the rays have met.
//
// A lobe has a ray or a few of its own, along directions that follow its visible normals. What they meet serves the lobes of the
// pixels about it, too (glossy_reuse.h), so the rays stay here until all tiles have been traced. Each part of the frame has room
// of its own, whatever others have: a frame does not depend on the order of its parts. A lobe and its rays take some 500 bytes.

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
    float alpha;                      // the width of GGX
    std::uint32_t object;
    std::uint16_t surface;
    bool back;               // which side of the surface's triangles
    std::uint32_t pixel;     // in the part
    std::uint32_t triangle;  // in the object's level of detail
    float footprint_m;       // width of a pixel there
    SubpixelMoments moments;
    float weight_samples;  // samples of sixteen a pixel that see it
    SampleMask samples;    // samples of the visibility buffer; 0: a ray sees it
    // Light: what the pixel has of it, times the samples that see the point.
    Spectrum weight;  // the factor on radiance that comes from everywhere alike
    Spectrum cached;  // that the cache's directions bring from other surfaces
    std::array<Spectrum, Planetshine::kMaxBodies> bodies;  // light of bodies, if nothing is in the way
    std::array<float, Planetshine::kMaxBodies> free{};  // share of each that the cache's directions find free
    float directions;                                   // that bring `cached`
    float probes_apart_m;  // distance between the probes that `cached` comes from
    float per_light = 1;   // radiance of what a ray of it has met, over the light that it has
    float share;           // 0 to 1: of what rays find, against what the cache has
    int reach_px;          // the rays of pixels nearer than this serve it, too (glossy_reach_px())

    bool same_surface(const GlossyPoint& other) const {
        return object == other.object && surface == other.surface && back == other.back;
    }
};

// A ray along a lobe.
struct GlossyRay {
    Spectrum light;        // radiance of what it has met, over the per_light of its point
    Vec3f met_m;           // where that is, ray space; its direction, where it has met nothing
    float per_density_sr;  // one over the density of its direction
    std::array<float, Planetshine::kMaxBodies>
        towards{};                 // radiance of each body along it, be it hidden or not
    std::uint32_t next = 0;        // the next ray of the same pixel, in the frame
    std::uint32_t point : 31 = 0;  // the number of its point in the frame
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
        // Null: there is no room.
        GlossyPoint* add_point() {
            return point_count_ < points_.size() ? new (&points_[point_count_++]) GlossyPoint : nullptr;
        }
        // A ray of the point that was added last.
        GlossyRay* add_ray(const GlossyPoint& of);
        std::span<const GlossyPoint> points() const { return points_.first(point_count_); }
        const PixelBox& box() const { return box_; }
        float share() const { return share_; }
        // Returns whose ray it is, of this part.
        const GlossyPoint& point_of(const GlossyRay& ray) const { return points_[ray.point - first_point_]; }

      private:
        friend class GlossyBuffer;
        PixelBox box_{};
        float share_ = 1;
        std::span<GlossyPoint> points_;
        std::span<GlossyRay> rays_;
        std::size_t point_count_ = 0, ray_count_ = 0;
        std::uint32_t first_point_ = 0, first_ray_ = 0;
        bool linked_ = false;
    };

    GlossyBuffer() = default;
    // Room for the parts of a frame, each with so many lobes at most, and four rays for each. Owner thread.
    GlossyBuffer(int width_px, int height_px, std::size_t parts, std::size_t lobes);

    std::size_t parts() const { return parts_.size(); }
    const Part& part(std::size_t number) const { return parts_[number]; }
    // Empties a part. Loop; different threads may see to different parts.
    // share: of a pixel that one of its samples is.
    Part& begin(std::size_t number, const PixelBox& box, float share);
    // Empties a part that has nothing this time.
    void skip(std::size_t number);
    // Gives a part's rays to their pixels, when all have come back.
    void link(Part& part);

    // The rays of a pixel: visit(ray, its point), in an order that depends on nothing but the frame. Any thread, after link().
    template <class Visit>
    void for_each_ray(int x, int y, const Visit& visit) const {
        for (std::uint32_t r = first_of_pixel_[index(x, y)]; r != kNone; r = rays_[r].next)
            visit(rays_[r], points_[rays_[r].point]);
    }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;
    // Room for objects that are made when they are added. Memory that no lobe has used is neither touched nor counted by the kernel, unless
    // all memory is locked.
    struct Unmap {
        std::size_t bytes;
        void operator()(void* room) const;
    };
    std::unique_ptr<GlossyPoint[], Unmap> points_;
    std::unique_ptr<GlossyRay[], Unmap> rays_;
    std::vector<std::uint32_t> first_of_pixel_;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    void clear_pixels(const PixelBox& box);
    template <class T>
    static std::unique_ptr<T[], Unmap> room_for(std::size_t count);
};

}  // namespace hilcam
