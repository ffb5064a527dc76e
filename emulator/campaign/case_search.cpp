#include "emulator/campaign/case_search.h"

#include <cmath>
#include <map>

#include "emulator/campaign/view_draw.h"

namespace hilcam {
namespace {

// The reason why a case is rejected; empty: it is accepted.
struct Unfit {
    std::string rule;  // "require.lit_share"
    double found = 0;
};

bool is_inside(Vec2d px, const FrameRaster& raster, double margin_px) {
    return px.x >= margin_px && px.y >= margin_px && px.x <= raster.width_px - margin_px &&
           px.y <= raster.height_px - margin_px;
}

bool is_inside(const PixelBox& box, const FrameRaster& raster, double margin_px) {
    return !box.empty() && box.x0 >= margin_px && box.y0 >= margin_px &&
           box.x1 <= raster.width_px - margin_px && box.y1 <= raster.height_px - margin_px;
}

double known(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

class Judge {
  public:
    Judge(const RequireConfig& require, CaseCamera& camera) : require_(require), camera_(camera) {}

    Unfit judge() {
        if (!require_.any()) return {};
        TruthRequest request;
        request.stars = false;
        // Conditions without rays are checked first.
        request.visibility = false;
        FrameTruth truth = reported(request);
        const SeenThing& target = truth.things[camera_.target()];
        if (const double sunlit = known(target.sunlit, 1); sunlit < require_.sunlit_fraction)
            return {"require.sunlit_fraction", sunlit};
        if (require_.in_field != RequireConfig::InField::kAny &&
            !(target.has_center && is_inside(target.center_px, truth.raster, require_.margin_px)))
            return {"require.in_field", 0};
        return require_.needs_rays() ? by_rays() : Unfit{};
    }

  private:
    const RequireConfig& require_;
    CaseCamera& camera_;

    FrameTruth reported(const TruthRequest& request) {
        FrameTruth truth = truth_record(camera_, request);
        camera_.camera().report(truth);
        if (camera_.target() >= truth.things.size() || truth.things[camera_.target()].is_body)
            throw InputError("target: the scenario has no object " + std::to_string(camera_.target() + 1));
        return truth;
    }

    Unfit by_rays() {
        TruthRequest request;
        request.stars = false;
        request.visibility = true;
        request.object = request.normal = require_.lit_share > 0;
        const FrameTruth truth = reported(request);
        const SeenThing& target = truth.things[camera_.target()];
        if (require_.in_field == RequireConfig::InField::kWhole &&
            (target.silhouette_cut || !is_inside(target.silhouette_box_px, truth.raster, require_.margin_px)))
            return {"require.in_field", 0};
        if (const auto px = static_cast<double>(target.visible_px);
            px < static_cast<double>(require_.visible_px))
            return {"require.visible_px", px};
        if (const double share = known(target.visible_fraction, 0); share < require_.visible_fraction)
            return {"require.visible_fraction", share};
        if (const double share = lit_share_of(truth, target); share < require_.lit_share)
            return {"require.lit_share", share};
        return {};
    }
};

std::string tried_text(std::uint32_t tries,
                       const std::map<std::string, std::pair<std::uint32_t, double>>& unfit) {
    std::string text = "none of " + std::to_string(tries) + " tries is what is asked for:";
    bool first = true;
    for (const auto& [rule, seen] : unfit) {
        text += (first ? " " : "; ") + rule + " was not met by " + std::to_string(seen.first);
        if (rule != "require.in_field" && rule.starts_with("require."))
            text += " (at best " + exact_number(seen.second) + ")";
        first = false;
    }
    return text + "; accepted: wider draws, less in 'require', or more tries";
}

}  // namespace

double lit_share_of(const FrameTruth& truth, const SeenThing& thing) {
    const IdImage& ids = truth.layers.object;
    const DirectionImage& normal = truth.layers.normal;
    const Vec3f sun = to_float(truth.sun_camera_dir);
    std::uint64_t visible = 0, lit = 0;
    for (int y = 0; y < truth.raster.height_px; ++y) {
        const auto id_row = ids.row(y);
        const auto nx = normal.row(y, 0), ny = normal.row(y, 1), nz = normal.row(y, 2);
        for (std::size_t x = 0; x < static_cast<std::size_t>(truth.raster.width_px); ++x) {
            if (id_row[x] != thing.id) continue;
            ++visible;
            if (nx[x] * sun.x + ny[x] * sun.y + nz[x] * sun.z > 0) ++lit;
        }
    }
    return visible == 0 ? 0
                        : known(thing.sunlit, 1) * static_cast<double>(lit) / static_cast<double>(visible);
}

CasePlan find_case(const CampaignConfig& campaign, const CaseDraw& draw, std::uint64_t number,
                   CaseCamera& camera) {
    const auto tries = static_cast<std::uint32_t>(campaign.require.tries);
    std::map<std::string, std::pair<std::uint32_t, double>> unfit;
    for (std::uint32_t attempt = 0; attempt < tries; ++attempt) {
        CasePlan plan = draw.plan(number, attempt);
        camera.take(plan.overrides);
        Unfit why;
        if (campaign.view) {
            try {
                draw_view(*campaign.view, draw, attempt, camera, plan);
            } catch (const InputError& problem) {
                why = {std::string("the view (") + problem.what() + ")", 0};
            }
            if (why.rule.empty()) camera.take(plan.overrides);
        }
        if (why.rule.empty()) why = Judge(campaign.require, camera).judge();
        if (why.rule.empty()) return plan;
        // Each attempt at a view fails with its own message, so only the first is kept.
        if (why.rule.starts_with("the view") && !unfit.empty())
            for (const auto& [rule, seen] : unfit)
                if (rule.starts_with("the view")) why.rule = rule;
        auto& [count, best] = unfit[why.rule];
        ++count;
        best = std::max(best, why.found);
    }
    throw InputError(tried_text(tries, unfit));
}

}  // namespace hilcam
