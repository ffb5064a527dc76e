#include "render/visibility/visibility_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "render/visibility/visibility_raster.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// A triangle sample by sample, as TriangleSetup says.
void fill_plainly(const TriangleSetup& s, VisibilityTile& tile) {
    for (std::size_t k = 0; k < s.count; ++k)
        for (int p = 0; p < kVisibilityTile_px * kVisibilityTile_px && s.x1[k] >= s.x0[k]; ++p)
            for (int i = 0; i < kVisibilitySamples; ++i) {
                const float x = static_cast<float>(p % kVisibilityTile_px) + sample_x(i);
                const float y = static_cast<float>(p / kVisibilityTile_px) + sample_y(i);
                bool inside = true;
                for (std::size_t e = 0; e < 3; ++e)
                    inside &=
                        std::signbit(s.a[e][k] * x + (s.b[e][k] * y + s.c[e][k])) != (s.flip[e][k] != 0);
                const float z = std::clamp(s.depth_x[k] * x + (s.depth_y[k] * y + s.depth[k]), s.min_depth[k],
                                           s.max_depth[k]);
                const auto at = static_cast<std::size_t>(p * kVisibilitySamples + i);
                if (inside && z > tile.depth[at]) tile.depth[at] = z, tile.id[at] = s.id[k];
            }
}

// Triangles about a tile at (32, 48) px, from a tenth of a pixel to some hundred across.
struct Shower {
    std::vector<ScreenVertex> vertices;
    std::vector<TriangleCorners> triangles;

    explicit Shower(unsigned seed) {
        std::mt19937 engine(seed);
        std::uniform_real_distribution<float> any(0, 1);
        for (std::uint32_t t = 0; t < 16; ++t) {
            const float size_px = 0.1f * std::pow(1000.0f, any(engine));
            const float x = 32 + 16 * any(engine), y = 48 + 16 * any(engine), depth = any(engine) - 0.5f;
            for (int k = 0; k < 3; ++k)
                vertices.push_back({x + size_px * (any(engine) - 0.5f), y + size_px * (any(engine) - 0.5f),
                                    depth + 0.1f * any(engine), 0});
            triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        }
    }
    TriangleSetup set_up(std::uint32_t first_id) const {
        TriangleSetup out;
        std::array<std::uint32_t, kTrianglesAtOnce> numbers{};
        for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
        set_up_triangles({vertices.data(), triangles.data(), first_id}, numbers, numbers.size(), 32, 48,
                         nullptr, out);
        return out;
    }
};

// Squares of pixels and what is known to be hidden save time and change nothing.
TEST(VisibilityTile, HasWhatEachSampleSees) {
    const auto tile = std::make_unique<VisibilityTile>(), plain = std::make_unique<VisibilityTile>();
    std::size_t covered = 0;
    for (unsigned round = 0; round < 20; ++round) {
        tile->clear(), plain->clear();
        for (unsigned part = 0; part < 12; ++part) {
            const TriangleSetup setup = Shower(100 * round + part).set_up(16 * part);
            fill_tile(setup, *tile);
            fill_plainly(setup, *plain);
            find_farthest(*tile);
        }
        EXPECT_EQ(tile->id, plain->id);
        EXPECT_EQ(tile->depth, plain->depth);
        covered +=
            static_cast<std::size_t>(std::count_if(tile->id.begin(), tile->id.end(), [](std::uint32_t id) {
                return id != VisibilityTile::kNothing;
            }));
    }
    EXPECT_GT(covered, 20 * VisibilityTile::kSize / 2);
}

TEST(VisibilityTile, KnowsTheFarthestOfEachPixelAndQuarter) {
    const auto tile = std::make_unique<VisibilityTile>();
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> any(-1, 1);
    tile->clear();
    for (float& depth : tile->depth) depth = any(engine);
    find_farthest(*tile);
    std::array<float, 4> quarters;
    quarters.fill(std::numeric_limits<float>::infinity());
    for (std::size_t p = 0; p < VisibilityTile::kPixels; ++p) {
        const auto first = tile->depth.begin() + static_cast<std::ptrdiff_t>(p * kVisibilitySamples);
        EXPECT_EQ(tile->farthest_of[p], *std::min_element(first, first + kVisibilitySamples));
        float& quarter = quarters[p / 128 * 2 + p % 16 / 8];
        quarter = std::min(quarter, tile->farthest_of[p]);
    }
    EXPECT_EQ(tile->farthest, quarters);
}

// An id, the samples that see it; most samples first, of as many the lesser mask.
using Listed = std::vector<std::pair<std::uint32_t, SampleMask>>;

// Pixels of the picture that are so many of the tile's wide and high.
void expect_lists(int across) {
    std::mt19937 engine(2);
    const auto tile = std::make_unique<VisibilityTile>();
    const auto any = [&](std::uint32_t below) { return static_cast<std::uint32_t>(engine() % below); };
    for (int round = 0; round < 1000; ++round) {
        const std::uint32_t kinds = 1 + any(16);
        for (std::uint32_t& id : tile->id) id = any(kinds) == 0 ? VisibilityTile::kNothing : 7 + any(kinds);
        const int x = static_cast<int>(any(16 / static_cast<unsigned>(across))) * across, y = across;
        Listed wanted;
        SampleMask nothing = 0;
        for (int i = 0; i < kVisibilitySamples * across * across; ++i) {
            const int quarter = i / kVisibilitySamples;
            const std::uint32_t id =
                tile->ids(x + quarter % across, y + quarter / across)[i % kVisibilitySamples];
            if (id == VisibilityTile::kNothing) {
                nothing |= SampleMask{1} << i;
                continue;
            }
            const auto same = std::find_if(wanted.begin(), wanted.end(),
                                           [&](const auto& listed) { return listed.first == id; });
            if (same == wanted.end())
                wanted.push_back({id, SampleMask{1} << i});
            else
                same->second |= SampleMask{1} << i;
        }
        std::sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) {
            const int more = std::popcount(a.second), less = std::popcount(b.second);
            return more != less ? more > less : a.second < b.second;
        });
        expect_same_by_any_width([&] {
            PixelFragments out;
            list_fragments(tile->ids(x, y), across, out);
            EXPECT_EQ(out.nothing, nothing);
            Listed listed;
            for (std::size_t i = 0; i < out.count; ++i)
                listed.push_back({out.fragments[i].id, out.fragments[i].samples});
            EXPECT_EQ(listed, wanted);
            return listed;
        });
    }
}

TEST(VisibilityTile, ListsWhatAPixelSees) { expect_lists(1); }
TEST(VisibilityTile, ListsWhatAPixelOfFourQuartersSees) { expect_lists(2); }

}  // namespace
}  // namespace hilcam
