#pragma once
// Finds the silhouette of a thing: what it would cover if it were alone, in the frame and up to a frame's
// size beside it.
//
// In the frame the pixels' own rays answer most of it: the silhouette includes pixels that see the thing and
// excludes those that see the sky, where nothing is in front. Extra rays are needed only for pixels that see
// something else, and beside the frame.

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_truth.h"
#include "render/frame/truth_rays.h"

namespace hilcam {

class TruthOutlines {
  public:
    // truth: its pixels are traced and counted already. All arguments must outlive this.
    TruthOutlines(const FrameSetup& setup, const TruthRays& rays, FrameTruth& truth)
        : setup_(setup), frame_(setup.frame()), world_(setup.world()), rays_(rays), truth_(truth) {}

    // Fills the silhouettes of the truth. Call it before measure(), which replaces the boxes of small things.
    // Runs on oneTBB, like measure().
    void find_silhouettes();
    // Sets how much of a thing's silhouette is visible.
    void measure(SeenThing& thing) const;

  private:
    // Area and bounds of what a thing covers if it is alone.
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
    PixelSilhouette silhouette_of(const SeenThing& thing, std::vector<std::uint8_t>& marks) const;
    void measure_small(SeenThing& thing, const PixelBox& bounds) const;

    const FrameSetup& setup_;
    const FrameContext& frame_;
    const WorldSnapshot& world_;
    const TruthRays& rays_;
    FrameTruth& truth_;
};

}  // namespace hilcam
