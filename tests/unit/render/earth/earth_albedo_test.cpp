// What ground and clouds of a map send up again to the air, against values by hand.

#include "render/earth/earth_albedo.h"

#include <gtest/gtest.h>

#include "render/earth/sea.h"

namespace hilcam {
namespace {

const SpectralGrid kFourBins({0.50, 0.57, 0.60, 0.67});

// East of Greenwich one texel, west of it another.
EarthMap two_halves(const EarthSample& west, const EarthSample& east) {
    EarthMap::Level level{256, 128, {}};
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            level.texels.push_back(EarthMap::coded(x < level.width / 2 ? west : east));
    return EarthMap(EarthMap::halves(std::move(level)));
}
EarthSample land(float reflectance, float cloud) {
    EarthSample out;
    for (const auto band :
         {EarthSample::kBlue, EarthSample::kGreen, EarthSample::kRed, EarthSample::kInfrared})
        out.value[band] = reflectance;
    out.value[EarthSample::kCloud] = cloud;
    return out;
}
EarthSample sea() {
    EarthSample out;
    out.value[EarthSample::kWater] = 1;
    return out;
}
// In the middle of the western and of the eastern half, at the equator.
float west(const AirGround& g, int bin) {
    return g.albedo[static_cast<std::size_t>(g.height / 2 * g.width + g.width / 4)][bin];
}
float east(const AirGround& g, int bin) {
    return g.albedo[static_cast<std::size_t>(g.height / 2 * g.width + 3 * g.width / 4)][bin];
}

TEST(EarthAlbedo, IsThatOfWhatLiesBelow) {
    const AirGround clear = earth_albedo({}, two_halves(sea(), land(0.3f, 0)), {}, kFourBins);
    ASSERT_EQ(clear.albedo.size(), static_cast<std::size_t>(clear.width * clear.height));
    EXPECT_NEAR(west(clear, 0), Sea(EarthConfig{}.wind_m_s, kFourBins).albedo()[0], 0.005);
    // Codes have eight bits.
    EXPECT_NEAR(east(clear, 0), 0.3, 0.005);
    EXPECT_NEAR(east(clear, 2), 0.3, 0.005);
}

// A cloud of c = 0.5 over ground of 0.3: 0.5 + 0.5^2 0.3 / (1 - 0.3 0.5); half as thick: c = 1/3.
TEST(EarthAlbedo, LightGoesUpAndDownBetweenGroundAndCloud) {
    const EarthMap map = two_halves(land(0.3f, 0), land(0.3f, 0.5f));
    EXPECT_NEAR(east(earth_albedo({}, map, {}, kFourBins), 0), 0.5882, 0.01);
    EXPECT_NEAR(west(earth_albedo({}, map, {}, kFourBins), 0), 0.3, 0.005);
    EarthConfig thin;
    thin.cloud_thickness = 0.5;
    EXPECT_NEAR(east(earth_albedo(thin, map, {}, kFourBins), 0), 0.4815, 0.01);
    // Clouds of another map take the place of these.
    EXPECT_NEAR(east(earth_albedo({}, map, two_halves(land(0, 0.9f), land(0, 0)), kFourBins), 0), 0.3, 0.005);
}

// Clouds of two instants count alike.
TEST(EarthAlbedo, MapsByTimeAreTheirMean) {
    std::vector<CloudMaps::Timed> hours;
    hours.push_back({TimeTai{0}, two_halves(land(0, 0.2f), land(0, 0))});
    hours.push_back({TimeTai{3600'000'000'000}, two_halves(land(0, 0.6f), land(0, 0))});
    const AirGround both =
        earth_albedo({}, two_halves(land(0, 0), land(0, 0)), CloudMaps(std::move(hours)), kFourBins);
    EXPECT_NEAR(west(both, 0), 0.4, 0.01);
    EXPECT_NEAR(east(both, 0), 0, 0.005);
}

}  // namespace
}  // namespace hilcam
