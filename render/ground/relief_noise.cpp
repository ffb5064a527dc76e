#include "render/ground/relief_noise.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/ground/relief_noise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/ground/double_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

using Words = hn::RebindToUnsigned<Doubles>;
using W = hn::Vec<Words>;

HWY_INLINE W word(std::uint64_t value) { return hn::Set(Words(), value); }

HWY_INLINE V fade(V t) {
    const V inner = hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, number(6)), number(15))), number(10));
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
}

// A coordinate between two planes of the lattice.
struct Along {
    W hash[2];   // the planes' numbers, mixed
    V from[2];   // distance from each
    V share[2];  // weight of each
};
HWY_INLINE Along along(V p, std::uint64_t factor) {
    const V floor = hn::Floor(p);
    const W number_of = hn::BitCast(Words(), hn::ConvertTo(Longs(), floor));
    const W hash = number_of * word(factor);
    const V t = hn::Sub(p, floor), faded = fade(t);
    return {
        {hash, hn::Add(hash, word(factor))}, {t, hn::Sub(t, number(1))}, {hn::Sub(number(1), faded), faded}};
}

// The gradient at a corner of the lattice: towards the middles of a cube's edges, as in Perlin's noise.
HWY_INLINE V gradient(W h, V x, V y, V z) {
    // A 64-bit mixer (Stafford's 13th of splitmix64; Steele, Lea and Flood, OOPSLA 14): there are too many
    // corners for ten rounds of Philox each.
    const Doubles d;
    h = hn::Xor(h, hn::ShiftRight<30>(h)) * word(0xBF58476D1CE4E5B9u);
    h = hn::Xor(h, hn::ShiftRight<27>(h)) * word(0x94D049BB133111EBu);
    h = hn::Xor(h, hn::ShiftRight<31>(h));
    const auto bit = [&](std::uint64_t which) { return hn::RebindMask(d, hn::TestBit(h, word(which))); };
    const auto four = bit(4), eight = bit(8);
    const V u = hn::IfThenElse(eight, y, x);
    const V v = hn::IfThenElse(eight, hn::IfThenElse(four, x, z), hn::IfThenElse(four, z, y));
    const W sign = word(std::uint64_t{1} << 63);
    const auto signed_by = [&](V value, W bits) {
        return hn::Xor(value, hn::BitCast(d, hn::And(bits, sign)));
    };
    return hn::Add(signed_by(u, hn::ShiftLeft<63>(h)), signed_by(v, hn::ShiftLeft<62>(h)));
}

HWY_INLINE V noise(W seed, V px, V py, V pz) {
    const Along x = along(px, 0x9E3779B97F4A7C15u), y = along(py, 0xC2B2AE3D27D4EB4Fu),
                z = along(pz, 0x165667B19E3779F9u);
    V sum = number(0);
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t j = 0; j < 2; ++j)
            for (std::size_t i = 0; i < 2; ++i) {
                const W h = hn::Xor(hn::Xor(seed, x.hash[i]), hn::Xor(y.hash[j], z.hash[k]));
                const V share = hn::Mul(hn::Mul(x.share[i], y.share[j]), z.share[k]);
                sum = hn::Add(sum, hn::Mul(share, gradient(h, x.from[i], y.from[j], z.from[k])));
            }
    return sum;
}

void add(const ReliefWave& wave, std::span<const Vec3d> places, std::span<double> heights_m) {
    const Doubles d;
    const std::size_t lanes = hn::Lanes(d);
    const W seed = word(wave.seed ^ (static_cast<std::uint64_t>(wave.octave) << 56));
    const auto heights_at = [&](const double* at) {
        V x, y, z;
        hn::LoadInterleaved3(d, at, x, y, z);
        const auto placed = [&](V v, double shift) {
            return hn::Add(hn::Mul(number(wave.scale), v), number(shift));
        };
        return hn::Mul(number(wave.amplitude_m), noise(seed, placed(x, wave.shift.x), placed(y, wave.shift.y),
                                                       placed(z, wave.shift.z)));
    };
    std::size_t i = 0;
    for (; i + lanes <= places.size(); i += lanes) {
        double* const to = heights_m.data() + i;
        hn::StoreU(hn::Add(hn::LoadU(d, to), heights_at(&places[i].x)), d, to);
    }
    // The rest is less than a vector.
    double rest[3 * kMaxLanes] = {}, added[kMaxLanes] = {};
    for (std::size_t k = i; k < places.size(); ++k)
        rest[3 * (k - i)] = places[k].x, rest[3 * (k - i) + 1] = places[k].y,
                      rest[3 * (k - i) + 2] = places[k].z;
    hn::StoreU(heights_at(rest), d, added);
    for (std::size_t k = i; k < places.size(); ++k) heights_m[k] += added[k - i];
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(add);

void add_wave(const ReliefWave& wave, std::span<const Vec3d> places, std::span<double> heights_m) {
    HWY_DYNAMIC_DISPATCH(add)(wave, places, heights_m);
}

}  // namespace hilcam
#endif
