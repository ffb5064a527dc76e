// After its first frames the loop allocates nothing (allocation_guard.h).

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/spice_sky.h"
#include "emulator/motion/trajectories.h"
#include "emulator/run/emulator.h"
#include "tests/realtime/allocation_guard.h"
#include "tests/realtime/frame_readers.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

class Allocation : public testing::Test {
  protected:
    static void SetUpTestSuite() { prepare_allocation_guard(); }
    void TearDown() override { counted_allocations(); }
};

TEST_F(Allocation, TheGuardSeesOne) {
    arm_allocation_guard();
    auto* volatile number = new int(1);
    EXPECT_EQ(counted_allocations().own, 1);
    delete number;
}

enum class Loop {
    kUnpaced,    // as fast as it goes, without outputs
    kTold,       // the same, with the outputs that the scenario has
    kPaced,      // at the camera's rate, as the governor needs it
    kStreaming,  // the same, with a GigE Vision camera whose frames an application takes
    kLookedAt,   // with a preview whose pictures and their truth somebody looks at
};
struct Seen {
    int allocations = 0;           // of the program's own
    int terrain_allocations = 0;   // of the thread that makes the ground's meshes
    std::uint64_t bytes_read = 0;  // by the process, out of files
    std::uint32_t level_changes = 0;
};
// Bytes that the process has read so far (proc(5), /proc/pid/io).
std::uint64_t bytes_read() {
    std::string name;
    std::uint64_t bytes = 0;
    std::ifstream("/proc/self/io") >> name >> bytes;  // "rchar:", the first line
    return bytes;
}
// A camera that does not fly by itself is commanded to a place beside the satellite.
Seen run(const std::vector<std::string>& overrides, Loop loop, const std::filesystem::path& record = {},
         const char* scenario_file = "tests/protocol/minimal_scenario.yaml") {
    const bool streaming = loop == Loop::kStreaming, looked_at = loop == Loop::kLookedAt;
    const ScenarioConfig scenario =
        load_scenario(std::string(HILCAM_SOURCE_DIR) + "/" + scenario_file, overrides);
    RunLimits limits;
    limits.frames = streaming ? 300 : looked_at ? 150 : 80;
    limits.paced = loop != Loop::kUnpaced && loop != Loop::kTold;
    limits.outputs = streaming || looked_at || loop == Loop::kTold;
    limits.record = record;
    Emulator emulator(scenario, limits);
    std::thread runner([&] { emulator.run([] {}); });
    const auto frames = [&] { return emulator.loop().counters().frames.load(); };
    const auto wait_for = [&](std::uint64_t count) {
        while (frames() < count && !emulator.loop().finished()) std::this_thread::yield();
    };
    wait_for(20);
    std::optional<StreamReader> reader;
    int packets = 0;
    if (streaming) {
        reader.emplace();
        for (int i = 0; i < 5000 && packets == 0; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            packets += reader->drain();
        }
        EXPECT_GT(packets, 0);
        packets = 0;
    }
    std::optional<PreviewReader> viewer;
    if (looked_at) {
        viewer.emplace();
        while (viewer->with_truth() < 2 && !emulator.loop().finished()) std::this_thread::yield();
        EXPECT_GE(viewer->with_truth(), 2);
    }
    const int seen = viewer ? viewer->with_truth() : 0;
    const std::uint64_t until = streaming || looked_at ? frames() + 50 : 70;
    const std::uint32_t changes = emulator.loop().counters().level_changes.load();
    const std::uint64_t read = bytes_read();
    arm_allocation_guard();
    Motion motion;
    motion.pose.position_world_m = {22, 15, 7};
    for (std::uint32_t i = 0; frames() < until && !emulator.loop().finished(); ++i) {
        motion.time = emulator.clock().now();
        motion.rate_body_rad_s = scenario.camera_pose.rate_body_rad_s;
        if (!scenario.camera_motion) emulator.world().set(0, motion, {i, monotonic_ns()});
        if (reader) packets += reader->drain();
        std::this_thread::yield();
    }
    const Allocations counted = counted_allocations();
    const std::uint64_t read_meanwhile = bytes_read() - read;
    const std::uint64_t measured = frames();
    if (viewer) {
        EXPECT_GT(viewer->with_truth(), seen);
    }
    viewer.reset();
    const std::uint32_t changed = emulator.loop().counters().level_changes.load() - changes;
    runner.join();
    EXPECT_GE(measured, until);
    // A leader, a trailer and one packet at the least, of each frame that the machine had time to send.
    EXPECT_GE(packets, streaming ? 10 * 3 : 0);
    return {counted.own, counted.terrain, read_meanwhile, changed};
}

int allocations(const std::vector<std::string>& overrides, Loop loop = Loop::kUnpaced) {
    return run(overrides, loop).allocations;
}

TEST_F(Allocation, TheLoopAllocatesNothing) { EXPECT_EQ(allocations({}), 0); }

TEST_F(Allocation, NorWithStarsAutomaticExposureJitterAndExactMotion) {
    EXPECT_EQ(allocations(
                  {"quality.motion=exact", "quality.motion_error_px=4", "camera_pose.rate_deg_s=[0, 100, 0]",
                   "camera.exposure_ms=10", "camera.exposure_range_ms=[0.01, 20]",
                   "camera.auto_exposure.on=true", "camera.jitter.psd=[[1, 100], [50, 1]]",
                   std::string("stars.catalogue=") + HILCAM_SOURCE_DIR + "/configs/stars/hipparcos.csv",
                   "stars.faintest_magnitude=4"}),
              0);
}

TEST_F(Allocation, NorWithLamps) {
    for (const char* motion : {"quality.motion=fast", "quality.motion=exact"})
        EXPECT_EQ(allocations({motion, "camera_pose.rate_deg_s=[0, 100, 0]",
                               "lamps=[{name: flood, intensity_w_sr_um: 1000, beam_angle_deg: 40}, {name: "
                               "beacon, on: target, position_m: [0, 0, 9], intensity_w_sr_um: 1, beam: [[0, "
                               "1], [180, 0.5]]}]"}),
                  0);
}

TEST_F(Allocation, NorWithLightFromBesideThePictureAndBodiesWithAllTheyHave) {
    EXPECT_EQ(allocations(
                  {"camera.stray_light={veiling_glare_fraction: 0.001, glare_radius_px: 3}",
                   "camera.outside_light={ghosts: [{gain: 1.0e-6, defocus_mm: 2}]}",
                   "camera.spider={vanes: 4, width_mm: 0.01}", "moon={law: hapke, planetshine: true}",
                   "saturn.rings=true",
                   "bodies=[{name: io, equatorial_radius_km: 1800, kepler: {semi_major_axis_km: 421800}}]"}),
              0);
}

TEST_F(Allocation, NorWithAKeptPictureOfTheEarth) {
    EXPECT_EQ(
        allocations({"quality.kept_earth=true", "camera_pose.position_m=[0, 0, 0]",
                     "camera_pose.look_at_m=[-1, 0.5, 0]",
                     std::string("earth_surface.map=") + HILCAM_SOURCE_DIR + "/configs/maps/earth.map"}),
        0);
}

// Layers of 16384 x 8192 posts below a camera in low orbit, twenty seconds of it from frame to frame: tiles come in all the time.
TEST_F(Allocation, NorWhileTilesOfTheEarthsLayersAreRead) {
    if (!HILCAM_HAS_GDAL) GTEST_SKIP() << "built without GDAL";
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_allocation_layers_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    constexpr int kColumns = 16384, kRows = 8192;
    std::ofstream(folder / "lights.img").put('\0');
    std::filesystem::resize_file(folder / "lights.img", std::uintmax_t{kColumns} * kRows);
    std::ofstream(folder / "lights.hdr")
        << "ENVI\nsamples = " << kColumns << "\nlines = " << kRows
        << "\nbands = 1\nheader offset = 0\ndata type = 1\ninterleave = bsq\nbyte order = 0\n"
        << "map info = {Geographic Lat/Lon, 1, 1, -180, 90, " << 360.0 / kColumns << ", " << 180.0 / kRows
        << ", WGS-84}\n";
    const Seen seen = run({"camera.width_px=256", "camera.height_px=192", "clock.scale=1000",
                           "camera.frame_rate_hz=0.05", "camera.frame_rate_range_hz=[0.01, 60]",
                           "camera_motion.attitude={law: nadir, second_axis: [1, 0, 0], second: velocity}",
                           "objects.0.generate.triangles=20000", "quality.path_model=direct",
                           "earth_surface.layers=[{file: " + (folder / "lights.img").string() +
                               ", kind: lights, scale: 0.003}]",
                           "earth_surface.memory_mb=16", "events=[]"},
                          Loop::kPaced, {}, "configs/scenarios/leo_inspection.yaml");
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(seen.bytes_read, 50'000u);  // a tile has more, nothing else is read
    std::filesystem::remove_all(folder);
}

// On its way down, every second pixel of every second row: meshes change while it is watched.
TEST_F(Allocation, NorInALandingByEverySecondPixel) {
    const Seen seen = run({"quality.ground_step_px=2", "loop.frame_budget_ms=0", "camera.width_px=256",
                           "camera.height_px=192", "camera.focal_length_mm=4", "terrain.most_triangles=60000",
                           "outputs.gige.interface=", "commands.udp.address="},
                          Loop::kPaced, {}, "configs/scenarios/lunar_landing.yaml");
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(seen.terrain_allocations, 0);  // a mesh was made meanwhile
}

TEST_F(Allocation, NorWithANoiseBudget) { EXPECT_EQ(allocations({"quality.noise_budget=0.2"}), 0); }

// Below a budget that nothing meets it goes down a ladder of fifteen levels, some frames each: it is on its
// way while it is watched.
TEST_F(Allocation, NorWhileTheGovernorChangesTheLevel) {
    std::string levels;
    for (const char* three :
         {"{path_model: hemisphere, max_depth: 1}", "{noise_budget: 0, samples_per_axis: 1}",
          "{path_model: direct, noise_budget: 0, samples_per_axis: 3}"})
        for (int i = 0; i < 5; ++i) levels += std::string(levels.empty() ? "" : ", ") + three;
    const Seen seen = run({"loop.frame_budget_ms=0.001", "loop.levels=[" + levels + "]",
                           "quality.noise_budget=0.5", "quality.samples_per_axis=2"},
                          Loop::kPaced);
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(seen.level_changes, 0u);
}

TEST_F(Allocation, NorWhileItIsRecordedAndEventsAreWatchedFor) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("hilcam_allocation_" + std::to_string(getpid()) + ".rec");
    const Seen seen = run({"events=[{when: {object: target, distance_below_m: 1, light: lit}, do: stop}, "
                           "{at_s: 10000, do: stop}]"},
                          Loop::kPaced, file);
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(std::filesystem::file_size(file), 80u * 100);  // of a frame's record
    std::filesystem::remove(file);
}

TEST_F(Allocation, NorWhenSimulatedTimeGoesFasterOrStands) {
    EXPECT_EQ(allocations({"clock.scale=3"}, Loop::kPaced), 0);
    EXPECT_EQ(allocations({"clock.paused=true", "camera_pose.rate_deg_s=[0, 10, 0]"}, Loop::kPaced), 0);
}

TEST_F(Allocation, NorWhileTheTruthOfItsFramesIsTold) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_allocation_" + std::to_string(getpid()));
    for (const char* motion : {"quality.motion=fast", "quality.motion=exact"})
        EXPECT_EQ(allocations(
                      {motion, "camera_pose.rate_deg_s=[0, 100, 0]",
                       "outputs.truth.folder=" + folder.string(), "outputs.truth.overwrite=true",
                       "outputs.truth.layers=[object, range, depth, normal, position]",
                       std::string("stars.catalogue=") + HILCAM_SOURCE_DIR + "/configs/stars/hipparcos.csv"},
                      Loop::kTold),
                  0);
    EXPECT_GT(std::filesystem::file_size(folder / "truth.jsonl"), 0u);
    std::filesystem::remove_all(folder);
}

TEST_F(Allocation, NorWhileSomebodyLooksAtPicturesWithTheirTruth) {
    EXPECT_EQ(
        allocations({"outputs.preview.port=" + std::to_string(PreviewReader::kPort),
                     std::string("stars.catalogue=") + HILCAM_SOURCE_DIR + "/configs/stars/hipparcos.csv"},
                    Loop::kLookedAt),
        0);
}

TEST_F(Allocation, NorWhileFramesGoToASharedMemory) {
    EXPECT_EQ(allocations({"outputs.shm.name=hilcam_allocation_" + std::to_string(getpid())}, Loop::kTold),
              0);
}

TEST_F(Allocation, NorWithAScanningLine) {
    EXPECT_EQ(
        allocations({"camera.shutter={kind: line_scan, line_time_us: 50}",
                     "camera_pose.rate_deg_s=[-2000, 0, 0]",
                     std::string("stars.catalogue=") + HILCAM_SOURCE_DIR + "/configs/stars/hipparcos.csv"}),
        0);
}

TEST_F(Allocation, NorWhileACameraIsStreamedFrom) {
    EXPECT_EQ(
        allocations({"outputs.gige.interface=127.83.4.1", "outputs.gige.serial=ALLOC"}, Loop::kStreaming), 0);
}

// The first frames are without kept light; it is taken on the way, and frames with it come after that. What
// the loop allocates is counted from before the tables are given until then.
TEST_F(Allocation, NorWhenLightComesThatWasMadeBesideTheRun) {
    const std::filesystem::path cache =
        std::filesystem::temp_directory_path() / ("hilcam_allocation_cache_" + std::to_string(getpid()));
    const char* const before = std::getenv("HILCAM_CACHE");
    const std::string kept_before = before ? before : "";
    setenv("HILCAM_CACHE", cache.c_str(), 1);
    {
        const ScenarioConfig scenario =
            load_scenario(std::string(HILCAM_SOURCE_DIR) + "/tests/protocol/minimal_scenario.yaml",
                          std::vector<std::string>{"quality.path_model=kept", "quality.kept_nodes=20000"});
        RunLimits limits;
        limits.outputs = false;
        limits.light_beside = true;
        limits.seconds = 300;
        Emulator emulator(scenario, limits);
        const LoopCounters& counters = emulator.loop().counters();
        std::thread runner([&] { emulator.run([] {}); });
        const auto wait_until = [&](auto&& done) {
            while (!done() && !emulator.loop().finished()) std::this_thread::yield();
        };
        wait_until([&] { return counters.frames >= 5; });
        EXPECT_TRUE(counters.lacks_light);
        arm_allocation_guard();
        wait_until([&] { return !counters.lacks_light; });
        const std::uint64_t lit = counters.last_id;
        wait_until([&] { return counters.last_id >= lit + 20; });
        const int allocated = counted_allocations().own;
        EXPECT_GE(counters.without_light, 5u);
        EXPECT_EQ(allocated, 0);
        emulator.loop().stop();
        runner.join();
    }
    if (before)
        setenv("HILCAM_CACHE", kept_before.c_str(), 1);
    else
        unsetenv("HILCAM_CACHE");
    std::filesystem::remove_all(cache);
}

// A satellite by its element set that looks at one by an ephemeris, and a third that drifts beside it.
TEST_F(Allocation, NorDoSourcesOfMotion) {
    const Tle tle = read_tles(
                        "1 25544U 98067A   14020.93268519  .00009878  00000-0  18200-3 0  5082\n"
                        "2 25544  51.6498 109.4756 0003572  55.9686 274.8005 15.49815350868473\n",
                        "iss.tle")
                        .at(0);
    OemSegment segment;
    segment.center_name = "EARTH";
    segment.frame = CcsdsFrame::kEarthFixed;
    for (int i = 0; i < 20; ++i)
        segment.states.push_back({tle.epoch + i * 60'000'000'000, {7e6, 1e5 * i, 0}, {0, 1e5 / 60, 0}});
    segment.usable_start = segment.states.front().time, segment.usable_stop = segment.states.back().time;
    Pointing pointing;
    pointing.aim = {Aim::Kind::kThing, {}, {}, 1};
    JitterBand band;
    band.rms_rad = {1e-5, 1e-5, 1e-5};
    const PlacedFrame lvlh{PlacedFrame::Kind::kLvlh, 0, {}};
    std::vector<std::unique_ptr<MotionSource>> sources;
    sources.push_back(std::make_unique<MotionSource>(make_tle(tle, 86400, "iss.tle"), make_pointing(pointing),
                                                     AttitudeJitter(band, 1, 0, tle.epoch)));
    sources.push_back(
        std::make_unique<MotionSource>(make_oem({segment}, "t.oem"), make_turning({}, {}, tle.epoch)));
    sources.push_back(std::make_unique<MotionSource>(make_drifting(lvlh, {{-200, 0, 0}, {}}, 1e-3, tle.epoch),
                                                     make_turning(lvlh, {}, tle.epoch)));
    const std::array<std::string, 3> names{"a", "b", "c"};
    const std::array<Motion, 3> at_rest{};
    WorldState world(at_rest, {}, {}, {}, MotionSources(std::move(sources), names));
    WorldSnapshot snapshot;
    snapshot.objects.resize(2);
    ShownCommand shown;
    world.sample(tle.epoch, snapshot, shown);
    arm_allocation_guard();
    for (int i = 0; i < 30; ++i)
        world.sample(tle.epoch + i * 60'000'000'000, snapshot, shown);  // and past its end
    const int allocated = counted_allocations().own;
    EXPECT_EQ(allocated, 0);
    EXPECT_GT(world.held(), 0u);
}

// A ship by SPICE's kernels about Mars, a frame of a C-kernel, and the sky by the same, inside what they know and outside.
TEST_F(Allocation, NorDoKernels) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_kernels_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const TimeTai start = parse_utc("2026-03-20T14:00:00Z");
    const double et_s = EphemerisTime().et_s(start);
    std::vector<double> states, ticks, times, attitudes;
    for (int i = 0; i < 20; ++i) {
        states.insert(states.end(), {5000, 60.0 * i, 0, 0, 1, 0});
        times.push_back(et_s + 60 * i), ticks.push_back(10 * (et_s + 60 * i));
        attitudes.insert(attitudes.end(), {std::cos(0.1 * i), 0, 0, std::sin(0.1 * i)});
    }
    const double stop = times.back();
    states.insert(states.end(), times.begin(), times.end());
    states.insert(states.end(), {3, 20});
    attitudes.insert(attitudes.end(), ticks.begin(), ticks.end());
    attitudes.insert(attitudes.end(), {ticks.front(), 1, 20});
    const auto still = [&](int body, double x_km) {
        return WrittenArray{"B",
                            et_s - 1e5,
                            et_s + 1e5,
                            {body, 0, 1, 2},
                            {et_s, 1e5, x_km, 0, 0, 1, 0, 0, et_s - 1e5, 2e5, 8, 1}};
    };
    const auto write = [&](const char* name, const std::string& bytes) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
        return folder / name;
    };
    const std::vector files = {
        write("a.bsp", SpiceWriter("SPK")
                           .add({"S", et_s, stop, {-99, 499, 1, 13}, states})
                           .add(still(499, 2e8))
                           .add(still(10, 1e6))
                           .bytes()),
        write(
            "a.bc",
            SpiceWriter("CK").add({"S", ticks.front(), ticks.back(), {-99000, 1, 3, 0}, attitudes}).bytes()),
        write(
            "a.tf",
            "\\begindata\nFRAME_BUS = -99000\nFRAME_-99000_NAME = 'BUS'\nFRAME_-99000_CLASS = "
            "3\nFRAME_-99000_CLASS_ID = -99000\n"
            "CK_-99000_SCLK = -99\nSCLK01_MODULI_99 = ( 4000000000 10 )\nSCLK01_COEFFICIENTS_99 = ( 0 0 1 )\n"
            "BODY499_POLE_RA = ( 317.68 -0.1 )\nBODY499_POLE_DEC = ( 52.88 -0.06 )\nBODY499_PM = ( 176.63 "
            "350.89 )\n")};
    const auto kernels = std::make_shared<SpiceKernels>(files);
    std::filesystem::remove_all(folder);
    OriginConfig origin;
    origin.kind = OriginConfig::Kind::kBodyCenter, origin.body = BodyId::kMars;
    origin.source = make_spice_sky(kernels, {}, true, start);
    std::vector<std::unique_ptr<MotionSource>> sources;
    sources.push_back(std::make_unique<MotionSource>(
        make_spice_place(kernels, {-99, 499, OrbitCenter{BodyId::kMars}}, "ship"),
        make_spice_attitude(kernels, "BUS", {})));
    const std::array<std::string, 1> names{"a"};
    const std::array<Motion, 1> at_rest{};
    WorldState world(at_rest, origin, {}, {}, MotionSources(std::move(sources), names));
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample(start, snapshot, shown);
    EXPECT_NEAR(length(snapshot.camera.position_world_m), 5e6, 1);
    EXPECT_NEAR(length(snapshot.bodies.sun_world_m), 1.99e11, 1e9);
    arm_allocation_guard();
    for (int i = 0; i < 30; ++i) world.sample(start + i * 60'000'000'000, snapshot, shown);
    const int allocated = counted_allocations().own;
    EXPECT_EQ(allocated, 0);
    EXPECT_GT(world.held(), 0u);
}

}  // namespace
}  // namespace hilcam
