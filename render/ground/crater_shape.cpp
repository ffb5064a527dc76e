#include "render/ground/crater_shape.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/ground/crater_shape.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/ground/double_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

struct Vector {
    V x, y, z;
    HWY_INLINE V along(Vec3d other) const {
        return hn::Add(hn::Add(hn::Mul(x, number(other.x)), hn::Mul(y, number(other.y))),
                       hn::Mul(z, number(other.z)));
    }
};

// Distances of places from a crater's middle in radii, corrected for its outline there.
class CraterDistances {
  public:
    explicit CraterDistances(const CraterShape& c) : c_(c) {
        const double most = CraterShape::reach(c.bright) * 1.1 * c.radius_m / c.body_radius_m;
        most2_ = most * most;
    }
    // Returns false, without distances, if none of the places is within its reach.
    HWY_INLINE bool find(const double* places, V& x, V& distances2) const {
        const Doubles d;
        Vector away;
        hn::LoadInterleaved3(d, places, away.x, away.y, away.z);
        away = {hn::Sub(away.x, number(c_.place.x)), hn::Sub(away.y, number(c_.place.y)),
                hn::Sub(away.z, number(c_.place.z))};
        distances2 =
            hn::Add(hn::Add(hn::Mul(away.x, away.x), hn::Mul(away.y, away.y)), hn::Mul(away.z, away.z));
        if (hn::AllTrue(d, hn::Gt(distances2, number(most2_)))) return false;
        const V distance = hn::Sqrt(distances2);
        // Cosines and sines of multiples of the azimuth, by rotation.
        const V c1 = hn::Div(away.along(c_.axes.east), distance),
                s1 = hn::Div(away.along(c_.axes.north), distance);
        V ck = c1, sk = s1, outline = number(1);
        for (std::size_t k = 0; k < kCraterWaves; ++k) {
            const V next = hn::Sub(hn::Mul(ck, c1), hn::Mul(sk, s1));
            sk = hn::Add(hn::Mul(sk, c1), hn::Mul(ck, s1)), ck = next;
            outline = hn::Add(
                outline, hn::Add(hn::Mul(number(c_.wave_cos[k]), ck), hn::Mul(number(c_.wave_sin[k]), sk)));
        }
        outline = hn::IfThenElse(hn::Gt(distance, number(0)), outline, number(1));
        x = hn::Div(hn::Mul(distance, number(c_.body_radius_m)), hn::Mul(number(c_.radius_m), outline));
        return true;
    }
    HWY_INLINE auto within(V distances2) const { return hn::Le(distances2, number(most2_)); }

  private:
    const CraterShape& c_;
    double most2_;
};

// CraterProfile::Worn::height().
HWY_INLINE V height(const CraterProfile::Worn& worn, V distance) {
    const Doubles d;
    const V x = hn::Mul(hn::Div(distance, number(CraterProfile::kReach)), number(CraterProfile::kSteps));
    const auto inside = hn::Lt(distance, number(CraterProfile::kReach));
    const V step = hn::Min(hn::Floor(hn::IfThenElseZero(inside, x)), number(CraterProfile::kSteps - 1));
    const V t = hn::Sub(x, step);
    const auto index = hn::ConvertTo(Longs(), step);
    const auto at = [&](const double* state) {
        const V low = hn::GatherIndex(d, state, index), high = hn::GatherIndex(d, state + 1, index);
        return hn::Add(low, hn::Mul(t, hn::Sub(high, low)));
    };
    const V fresher = at(worn.fresher);
    return hn::IfThenElseZero(
        inside, hn::Add(fresher, hn::Mul(number(worn.share), hn::Sub(at(worn.older), fresher))));
}

// Adds the rays at one place, x radii away.
void brighten(const CraterShape& c, Vec3d place, double x, Vec3f& color) {
    if (!(x < CraterShape::kRayReach)) return;
    const Vec3d away = place - c.place;
    const double azimuth = std::atan2(dot(away, c.axes.north), dot(away, c.axes.east));
    const double ray = 0.5 + 0.5 * std::cos(c.ray_count * azimuth + c.ray_phase_rad);
    const double share =
        x < 1 ? 0.6 : std::exp(1 - x) * (0.3 + 0.7 * ray * ray) * (1 - x / CraterShape::kRayReach);
    color = static_cast<float>(1 + c.bright * share) * color;
}

void add(const CraterShape& c, const GroundPatch& patch) {
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    const CraterDistances distances(c);
    const GroundPatch::Window w =
        patch.window(c.place, CraterShape::reach(c.bright) * 1.1 * c.radius_m / c.body_radius_m);
    const bool colored = c.bright > 0 && !patch.colors.empty();
    const auto add_some = [&](const double* places, double* heights_m, std::size_t first, std::size_t count) {
        V x, distances2;
        if (!distances.find(places, x, distances2)) return;
        const auto within = distances.within(distances2);
        const V before = hn::LoadU(d, heights_m);
        const V sum = hn::Add(before, hn::Mul(number(c.depth_m), height(c.profile, x)));
        hn::StoreU(hn::IfThenElse(within, sum, before), d, heights_m);
        if (!colored) return;
        double at[kMaxLanes] = {};
        hn::StoreU(hn::IfThenElse(within, x, number(CraterShape::kRayReach)), d, at);
        for (std::size_t k = 0; k < count; ++k)
            brighten(c, patch.places[first + k], at[k], patch.colors[first + k]);
    };
    // Whole vectors, which may extend beyond the window; there are no places within the crater's reach there.
    const int wanted =
        (w.x1 - w.x0 + static_cast<int>(lanes) - 1) / static_cast<int>(lanes) * static_cast<int>(lanes);
    const int x0 = std::max(0, std::min(w.x0, patch.side - wanted)), x1 = std::min(patch.side, x0 + wanted);
    for (int y = w.y0; y < w.y1; ++y) {
        const auto end = static_cast<std::size_t>(y * patch.side + x1);
        auto i = static_cast<std::size_t>(y * patch.side + x0);
        for (; i + lanes <= end; i += lanes)
            add_some(&patch.places[i].x, patch.heights_m.data() + i, i, lanes);
        if (i >= end) continue;
        // The rest of a narrow patch is less than a vector.
        Vec3d places[kMaxLanes] = {};
        double heights_m[kMaxLanes] = {};
        std::copy_n(patch.places.begin() + static_cast<std::ptrdiff_t>(i), end - i, places);
        std::copy_n(patch.heights_m.begin() + static_cast<std::ptrdiff_t>(i), end - i, heights_m);
        add_some(&places[0].x, heights_m, i, end - i);
        std::copy_n(heights_m, end - i, patch.heights_m.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(add);

void add_crater(const CraterShape& crater, const GroundPatch& patch) {
    HWY_DYNAMIC_DISPATCH(add)(crater, patch);
}

}  // namespace hilcam
#endif
