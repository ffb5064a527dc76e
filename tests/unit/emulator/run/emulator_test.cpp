#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emulator/loop/frame_schedule.h"
#include "emulator/loop/latency.h"
#include "emulator/motion/flight.h"
#include "emulator/run/command_dispatch.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/world/clock.h"
#include "io/config/config_yaml.h"
#include "io/pictures/image_file.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

Motion at(std::int64_t ns, double x, double velocity = 0) {
    Motion m;
    m.time = {ns};
    m.pose.position_world_m = {x, 0, 0};
    m.velocity_world_m_s = {velocity, 0, 0};
    return m;
}
double x_of(WorldState& world, std::int64_t ns) {
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample({ns}, snapshot, shown);
    return snapshot.camera.position_world_m.x;
}

TEST(WorldState, PropagatesInterpolatesAndTakesAnyOrder) {
    const Motion initial = at(0, 5, 1);
    WorldState world(std::span(&initial, 1), {});
    EXPECT_NEAR(x_of(world, 2'000'000'000), 7, 1e-12);  // the scenario's own motion
    world.set(0, at(1'000'000'000, 10, 10), {1, 100});
    EXPECT_NEAR(x_of(world, 1'500'000'000), 15, 1e-12);  // propagated
    world.set(0, at(3'000'000'000, 30, 10), {2, 200});
    world.set(0, at(2'000'000'000, 20, 10), {3, 300});  // late, but between
    EXPECT_NEAR(x_of(world, 2'500'000'000), 25, 1e-9);
    EXPECT_NEAR(x_of(world, 500'000'000), 5, 1e-9);  // backwards from the first command
}

TEST(WorldState, TellsTheNewestCommandItShows) {
    const Motion initial[2] = {at(0, 0), at(0, 0)};
    WorldState world(initial, {});
    world.set(1, at(5, 1), {7, 900});
    world.set(0, at(5, 1), {6, 800});
    WorldSnapshot snapshot;
    snapshot.objects.resize(1);
    ShownCommand shown;
    world.sample({5}, snapshot, shown);
    EXPECT_EQ(shown.sequence, 7u);
    EXPECT_FALSE(world.set(2, at(0, 0), {}));
}

// A wing that turns about +y through (0, 2, 1) of a body that itself stands turned and moved.
TEST(WorldState, AJointTurnsItsPartAboutItsAxis) {
    const Motion initial[2] = {at(0, 0), {{0}, {{5, 0, 0}, from_rotation_vector({0, 0, kPi / 2})}, {}, {}}};
    const Joint joint{0, {0, 2, 1}, {0, 1, 0}, 0.3, 0.1};
    WorldState world(initial, {}, std::span(&joint, 1));
    EXPECT_EQ(world.placed_objects(), 2u);
    WorldSnapshot snapshot;
    snapshot.objects.resize(2);
    ShownCommand shown;
    const auto place_of = [&](std::int64_t ns, Vec3d p) {
        world.sample({ns}, snapshot, shown);
        const Pose& part = snapshot.objects[1];
        return part.position_world_m + to_matrix(part.world_from_body) * p;
    };
    // The pivot stays; a point 1 m over it goes 1 m sideways when turned by a right angle.
    const Vec3d pivot = place_of(0, {0, 2, 1});
    EXPECT_NEAR(length(pivot - Vec3d{5 - 2, 0, 1}), 0, 1e-12);
    EXPECT_NEAR(length(place_of(9'000'000'000, {0, 2, 1}) - pivot), 0, 1e-9);
    // 0.3 + 0.1 t: after 2 s the point is turned by 0.5 about the body's y, the world's -x.
    const Vec3d over = place_of(2'000'000'000, {0, 2, 2});
    EXPECT_NEAR(length(over - (pivot + Vec3d{0, std::sin(0.5), std::cos(0.5)})), 0, 1e-9);
    EXPECT_TRUE(world.set_joint(1, 1, {{3'000'000'000}, kPi / 2, 0}, {8, 1}));
    EXPECT_NEAR(length(place_of(4'000'000'000, {0, 2, 2}) - (pivot + Vec3d{0, 1, 0})), 0, 1e-9);
    EXPECT_EQ(shown.sequence, 8u);
    EXPECT_FALSE(world.set_joint(1, 2, {}, {}));
    EXPECT_FALSE(world.set_joint(2, 1, {}, {}));
    EXPECT_FALSE(world.set(2, at(0, 0), {}));  // a part is no object
}

TEST(WorldState, KeepsTheNewestEightMotions) {
    const Motion initial = at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    for (int i = 1; i <= 20; ++i) world.set(0, at(i * 1'000'000'000LL, i, 1), {1, 1});
    world.set(0, at(1'000'000'000, -100, 1), {2, 2});  // older than all that are kept: ignored
    EXPECT_NEAR(x_of(world, 13'500'000'000), 13.5, 1e-9);
    EXPECT_NEAR(x_of(world, 25'000'000'000), 25, 1e-9);
}

TEST(FrameSchedule, SkipsWholePeriodsAndNeverCatchesUp) {
    FrameSchedule schedule(1000);
    EXPECT_EQ(schedule.take(0, 100).start_ns, 1000);
    EXPECT_EQ(schedule.take(1150, 100).start_ns, 1100);  // late by less than a period: still made
    const FrameSchedule::Slot slot = schedule.take(1555, 100);
    EXPECT_EQ(slot.start_ns, 1500);
    EXPECT_EQ(slot.skipped, 3u);
    EXPECT_EQ(schedule.take(1555, 100).start_ns, 1600);
    EXPECT_EQ(schedule.take(1555, 300).start_ns, 1900);  // a new period counts from the last frame on
}

TEST(LiveSettings, RefusesWhatIsOutsideAndTheLoopSeesTheRest) {
    CameraModel camera;
    LiveSettings settings(camera);
    EXPECT_FALSE(settings.change({.exposure_s = 1e9}));
    EXPECT_FALSE(settings.change({.gain_db = std::nan("")}));
    EXPECT_TRUE(settings.change({.gain_db = 6}));
    EXPECT_EQ(settings.read_in_loop().gain_db, 6);
}

// An order that comes just when the loop has looked for the last time, as at the end of --frames.
TEST(LiveSettings, NobodyWaitsForALoopThatHasEnded) {
    LiveSettings settings(CameraModel{}, {.lockstep = true});
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    ASSERT_EQ(settings.order_in_lockstep(order), TriggerResult::kTaken);
    settings.close();
    EXPECT_TRUE(settings.wait_for_order(5)) << "the whole patience";
}

TEST(CommandDispatch, SettingsAreAllOrNothingAndTimeTagsAreBounded) {
    CameraModel camera;
    LiveSettings settings(camera);
    const Motion initial = at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    FaultBoard faults;
    CommandDispatch dispatch({{&world, &settings, &faults}}, clock);
    SettingsCommand command;
    command.gain_db = 3;
    command.exposure_s = 1e9;
    EXPECT_EQ(dispatch.handle(command, {1, 0}), CommandStatus::kBadArgument);
    EXPECT_EQ(settings.settings().gain_db, camera.gain_db);
    PoseCommand pose;
    pose.motion.time.ns = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kTimeOutOfRange);
    pose.motion.time.ns = 0;
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kAccepted);
    pose.object = 9;
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kUnknownObject);
    dispatch.handle(StopCommand{}, {1, 0});
    EXPECT_FALSE(settings.settings().running);
}

TEST(DurationHistogram, QuantilesAreRightWithinItsBuckets) {
    std::mt19937 engine(5);
    std::lognormal_distribution<double> distribution(1, 1);
    DurationHistogram histogram;
    std::vector<double> all;
    for (int i = 0; i < 20000; ++i) {
        all.push_back(distribution(engine));
        histogram.record(static_cast<std::int64_t>(all.back() * 1e6));
    }
    std::sort(all.begin(), all.end());
    EXPECT_NEAR(histogram.quantile_ms(0.5) / all[10000], 1, 0.025);
    EXPECT_NEAR(histogram.quantile_ms(0.99) / all[19800], 1, 0.025);
    EXPECT_EQ(DurationHistogram().quantile_ms(0.5), 0);
}

TEST(CircleFlight, RatesAreTheDerivativesOfThePose) {
    CircleFlight flight;
    flight.center_m = {1, 2, 3};
    flight.start_m = {1, -30, 10};
    flight.up = {0, 0, 1};
    const Motion m = flight.at(7, {});
    constexpr double h = 1e-4;
    const Motion later = flight.at(7 + h, {});
    const Pose predicted =
        propagate({{0}, m.pose, m.velocity_world_m_s, m.rate_body_rad_s}, TimeTai{100'000});
    EXPECT_LT(length(predicted.position_world_m - later.pose.position_world_m), 1e-8);
    const Quat a = predicted.world_from_body, b = later.pose.world_from_body;
    EXPECT_NEAR(std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z), 1, 1e-12);
    // It looks at the centre all the way.
    const Vec3d boresight = to_matrix(m.pose.world_from_body) * Vec3d{0, 0, 1};
    EXPECT_NEAR(dot(boresight, normalized(flight.center_m - m.pose.position_world_m)), 1, 1e-12);
}

TEST(Configs, EveryShippedScenarioLoads) {
    int found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/scenarios")) {
        EXPECT_NO_THROW(load_scenario(entry.path(), {})) << entry.path();
        ++found;
    }
    EXPECT_GE(found, 3);
}

TEST(Configs, EveryShippedPartLoads) {
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/cameras")) {
        CameraModel camera;
        EXPECT_NO_THROW(read_config(entry.path(), section_of(camera))) << entry.path();
        EXPECT_FALSE(camera.source.empty()) << entry.path();
    }
    for (const auto& entry : std::filesystem::directory_iterator(HILCAM_SOURCE_DIR "/configs/quality")) {
        QualityConfig quality;
        EXPECT_NO_THROW(read_config(entry.path(), section_of(quality))) << entry.path();
    }
}

// What a camera's file gets wrong is named with its place.
TEST(Configs, AnImpossibleCameraIsRefusedByName) {
    const std::string good =
        "width_px: 64\nheight_px: 64\npitch_um: 5\nfocal_length_mm: 10\nf_number: 4\nquantum_efficiency: "
        "0.5\n"
        "full_well_e: 10000\nbits: 12\n";
    const auto error_of = [&](const std::string& more) -> std::string {
        CameraModel camera;
        try {
            read_config_text(good + more, "camera.yaml", ".", section_of(camera));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(error_of("gain_dn_e: 0.3\n"), "no error");
    for (const auto& [more, message] : std::vector<std::pair<std::string, std::string>>{
             {"gain_dn_e: 0\n", "camera.yaml:9:12: gain_dn_e: found '0'"},
             {"", "either gain_dn_e or gain_e_dn; found neither"},
             {"gain_dn_e: 0.3\nread_noise_e: -1\n", "read_noise_e: found '-1'"},
             {"gain_dn_e: 0.3\nquantum_efficency: 0.5\n", "nearest known key: quantum_efficiency"},
             {"gain_dn_e: 0.3\nmeasured_mtf: {mtf: [[0, 1], [50, 1.2]]}\n", "measured_mtf.mtf: found '1.2'"},
             {"gain_dn_e: 0.3\ncontainer_bits: 8\n", "bits 12 do not fit into container_bits 8"},
             {"gain_dn_e: 0.3\ntransmission: [[0.5, 1.5]]\n", "transmission: found '1.5'"},
             {"gain_dn_e: 0.3\nvignetting: [[0.5, 1], [0.5, 0.9]]\n",
              "field_fraction that rises from pair to pair"},
         })
        EXPECT_THAT(error_of(more), HasSubstr(message)) << more;
}

class CameraMaps : public FilesTest {};

TEST_F(CameraMaps, AreReadFromTheirFiles) {
    DnImage gain(64, 64);
    for (std::uint16_t& v : gain.all()) v = 1;
    write_numbers(folder_ / "gain.tiff", gain);
    CameraModel c;
    c.fixed_pattern.prnu_map = folder_ / "gain.tiff";
    const DetectorPictures pictures = load_detector_pictures(c);
    EXPECT_EQ(pictures.prnu.width(), 64);
    EXPECT_EQ(pictures.prnu.row(10)[10], 1.0f);
    EXPECT_EQ(pictures.offset_e.width(), 0);
}

TEST(Configs, AnObjectHasAMeshOrAGenerator) {
    ObjectConfig object;
    EXPECT_THROW(validate(object), InputError);
}

// What rides on a turning body: by hand, for a body that turns at w about z through the origin.
TEST(WorldState, AMountedCameraRidesOnItsBody) {
    const double w = 0.5;
    Motion body = at(0, 0);
    body.velocity_world_m_s = {3, 0, 0};
    body.rate_body_rad_s = {0, 0, w};
    const Quat quarter{std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // about x: camera z is the body's -y
    WorldState world(std::span(&body, 1), {}, {}, {0, {2, 0, 0}, quarter});
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample({body.time.ns + 1'000'000'000}, snapshot, shown);
    EXPECT_NEAR(snapshot.camera.position_world_m.x, 3 + 2 * std::cos(w), 1e-9);
    EXPECT_NEAR(snapshot.camera.position_world_m.y, 2 * std::sin(w), 1e-9);
    EXPECT_NEAR(snapshot.camera_velocity_m_s.x, 3 - 2 * w * std::sin(w), 1e-5);
    EXPECT_NEAR(snapshot.camera_velocity_m_s.y, 2 * w * std::cos(w), 1e-5);
    const Vec3d boresight = to_matrix(snapshot.camera.world_from_body) * Vec3d{0, 0, 1};
    EXPECT_NEAR(boresight.x, std::sin(w), 1e-9);
    EXPECT_NEAR(boresight.y, -std::cos(w), 1e-9);
    // w about the body's z is about the camera's y.
    EXPECT_NEAR(snapshot.camera_rate_rad_s.y, w, 1e-5);
    EXPECT_NEAR(snapshot.camera_rate_rad_s.z, 0, 1e-5);
}

TEST(CommandDispatch, ACommandIsForTheCameraItNamesAndAPoseForAll) {
    CameraModel camera;
    LiveSettings left(camera), right(camera);
    const Motion initial = at(0, 0);
    WorldState left_world(std::span(&initial, 1), {}), right_world(std::span(&initial, 1), {});
    FaultBoard left_faults, right_faults;
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    CommandDispatch dispatch({{&left_world, &left, &left_faults}, {&right_world, &right, &right_faults}},
                             clock);
    SettingsCommand settings;
    settings.gain_db = 3;
    EXPECT_EQ(dispatch.handle(settings, {1, 0, 2}), CommandStatus::kAccepted);
    EXPECT_EQ(left.settings().gain_db, 0);
    EXPECT_EQ(right.settings().gain_db, 3);
    settings.gain_db = 6;
    EXPECT_EQ(dispatch.handle(settings, {2, 0, 0}), CommandStatus::kAccepted);
    EXPECT_EQ(left.settings().gain_db, 6);
    EXPECT_EQ(right.settings().gain_db, 6);
    EXPECT_EQ(dispatch.handle(settings, {3, 0, 3}), CommandStatus::kUnknownObject);
    EXPECT_EQ(dispatch.handle(FaultCommand{{FaultKind::kFrameDrop, 1, 0, 0, 0, 0}, false}, {4, 0, 1}),
              CommandStatus::kAccepted);
    EXPECT_TRUE(left_faults.order_of(FaultKind::kFrameDrop));
    EXPECT_FALSE(right_faults.order_of(FaultKind::kFrameDrop));
    PoseCommand pose;
    pose.motion = at(1'000'000'000'000'000, 7);
    EXPECT_EQ(dispatch.handle(pose, {5, 1, 1}), CommandStatus::kAccepted);
    EXPECT_EQ(x_of(left_world, 1'000'000'000'000'000), 7);
    EXPECT_EQ(x_of(right_world, 1'000'000'000'000'000), 7);
}

}  // namespace
}  // namespace hilcam
