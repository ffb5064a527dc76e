// What moves allocates nothing after its first sample (allocation_guard.h).

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/spice_sky.h"
#include "emulator/motion/trajectories.h"
#include "emulator/world/world_state.h"
#include "tests/realtime/allocation_guard.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

// A satellite by its element set that looks at one by an ephemeris, and a third that drifts beside it.
TEST_F(Allocation, NorDoSourcesOfMotion) {
    const ElementSet tle = read_element_sets(
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
    sources.push_back(std::make_unique<MotionSource>(make_tle(tle, 86400), make_pointing(pointing),
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

// Writes and loads kernels of a ship for twenty minutes from `start`: its way about Mars, a frame BUS that turns, the Sun and Mars.
std::shared_ptr<SpiceKernels> kernels_of_ship(TimeTai start) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_kernels_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
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
    auto kernels = std::make_shared<SpiceKernels>(files);
    std::filesystem::remove_all(folder);
    return kernels;
}

// A ship by SPICE's kernels about Mars, a frame of a C-kernel, and the sky by the same, inside what they know and outside.
TEST_F(Allocation, NorDoKernels) {
    const TimeTai start = parse_utc("2026-03-20T14:00:00Z");
    const std::shared_ptr<SpiceKernels> kernels = kernels_of_ship(start);
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
