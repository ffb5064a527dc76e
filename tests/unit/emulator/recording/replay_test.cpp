// A recorded run comes back bit by bit.

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <atomic>
#include <map>
#include <random>
#include <thread>

#include "emulator/recording/recording_reader.h"
#include "emulator/recording/recording_text.h"
#include "emulator/run/emulator.h"
#include "tests/support/commands.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// Two cameras on one body, automatic exposure on the second; frames go to folders as their bytes.
class ReplayTest : public PlateTest {
  protected:
    static constexpr std::uint32_t kAddress = 0x7F530801;  // 127.83.8.1
    static constexpr std::uint16_t kPort = 5010;

    using Frames = std::map<std::string, std::string>;  // by file name

    std::filesystem::path bench() {
        const std::string second =
            "{name: second, width_px: 48, height_px: 32, pitch_um: 10, focal_length_mm: 4, f_number: 8,\n"
            "  transmission: 0.01, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12,\n"
            "  offset_dn: 50, read_noise_e: 5, exposure_ms: 3, exposure_range_ms: [0.1, 15],\n"
            "  auto_exposure: {on: true}, frame_rate_hz: 40}";
        return scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 100], exposure_range_ms: [0.1, 20]",
                        "quality: {motion: exact, samples_per_axis: 2}\n"
                        "lamps: [{name: flash, intensity_w_sr_um: 4000, beam_angle_deg: 20, lit: false}]\n"
                        "more_cameras:\n  - {camera: " +
                            second +
                            ", outputs: {files: {folder: unused, format: raw}}}\n"
                            "outputs: {files: {folder: unused, format: raw}}\n");
    }
    ScenarioConfig scenario_into(const std::string& folder, const std::vector<std::string>& more = {}) {
        std::vector<std::string> overrides = {
            "outputs.files.folder=" + (folder_ / folder / "1").string(),
            "more_cameras.0.outputs.files.folder=" + (folder_ / folder / "2").string()};
        overrides.insert(overrides.end(), more.begin(), more.end());
        return load_scenario(file_, overrides);
    }
    Frames frames_in(const std::string& folder) const {
        Frames out;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / folder)) {
            if (!entry.is_regular_file()) continue;
            std::ifstream in(entry.path(), std::ios::binary);
            out[std::filesystem::relative(entry.path(), folder_ / folder).string()] = {
                std::istreambuf_iterator<char>(in), {}};
        }
        return out;
    }
    // Frames of a replay, on so many threads.
    Frames replay(const std::filesystem::path& recording, const std::string& into, std::size_t threads,
                  bool fast, const std::vector<std::string>& more = {}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        RunLimits limits;
        limits.replay = recording;
        limits.replay_fast = fast;
        Emulator emulator(scenario_into(into, more), limits);
        emulator.run([] {});
        outcomes_.clear();
        for (const auto& replayed : emulator.replays()) outcomes_.push_back(replayed->outcome());
        return frames_in(into);
    }
    // Every frame that the run wrote is among those of the replay, with the same bytes.
    static void expect_same(const Frames& run, const Frames& replayed, std::size_t least) {
        EXPECT_GE(run.size(), least);
        EXPECT_GE(replayed.size(), run.size());
        for (const auto& [name, bytes] : run) {
            const auto other = replayed.find(name);
            ASSERT_NE(other, replayed.end()) << name;
            EXPECT_EQ(bytes == other->second, true) << name;
        }
    }

    std::filesystem::path file_;
    std::vector<Replay::Outcome> outcomes_;
};

// Commands by UDP as fast as they are answered, and what clients of the cameras change, while frames are
// taken: which frame shows what is up to the machine.
void disturb(Emulator& emulator, std::uint32_t address, std::uint16_t port, const std::atomic<bool>& done) {
    const Fd socket = open_udp(address, 0);
    const sockaddr_in to = socket_address(address, port);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::uint32_t sequence = 0;
    const auto send = [&](const Command& command) {
        const std::vector<std::uint8_t> bytes = encoded(command, ++sequence);
        sendto(socket.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
    };
    for (int i = 0; !done.load(); ++i) {
        PoseCommand pose;
        pose.object = static_cast<std::uint16_t>(i % 2);
        pose.motion.pose.position_world_m = {0.05 * uniform(random), 0.05 * uniform(random), i % 2 * 4.0};
        pose.motion.velocity_world_m_s = {uniform(random), 0, 0};
        pose.motion.rate_body_rad_s = {0, 0, uniform(random)};
        send(pose);
        if (i % 50 == 10) {
            SettingsCommand settings;
            settings.gain_db = 3 + 3 * uniform(random);
            send(settings);
        }
        if (i % 20 == 5) send(LampCommand{1, {}, 0.5 + 0.5 * uniform(random)});
        if (i % 80 == 20) send(FaultCommand{{FaultKind::kImageBitFlips, 1e-3, 0, 0, 0, 0.05}, false});
        if (i % 80 == 60) send(FaultCommand{{FaultKind::kImageTear, 0.5, 0.5, 0, 0, 0.05}, false});
        if (i % 100 == 50) {
            const std::int64_t binning = 1 + i / 100 % 2;
            emulator.first().settings().change({.reverse_x = binning == 1, .binning_x = binning});
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

TEST_F(ReplayTest, AFreeRunComesBackBitByBitOnAnyNumberOfThreads) {
    file_ = bench();
    const std::string udp = "commands={udp: {address: 127.83.8.1, port: 5010}}";
    const auto recording = folder_ / "run.rec";
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        RunLimits limits;
        limits.frames = 80;
        limits.record = recording;
        Emulator emulator(scenario_into("run", {udp}), limits);
        std::atomic<bool> ready{false}, done{false};
        std::thread commander([&] {
            while (!ready.load() && !done.load()) std::this_thread::yield();
            disturb(emulator, kAddress, kPort, done);
        });
        emulator.run([&] { ready = true; });
        done = true;
        commander.join();
        const RecorderReport report = emulator.recorder()->report();
        EXPECT_EQ(report.fault, "");
        EXPECT_EQ(report.frames, 160u);
        EXPECT_GT(report.commands, 100u);
        EXPECT_GT(emulator.command_report().received, 100u);
    }
    const Frames run = frames_in("run");
    // The outputs may have dropped some while the machine was busy; the recording has all.
    const Frames one = replay(recording, "one", 1, true), four = replay(recording, "four", 4, true),
                 paced = replay(recording, "paced", 2, false);
    for (const Replay::Outcome& outcome : outcomes_) {
        EXPECT_TRUE(outcome.whole) << outcome.text;
        EXPECT_EQ(outcome.frames, 80u);
    }
    EXPECT_EQ(one.size(), 160u);
    expect_same(run, one, 100);
    expect_same(one, four, 160);
    expect_same(one, paced, 160);
    // The test would notice: frames differ from each other, and with them what was shown.
    EXPECT_NE(one.begin()->second, std::next(one.begin(), 10)->second);

    // What is recorded is what was done.
    RecordingReader reader(recording);
    std::map<std::string, int> kinds;
    list_recording(reader, [&](const std::string& line) {
        const auto at = line.find("\"record\":\"") + 10;
        ++kinds[line.substr(at, line.find('"', at) - at)];
    });
    EXPECT_EQ(kinds["header"], 1);
    EXPECT_EQ(kinds["frame"], 160);
    EXPECT_GT(kinds["shown"], 20);
    EXPECT_GT(kinds["settings"], 0);
    EXPECT_EQ(kinds["file"], 1);
}

// As a run that was killed leaves it.
TEST_F(ReplayTest, ARecordingThatIsCutOffGivesItsFramesUpToThere) {
    file_ = bench();
    const auto recording = folder_ / "run.rec", cut = folder_ / "cut.rec";
    RunLimits limits;
    limits.frames = 30;
    limits.record = recording;
    Emulator(scenario_into("run"), limits).run([] {});
    std::filesystem::copy_file(recording, cut);
    const std::uintmax_t header = RecordingReader(recording).offset(), size = std::filesystem::file_size(cut);
    std::filesystem::resize_file(cut, header + (size - header) * 3 / 4);
    const Frames whole = replay(recording, "whole", 2, true), part = replay(cut, "part", 2, true);
    EXPECT_EQ(whole.size(), 60u);
    EXPECT_FALSE(outcomes_.at(0).whole);
    EXPECT_THAT(outcomes_.at(0).text, HasSubstr("cut off"));
    EXPECT_GT(part.size(), 10u);
    EXPECT_LT(part.size(), 60u);
    expect_same(part, whole, 10);
}

TEST_F(ReplayTest, LockstepWithEventsComesBackOnAnyNumberOfThreads) {
    file_ = scenario("",
                     "mode: lockstep\n"
                     "camera_pose: {velocity_m_s: [0.02, 0, 0.3]}\n"
                     "lamps: [{name: flash, intensity_w_sr_um: 4000, lit: false}]\n"
                     "more_cameras:\n  - {camera: {name: second, width_px: 32, height_px: 32, pitch_um: 10,\n"
                     "  focal_length_mm: 4, f_number: 8, transmission: 0.01, quantum_efficiency: 0.5,\n"
                     "  full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 3},\n"
                     "  outputs: {files: {folder: unused, format: raw}}}\n"
                     "outputs: {files: {folder: unused, format: raw}}\n"
                     "events:\n"
                     "  - {at_s: 0.5, every_s: 0.5, times: 16, do: expose --frames 2}\n"
                     "  - {when: {object: plate, distance_below_m: 3.5}, do: settings --exposure-ms 7}\n"
                     "  - {at_s: 1.2, every_s: 2, times: 4, do: lamp on --level 0.5}\n"
                     "  - {at_s: 2.001, every_s: 2, times: 4, do: lamp off}\n"
                     "  - {at_s: 4, do: [fault image_tear --value 0.5 --frames 3, settings --gain-db 6]}\n"
                     "  - {at_s: 20, do: end}\n");
    const auto run_on = [&](std::size_t threads, const std::string& into) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        RunLimits limits;
        limits.record = folder_ / (into + ".rec");
        limits.seconds = 60;
        Emulator(scenario_into(into), limits).run([] {});
        return frames_in(into);
    };
    const Frames one = run_on(1, "one"), four = run_on(4, "four");
    EXPECT_EQ(one.size(), 64u);
    EXPECT_EQ(one == four, true);
    EXPECT_EQ(replay(folder_ / "one.rec", "again", 3, false) == one, true);
}

TEST_F(ReplayTest, AnotherScenarioIsRefusedAndAnotherOutputIsNot) {
    file_ = bench();
    RunLimits limits;
    limits.frames = 3;
    limits.record = folder_ / "run.rec";
    Emulator(scenario_into("run"), limits).run([] {});
    const auto refusal = [&](const std::string& change) {
        return error_of([&] {
            replay(folder_ / "run.rec", "other", 2, true,
                   {change, "outputs.files.overwrite=true", "more_cameras.0.outputs.files.overwrite=true"});
        });
    };
    EXPECT_THAT(refusal("camera.f_number=4"), HasSubstr("camera.f_number: '8' there, '4' here; --force"));
    EXPECT_THAT(refusal("seed=2"), HasSubstr("seed: '1' there, '2' here"));
    write("plate.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 3 2\n");
    EXPECT_THAT(refusal("threads=1"), HasSubstr("objects.0.mesh: 'plate.obj ("));
    file_ = bench();
    EXPECT_EQ(refusal("threads=1"), "no error");
    EXPECT_EQ(refusal("name=another"), "no error");
    EXPECT_EQ(refusal("loop.cores=[0]"), "no error");
}

}  // namespace
}  // namespace hilcam
