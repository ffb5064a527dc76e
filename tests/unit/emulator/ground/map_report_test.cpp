#include "emulator/ground/map_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

GlobeConfig globe_of_picture() {
    GroundMapConfig map;
    map.file = HILCAM_SOURCE_DIR "/tests/fuzz/corpus/picture/grey16.png";
    map.where = "terrain.globe.maps.0";
    map.bounds_deg = {-180, -90, 180, 90};
    GlobeConfig globe;
    globe.maps = {map};
    return globe;
}

// A picture says nothing of its latitudes, which matters on a flattened body alone.
TEST(MapReport, SaysWhatWasTaken) {
    GlobeConfig globe = globe_of_picture();
    const MappedBody mars{"mars", {3396.19e3, 3376.20e3}}, moon{"moon", {1737.4e3, 1737.4e3}};
    EXPECT_THAT(
        report_maps(globe, mars).taken,
        ElementsAre(testing::AllOf(testing::StartsWith("terrain.globe.maps.0: "), HasSubstr("grey16.png"),
                                   HasSubstr("latitudes planetographic (taken: a picture does not say)"))));
    EXPECT_THAT(report_maps(globe, moon).taken, IsEmpty());
    globe.maps[0].latitudes = MapLatitudes::kPlanetocentric;
    EXPECT_THAT(report_maps(globe, mars).taken,
                ElementsAre(HasSubstr("latitudes planetocentric (latitudes)")));
    EXPECT_THAT(report_maps(globe, mars).doubts, IsEmpty());
}

}  // namespace
}  // namespace hilcam
