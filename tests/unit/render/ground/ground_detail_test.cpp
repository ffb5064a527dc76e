#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render/ground/boulder_field.h"
#include "render/ground/crater_field.h"
#include "render/ground/ground_relief.h"
#include "tests/support/ground_maps.h"

namespace hilcam {
namespace {

double cap_m2(double reach_rad) {
    return 2 * kPi * kMoonRadius_m * kMoonRadius_m * (1 - std::cos(reach_rad));
}

// The heights that a detail adds at places of its own, one by one.
double added_m(const GroundDetail& detail, Vec3d place, double spacing_m) {
    double height_m = 0;
    const GroundPatch patch{1, {&place, 1}, {&height_m, 1}, {}, place, 0, spacing_m};
    detail.add_wide(patch);
    detail.add(patch);
    return height_m;
}

CraterField craters_between(double smallest_m, double largest_m) {
    CraterSettings settings;
    settings.smallest_m = smallest_m, settings.largest_m = largest_m;
    return CraterField(kMoonRadius_m, settings);
}

// The things of a field above a diameter within a distance of a place.
template <class Thing>
std::vector<Thing> found_of(const auto& field, Vec3d middle, double within_m, double smallest_m) {
    std::vector<Thing> things;
    field.find(middle, within_m / kMoonRadius_m, smallest_m, things);
    return things;
}

// Neukum, Ivanov & Hartmann 2001, table 1 and eq. 5: 8.38e-4 craters above 1 km on a square kilometre of 1 Ga; Trask's 10^-1.1 of
// one metre on a square metre.
TEST(CraterLaw, HasThePublishedNumbers) {
    EXPECT_NEAR(neukum_per_m2(1000) * 1e6, std::pow(10, -3.0876), 1e-9);
    EXPECT_NEAR(neukum_age_factor(1), 1, 1e-12);
    EXPECT_NEAR(neukum_age_factor(3.5), (5.44e-14 * (std::exp(6.93 * 3.5) - 1) + 8.38e-4 * 3.5) / 8.38e-4,
                0.001);
    EXPECT_NEAR(equilibrium_per_m2(1), 0.0794, 1e-4);
    const CraterLaw law(3.5, 0.5, 5000);
    // On a mare craters below some 200 m are in equilibrium (Xiao & Werner, J. Geophys. Res. Planets 120, 2277, 2015).
    EXPECT_NEAR(law.per_m2(10), equilibrium_per_m2(10), 0.01 * equilibrium_per_m2(10));
    EXPECT_NEAR(law.per_m2(2000), neukum_age_factor(3.5) * neukum_per_m2(2000), 0.01 * law.per_m2(2000));
    for (const double d : {0.7, 9.0, 130.0, 3000.0}) EXPECT_NEAR(law.diameter_m(law.per_m2(d)), d, 1e-6 * d);
}

// Counts of what was seeded lie within four deviations of Poisson's of the law's, from 1 m to 1 km, at different places.
TEST(CraterField, NumbersFollowTheLaw) {
    const CraterField field = craters_between(1, 2000);
    for (const auto& [smallest_m, reach_m] :
         {std::pair{1.0, 150.0}, {8.0, 1500.0}, {60.0, 12e3}, {500.0, 100e3}})
        for (const Vec3d& middle : {place_on_sphere(10, 5), place_on_sphere(45, 35.26),
                                    place_on_sphere(0, 90), place_on_sphere(180, -44)}) {
            const auto craters = found_of<Crater>(field, middle, reach_m, smallest_m);
            const double expected =
                (field.per_m2(smallest_m) - field.per_m2(2000)) * cap_m2(reach_m / kMoonRadius_m);
            EXPECT_GT(expected, 300);
            EXPECT_NEAR(static_cast<double>(craters.size()), expected, 4 * std::sqrt(expected)) << smallest_m;
            for (const Crater& c : craters) EXPECT_TRUE(c.diameter_m >= smallest_m && c.diameter_m <= 2000);
        }
}

// Kolmogorov's distance of numbers from the share of them that a law has below each.
template <class Share>
double distance_from(std::vector<double> numbers, const Share& share_below) {
    std::sort(numbers.begin(), numbers.end());
    double most = 0;
    const auto n = static_cast<double>(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        most = std::max(most, std::abs((static_cast<double>(i) + 0.5) / n - share_below(numbers[i])));
    return most;
}
// The distance that one of a hundred samples of the law exceeds.
double max_distance(std::size_t count) { return 1.63 / std::sqrt(static_cast<double>(count)); }

// The slope of the distribution is the law's as well, which a wrong law fails.
TEST(CraterField, DiametersAreDrawnFromTheLaw) {
    std::vector<double> diameters_m;
    for (const Crater& c : found_of<Crater>(craters_between(1, 500), place_on_sphere(23, 1), 200, 1))
        diameters_m.push_back(c.diameter_m);
    const auto distance = [&](double power) {
        return distance_from(diameters_m, [power](double d) { return 1 - std::pow(d, -power); });
    };
    EXPECT_LT(distance(2), max_distance(diameters_m.size()));
    EXPECT_GT(distance(2.3), max_distance(diameters_m.size()));
}

// Wear is spread evenly up to the greatest that craters of a size can have: where they are in equilibrium all, where the
// ground's age has not worn them so far, less.
TEST(CraterField, WearIsEven) {
    CraterSettings settings;
    settings.smallest_m = 300, settings.largest_m = 1000;
    const CraterField large(kMoonRadius_m, settings);
    std::vector<double> of_small, of_large;
    for (const Crater& c : found_of<Crater>(craters_between(1, 500), place_on_sphere(23, 1), 100, 1))
        of_small.push_back(c.worn / CraterProfile::kMaxWorn);
    for (const Crater& c : found_of<Crater>(large, place_on_sphere(-60, 33), 60e3, 300)) {
        const double oldest =
            settings.diffusivity_m2_ga * settings.age_ga / (0.25 * c.diameter_m * c.diameter_m);
        ASSERT_LT(oldest, CraterProfile::kMaxWorn * 2);
        of_large.push_back(c.worn / std::min(CraterProfile::kMaxWorn, oldest));
    }
    for (const std::vector<double>& worn : {of_small, of_large}) {
        ASSERT_GT(worn.size(), 200u);
        EXPECT_LT(distance_from(worn, [](double w) { return w; }), max_distance(worn.size()));
        EXPECT_GT(distance_from(worn, [](double w) { return w * w; }), max_distance(worn.size()));
    }
}

// The same craters are found from wherever one looks.
TEST(CraterField, TheSameSeedGivesTheSameCratersFromAnywhere) {
    const CraterField field(kMoonRadius_m, CraterSettings{});
    CraterSettings other_seed;
    other_seed.seed = 2;
    const CraterField other(kMoonRadius_m, other_seed);
    const Vec3d middle = place_on_sphere(45, 1);
    const auto wide = found_of<Crater>(field, middle, 3000, 20),
               narrow = found_of<Crater>(field, middle, 500, 20),
               others = found_of<Crater>(other, middle, 500, 20);
    ASSERT_GT(narrow.size(), 50u);
    std::set<std::pair<double, double>> known, unknown;
    for (const Crater& c : wide) known.insert({c.place.x, c.diameter_m});
    for (const Crater& c : narrow) EXPECT_TRUE(known.contains({c.place.x, c.diameter_m}));
    for (const Crater& c : others) EXPECT_FALSE(known.contains({c.place.x, c.diameter_m}));
}

// Pike 1977: 1 km craters are 196 m deep under a rim of 36 m; diffusion wears depth and rim away and leaves no step at the edge.
TEST(CraterProfile, FreshAndWornShapes) {
    const CraterProfile profile;
    const double depth = CraterProfile::fresh_depth(1000);
    EXPECT_NEAR(depth, 0.196, 1e-12);
    EXPECT_NEAR((profile.height(1, 0) - profile.height(0, 0)) * depth, 0.196, 0.002);
    EXPECT_NEAR(profile.height(1, 0) * depth, 0.036, 0.002);
    double before = 1;
    for (const double worn : {0.01, 0.05, 0.2, 0.5}) {
        const double left = profile.height(1, worn) - profile.height(0, worn);
        EXPECT_LT(left, before);
        before = left;
        EXPECT_NEAR(profile.height(2.999, worn), 0, 0.002);
    }
    EXPECT_LT(before, 0.2);
    // Early on the middle rises as the fresh parabola's curvature says: dh/dt = 4 at the middle, in units of its depth.
    EXPECT_NEAR(profile.height(0, 0.02) - profile.height(0, 0), 0.08, 0.008);
}

// A crater's bottom lies as deep as its shape says.
TEST(CraterField, TheGroundHasTheCraters) {
    const CraterField field = craters_between(400, 401);
    const auto craters = found_of<Crater>(field, place_on_sphere(10, 5), 100e3, 1);
    ASSERT_GT(craters.size(), 3u);
    const CraterProfile profile;
    int alone = 0;
    for (const Crater& c : craters) {
        if (std::any_of(craters.begin(), craters.end(), [&](const Crater& o) {
                return length(o.place - c.place) > 0 && length(o.place - c.place) * kMoonRadius_m < 1300;
            }))
            continue;
        ++alone;
        EXPECT_NEAR(added_m(field, c.place, 10),
                    0.196 * c.diameter_m * std::pow(0.4, 0.01) * profile.height(0, c.worn), 0.5);
        EXPECT_EQ(added_m(field, c.place, 1000), 0);  // not to be seen from afar
    }
    EXPECT_GT(alone, 0);
}

TEST(BoulderField, NumbersFollowThePowerLawAndCoverWhatIsAsked) {
    BoulderSettings settings;
    settings.abundance = 0.03, settings.exponent = 2.4;
    const BoulderField field(kMoonRadius_m, settings);
    constexpr double kWithin_m = 100, reach_rad = kWithin_m / kMoonRadius_m;
    const auto boulders = found_of<Boulder>(field, place_on_sphere(-33, 61), kWithin_m, 0.1);
    for (const double d : {0.1, 0.3, 1.0}) {
        const double expected = (field.per_m2(d) - field.per_m2(10)) * cap_m2(reach_rad);
        const auto found = std::count_if(boulders.begin(), boulders.end(),
                                         [&](const Boulder& b) { return b.diameter_m >= d; });
        EXPECT_NEAR(static_cast<double>(found), expected, 4 * std::sqrt(expected)) << d;
    }
    EXPECT_NEAR(field.per_m2(0.5) / field.per_m2(1), std::pow(2, 2.4), 1e-9);
    double area_m2 = 0;
    for (const Boulder& b : boulders) area_m2 += 0.25 * kPi * 0.8 * b.diameter_m * b.diameter_m;
    EXPECT_NEAR(area_m2 / cap_m2(reach_rad), 0.03, 0.006);
    // Stones stand on the ground; from afar they are left out.
    const auto largest =
        std::max_element(boulders.begin(), boulders.end(),
                         [](const Boulder& a, const Boulder& b) { return a.diameter_m < b.diameter_m; });
    EXPECT_GT(added_m(field, largest->place, 0.02), 0.5 * largest->height_m);
    EXPECT_EQ(added_m(field, largest->place, 10), 0);
}

// Boulders' diameters are the power law's between the smallest and the largest, which another power fails.
TEST(BoulderField, DiametersAreDrawnFromTheLaw) {
    BoulderSettings settings;
    settings.exponent = 2.5, settings.smallest_m = 0.2, settings.largest_m = 5;
    std::vector<double> diameters_m;
    for (const Boulder& b :
         found_of<Boulder>(BoulderField(kMoonRadius_m, settings), place_on_sphere(100, -20), 150, 0.2))
        diameters_m.push_back(b.diameter_m);
    const auto distance = [&](double power) {
        return distance_from(diameters_m, [power](double d) {
            return (1 - std::pow(d / 0.2, -power)) / (1 - std::pow(5 / 0.2, -power));
        });
    };
    ASSERT_GT(diameters_m.size(), 3000u);
    EXPECT_LT(distance(2.5), max_distance(diameters_m.size()));
    EXPECT_GT(distance(2.3), max_distance(diameters_m.size()));
}

// The differences of the relief grow as asked for, over distances that its longest wave has little to do with.
TEST(GroundRelief, DifferencesFollowThePower) {
    ReliefSettings settings;
    settings.longest_m = 2000, settings.deviation_m = 3, settings.at_m = 100, settings.hurst = 0.8;
    const GroundRelief relief(kMoonRadius_m, settings);
    for (const double lag_m : {0.5, 2.0, 10.0, 50.0}) {
        double sum = 0;
        constexpr int kPlaces = 3000;
        for (int i = 0; i < kPlaces; ++i) {
            const Vec3d a = place_on_sphere(0.0137 * i, 20 + 0.0053 * i);
            const Vec3d b = normalized(a + lag_m / kMoonRadius_m * normalized(cross(Vec3d{0, 0, 1}, a)));
            const double d = added_m(relief, b, 0.1) - added_m(relief, a, 0.1);
            sum += d * d;
        }
        const double expected_m = 3 * std::pow(lag_m / 100, 0.8);
        EXPECT_NEAR(std::sqrt(sum / kPlaces), expected_m, 0.15 * expected_m) << lag_m;
    }
}

// What is measured on a map is its own spectrum: of a relief laid out as a map, its exponent.
TEST(GroundRelief, TheMapsOwnSpectrumIsMeasured) {
    ReliefSettings settings;
    settings.longest_m = 2000e3, settings.deviation_m = 300, settings.at_m = 10e3, settings.hurst = 0.75;
    const GroundRelief relief(kMoonRadius_m, settings);
    std::vector<GroundMap> maps(1);
    maps[0].raster = std::make_unique<DetailMap>(1440, relief, kMoonRadius_m);
    GroundSurface surface({kMoonRadius_m, kMoonRadius_m}, std::move(maps), std::size_t{64} << 20);
    const double spacing_m = 2 * kPi * kMoonRadius_m / 1440;
    const std::optional<ReliefSettings> found = measured_relief(surface, spacing_m);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->hurst, 0.75, 0.12);
    EXPECT_NEAR(found->deviation_m, 300 * std::pow(found->at_m / 10e3, 0.75), 0.2 * 300);
    GroundSurface flat({kMoonRadius_m, kMoonRadius_m}, {}, 1 << 20);
    EXPECT_FALSE(measured_relief(flat, spacing_m));
}

}  // namespace
}  // namespace hilcam
