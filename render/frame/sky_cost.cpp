#include "render/frame/sky_cost.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "render/earth/earth_model.h"
#include "render/primary/primary_hits.h"
#include "render/shading/tile.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

constexpr int kTile_px = 32, kTimes = 3;

// The tiles of a frame, sampled with a stride, and the time to fill one.
class TileCost {
  public:
    TileCost(const FrameContext& frame, int max_tiles)
        : width_(frame.geometry.padded_width()),
          height_(frame.geometry.padded_height()),
          across_((width_ + kTile_px - 1) / kTile_px),
          count_(across_ * ((height_ + kTile_px - 1) / kTile_px)),
          stride_(1 + count_ / max_tiles),
          pixels_(kTile_px * kTile_px),
          uncovered_(pixels_.size(), ~SampleMask{0}) {}

    int stride() const { return stride_; }
    template <class Use>
    void each(const PixelBox& within, const Use& use) const {
        for (int i = 0; i < count_; i += stride_) {
            const int x = i % across_ * kTile_px, y = i / across_ * kTile_px;
            const PixelBox box{x, y, std::min(x + kTile_px, width_), std::min(y + kTile_px, height_)};
            if (box.overlaps(within)) use(box);
        }
    }
    void fill(const FrameContext& frame, const PixelBox& box) {
        TileStats stats;
        Tile tile{frame, box, kVisibilitySamplesAcross, pixels_, stats, *clusters_};
        add_backdrop(tile, uncovered_.data());
    }

  private:
    int width_, height_, across_, count_, stride_;
    std::vector<Spectrum> pixels_;
    std::vector<SampleMask> uncovered_;
    std::unique_ptr<NormalClusters> clusters_ = std::make_unique<NormalClusters>();
};

// A look without a part, and the name of that part.
struct Variant {
    std::string text;
    std::size_t bytes;
    std::unique_ptr<const std::array<SceneBody, kMaxBodies>> bodies;  // null: unchanged
    std::unique_ptr<const EarthModel> earth;                          // null: unchanged
};

std::vector<Variant> variants_of(const Background& background, const PlacedBody& body) {
    std::vector<Variant> out;
    const SceneBody& scene = background.scene_of(body);
    const auto add = [&](const std::string& text, std::size_t bytes, const auto& leave_out) {
        auto bodies = std::make_unique<std::array<SceneBody, kMaxBodies>>(background.bodies());
        leave_out((*bodies)[index_of(body.id)]);
        out.push_back({text, bytes, std::move(bodies), nullptr});
    };
    if (!scene.relief.empty()) add("relief", scene.relief.bytes(), [](SceneBody& own) { own.relief = {}; });
    if (body.shine_count > 0)
        add("light of other bodies", 0, [](SceneBody& own) { own.planetshine = false; });
    if (body.id == BodyId::kEarth && background.earth())
        for (const EarthModel::PartInfo& part : background.earth()->parts())
            if (part.part != EarthModel::Part::kSurface)
                out.push_back({part.text, part.bytes, nullptr,
                               std::make_unique<const EarthModel>(background.earth()->without(part.part))});
    return out;
}

}  // namespace

std::vector<double> sky_costs_ms(const FrameContext& frame) {
    if (!frame.rays->linear()) return {};
    constexpr double kLong_ms = 200;  // long enough to be measured once
    TileCost tiles(frame, 1024);
    std::vector<double> out;
    for (std::size_t body = 0; body < frame.body_box_count; ++body) {
        double min_ms = 0;
        for (int time = 0; time < kTimes && min_ms < kLong_ms; ++time) {
            const ThreadStopwatch watch;
            tiles.each(frame.body_boxes[body], [&](const PixelBox& box) { tiles.fill(frame, box); });
            const double ms = tiles.stride() * watch.ms();
            min_ms = time == 0 ? ms : std::min(min_ms, ms);
        }
        out.push_back(min_ms);
    }
    return out;
}

std::vector<SkyPart> sky_parts(const FrameContext& frame) {
    std::vector<SkyPart> out;
    for (std::size_t i = 0; i < frame.body_box_count; ++i) {
        const PlacedBody& body = frame.background->disks()[i];
        const std::vector<Variant> variants = variants_of(*frame.background, body);
        const EarthModel* const earth = body.id == BodyId::kEarth ? frame.background->earth() : nullptr;
        if (variants.empty() && !earth) continue;
        // An impostor contains all parts.
        const bool told =
            frame.rays->linear() && !frame.body_boxes[i].empty() && !(frame.earth_impostor && i == 0);
        std::vector<double> saved_ms(variants.size());
        double whole_ms = 0;
        if (told) {
            std::vector<Background> backgrounds;
            backgrounds.reserve(variants.size());
            std::vector<FrameContext> views;
            for (const Variant& v : variants) {
                backgrounds.push_back(
                    frame.background->with(v.bodies ? *v.bodies : frame.background->bodies(),
                                           v.earth ? v.earth.get() : frame.background->earth()));
                views.push_back(frame);
                views.back().background = &backgrounds.back();
            }
            TileCost tiles(frame, 256);
            tiles.each(frame.body_boxes[i], [&](const PixelBox& box) {
                std::vector<double> min_ms(1 + views.size(), std::numeric_limits<double>::infinity());
                for (int time = 0; time < kTimes; ++time)
                    for (std::size_t k = 0; k <= views.size(); ++k) {
                        const ThreadStopwatch watch;
                        tiles.fill(k == 0 ? frame : views[k - 1], box);
                        min_ms[k] = std::min(min_ms[k], watch.ms());
                    }
                whole_ms += tiles.stride() * min_ms[0];
                for (std::size_t k = 0; k < views.size(); ++k)
                    saved_ms[k] += tiles.stride() * (min_ms[0] - min_ms[k + 1]);
            });
        }
        // Times of tiles vary by some per cent.
        const double resolved_ms = 0.02 * whole_ms;
        const std::string name = frame.background->name_of(body.id);
        const auto saved = [&](double ms) { return told ? std::optional(ms) : std::nullopt; };
        if (earth) {
            double rest_ms = whole_ms;
            for (const double ms : saved_ms) rest_ms -= std::max(0.0, ms);
            const EarthModel::PartInfo surface = earth->parts().front();
            out.push_back({name, surface.text, saved(rest_ms), resolved_ms, surface.bytes});
        }
        for (std::size_t k = 0; k < variants.size(); ++k)
            out.push_back({name, variants[k].text, saved(saved_ms[k]), resolved_ms, variants[k].bytes});
    }
    return out;
}

}  // namespace hilcam
