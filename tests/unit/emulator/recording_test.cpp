#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "emulator/emulator.h"
#include "emulator/recording_codec.h"
#include "emulator/recording_reader.h"
#include "emulator/recording_text.h"
#include "emulator/scenario_listing.h"
#include "io/frame_flags.h"
#include "tests/support/commands.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;

// --- bytes

std::vector<std::uint8_t> bytes_of(const Record& record) {
    std::vector<std::uint8_t> bytes(kRecordPrefixBytes + kMostRecordBytes);
    bytes.resize(encode_record(record, bytes));
    return bytes;
}
std::optional<Record> read_back(const std::vector<std::uint8_t>& bytes) {
    return decode_record(std::span(bytes).subspan(kRecordPrefixBytes));
}

PoseCommand odd_pose() {
    PoseCommand pose = some_pose();
    // Not of norm 1, which the wire would change.
    pose.motion.pose.world_from_body = {0.1, 0.2, 0.3, 0.4};
    pose.motion.pose.position_world_m = {1.0 / 3, -1e-300, 1e300};
    pose.alone = true;
    return pose;
}

FrameUse some_use() {
    FrameUse use;
    use.id = 1'000'000'007, use.skipped = 3, use.late = true, use.reverse_y = true;
    use.test_pattern = TestPattern::kRampHorizontalMoving;
    use.trigger_sequence = 77, use.quality_level = 5;
    use.begin_ns = 123456789, use.middle_ns = 123456790, use.end_ns = 123456792, use.exposure_mid = {-5};
    use.shown_at = {-6}, use.moving = 0.125, use.shutter_closed = true;
    use.exposure_s = 1.0 / 3, use.gain_db = -0.0, use.black_level_dn = 12.5;
    use.binning_x = 2, use.binning_y = 4, use.faults = ~std::uint64_t{0};
    use.image = {true, false, true, 0.25, 1e-9};
    return use;
}

std::vector<Record> all_kinds() {
    SettingsChange change;
    change.exposure_s = 0.1, change.running = false, change.trigger_source = TriggerSource::kAction1;
    change.test_pattern = TestPattern::kWhite, change.burst_frames = 9, change.binning_y = 2;
    TriggerOrder order;
    order.at_monotonic_ns = 5, order.at_simulated = {6}, order.frames = 7, order.sequence = 8;
    SettingsCommand settings;
    settings.gain_db = 3;
    std::vector<Record> all = {
        RecordedChange{2, -1, change},
        RecordedTrigger{3, 4, order, TriggerResult::kMissed},
        RecordedShown{1, 70000, 1ull << 40},
        RecordedFrame{1, some_use()},
        RecordedLoss{12},
        RecordedEnd{99},
    };
    const Command commands[] = {odd_pose(),
                                JointCommand{1, 2, {3}, 0.4, -0.5},
                                settings,
                                StartCommand{},
                                StopCommand{},
                                ExposeCommand{{11}, 12, true},
                                FaultCommand{{FaultKind::kImageTear, 0.5, 0.25, 1, 2, 3}, false},
                                FaultCommand{{}, true},
                                TriggerModeCommand{true, 4},
                                ClockCommand{ClockCommand::Action::kScale, 5, 0.5, 0},
                                LampCommand{2, {7}, 0.5}};
    std::uint64_t number = 0;
    for (const Command& command : commands)
        all.push_back(RecordedCommand{++number, command, {5, 6, 1, nullptr, 2}, true});
    return all;
}

TEST(Recording, EveryRecordComesBackBitByBit) {
    for (const Record& record : all_kinds()) {
        const std::vector<std::uint8_t> bytes = bytes_of(record);
        const std::optional<Record> back = read_back(bytes);
        ASSERT_TRUE(back) << record.index();
        EXPECT_EQ(back->index(), record.index());
        EXPECT_EQ(bytes_of(*back), bytes) << record.index();
    }
    const std::optional<Record> frame = read_back(bytes_of(RecordedFrame{1, some_use()}));
    ASSERT_TRUE(frame);
    EXPECT_EQ(std::get<RecordedFrame>(*frame).use, some_use());
    EXPECT_TRUE(std::signbit(std::get<RecordedFrame>(*frame).use.gain_db));
    const std::optional<Record> pose = read_back(bytes_of(RecordedCommand{1, odd_pose(), {}, true}));
    ASSERT_TRUE(pose);
    const auto& read = std::get<PoseCommand>(std::get<RecordedCommand>(*pose).command);
    EXPECT_EQ(read.motion.pose.world_from_body.w, 0.1);
    EXPECT_TRUE(read.alone);
    EXPECT_TRUE(std::get<RecordedCommand>(*pose).forgets);
}

// By hand, from docs/recording.md; the CRC from Python's zlib.crc32.
TEST(Recording, BytesAreThoseOfTheManual) {
    EXPECT_EQ(hex(bytes_of(RecordedLoss{12})), "00 00 00 09 8B DE 35 4C 07 00 00 00 00 00 00 00 0C");
}

TEST(Recording, AByteMoreOrLessOrAWordThatDoesNotExistIsNoRecord) {
    std::vector<std::uint8_t> bytes = bytes_of(RecordedTrigger{3, 4, {}, TriggerResult::kTaken});
    ASSERT_TRUE(read_back(bytes));
    std::vector<std::uint8_t> longer = bytes, shorter = bytes, other = bytes;
    longer.push_back(0);
    shorter.pop_back();
    other.back() = 9;  // no such result
    EXPECT_FALSE(read_back(longer));
    EXPECT_FALSE(read_back(shorter));
    EXPECT_FALSE(read_back(other));
}

// --- files

RecordingHeader small_header() {
    return {"hilcam test", 1, "a processor", {5}, 6, 1, false, "camera.exposure_ms = 20\nseed = 1\n"};
}

class RecordingFileTest : public FilesTest {
  protected:
    std::filesystem::path record(const std::vector<Record>& records) {
        const auto file = folder_ / "some.rec";
        Recorder recorder(file, small_header());
        recorder.start();
        for (const Record& r : records) recorder.put(r);
        recorder.stop();
        EXPECT_EQ(recorder.report().fault, "");
        return file;
    }
    static std::string content(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(RecordingFileTest, AFileCutOffAnywhereGivesItsWholeRecords) {
    std::vector<Record> records;
    for (std::uint64_t i = 1; i <= 20; ++i) records.push_back(RecordedShown{1, 0, i});
    const std::string whole = content(record(records));
    const std::size_t record_bytes = bytes_of(records[0]).size(), end_bytes = bytes_of(RecordedEnd{}).size();
    const std::size_t first = whole.size() - end_bytes - 20 * record_bytes;
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        auto in = std::make_unique<std::istringstream>(whole.substr(0, size));
        if (size < first) {
            EXPECT_THROW(RecordingReader(std::move(in), "cut"), InputError) << size;
            continue;
        }
        RecordingReader reader(std::move(in), "cut");
        EXPECT_EQ(reader.header().scenario, small_header().scenario);
        std::size_t count = 0;
        for (Record r; reader.next(r);) EXPECT_EQ(std::get<RecordedShown>(r).number, ++count);
        EXPECT_EQ(count, std::min<std::size_t>(20, (size - first) / record_bytes)) << size;
        EXPECT_EQ(reader.end(), size == whole.size() ? RecordingEnd::kClean : RecordingEnd::kCutOff) << size;
    }
}

TEST_F(RecordingFileTest, ADamagedByteEndsItThere) {
    std::vector<Record> records;
    for (std::uint64_t i = 1; i <= 5; ++i) records.push_back(RecordedShown{1, 0, i});
    std::string bytes = content(record(records));
    const std::size_t record_bytes = bytes_of(records[0]).size(), end_bytes = bytes_of(RecordedEnd{}).size();
    bytes[bytes.size() - end_bytes - 2 * record_bytes + 10] ^= 1;  // in the fourth
    RecordingReader reader(std::make_unique<std::istringstream>(bytes), "damaged");
    std::size_t count = 0;
    for (Record r; reader.next(r);) ++count;
    EXPECT_EQ(count, 3u);
    EXPECT_EQ(reader.end(), RecordingEnd::kDamaged);
    EXPECT_THAT(reader.end_text(), HasSubstr("damaged"));
}

TEST_F(RecordingFileTest, WhatTheQueueHasNoRoomForIsSaid) {
    const auto file = folder_ / "slow.rec";
    Recorder recorder(file, small_header());
    constexpr std::uint64_t kMore = 3, kRoom = 16384;
    for (std::uint64_t i = 0; i < kRoom + kMore; ++i) recorder.put(RecordedShown{1, 0, i});
    recorder.start();
    recorder.stop();
    EXPECT_EQ(recorder.report().lost, kMore);
    EXPECT_THAT(recorder.report().fault, HasSubstr("3 records were lost"));
    Record r;
    RecordingReader strict(file);
    EXPECT_FALSE(strict.next(r));
    EXPECT_EQ(strict.end(), RecordingEnd::kLoss);
    RecordingReader lenient(file);
    lenient.pass_losses();
    std::uint64_t count = 0;
    while (lenient.next(r)) ++count;
    EXPECT_EQ(count, 1 + kRoom);
    EXPECT_EQ(lenient.end(), RecordingEnd::kClean);
}

TEST_F(RecordingFileTest, AFileThatIsNoneIsRefused) {
    const auto none = folder_ / "none.rec";
    EXPECT_THAT(error_of([&] { RecordingReader reader(none); }), HasSubstr("cannot be read"));
    EXPECT_THAT(error_of([&] { RecordingReader reader(folder_); }), HasSubstr("cannot be read"));
    const auto text = write("text.rec", "time_utc: 2026-12-21T00:00:00Z\n");
    EXPECT_THAT(error_of([&] { RecordingReader reader(text); }), HasSubstr("is no recording"));
    const auto newer = write("newer.rec", "hilcrec\x02");
    EXPECT_THAT(error_of([&] { RecordingReader reader(newer); }),
                HasSubstr("of format 2; accepted: format 1"));
}

TEST_F(RecordingFileTest, AsTextAClockCommandHasItsWord) {
    using Action = ClockCommand::Action;
    RecordingReader reader(record({RecordedCommand{1, ClockCommand{Action::kPause}, {}, false},
                                   RecordedCommand{2, ClockCommand{Action::kScale, 0, 0.5}, {}, false}}));
    std::vector<std::string> lines;
    list_recording(reader, [&](const std::string& line) { lines.push_back(line); });
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(lines[1], HasSubstr("\"command\":\"clock\",\"action\":\"pause\"}"));
    EXPECT_THAT(lines[2], HasSubstr("\"action\":\"scale\",\"scale\":0.5}"));
}

// For people: what time and poses did to a frame is there as well as the faults on demand.
TEST_F(RecordingFileTest, AsTextAFrameSaysWhatItShowsAndWhatStruckIt) {
    FrameUse use = some_use();
    use.exposure_mid = {1'000'000'005}, use.shown_at = {500'000'005};
    use.faults = bit_of(FaultKind::kImageBlack) | kTimeStandsBit | kPosesStaleBit | kTagsWentBackBit;
    FrameUse plain;
    RecordingReader reader(record({RecordedFrame{1, use}, RecordedFrame{1, plain}}));
    std::vector<std::string> lines;
    list_recording(reader, [&](const std::string& line) { lines.push_back(line); });
    ASSERT_EQ(lines.size(), 4u);  // with the header and the end
    for (const char* part :
         {"\"middle_s\":1.0,", "\"shown_s\":0.5,", "\"late\":true", "\"shutter_closed\":true",
          "\"faults\":[\"image_black\",\"time_stands\",\"poses_stale\",\"tags_went_back\"]"})
        EXPECT_THAT(lines[1], HasSubstr(part));
    for (const char* key : {"late", "shutter_closed", "faults"}) EXPECT_THAT(lines[2], Not(HasSubstr(key)));
}

TEST(CheckRecording, NamesWhatIsAnother) {
    const RecordingHeader own = small_header();
    EXPECT_TRUE(check_recording(own, "a.rec", own, false).empty());
    RecordingHeader other = own;
    other.scenario = "camera.exposure_ms = 5\nseed = 1\n";
    const auto refusal = [&] {
        try {
            check_recording(other, "a.rec", own, false);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(),
              "a.rec: was recorded with another scenario: camera.exposure_ms: '5' there, '20' here; --force "
              "replays it all the same");
    EXPECT_EQ(check_recording(other, "a.rec", own, true).size(), 1u);
    other = own;
    other.program = "hilcam 0.0.1";
    EXPECT_THAT(refusal(), HasSubstr("was recorded by 'hilcam 0.0.1', this is 'hilcam test'"));
    other = own;
    other.build = 2, other.processor = "another";
    EXPECT_EQ(check_recording(other, "a.rec", own, false).size(), 2u);  // said, not refused
}

// --- replays

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
        return error_of([&] { replay(folder_ / "run.rec", "other", 2, true, {change}); });
    };
    EXPECT_THAT(refusal("camera.f_number=4"), HasSubstr("camera.f_number: '8' there, '4' here; --force"));
    EXPECT_THAT(refusal("seed=2"), HasSubstr("seed: '1' there, '2' here"));
    write("plate.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 3 2\n");
    EXPECT_THAT(refusal("threads=1"), HasSubstr("objects.0.mesh: 'plate.obj ("));
    file_ = bench();
    EXPECT_EQ(refusal("threads=1"), "no error");
    EXPECT_EQ(refusal("name=another"), "no error");
}

}  // namespace
}  // namespace hilcam
