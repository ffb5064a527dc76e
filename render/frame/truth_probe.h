#pragma once
// Tells what the frame that was placed last shows (frame_truth.h).

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/frame/frame_placer.h"
#include "render/frame/frame_truth.h"
#include "render/frame/truth_rays.h"
#include "render/shading/point_field.h"

namespace hilcam {

// The greatest number of stars that a frame's truth holds.
inline constexpr std::size_t kMaxTruthStars = 16384;

// A record with room for all that TruthProbe tells of the placer's frames, up to a size. Owner thread.
FrameTruth make_truth(const FramePlacer& placer, const TruthWishes& wishes, int width_px, int height_px);

class TruthProbe {
  public:
    // Fills `truth`, which make_truth() made for this placer; its raster is set. Loop: nothing is allocated.
    // Runs on oneTBB; the result does not depend on the thread count.
    TruthProbe(const FramePlacer& placer, FrameTruth& truth);
    void report();

  private:
    void report_sun_and_bodies();
    void report_objects();
    void report_stars();
    SeenThing described(std::uint32_t id, const Pose& world) const;
    SeenThing described(std::uint32_t id, const Pose& world, Vec3d from_camera_m) const;
    bool project(Vec3d from_camera_m, Vec2d& frame_px) const;

    void size_layers();
    void trace_pixels();
    void trace_block(int x0, int y0);
    PixelBox padded_box(int x0, int y0, int x1, int y1) const;
    bool on_image(Vec2d image_px) const;
    bool can_see(const PixelBox& padded) const;
    void write(int x, int y, const RayMet& met);
    // The thing that an object of the renderer is part of.
    std::uint32_t owner_of(std::size_t object) const {
        const std::vector<std::uint32_t>& owners = truth_.wishes.thing_of_object;
        return owners.empty() ? static_cast<std::uint32_t>(object) : owners[object];
    }
    std::uint32_t id_of(const RayMet& met) const;

    void count_pixels();
    SeenThing* thing_of(std::uint32_t id);

    // Area and bounds of what a thing alone covers.
    struct Outline {
        double area_px = 0;
        int x0 = 1 << 30, y0 = 1 << 30, x1 = -(1 << 30), y1 = -(1 << 30);

        Outline() = default;
        Outline(const PixelBox& box, double area)
            : area_px(area), x0(box.x0), y0(box.y0), x1(box.x1), y1(box.y1) {}
        void add(Vec2d frame_px, double area);
        void add(const Outline& other);
        PixelBox box() const { return area_px > 0 ? PixelBox{x0, y0, x1, y1} : PixelBox{}; }
    };
    void measure_outline(SeenThing& thing);
    PixelBox canvas_bounds(const SeenThing& thing) const;
    std::uint32_t meets_alone(const SeenThing& thing, std::span<const Vec2d> image_px) const;
    template <class Fill>
    Outline covered(const SeenThing& thing, int first_row, int last_row, const Fill& fill,
                    std::vector<std::uint8_t>* marks) const;
    Outline hidden_part(const SeenThing& thing, const PixelBox& bounds,
                        std::vector<std::uint8_t>* marks = nullptr) const;
    Outline part_beside(const SeenThing& thing, const PixelBox& box, int step) const;
    Outline parts_beside(const SeenThing& thing, const PixelBox& bounds, int& step) const;
    bool has_outline(const SeenThing& thing) const;
    void find_silhouettes();
    PixelSilhouette silhouette_of(const SeenThing& thing, std::vector<std::uint8_t>& marks) const;
    void measure_small(SeenThing& thing, const PixelBox& bounds);

    const FramePlacer& placer_;
    const FrameView& frame_;
    const WorldSnapshot& world_;
    FrameTruth& truth_;
    TruthRays rays_;
    Mat3d camera_from_world_;
};

}  // namespace hilcam
