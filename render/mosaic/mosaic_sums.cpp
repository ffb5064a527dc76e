#include "render/mosaic/mosaic_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/mosaic/mosaic_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/vocabulary/lane_sum.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, MosaicTexels::kLanes>;
using V = hn::Vec<Floats>;
constexpr std::size_t kStep = hn::MaxLanes(Floats()), kParts = MosaicTexels::kLanes / kStep;

// Weights of texels, and those times their places.
struct Weights {
    static constexpr std::size_t kSize = MosaicWindow::kMost * MosaicTexels::kLanes;
    alignas(64) float weight[kSize], x[kSize], y[kSize];
};

// The share of a pixel's width at which a texel's middle is in it.
HWY_INLINE V inside(V at, V fall) {
    const Floats d;
    const V half = hn::Set(d, 0.5f);
    const V in = hn::Add(hn::Mul(hn::Sub(half, hn::Abs(hn::Sub(at, half))), fall), half);
    return hn::Min(hn::Max(in, hn::Zero(d)), hn::Set(d, 1));
}

void weigh(const MosaicWindow& w, Weights& out) {
    const Floats d;
    const V x_fall = hn::Set(d, w.x_fall), y_fall = hn::Set(d, w.y_fall);
    for (std::size_t b = 0; b < w.count; ++b)
        for (std::size_t first = 0; first < MosaicTexels::kLanes; first += kStep) {
            const V lane = hn::Iota(d, static_cast<float>(first));
            const V x = hn::Add(hn::Set(d, w.x[b]), hn::Mul(lane, hn::Set(d, w.x_step))),
                    y = hn::Add(hn::Set(d, w.y[b]), hn::Mul(lane, hn::Set(d, w.y_step)));
            const V weight = hn::Mul(inside(x, x_fall), inside(y, y_fall));
            const std::size_t at = b * MosaicTexels::kLanes + first;
            hn::Store(weight, d, out.weight + at);
            hn::Store(hn::Mul(weight, x), d, out.x + at), hn::Store(hn::Mul(weight, y), d, out.y + at);
        }
}

template <class Byte>
HWY_INLINE V numbers(const std::uint8_t* bytes) {
    const Floats d;
    const hn::Rebind<Byte, Floats> db;
    const hn::Rebind<std::int32_t, Floats> di;
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(db, reinterpret_cast<const Byte*>(bytes))));
}

// A sum lane by lane, in one order for all widths.
struct Sum {
    V part[kParts];

    Sum() {
        for (V& p : part) p = hn::Zero(Floats());
    }
    HWY_INLINE void add(std::size_t i, V more) { part[i] = hn::Add(part[i], more); }
    HWY_INLINE float value() const {
        alignas(64) std::array<float, MosaicTexels::kLanes> lanes;
        for (std::size_t i = 0; i < kParts; ++i) hn::Store(part[i], Floats(), lanes.data() + i * kStep);
        return lane_sum(lanes);
    }
};

void sums(const MosaicWindow& w, std::size_t layers, MosaicSums& out) {
    const Floats d;
    Weights weights;
    weigh(w, weights);
    for (std::size_t k = 0; k < layers; ++k) {
        Sum share, x, y;
        for (std::size_t b = 0; b < w.count; ++b)
            for (std::size_t i = 0; i < kParts; ++i) {
                const std::size_t at = b * MosaicTexels::kLanes + i * kStep;
                const V part = numbers<std::uint8_t>(w.texels[b]->share[k].data() + i * kStep);
                share.add(i, hn::Mul(hn::Load(d, weights.weight + at), part));
                x.add(i, hn::Mul(hn::Load(d, weights.x + at), part));
                y.add(i, hn::Mul(hn::Load(d, weights.y + at), part));
            }
        out.share[k] = share.value(), out.x[k] = x.value(), out.y[k] = y.value();
    }
    for (std::size_t k = 0; k < 2; ++k) {
        Sum lean;
        for (std::size_t b = 0; b < w.count; ++b)
            for (std::size_t i = 0; i < kParts; ++i) {
                const V weight = hn::Load(d, weights.weight + b * MosaicTexels::kLanes + i * kStep);
                lean.add(i, hn::Mul(weight, numbers<std::int8_t>(w.texels[b]->lean[k].data() + i * kStep)));
            }
        out.lean[k] = lean.value();
    }
    // Texel by texel, as a narrow gap that is dark must not darken a wide one.
    Sum lit;
    const V across = hn::Set(d, w.across), down = hn::Set(d, w.down), dark = hn::Zero(d);
    for (std::size_t b = 0; b < w.count; ++b)
        for (std::size_t i = 0; i < kParts; ++i) {
            const auto of = [&](const MosaicTexels::Bytes& bytes) {
                return numbers<std::uint8_t>(bytes.data() + i * kStep);
            };
            const MosaicTexels& t = *w.texels[b];
            const V running_down = of(t.down), running_across = hn::Sub(of(t.share[0]), running_down);
            const V open = hn::Add(hn::Max(hn::Sub(running_down, hn::Mul(across, of(t.gap[0]))), dark),
                                   hn::Max(hn::Sub(running_across, hn::Mul(down, of(t.gap[1]))), dark));
            lit.add(i, hn::Mul(hn::Load(d, weights.weight + b * MosaicTexels::kLanes + i * kStep), open));
        }
    out.lit = lit.value();
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(sums);

MosaicSums sums_of(const MosaicWindow& window, std::size_t layers) {
    MosaicSums out;
    HWY_DYNAMIC_DISPATCH(sums)(window, layers, out);
    return out;
}

}  // namespace hilcam
#endif
