// What is told of many mirrors at once, against each mirror and each place.

#include "render/indirect/reflected_beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace hilcam {
namespace {

// Mirrors and boxes as in a crowd of small satellites, far from the origin of their space.
class Crowd {
  public:
    ReflectedBeam beam() {
        ReflectedBeam out;
        const auto line = [&](float length) {
            const Vec3f by_place = length * normalized(some(1));
            return ReflectedBeam::Line{by_place, -dot(by_place, some(30))};
        };
        out.distance = line(1 + 20 * share_(random_)), out.x = line(2), out.y = line(2);
        out.min_m = 1e-3f;
        out.width_m = 0.1f + 2 * share_(random_), out.height_m = 0.1f + 2 * share_(random_);
        out.margin = {0.02f * share_(random_), 0.02f * share_(random_)}, out.margin_m = {0.01f, 0.02f};
        return out;
    }
    PlaceBox box() { return {some(30), {share_(random_), share_(random_), share_(random_)}}; }
    // At its corners and inside.
    BeamPlaces places_in(const PlaceBox& box) {
        BeamPlaces out;
        for (std::size_t i = 0; i < BeamPlaces::kMax; ++i) {
            const auto along = [&](std::size_t bit) {
                return i < 8 ? (i >> bit & 1u ? 1.0f : -1.0f) : 2 * share_(random_) - 1;
            };
            out.x[i] = box.middle_m.x + along(0) * box.half_m.x;
            out.y[i] = box.middle_m.y + along(1) * box.half_m.y;
            out.z[i] = box.middle_m.z + along(2) * box.half_m.z;
        }
        return out;
    }

  private:
    std::mt19937 random_{5};
    std::uniform_real_distribution<float> share_{0, 1};

    Vec3f some(float size) {
        const auto one = [&] { return size * (2 * share_(random_) - 1); };
        return {one(), one(), one()};
    }
};

TEST(ReflectedBeams, NameEachBeamThatHoldsAPlaceOfTheBoxAndFewOthers) {
    Crowd crowd;
    constexpr std::size_t kBeams = 1000;
    std::vector<ReflectedBeam> beams;
    ReflectedBeams all;
    all.reserve(kBeams);
    for (std::size_t i = 0; i < kBeams; ++i) beams.push_back(crowd.beam()), all.add(beams.back());
    std::size_t named = 0, held = 0;
    for (int n = 0; n < 50; ++n) {
        const PlaceBox box = crowd.box();
        BeamPlaces places = crowd.places_in(box);
        std::array<std::uint8_t, ReflectedBeams::kTogether> meets;
        for (std::size_t block = 0; block < all.blocks(); ++block) {
            all.find(box, block, meets);
            for (std::size_t i = 0; i < meets.size(); ++i) {
                const std::size_t number = block * ReflectedBeams::kTogether + i;
                if (number >= kBeams) {
                    EXPECT_EQ(meets[i], 0) << "there is no beam " << number;
                    continue;
                }
                find_places_in_beam(beams[number], places);
                const bool holds =
                    std::find(places.in_beam.begin(), places.in_beam.end(), 1) != places.in_beam.end();
                EXPECT_TRUE(meets[i] || !holds) << number;
                named += meets[i], held += holds ? 1 : 0;
            }
        }
    }
    EXPECT_GT(held, 100u);
    EXPECT_LT(named, 3 * held);
}

}  // namespace
}  // namespace hilcam
