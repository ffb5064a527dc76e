#include "render/lod/coverage_map_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lod/coverage_map_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Two groups of eight texels side by side, in as many vectors as needed.
constexpr std::size_t kEight = CoverageTexels::kLanes, kLanes = 2 * kEight;
using Floats = hn::CappedTag<float, kLanes>;
using Numbers = hn::RebindToUnsigned<Floats>;
using V = hn::Vec<Floats>;
constexpr std::size_t kStep = hn::MaxLanes(Floats());

// Two groups anywhere in memory.
using Pair = std::array<const CoverageTexels*, 2>;
// A vector's part of them, starting with lane kFirst.
template <std::size_t kFirst>
struct Part {
    static constexpr std::size_t kOf = kFirst / kEight, kTexel = kFirst % kEight;

    // Returns the offset of each texel from the first of its group.
    static HWY_INLINE V ways(float step) {
        const hn::RebindToSigned<Floats> di;
        const auto texel = hn::And(hn::Iota(di, static_cast<std::int32_t>(kFirst)), hn::Set(di, kEight - 1));
        return hn::Mul(hn::ConvertTo(Floats(), texel), hn::Set(Floats(), step));
    }
    static HWY_INLINE V places(const float* first, V ways) {
        const Floats d;
        if constexpr (kStep == kLanes) {
            const hn::Half<Floats> half;
            return hn::Add(hn::Combine(d, hn::Set(half, first[1]), hn::Set(half, first[0])), ways);
        } else {
            return hn::Add(hn::Set(d, first[kOf]), ways);
        }
    }
    // Returns the texels' values at an offset in CoverageTexels.
    template <class Byte = std::uint8_t>
    static HWY_INLINE V numbers(const Pair& eights, std::size_t offset) {
        const hn::Rebind<Byte, Floats> bytes;
        const hn::RebindToSigned<Floats> di;
        const auto at = [&](std::size_t i)
                            HWY_ATTR { return reinterpret_cast<const Byte*>(eights[i]) + offset; };
        if constexpr (kStep == kLanes) {
            const hn::Half<decltype(bytes)> half;
            const auto both = hn::Combine(bytes, hn::LoadU(half, at(1)), hn::LoadU(half, at(0)));
            return hn::ConvertTo(Floats(), hn::PromoteTo(di, both));
        } else {
            return hn::ConvertTo(Floats(), hn::PromoteTo(di, hn::LoadU(bytes, at(kOf) + kTexel)));
        }
    }
};

// Groups that may be partly in the pixel, and the place of the first texel of each.
struct Found {
    std::size_t count = 0;
    alignas(64) std::array<std::uint32_t, CoverageWindow::kMax + kLanes> number;
    alignas(64) std::array<float, CoverageWindow::kMax + kLanes> x, y;

    // Appends those lanes of a vector that are in the pixel.
    HWY_INLINE void append(hn::Mask<Floats> seen, hn::Vec<Numbers> numbers, V x_there, V y_there) {
        const Floats d;
        const Numbers du;
        if constexpr (kStep == kLanes) {
            hn::StoreU(hn::Compress(numbers, hn::RebindMask(du, seen)), du, &number[count]);
            hn::StoreU(hn::Compress(x_there, seen), d, &x[count]);
            hn::StoreU(hn::Compress(y_there, seen), d, &y[count]);
            count += hn::CountTrue(d, seen);
        } else {
            // Highway uses a table for this, which is slower than one by one.
            alignas(64) std::array<std::uint32_t, kStep> n, is_seen;
            alignas(64) std::array<float, kStep> x_of, y_of;
            hn::Store(numbers, du, n.data()), hn::Store(x_there, d, x_of.data()),
                hn::Store(y_there, d, y_of.data());
            hn::Store(hn::VecFromMask(du, hn::RebindMask(du, seen)), du, is_seen.data());
            for (std::size_t i = 0; i < kStep; ++i) {
                number[count] = n[i], x[count] = x_of[i], y[count] = y_of[i];
                count += is_seen[i] & 1u;
            }
        }
    }
};

// Returns 1 / step. Along a side of the pixel a row is inside completely or not at all, as with a step near
// zero.
float inverse(float step) { return std::copysign(1 / std::max(std::abs(step), 1e-6f), step); }

// Returns false if there are too many. Lanes are rows.
HWY_INLINE bool find(const CoverageWindow& w, Found& out) {
    const Floats d;
    const Numbers du;
    const float x_per_column = inverse(w.x_column), y_per_column = inverse(w.y_column);
    const V x_half = hn::Set(d, w.x_reach * std::abs(x_per_column)),
            y_half = hn::Set(d, w.y_reach * std::abs(y_per_column));
    const auto rows_of_eights = hn::Mul(hn::Iota(du, 0), hn::Set(du, w.row_of_eights));
    for (std::uint32_t e = 0; e < w.across; ++e) {
        const float first = w.column + static_cast<float>(e * kEight),
                    last = first + static_cast<float>(kEight - 1);
        for (std::uint32_t r = 0; r < w.rows; r += kStep) {
            const V below = hn::Add(hn::Set(d, w.row), hn::Iota(d, static_cast<float>(r)));
            const V x = hn::Mul(below, hn::Set(d, w.x_row)), y = hn::Mul(below, hn::Set(d, w.y_row));
            // The columns between which the row is inside the pixel.
            const V x_middle = hn::Mul(x, hn::Set(d, -x_per_column)),
                    y_middle = hn::Mul(y, hn::Set(d, -y_per_column));
            const V from = hn::Max(hn::Sub(x_middle, x_half), hn::Sub(y_middle, y_half)),
                    until = hn::Min(hn::Add(x_middle, x_half), hn::Add(y_middle, y_half));
            const auto seen =
                hn::And(hn::And(hn::Le(from, hn::Set(d, last)), hn::Ge(until, hn::Set(d, first))),
                        hn::FirstN(d, w.rows - r));
            const auto number = hn::Add(rows_of_eights, hn::Set(du, r * w.row_of_eights + e));
            out.append(seen, number, hn::Add(x, hn::Set(d, first * w.x_column)),
                       hn::Add(y, hn::Set(d, first * w.y_column)));
            if (out.count > CoverageWindow::kMax) return false;
        }
    }
    // They are processed in pairs, so the last one may be a dummy far away.
    out.number[out.count] = 0;
    out.x[out.count] = out.y[out.count] = 1e9f;
    return true;
}

// Returns the share of a texel inside the pixel along one side.
HWY_INLINE V inside(V at, V reach) {
    const Floats d;
    return hn::Min(hn::Max(hn::Sub(reach, hn::Abs(at)), hn::Zero(d)), hn::Set(d, 1));
}

// The terms of CoverageSums, in order.
constexpr std::size_t kLayers = CoverageTexels::kLayers, kShare = 0, kX = kLayers, kY = 2 * kLayers,
                      kLean = 3 * kLayers, kLit = kLean + 2, kTerms = kLit + 1;
static_assert(sizeof(CoverageSums) == kTerms * sizeof(float) && kTerms % 4 == 0);
using Lanes = std::array<std::array<float, kLanes>, kTerms>;

template <std::size_t kFirst>
HWY_INLINE void sum_part(const CoverageWindow& w, const Found& found, Lanes& out) {
    using P = Part<kFirst>;
    const Floats d;
    const V x_ways = P::ways(w.x_column), y_ways = P::ways(w.y_column), x_reach = hn::Set(d, w.x_reach),
            y_reach = hn::Set(d, w.y_reach), light_across = hn::Set(d, w.light_across),
            light_down = hn::Set(d, w.light_down), dark = hn::Zero(d);
    V sum[kTerms];
    for (V& term : sum) term = hn::Zero(d);
    const auto add = [&](std::size_t term, V more) HWY_ATTR { sum[term] = hn::Add(sum[term], more); };
    for (std::size_t i = 0; i < found.count; i += 2) {
        const Pair eights{w.kinds + w.eights[found.number[i]], w.kinds + w.eights[found.number[i + 1]]};
        const V x = P::places(&found.x[i], x_ways), y = P::places(&found.y[i], y_ways),
                weight = hn::Mul(inside(x, x_reach), inside(y, y_reach));
        V share[kLayers];
        for (std::size_t k = 0; k < kLayers; ++k) {
            share[k] = P::numbers(eights, offsetof(CoverageTexels, share) + k * kEight);
            const V part = hn::Mul(weight, share[k]);
            add(kShare + k, part), add(kX + k, hn::Mul(part, x)), add(kY + k, hn::Mul(part, y));
        }
        V gap[2];
        for (std::size_t k = 0; k < 2; ++k) {
            const std::size_t lean = offsetof(CoverageTexels, lean) + k * kEight;
            add(kLean + k, hn::Mul(weight, P::template numbers<std::int8_t>(eights, lean)));
            gap[k] = P::numbers(eights, offsetof(CoverageTexels, gap) + k * kEight);
        }
        // Computed texel by texel, because a narrow dark gap must not darken a wide one.
        const V down = P::numbers(eights, offsetof(CoverageTexels, down)), across = hn::Sub(share[0], down);
        const V open = hn::Add(hn::Max(hn::Sub(down, hn::Mul(light_across, gap[0])), dark),
                               hn::Max(hn::Sub(across, hn::Mul(light_down, gap[1])), dark));
        add(kLit, hn::Mul(weight, open));
    }
    for (std::size_t i = 0; i < kTerms; ++i) hn::StoreU(sum[i], d, &out[i][kFirst]);
}

template <std::size_t... kPart>
HWY_INLINE void sum_parts(const CoverageWindow& w, const Found& found, Lanes& out,
                          std::index_sequence<kPart...>) {
    (sum_part<kPart * kStep>(w, found, out), ...);
}

// Adds the halves of lanes to each other, for four sums at a time.
CoverageSums add_lanes(const Lanes& lanes) {
    const hn::Full128<float> d;
    const auto four = [&](std::size_t term) HWY_ATTR {
        const float* lane = lanes[term].data();
        return hn::Add(hn::Add(hn::Load(d, lane), hn::Load(d, lane + 8)),
                       hn::Add(hn::Load(d, lane + 4), hn::Load(d, lane + 12)));
    };
    const auto two_each = [&](std::size_t term) HWY_ATTR {
        const auto a = four(term), b = four(term + 1);
        return hn::Add(hn::ConcatLowerLower(d, b, a), hn::ConcatUpperUpper(d, b, a));
    };
    alignas(16) std::array<float, kTerms> out;
    for (std::size_t i = 0; i < kTerms; i += 4) {
        const auto ab = two_each(i), cd = two_each(i + 2);
        hn::Store(hn::Add(hn::ConcatEven(d, cd, ab), hn::ConcatOdd(d, cd, ab)), d, &out[i]);
    }
    return std::bit_cast<CoverageSums>(out);
}

bool sums(const CoverageWindow& w, CoverageSums& out) {
    Found found;
    if (!find(w, found)) return false;
    alignas(64) Lanes lanes;
    sum_parts(w, found, lanes, std::make_index_sequence<kLanes / kStep>());
    out = add_lanes(lanes);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(sums);

bool find_sums(const CoverageWindow& window, CoverageSums& out) {
    return HWY_DYNAMIC_DISPATCH(sums)(window, out);
}

}  // namespace hilcam
#endif
