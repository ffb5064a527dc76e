// After its first frames the loop allocates nothing (allocation_guard.h).

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "emulator/run/emulator.h"
#include "tests/realtime/allocation_guard.h"
#include "tests/realtime/frame_readers.h"
#include "tests/realtime/watched_run.h"

namespace hilcam {
namespace {

TEST_F(Allocation, TheGuardSeesOne) {
    arm_allocation_guard();
    auto* volatile number = new int(1);
    EXPECT_EQ(counted_allocations().own, 1);
    delete number;
}

int allocations(const std::vector<std::string>& overrides, Loop loop = Loop::kUnpaced) {
    return watch_run(overrides, loop).allocations;
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

// It has a picture of its own, from which points take its light, whether its pixels are the camera's or not.
TEST_F(Allocation, NorWithASmallObject) {
    for (const char* distance_m : {"300", "3000"})
        EXPECT_EQ(allocations({"quality.visibility=buffer", "quality.buffer_samples=64",
                               "camera_pose.look_at_m=[0, 0, 0]",
                               std::string("camera_pose.position_m=[") + distance_m + ", 0, 0]"}),
                  0)
            << distance_m;
}

TEST_F(Allocation, NorWithLinesThatFollowIt) {
    EXPECT_EQ(allocations(
                  {"lines={outputs: [{line: 1, source: exposure_active}, {line: 2, source: frame_active}]}"},
                  Loop::kTold),
              0);
}

TEST_F(Allocation, NorWithAKeptPictureOfTheEarth) {
    EXPECT_EQ(
        allocations({"quality.earth_impostor=true", "camera_pose.position_m=[0, 0, 0]",
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
    const Seen seen =
        watch_run({"camera.width_px=256", "camera.height_px=192", "clock.scale=1000",
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
    const Seen seen =
        watch_run({"quality.ground_step_px=2", "loop.frame_budget_ms=0", "camera.width_px=256",
                   "camera.height_px=192", "camera.focal_length_mm=4", "terrain.max_triangles=60000",
                   "outputs.gige.interface=", "commands.udp.address="},
                  Loop::kPaced, {}, "configs/scenarios/lunar_landing.yaml");
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(seen.terrain_allocations, 0);  // a mesh was made meanwhile
}

TEST_F(Allocation, NorWithScatteredRays) {
    EXPECT_EQ(allocations({"quality.visibility=rays", "quality.sun_disk=true"}), 0);
}

// A rate that no frame holds sends it down the ladder, one that all hold up again, while it is watched.
TEST_F(Allocation, NorWhileTheGovernorChangesTheLevel) {
    const Seen seen =
        watch_run({"loop.levels=[{path_model: path, max_depth: 1}, {sun_disk: false, samples_per_axis: 1}, "
                   "{path_model: direct, sun_disk: false, samples_per_axis: 3}]",
                   "quality.sun_disk=true", "quality.samples_per_axis=2", "camera.exposure_ms=0.1",
                   "camera.frame_rate_range_hz=[1, 5000]"},
                  Loop::kGoverned);
    EXPECT_EQ(seen.allocations, 0);
    EXPECT_GT(seen.level_changes, 2u);
}

TEST_F(Allocation, NorWhileItIsRecordedAndEventsAreWatchedFor) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("hilcam_allocation_" + std::to_string(getpid()) + ".rec");
    const Seen seen =
        watch_run({"events=[{when: {object: target, distance_below_m: 1, light: lit}, do: stop}, "
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

// Frames that are taken apart for somebody as little as others.
TEST_F(Allocation, NorWhileSomebodyLooksAtPicturesWithTheirTruthAndPartsOfTheirLight) {
    for (const char* quality : {"quality.visibility=rays", "quality.visibility=buffer"})
        EXPECT_EQ(allocations(
                      {quality, "outputs.preview.port=" + std::to_string(PreviewReader::kPort),
                       std::string("stars.catalogue=") + HILCAM_SOURCE_DIR + "/configs/stars/hipparcos.csv"},
                      Loop::kLookedAt),
                  0)
            << quality;
}

TEST_F(Allocation, NorWhileFramesGoToASharedMemory) {
    EXPECT_EQ(allocations({"outputs.shm.name=hilcam_allocation_" + std::to_string(getpid())}, Loop::kTold),
              0);
}

TEST_F(Allocation, NorWhileFramesGoOutAsPackets) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_packets_" + std::to_string(getpid()));
    EXPECT_EQ(allocations({"outputs.packets={transport: file, payload: packed, overwrite: true, folder: " +
                           folder.string() + "}"},
                          Loop::kTold),
              0);
    EXPECT_GT(std::filesystem::file_size(folder / "packets.bin"), 0u);
    std::filesystem::remove_all(folder);
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

// The first frames are without cached light; it is taken on the way, and frames with it come after that. What
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
                          std::vector<std::string>{"quality.path_model=cached", "quality.probes=20000"});
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

}  // namespace
}  // namespace hilcam
