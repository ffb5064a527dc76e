#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "emulator/recording/recording_codec.h"
#include "emulator/recording/recording_header.h"
#include "emulator/recording/recording_reader.h"
#include "emulator/recording/recording_text.h"
#include "emulator/run/emulator.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/contract/frame_flags.h"
#include "tests/support/commands.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;

// --- bytes

std::vector<std::uint8_t> bytes_of(const Record& record) {
    std::vector<std::uint8_t> bytes(kRecordPrefixBytes + kMaxRecordBytes);
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
    use.trigger_sequence = 77, use.quality_level = 5, use.sequencer_set = 3;
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
    change.trigger_activation = TriggerActivation::kAnyEdge, change.trigger_divider = 4;
    change.trigger_overlap = TriggerOverlap::kOff, change.exposure_mode = ExposureMode::kTriggerWidth;
    TriggerOrder order;
    order.at_monotonic_ns = 5, order.until_monotonic_ns = 9, order.at_simulated = {6}, order.frames = 7,
    order.sequence = 8;
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

// The manual computes the size of a recording from these figures.
TEST(Recording, PosesAndFramesHaveTheSizesOfTheManual) {
    EXPECT_EQ(bytes_of(RecordedCommand{1, odd_pose(), {}, false}).size(), 150u);
    EXPECT_EQ(bytes_of(RecordedFrame{1, FrameUse{}}).size(), 149u);
    EXPECT_EQ(bytes_of(RecordedShown{1, 0, 1}).size(), 23u);
}

TEST(Recording, AByteMoreOrLessOrAWordThatDoesNotExistIsNoRecord) {
    std::vector<std::uint8_t> bytes = bytes_of(RecordedTrigger{3, 4, {}, TriggerResult::kTaken});
    ASSERT_TRUE(read_back(bytes));
    std::vector<std::uint8_t> longer = bytes, shorter = bytes, other = bytes;
    longer.push_back(0);
    shorter.pop_back();
    other[other.size() - 9] = 9;  // no such result; the end of a pulse follows
    EXPECT_FALSE(read_back(longer));
    EXPECT_FALSE(read_back(shorter));
    EXPECT_FALSE(read_back(other));
    bytes.resize(bytes.size() - 8);  // of a program without pulses
    EXPECT_TRUE(read_back(bytes));
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
    EXPECT_THAT(error_of([&] { RecordingReader reader(none); }), HasSubstr("no such file"));
    EXPECT_THAT(error_of([&] { RecordingReader reader(folder_); }), HasSubstr("cannot be read"));
    ASSERT_EQ(mkfifo((folder_ / "pipe.rec").c_str(), 0600), 0);
    EXPECT_THAT(error_of([&] { RecordingReader reader(folder_ / "pipe.rec"); }), HasSubstr("it is a pipe"));
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

// --- what a replay may have otherwise

void add_keys_beside_frames(const SectionField& section, const std::string& prefix,
                            std::vector<std::string>& keys) {
    for (const Field& field : section.fields) {
        if (!field.changes_frames)
            keys.push_back(prefix + field.key);
        else if (const std::optional<SectionField> nested = section_in(field))
            add_keys_beside_frames(*nested, prefix + field.key + ".", keys);
        else if (const auto* many = std::get_if<SectionsField>(&field.target))
            add_keys_beside_frames(many->append(), prefix + field.key + ".N.", keys);
    }
}

TEST(ScenarioListing, TheManualNamesTheKeysThatAReplayMayHaveOtherwise) {
    ScenarioConfig scenario;
    std::vector<std::string> keys;
    add_keys_beside_frames(section_of(scenario), "", keys);
    ASSERT_THAT(keys, testing::IsSupersetOf({"threads", "loop.priority", "more_cameras.N.outputs"}));
    std::string list;
    for (const std::string& key : keys) list += (list.empty() ? "`" : ", `") + key + "`";
    std::ifstream in(HILCAM_SOURCE_DIR "/docs/recording.md");
    std::string manual{std::istreambuf_iterator<char>(in), {}};
    std::replace(manual.begin(), manual.end(), '\n', ' ');
    EXPECT_THAT(manual, HasSubstr("differ: " + list + "."));
}

TEST(ScenarioListing, HasNothingOfHowTheMachineIsUsed) {
    ScenarioConfig here;
    here.more_cameras.resize(1);
    ScenarioConfig there = here;
    there.name = "another", there.threads = 3, there.clock.paused = true;
    there.loop.prefer = LoopPreference::kLatency;
    there.loop.real_time = {50, {0, 1}, true};
    there.outputs.give<FilesConfig>(), there.more_cameras[0].outputs.give<FilesConfig>();
    there.commands.has_udp = true;
    there.telemetry.emplace();
    there.faults.resize(1), there.events.resize(1);
    EXPECT_EQ(listing_difference(scenario_listing(there), scenario_listing(here)), "");
    there.loop.frame_budget_s = 0.01;
    EXPECT_THAT(listing_difference(scenario_listing(there), scenario_listing(here)),
                HasSubstr("loop.frame_budget_ms: '10' there, 'auto' here"));
    there.loop.frame_budget_s = here.loop.frame_budget_s;
    there.loop.levels_fixed = true;
    EXPECT_THAT(listing_difference(scenario_listing(there), scenario_listing(here)),
                HasSubstr("loop.levels: 'fixed' there"));
}

TEST(RecordingWarnings, TerrainThatFramesDoNotWaitForIsOne) {
    ScenarioConfig scenario;
    EXPECT_TRUE(recording_warnings(scenario).empty());
    scenario.terrain.emplace();
    ASSERT_FALSE(scenario.terrain->wait);
    ASSERT_EQ(recording_warnings(scenario).size(), 1u);
    EXPECT_THAT(recording_warnings(scenario)[0], HasSubstr("'terrain.wait: true'"));
    scenario.terrain->wait = true;
    EXPECT_TRUE(recording_warnings(scenario).empty());
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
              "replays it anyway");
    EXPECT_EQ(check_recording(other, "a.rec", own, true).size(), 1u);
    other = own;
    other.program = "hilcam 0.0.1";
    EXPECT_THAT(refusal(), HasSubstr("was recorded by 'hilcam 0.0.1', this is 'hilcam test'"));
    other = own;
    other.build = 2, other.processor = "another";
    EXPECT_EQ(check_recording(other, "a.rec", own, false).size(), 2u);  // said, not refused
}

}  // namespace
}  // namespace hilcam
