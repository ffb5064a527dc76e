#include "render/visibility/visibility_tile.h"

#include <limits>

#include "render/visibility/visibility_raster.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/visibility_tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/sixteen_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

static_assert(kVisibilitySamples == 16);
constexpr int kSide_px = kVisibilityTile_px;

struct SamplePlaces {
    HWY_ALIGN float x[kSide_px][kVisibilitySamples];
    HWY_ALIGN float y[kSide_px][kVisibilitySamples];
    constexpr SamplePlaces() : x(), y() {
        for (int p = 0; p < kSide_px; ++p)
            for (int i = 0; i < kVisibilitySamples; ++i)
                x[p][i] = static_cast<float>(p) + sample_x(i), y[p][i] = static_cast<float>(p) + sample_y(i);
    }
};
constexpr SamplePlaces kPlaces;

// Bounds of sixteen triangles in a pixel, with pixels as lanes: at any sample of the pixel an edge function,
// or the depth, is at most a * column + b * row + c.
struct PixelBounds {
    struct Plane {
        HWY_ALIGN float a[kTrianglesAtOnce];
        HWY_ALIGN float b[kTrianglesAtOnce];
        HWY_ALIGN float c[kTrianglesAtOnce];
    };
    Plane edge[3], depth;
};
// Writes the bounds of triangles from k on.
HWY_INLINE void bound(V a, V b, V c, std::size_t k, PixelBounds::Plane& out) {
    const Floats d;
    constexpr float kFirst = sample_x(0), kLast = sample_x(kVisibilitySamples - 1);
    // Sixteen times the rounding of the sums at samples.
    constexpr float kRounding = 0x1p-20f;
    const V first = hn::Set(d, kFirst), last = hn::Set(d, kLast);
    const auto greatest = [&](V slope) { return hn::Max(hn::Mul(slope, first), hn::Mul(slope, last)); };
    const V size = times_plus(hn::Set(d, kSide_px), hn::Add(hn::Abs(a), hn::Abs(b)), hn::Abs(c));
    const V most =
        hn::Add(hn::Add(c, hn::Add(greatest(a), greatest(b))), hn::Mul(size, hn::Set(d, kRounding)));
    hn::Store(a, d, out.a + k), hn::Store(b, d, out.b + k), hn::Store(most, d, out.c + k);
}
void bound_pixels(const TriangleSetup& s, PixelBounds& out) {
    const Floats d;
    const Ints di;
    const std::size_t lanes = hn::Lanes(d);
    const I sign = hn::Set(di, std::numeric_limits<std::int32_t>::min());
    for (std::size_t k = 0; k < s.count; k += lanes) {
        for (std::size_t i = 0; i < 3; ++i) {
            // Inside is where the function is positive.
            const I flip = hn::Load(di, reinterpret_cast<const std::int32_t*>(s.flip[i].data()) + k);
            const V turn = hn::BitCast(d, hn::Xor(flip, sign));
            const auto turned = [&](const auto& of) { return hn::Xor(hn::Load(d, of[i].data() + k), turn); };
            bound(turned(s.a), turned(s.b), turned(s.c), k, out.edge[i]);
        }
        bound(hn::Load(d, s.depth_x.data() + k), hn::Load(d, s.depth_y.data() + k),
              hn::Load(d, s.depth.data() + k), k, out.depth);
    }
}

// True when everything that a triangle may cover is already nearer.
bool is_hidden(const TriangleSetup& s, std::size_t k, const VisibilityTile& tile) {
    constexpr int kHalf = kSide_px / 2;
    const float nearest = s.max_depth[k];
    for (int j = s.y0[k] / kHalf; j <= s.y1[k] / kHalf; ++j)
        for (int i = s.x0[k] / kHalf; i <= s.x1[k] / kHalf; ++i)
            if (nearest > tile.farthest[static_cast<std::size_t>(2 * j + i)]) return false;
    return true;
}

// Finds the least depth of the samples of each of four consecutive pixels.
HWY_INLINE void least_of_four(const float* depth, float* out) {
    const Floats d;
    const hn::Full128<float> four;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    using Pairs = hn::Repartition<double, Floats>;
    auto least = hn::Set(four, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < kVisibilitySamples; i += lanes) {
        // Takes the least of each block of four samples, for each pixel.
        const auto of = [&](std::size_t pixel) {
            return hn::Load(d, depth + pixel * kVisibilitySamples + i);
        };
        const auto two = [&](V a, V b) {
            return hn::Min(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
        };
        const auto p = hn::BitCast(Pairs(), two(of(0), of(1))), q = hn::BitCast(Pairs(), two(of(2), of(3)));
        HWY_ALIGN float blocks[kVisibilitySamples];
        hn::Store(hn::Min(hn::BitCast(d, hn::InterleaveLower(Pairs(), p, q)),
                          hn::BitCast(d, hn::InterleaveUpper(Pairs(), p, q))),
                  d, blocks);
        for (std::size_t block = 0; block < lanes; block += 4)
            least = hn::Min(least, hn::Load(four, blocks + block));
    }
    hn::Store(least, four, out);
}

void farthest(VisibilityTile& tile) {
    constexpr std::size_t kHalf = kSide_px / 2;
    for (std::size_t pixel = 0; pixel < VisibilityTile::kPixels; pixel += 4)
        least_of_four(&tile.depth[pixel * kVisibilitySamples], &tile.farthest_of[pixel]);
    const hn::CappedTag<float, kHalf> d;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        auto least = hn::Set(d, std::numeric_limits<float>::infinity());
        for (std::size_t row = 0; row < kHalf; ++row) {
            const float* of = &tile.farthest_of[(quarter / 2 * kHalf + row) * kSide_px + quarter % 2 * kHalf];
            for (std::size_t i = 0; i < kHalf; i += lanes) least = hn::Min(least, hn::Load(d, of + i));
        }
        tile.farthest[quarter] = hn::GetLane(hn::MinOfLanes(d, least));
    }
}

// Pixels are tested in squares of 4 x 4.
constexpr int kSquare_px = 4;
struct SquarePlaces {
    HWY_ALIGN float column[kSquare_px * kSquare_px];
    HWY_ALIGN float row[kSquare_px * kSquare_px];
    HWY_ALIGN std::int32_t pixel[kSquare_px * kSquare_px];  // in the tile, relative to the square's first
    constexpr SquarePlaces() : column(), row(), pixel() {
        for (int i = 0; i < kSquare_px * kSquare_px; ++i) {
            const int x = i % kSquare_px, y = i / kSquare_px;
            column[i] = static_cast<float>(x), row[i] = static_cast<float>(y), pixel[i] = y * kSide_px + x;
        }
    }
};
constexpr SquarePlaces kSquare;

// Fills a triangle into a tile.
class Filler {
  public:
    HWY_INLINE Filler(const TriangleSetup& s, const PixelBounds& bounds, std::size_t k, VisibilityTile& tile)
        : tile_(tile), x1_(s.x1[k]), y1_(s.y1[k]) {
        const Floats d;
        const Ints di;
        for (std::size_t i = 0; i < 3; ++i) {
            a_[i] = hn::Set(d, s.a[i][k]), b_[i] = hn::Set(d, s.b[i][k]), c_[i] = hn::Set(d, s.c[i][k]);
            flip_[i] = hn::Set(di, static_cast<std::int32_t>(s.flip[i][k]));
        }
        gx_ = hn::Set(d, s.depth_x[k]), gy_ = hn::Set(d, s.depth_y[k]), g_ = hn::Set(d, s.depth[k]);
        near_most_ = hn::Set(d, s.max_depth[k]), far_most_ = hn::Set(d, s.min_depth[k]);
        id_ = hn::Set(di, static_cast<std::int32_t>(s.id[k]));
        for (int y = s.y0[k]; y <= y1_; y += kSquare_px)
            for (int x = s.x0[k]; x <= x1_; x += kSquare_px) add_candidates(bounds, k, x, y);
        for (std::size_t i = 0; i < count_; ++i) fill(static_cast<std::size_t>(candidates_[i]));
    }

  private:
    VisibilityTile& tile_;
    int x1_, y1_;
    V a_[3], b_[3], c_[3], gx_, gy_, g_, near_most_, far_most_;
    I flip_[3], id_;
    // The pixels with a sample that may see the triangle. They are listed before any is filled, because a
    // loop over those of each square would have an unpredictable length.
    std::size_t count_ = 0;
    HWY_ALIGN std::int32_t candidates_[VisibilityTile::kPixels + hn::MaxLanes(Ints())];

    // Adds those of a square.
    HWY_INLINE void add_candidates(const PixelBounds& bounds, std::size_t k, int left, int top) {
        const Floats d;
        constexpr std::size_t lanes = hn::MaxLanes(d);
        const V x0 = hn::Set(d, static_cast<float>(left)), y0 = hn::Set(d, static_cast<float>(top));
        const V x1 = hn::Set(d, static_cast<float>(x1_)), y1 = hn::Set(d, static_cast<float>(y1_));
        const Ints di;
        const int corner = top * kSide_px + left;
        const auto behind = [&](std::size_t i) {
            return &tile_.farthest_of[static_cast<std::size_t>(corner) + i / kSquare_px * kSide_px];
        };
        for (std::size_t part = 0; part < kSquare_px * kSquare_px; part += lanes) {
            const V x = hn::Add(hn::Load(d, kSquare.column + part), x0);
            const V y = hn::Add(hn::Load(d, kSquare.row + part), y0);
            const auto most = [&](const PixelBounds::Plane& plane) {
                return times_plus(hn::Set(d, plane.a[k]), x,
                                  times_plus(hn::Set(d, plane.b[k]), y, hn::Set(d, plane.c[k])));
            };
            const V least =
                hn::Min(hn::Min(most(bounds.edge[0]), most(bounds.edge[1])), most(bounds.edge[2]));
            const V nearest = hn::Min(hn::Max(most(bounds.depth), far_most_), near_most_);
            const auto within = hn::And(hn::Le(x, x1), hn::Le(y, y1));
            const auto seen =
                hn::And(hn::Ge(least, hn::Zero(d)), hn::Gt(nearest, blocks_of(d, behind, part)));
            const auto found = hn::RebindMask(di, hn::And(within, seen));
            const I pixels = hn::Add(hn::Load(di, kSquare.pixel + part), hn::Set(di, corner));
            hn::StoreU(hn::Compress(pixels, found), di, candidates_ + count_);
            count_ += hn::CountTrue(di, found);
        }
    }
    HWY_INLINE void fill(std::size_t pixel) {
        const Floats d;
        const Ints di;
        constexpr std::size_t lanes = hn::MaxLanes(d);
        const std::size_t px = pixel % kSide_px, row = pixel / kSide_px, first = pixel * kVisibilitySamples;
        for (std::size_t sample = 0; sample < kVisibilitySamples; sample += lanes) {
            const V x = hn::Load(d, &kPlaces.x[px][sample]), y = hn::Load(d, &kPlaces.y[row][sample]);
            const auto side = [&](std::size_t i) {
                return hn::Xor(hn::BitCast(di, times_plus(a_[i], x, times_plus(b_[i], y, c_[i]))), flip_[i]);
            };
            const I all = hn::And(hn::And(side(0), side(1)), side(2));
            const V z = hn::Min(hn::Max(times_plus(gx_, x, times_plus(gy_, y, g_)), far_most_), near_most_);
            float* depth = &tile_.depth[first + sample];
            const V before = hn::Load(d, depth);
            const auto seen = hn::And(hn::RebindMask(d, hn::Lt(all, hn::Zero(di))), hn::Gt(z, before));
            // Stores all lanes: a load that follows soon does not have to wait, and masked stores are slow
            // without AVX-512.
            hn::Store(hn::IfThenElse(seen, z, before), d, depth);
            auto* const id = reinterpret_cast<std::int32_t*>(&tile_.id[first + sample]);
            hn::Store(hn::IfThenElse(hn::RebindMask(di, seen), id_, hn::Load(di, id)), di, id);
        }
    }
};

void fill(const TriangleSetup& s, VisibilityTile& tile) {
    PixelBounds bounds;
    bound_pixels(s, bounds);
    for (std::size_t k = 0; k < s.count; ++k)
        if (s.x1[k] >= s.x0[k] && !is_hidden(s, k, tile)) Filler(s, bounds, k, tile);
}

// Returns a bit for each of sixteen ids that equals the wanted one.
HWY_INLINE SampleMask equal_of_sixteen(const std::uint32_t* ids, std::uint32_t wanted) {
    const hn::CappedTag<std::uint32_t, kVisibilitySamples> d;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    SampleMask same = 0;
    for (std::size_t i = 0; i < kVisibilitySamples; i += lanes)
        same |= SampleMask{bits_of(d, hn::Eq(hn::Load(d, ids + i), hn::Set(d, wanted)))} << i;
    return same;
}

// Lists a pixel of kAcross x kAcross tile pixels; sample 16 q + i is sample i of quarter q.
template <int kAcross>
void list_pixel(const std::uint32_t* ids, PixelFragments& out) {
    constexpr int kQuarters = kAcross * kAcross;
    constexpr SampleMask kAll = ~SampleMask{0} >> (64 - kVisibilitySamples * kQuarters);
    const auto of_quarter = [&](int q) {
        return ids + (q / kAcross * kSide_px + q % kAcross) * kVisibilitySamples;
    };
    // All quarters, also those before the first that has it: a loop from there would have an unpredictable
    // length.
    const auto equal = [&](std::uint32_t id) {
        SampleMask same = 0;
        for (int q = 0; q < kQuarters; ++q)
            same |= equal_of_sixteen(of_quarter(q), id) << (kVisibilitySamples * q);
        return same;
    };
    out.nothing = 0;
    std::size_t count = 0;
    for (SampleMask rest = kAll, same; rest != 0; rest &= ~same) {
        const int first = __builtin_ctzll(rest);
        const std::uint32_t id = of_quarter(first / kVisibilitySamples)[first % kVisibilitySamples];
        same = equal(id);
        if (id == VisibilityTile::kNothing) {
            out.nothing = same;
            continue;
        }
        const auto others =
            static_cast<std::uint32_t>(kVisibilitySamples * kQuarters - __builtin_popcountll(same));
        const auto comes_after = [&](const PixelFragments::Fragment& other) {
            return other.others != others ? other.others > others : other.samples > same;
        };
        std::size_t place = count++;
        for (; place > 0 && comes_after(out.fragments[place - 1]); --place)
            out.fragments[place] = out.fragments[place - 1];
        out.fragments[place] = {id, others, same};
    }
    out.count = count;
}

void list(const std::uint32_t* ids, int across, PixelFragments& out) {
    if (across == 1)
        list_pixel<1>(ids, out);
    else
        list_pixel<2>(ids, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(fill);
HWY_EXPORT(farthest);
HWY_EXPORT(list);

void fill_tile(const TriangleSetup& setup, VisibilityTile& tile) { HWY_DYNAMIC_DISPATCH(fill)(setup, tile); }
void find_farthest(VisibilityTile& tile) { HWY_DYNAMIC_DISPATCH(farthest)(tile); }
void list_fragments(const std::uint32_t* ids, int across, PixelFragments& out) {
    HWY_DYNAMIC_DISPATCH(list)(ids, across, out);
}

}  // namespace hilcam
#endif
