// Run lengths, key points and optical flow, each against places computed by hand.

#include <gmock/gmock.h>

#include "emulator/campaign/keypoints.h"
#include "emulator/campaign/optical_flow.h"
#include "emulator/campaign/run_lengths.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Texts that COCO's own functions give for these counts.
TEST(RunLengths, TextIsCocos) {
    const std::vector<std::pair<RunLengths, std::string>> known = {
        {{0, 6, 1, 3}, "061M"}, {{0, 6, 1}, "061"},     {{0, 6, 1, 1}, "061K"},
        {{0, 6, 1, 5}, "061O"}, {{0, 6, 1, 6}, "0610"}, {{0, 1, 1, 2, 1, 3, 1, 4, 1}, "011101010"},
        {{0, 1024}, "0PP1"}};
    for (const auto& [runs, text] : known) {
        EXPECT_EQ(run_length_text(runs), text);
        EXPECT_EQ(parse_run_lengths(text), runs);
    }
}

TEST(RunLengths, GoDownTheColumnsAndComeBack) {
    IdImage ids(3, 2);
    ids.row(0)[1] = ids.row(1)[1] = ids.row(0)[2] = 5;
    const FrameRaster raster{3, 2, {}, {}};
    EXPECT_EQ(run_lengths_of(ids, raster, 5), (RunLengths{2, 3, 1}));
    EXPECT_EQ(run_lengths_of(ids, raster, 7), (RunLengths{6}));
    EXPECT_EQ(mask_of({2, 3, 1}, 3, 2), (std::vector<std::uint8_t>{0, 255, 255, 0, 255, 0}));
    EXPECT_THROW(mask_of({2, 3}, 3, 2), InputError);
    EXPECT_THROW(parse_run_lengths("0\x01"), InputError);
    EXPECT_THROW(parse_run_lengths("P"), InputError);
}

// A camera of 100 px focal length and 40 x 20 px, an object at z = 10 m turned by 90 degrees about z.
FrameTruth seen_at(Vec3d position_m, Quat attitude) {
    FrameTruth truth;
    truth.geometry.width_px = 40, truth.geometry.height_px = 20;
    truth.geometry.focal_length_px = 100;
    truth.raster = {40, 20, {}, {}};
    truth.layers.depth_m = LengthImage(40, 20);
    truth.layers.object = IdImage(40, 20);
    truth.layers.position_m = LengthImage(40, 20, 3);
    for (float& d : truth.layers.depth_m.all()) d = INFINITY;
    SeenThing thing;
    thing.id = 1;
    thing.position_camera_m = position_m;
    thing.camera_from_thing = attitude;
    truth.things.push_back(thing);
    return truth;
}

const Quat kQuarterTurn{std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

TEST(Keypoints, AreWhereTheLensShowsThemAndHiddenByWhatIsNearer) {
    FrameTruth truth = seen_at({0, 0, 10}, kQuarterTurn);
    const KeypointSet set{1, 0.01, {"a", "beside", "behind"}, {{0.5, 0, 0}, {0, -9, 0}, {0, 0, -11}}};
    std::vector<SeenKeypoint> seen = seen_keypoints(set, truth);
    // The object's x is the camera's y: 0.5 m of 10 are 5 px below the middle.
    EXPECT_NEAR(seen[0].place_px.x, 20, 1e-9);
    EXPECT_NEAR(seen[0].place_px.y, 15, 1e-9);
    EXPECT_EQ(seen[0].visibility, 2);
    EXPECT_NEAR(seen[1].place_px.x, 110, 1e-9);
    EXPECT_EQ(seen[1].visibility, 0);
    EXPECT_EQ(seen[2].visibility, 0);
    truth.layers.depth_m.row(15)[20] = 9.995f;  // within the tolerance
    EXPECT_EQ(seen_keypoints(set, truth)[0].visibility, 2);
    truth.layers.depth_m.row(15)[20] = 9.5f;
    EXPECT_EQ(seen_keypoints(set, truth)[0].visibility, 1);
}

// The part's origin is the object's while it is not turned: a point of the wing stands where the part's pose puts it.
TEST(Keypoints, OfAPartTurnWithIt) {
    FrameTruth truth = seen_at({0, 0, 10}, {});
    truth.parts.push_back({1, 4, {0, 0.1, 10}, kQuarterTurn});
    KeypointSet set{1, 0.01, {"body", "wing"}, {{0.5, 0, 0}, {0.5, 0, 0}}, {"", "wing"}, {0, 4}};
    const std::vector<SeenKeypoint> seen = seen_keypoints(set, truth);
    EXPECT_NEAR(seen[0].place_px.x, 25, 1e-9);
    EXPECT_NEAR(seen[0].place_px.y, 10, 1e-9);
    EXPECT_NEAR(seen[1].place_px.x, 20, 1e-9);
    EXPECT_NEAR(seen[1].place_px.y, 16, 1e-9);

    ScenarioConfig scenario;
    scenario.objects.resize(2);
    scenario.objects[0].joints.resize(2);
    scenario.objects[0].joints[1].node = "wing";
    scenario.objects[1].joints.resize(1);
    std::vector<KeypointSet> sets = {set};
    find_parts(scenario, sets);
    EXPECT_EQ(sets[0].parts, (std::vector<std::uint32_t>{0, 3}));
    sets[0].nodes[1] = "leg";
    try {
        find_parts(scenario, sets);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("part: found 'leg'; accepted: a node with a joint of object 1"));
    }
}

TEST(OpticalFlow, CarriesEachPixelWithItsThingAndTheSkyWithTheCamera) {
    FrameTruth from = seen_at({0, 0, 10}, {});
    FrameTruth to = seen_at({0.2, 0, 8}, kQuarterTurn);
    // The pixel right of the middle, above it, shows the object at its own z = 0: 0.05 m to the right and up.
    from.layers.object.row(9)[20] = 1;
    from.layers.position_m.row(9, 0)[20] = 0.05f;
    from.layers.position_m.row(9, 1)[20] = -0.05f;
    from.layers.position_m.row(9, 2)[20] = 10;
    // The camera turns by a hundredth about its y axis (down): the sky moves to the left.
    to.camera.world_from_body = normalized(Quat{std::cos(0.005), 0, std::sin(0.005), 0});
    const FlowImage flow = optical_flow(from, to);
    // Turned about z it is 0.05 m to the right and down of 0.2 m at 8 m: (0.25 / 8, 0.05 / 8) * 100 px from the
    // middle.
    EXPECT_NEAR(flow.row(9, 0)[20], 20 + 3.125 - 20.5, 1e-4);
    EXPECT_NEAR(flow.row(9, 1)[20], 10 + 0.625 - 9.5, 1e-4);
    // A part of the object that stays at its place and does not turn: the object's motion is not its own.
    from.layers.part = IdImage(40, 20);
    from.layers.part.row(9)[20] = 6;
    from.parts.push_back({1, 5, {0, 0, 10}, {}});
    to.parts.push_back({1, 5, {0.1, 0, 10}, {}});
    EXPECT_NEAR(optical_flow(from, to).row(9, 0)[20], 100 * 0.1 / 10, 1e-4);
    EXPECT_NEAR(optical_flow(from, to).row(9, 1)[20], 0, 1e-4);
    const double x = -19.5 / 100, turned = std::tan(std::atan(x) - 0.01);
    EXPECT_NEAR(flow.row(10, 0)[0], 20 + 100 * turned - 0.5, 1e-4);
}

}  // namespace
}  // namespace hilcam
