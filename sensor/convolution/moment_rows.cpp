#include "sensor/convolution/moment_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sensor/convolution/moment_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using V = hn::Vec<Floats>;
constexpr std::size_t kLanes = hn::MaxLanes(Floats());
// Vectors of a row with sums computed together: for both rows they fit into registers, of which there are at
// least sixteen.
constexpr std::size_t kVectors = kSubpixelBlock_px / kLanes < 4 ? kSubpixelBlock_px / kLanes : 4;
static_assert(kSubpixelBlock_px % (kVectors * kLanes) == 0);

// Sums for some columns of the two rows.
struct Columns {
    V upper[kVectors], lower[kVectors];

    // Adds one row of differences; null weights: it is beyond the kernel.
    template <bool kUpper, bool kLower>
    HWY_INLINE void add(const float* in, const float* of_upper, const float* of_lower, int taps) {
        const Floats d;
        for (int i = 0; i < taps; ++i) {
            const V to_upper = kUpper ? hn::Set(d, of_upper[-i]) : hn::Zero(d);
            const V to_lower = kLower ? hn::Set(d, of_lower[-i]) : hn::Zero(d);
            for (std::size_t k = 0; k < kVectors; ++k) {
                const V from = hn::LoadU(d, in + i + k * kLanes);
                if (kUpper) upper[k] = hn::Add(upper[k], hn::Mul(to_upper, from));
                if (kLower) lower[k] = hn::Add(lower[k], hn::Mul(to_lower, from));
            }
        }
    }
};

HWY_INLINE Columns sums_of(const MomentRows& rows, std::size_t first) {
    Columns sums;
    for (std::size_t k = 0; k < kVectors; ++k) sums.upper[k] = sums.lower[k] = hn::Zero(Floats());
    const float* in = rows.in + first;
    const float* weights = rows.weights;
    if (rows.lit[0]) sums.add<true, false>(in, weights, nullptr, rows.taps);
    for (int j = 1; j < rows.taps; ++j) {
        in += rows.side, weights -= rows.across;
        if (rows.lit[j]) sums.add<true, true>(in, weights, weights + rows.across, rows.taps);
    }
    if (rows.lit[rows.taps]) sums.add<false, true>(in + rows.side, nullptr, weights, rows.taps);
    return sums;
}

void sum_rows(const MomentRows& rows, float* out) {
    const Floats d;
    for (std::size_t first = 0; first < kSubpixelBlock_px; first += kVectors * kLanes) {
        const Columns sums = sums_of(rows, first);
        for (std::size_t k = 0; k < kVectors; ++k) {
            hn::StoreU(sums.upper[k], d, out + first + k * kLanes);
            hn::StoreU(sums.lower[k], d, out + kSubpixelBlock_px + first + k * kLanes);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(sum_rows);

void sum_moment_rows(const MomentRows& rows, float* out) { HWY_DYNAMIC_DISPATCH(sum_rows)(rows, out); }

}  // namespace hilcam
#endif
