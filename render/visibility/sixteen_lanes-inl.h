// Sixteen numbers in as many vectors as needed, for code that is compiled for several vector widths. Included
// once per width, like Highway's own headers.

#if defined(HILCAM_SIXTEEN_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HILCAM_SIXTEEN_LANES_INL_H
#undef HILCAM_SIXTEEN_LANES_INL_H
#else
#define HILCAM_SIXTEEN_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

// A sum after a product, never fused: every width must round in the same way.
HWY_INLINE V times_plus(V a, V b, V c) { return hn::Add(hn::Mul(a, b), c); }

// Loads four numbers into each block of four lanes, from places first, first + 4 and so on. They are combined
// in registers, because reading back memory that was written in parts is slow.
template <class Tag, class PlaceOf>
HWY_INLINE hn::Vec<Tag> blocks_of(Tag d, const PlaceOf& place_of, std::size_t first) {
    if constexpr (hn::MaxLanes(Tag()) == 4) {
        return hn::LoadU(d, place_of(first));
    } else {
        const hn::Half<Tag> half;
        constexpr std::size_t kHalf = hn::MaxLanes(hn::Half<Tag>());
        return hn::Combine(d, blocks_of(half, place_of, first + kHalf), blocks_of(half, place_of, first));
    }
}
// Loads the first three of four numbers at a place for each lane.
template <class PlaceOf>
HWY_INLINE void three_of_four(const PlaceOf& place_of, V& first, V& second, V& third) {
    const Floats d;
    using Pairs = hn::Repartition<double, Floats>;
    const auto of = [&](std::size_t i) { return blocks_of(d, place_of, i); };
    const V a = of(0), b = of(1), e = of(2), f = of(3);
    const auto pairs = [](V v) { return hn::BitCast(Pairs(), v); };
    const auto p = pairs(hn::InterleaveLower(d, a, b)), q = pairs(hn::InterleaveLower(d, e, f));
    first = hn::BitCast(d, hn::InterleaveLower(Pairs(), p, q));
    second = hn::BitCast(d, hn::InterleaveUpper(Pairs(), p, q));
    third = hn::BitCast(d, hn::InterleaveLower(Pairs(), pairs(hn::InterleaveUpper(d, a, b)),
                                               pairs(hn::InterleaveUpper(d, e, f))));
}

// Returns a bit for each lane of a mask, written as a whole so that it stays in a register.
template <class Tag>
HWY_INLINE unsigned bits_of(Tag d, hn::Mask<Tag> mask) {
    static_assert(hn::MaxLanes(Tag()) <= 16);
    std::conditional_t<(hn::MaxLanes(Tag()) > 8), std::uint16_t, std::uint8_t> bits;
    std::uint8_t bytes[8];
    hn::StoreMaskBits(d, mask, bytes);
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#endif
