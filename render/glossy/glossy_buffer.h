#pragma once
// The facet lobes of a frame that rays follow, and what the rays have met.
//
// A lobe has one ray or a few, along directions to its visible normals. The result also serves the lobes of
// the pixels around it (glossy_reuse.h), so rays stay here until all tiles have been traced. Each part of the
// frame has room of its own, so a frame does not depend on the order of its parts. Rays are traced as
// objects, and then sorted by pixel into arrays (glossy_columns.h). A lobe with its rays takes about 600
// bytes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "render/glossy/glossy_columns.h"
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

// A ray along a lobe, as it is traced.
struct alignas(64) GlossyRay {
    Spectrum light;        // radiance of what it has met, divided by the per_light of its point
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
    // The lobes and rays of one part of the frame. One thread at a time.
    class Part {
      public:
        // Null if there is no room.
        GlossyPoint* add_point() {
            return point_count_ < points_.size() ? new (&points_[point_count_++]) GlossyPoint : nullptr;
        }
        // Adds a ray of a point of this part. Null if there is no room.
        GlossyRay* add_ray(const GlossyPoint& of);
        std::span<GlossyPoint> points() { return points_.first(point_count_); }
        std::span<const GlossyPoint> points() const { return points_.first(point_count_); }
        const PixelBox& box() const { return box_; }
        std::size_t width() const { return static_cast<std::size_t>(box_.x1 - box_.x0); }
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
        bool sorted_ = false;  // its rays are in the frame's columns
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
    // Enters all rays of a part in the frame's columns; they must be finished. Called again after more rays.
    void sort(Part& part);

    // The rays that were sorted, by pixel.
    const GlossyColumns& columns() const { return columns_; }
    // Calls visit(first, end) for the rays of pixels x0 to x1 of a row, as ranges of the columns. The order
    // depends only on the frame. Any thread, after sort().
    template <class Visit>
    void for_each_range(int x0, int x1, int y, const Visit& visit) const {
        for (std::size_t at = index(x0, y), last = index(x1, y); at <= last; ++at) {
            const std::uint32_t first = first_of_pixel_[at];
            while (at < last && first_of_pixel_[at + 1] == end_of_pixel_[at]) ++at;
            if (end_of_pixel_[at] > first) visit(first, end_of_pixel_[at]);
        }
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
    std::unique_ptr<float[], Unmap> floats_;  // memory of the columns
    std::unique_ptr<std::uint32_t[], Unmap> words_;
    std::unique_ptr<GlossySum[], Unmap> sums_;
    GlossyColumns columns_;
    // The ranges of the pixels' rays in the columns; empty where a pixel has none.
    std::vector<std::uint32_t> first_of_pixel_, end_of_pixel_;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    void enter(const GlossyPoint& of, const GlossyRay& ray, int column, std::size_t place);
    template <class T>
    static std::unique_ptr<T[], Unmap> room_for(std::size_t count);
};

}  // namespace hilcam
