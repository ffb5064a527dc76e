#include "render/ground/rock_abundance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/ground/boulder_field.h"
#include "tests/support/ground_maps.h"

namespace hilcam {
namespace {

constexpr double kSeeded = 0.02;

// Figures of a whole body that are a function of the longitude and latitude [deg].
class FigureMap final : public WholeMap {
  public:
    FigureMap(int columns, double (*figure)(double longitude_deg, double latitude_deg))
        : WholeMap(columns, kMoonRadius_m), figure_(figure) {}
    double height_m(int column, int row) const override {
        return figure_((column + 0.5) * 360 / shape_.columns - 180, 90 - (row + 0.5) * 180 / shape_.rows);
    }

  private:
    double (*figure_)(double, double);
};

std::vector<GroundMap> map_of(GroundKind kind, double (*figure)(double, double)) {
    std::vector<GroundMap> maps(1);
    maps[0].kind = kind;
    maps[0].raster = std::make_unique<FigureMap>(3600, figure);
    return maps;
}

BoulderField boulders_by(double (*abundance)(double, double)) {
    BoulderSettings settings;
    settings.abundance = kSeeded, settings.smallest_m = 1;
    return BoulderField(
        kMoonRadius_m, settings,
        std::make_shared<RockAbundance>(Figure{kMoonRadius_m, kMoonRadius_m},
                                        map_of(GroundKind::kRockAbundance, abundance), kSeeded, kSeeded));
}

std::vector<Boulder> found(const BoulderField& field, Vec3d middle, double within_m) {
    std::vector<Boulder> boulders;
    field.find(middle, within_m / kMoonRadius_m, 1, boulders);
    return boulders;
}

// Counts lie within four deviations of Poisson's of the law times the map's share, fewer and more than were seeded.
TEST(RockAbundance, NumbersFollowTheMap) {
    const BoulderField field =
        boulders_by([](double longitude_deg, double) { return longitude_deg < 0 ? 0.002 : 0.3; });
    constexpr double kWithin_m = 400;
    const double area_m2 = kPi * kWithin_m * kWithin_m;
    const auto expected = [&](double share) {
        return share / kSeeded * (field.per_m2(1) - field.per_m2(10)) * area_m2;
    };
    for (const auto& [longitude_deg, share] : {std::pair{-40.0, 0.002}, {70.0, 0.3}}) {
        const Vec3d middle = place_on_sphere(longitude_deg, 20);
        EXPECT_GT(expected(share), 30);
        EXPECT_NEAR(static_cast<double>(found(field, middle, kWithin_m).size()), expected(share),
                    4 * std::sqrt(expected(share)));
        EXPECT_NEAR(field.per_m2_at(middle, 1) / field.per_m2(1), share / kSeeded, 1e-6);
    }
}

// A slope of the map is one of the numbers, from cell to cell as within them: on a ramp from 0.002 at 0 deg to 0.2 at 1 deg of
// longitude strips have what the map's mean over them says.
TEST(RockAbundance, NumbersFollowARamp) {
    const BoulderField field = boulders_by(
        [](double longitude_deg, double) { return std::fmin(0.2, std::fmax(0.002, 0.2 * longitude_deg)); });
    for (const double longitude_deg : {0.25, 0.5, 0.75}) {
        const double expected =
            0.2 * longitude_deg / kSeeded * (field.per_m2(1) - field.per_m2(10)) * kPi * 4e5 * 4;
        const auto count =
            static_cast<double>(found(field, place_on_sphere(longitude_deg, 0), std::sqrt(16e5)).size());
        EXPECT_NEAR(count, expected, 4 * std::sqrt(expected)) << longitude_deg;
    }
}

// Where the map says what was seeded, boulders are those without a map; and each is found from wherever one looks.
TEST(RockAbundance, ThePlaceAloneDecides) {
    const BoulderField even = boulders_by([](double, double) { return kSeeded; });
    BoulderSettings settings;
    settings.abundance = kSeeded, settings.smallest_m = 1;
    const BoulderField plain(kMoonRadius_m, settings);
    const Vec3d middle = place_on_sphere(12, -3);
    const auto with_map = found(even, middle, 300), without = found(plain, middle, 300);
    ASSERT_EQ(with_map.size(), without.size());
    for (std::size_t i = 0; i < without.size(); ++i) EXPECT_EQ(with_map[i].place, without[i].place);

    const BoulderField uneven = boulders_by([](double longitude_deg, double latitude_deg) {
        return 0.1 + 0.09 * std::sin(7 * longitude_deg) * std::cos(5 * latitude_deg);
    });
    std::set<std::pair<double, double>> known;
    for (const Boulder& b : found(uneven, middle, 900)) known.insert({b.place.x, b.diameter_m});
    const auto near = found(uneven, middle, 200);
    EXPECT_GT(near.size(), 50u);
    for (const Boulder& b : near) EXPECT_TRUE(known.contains({b.place.x, b.diameter_m}));
}

// Parameters of Hapke's law are the map's; elsewhere, and without a map, the material's.
TEST(GroundSurface, HapkeParametersAreTheMaps) {
    GroundSurface surface(
        {kMoonRadius_m, kMoonRadius_m},
        map_of(GroundKind::kLobeBackward, [](double longitude_deg, double) { return longitude_deg / 90; }),
        1 << 20);
    GroundSurface slopes({kMoonRadius_m, kMoonRadius_m},
                         map_of(GroundKind::kSlope, [](double, double) { return 30.0; }), 1 << 20);
    EXPECT_TRUE(surface.has_hapke());
    EXPECT_FALSE(surface.has(GroundKind::kSlope));
    for (const double longitude_deg : {-70.3, -20.0, 0.0, 45.71, 170.0}) {
        const Vec3d place = place_on_sphere(longitude_deg, 33);
        HapkeParameters p{.b = 0.2f, .c = 0.9f, .surge_amplitude = 1.5f};
        surface.find_hapke({&place, 1}, 0, {&p, 1});
        // The law takes -1 to 1.
        EXPECT_NEAR(p.c, std::fmin(1, longitude_deg / 90), 1e-5) << longitude_deg;
        EXPECT_EQ(p.b, 0.2f);
        EXPECT_EQ(p.surge_amplitude, 1.5f);
        slopes.find_hapke({&place, 1}, 0, {&p, 1});
        EXPECT_NEAR(p.roughness_tangent, std::tan(30 * kDegree_rad), 1e-6);
    }
}

}  // namespace
}  // namespace hilcam
