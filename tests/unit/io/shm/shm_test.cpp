// The shared memory of outputs.shm, read by the C header that readers copy (tools/client/hilcam_shm.h).

#include "tools/client/hilcam_shm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstring>
#include <fstream>
#include <thread>

#include "io/shm/sink_shm.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StrEq;

// What the header reads is what the sink writes.
static_assert(sizeof(hilcam_shm_report) == sizeof(ShmSlot) - 8);
#define HILCAM_SAME_PLACE(mine, theirs) \
    static_assert(offsetof(hilcam_shm_report, mine) + 8 == offsetof(ShmSlot, theirs))
HILCAM_SAME_PLACE(id, id);
HILCAM_SAME_PLACE(published_monotonic_ns, published_monotonic_ns);
HILCAM_SAME_PLACE(black_level_dn, black_level_dn);
HILCAM_SAME_PLACE(row_bytes, row_bytes);
HILCAM_SAME_PLACE(pose_tai_ns, pose_tai_ns);
HILCAM_SAME_PLACE(flags, flags);
HILCAM_SAME_PLACE(camera_attitude_wxyz, camera_attitude_wxyz);
static_assert(offsetof(ShmHeader, news) == 200 && offsetof(ShmHeader, ended) == 204);

std::string own_name(const char* what) {
    return "hilcam_test_" + std::string(what) + std::to_string(getpid());
}
std::string path_of(const std::string& name) { return "/dev/shm/" + name; }

ShmSink shm_sink(const std::string& name, std::int64_t slots = 4, int width = 64, int height = 48) {
    ShmConfig config;
    config.name = name, config.slots = slots;
    return ShmSink(config, width, height, "a camera", "RGGB", nullptr);
}
// Pixels all have the number, so that a mixture of two frames shows.
DnImage even_frame(std::uint16_t value, int width = 64, int height = 48) {
    DnImage frame(width, height);
    std::fill(frame.all().begin(), frame.all().end(), value);
    return frame;
}
FrameRecord report_record(std::uint64_t id) {
    FrameRecord r;
    r.id = id;
    r.bits = 12;
    r.exposure_mid.ns = 1'000'000'007;
    r.exposure_s = 0.25, r.gain_db = 3, r.black_level_dn = 64;
    r.pose_sequence = 17, r.trigger_sequence = 19, r.pose_time.ns = 23;
    r.faults = std::uint64_t{1} << 60;
    r.reverse_y = true;
    r.camera = Pose{{1, -2, 3}, {0.5, 0.5, -0.5, 0.5}};
    return r;
}
std::string start_error(ShmSink& sink) {
    try {
        sink.start();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "none";
}

TEST(Shm, AReaderFindsTheFrameAndItsReport) {
    ShmSink sink = shm_sink(own_name("report"));
    sink.start();
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, own_name("report").c_str()), nullptr);
    EXPECT_EQ(hilcam_shm_newest(&ring), 0U);
    EXPECT_EQ(hilcam_shm_wait(&ring, 0, 1), HILCAM_SHM_NOTHING);
    DnImage frame = even_frame(5, 32, 8);  // smaller than the largest: binning
    frame.row(7)[31] = 4095;
    sink.publish(frame, report_record(41));
    ASSERT_EQ(hilcam_shm_wait(&ring, 0, 1000), HILCAM_SHM_NEW);
    hilcam_shm_frame seen;
    ASSERT_EQ(hilcam_shm_get(&ring, 1, &seen), 1);
    EXPECT_EQ(hilcam_shm_get(&ring, 2, &seen), 0);
    EXPECT_EQ(seen.report.id, 41U);
    EXPECT_EQ(seen.report.width_px, 32U);
    EXPECT_EQ(seen.report.height_px, 8U);
    EXPECT_EQ(seen.pixels[0], 5);
    EXPECT_EQ(seen.pixels[7 * 32 + 31], 4095);
    EXPECT_EQ(seen.report.bits, 12U);
    EXPECT_EQ(seen.report.exposure_mid_tai_ns, 1'000'000'007);
    EXPECT_EQ(seen.report.exposure_s, 0.25);
    EXPECT_EQ(seen.report.gain_db, 3);
    EXPECT_EQ(seen.report.black_level_dn, 64);
    EXPECT_EQ(seen.report.pose_sequence, 17U);
    EXPECT_EQ(seen.report.trigger_sequence, 19U);
    EXPECT_EQ(seen.report.pose_tai_ns, 23);
    EXPECT_EQ(seen.report.faults, std::uint64_t{1} << 60);
    EXPECT_EQ(seen.report.flags, std::uint32_t{HILCAM_SHM_REVERSE_Y | HILCAM_SHM_HAS_POSE});
    EXPECT_EQ(seen.report.camera_position_m[1], -2);
    EXPECT_EQ(seen.report.camera_attitude_wxyz[2], -0.5);
    EXPECT_TRUE(hilcam_shm_is_whole(&seen));
    sink.stop();
    EXPECT_EQ(hilcam_shm_wait(&ring, 1, 1000), HILCAM_SHM_ENDED);
    EXPECT_EQ(seen.pixels[0], 5);  // what is mapped stays
    hilcam_shm again;
    EXPECT_THAT(hilcam_shm_open(&again, own_name("report").c_str()), HasSubstr("no such shared memory"));
    hilcam_shm_close(&ring);
}

// docs/shared_memory.md, "Layout".
TEST(Shm, EveryFieldIsWhereThePageHasIt) {
    EXPECT_EQ(offsetof(ShmHeader, magic), 0u);
    EXPECT_EQ(offsetof(ShmHeader, version), 8u);
    EXPECT_EQ(offsetof(ShmHeader, header_bytes), 12u);
    EXPECT_EQ(offsetof(ShmHeader, slots), 16u);
    EXPECT_EQ(offsetof(ShmHeader, slot_header_bytes), 20u);
    EXPECT_EQ(offsetof(ShmHeader, slot_bytes), 24u);
    EXPECT_EQ(offsetof(ShmHeader, segment_bytes), 32u);
    EXPECT_EQ(offsetof(ShmHeader, max_width_px), 40u);
    EXPECT_EQ(offsetof(ShmHeader, max_height_px), 44u);
    EXPECT_EQ(offsetof(ShmHeader, pixel_bytes), 48u);
    EXPECT_EQ(offsetof(ShmHeader, writer_pid), 52u);
    EXPECT_EQ(offsetof(ShmHeader, camera), 64u);
    EXPECT_EQ(offsetof(ShmHeader, colors), 128u);
    EXPECT_EQ(offsetof(ShmHeader, published), 192u);
    EXPECT_EQ(offsetof(ShmHeader, news), 200u);
    EXPECT_EQ(offsetof(ShmHeader, ended), 204u);
    EXPECT_EQ(offsetof(ShmSlot, sequence), 0u);
    EXPECT_EQ(offsetof(ShmSlot, id), 8u);
    EXPECT_EQ(offsetof(ShmSlot, exposure_mid_tai_ns), 16u);
    EXPECT_EQ(offsetof(ShmSlot, exposure_mid_monotonic_ns), 24u);
    EXPECT_EQ(offsetof(ShmSlot, published_monotonic_ns), 32u);
    EXPECT_EQ(offsetof(ShmSlot, exposure_s), 40u);
    EXPECT_EQ(offsetof(ShmSlot, gain_db), 48u);
    EXPECT_EQ(offsetof(ShmSlot, black_level_dn), 56u);
    EXPECT_EQ(offsetof(ShmSlot, bits), 64u);
    EXPECT_EQ(offsetof(ShmSlot, width_px), 68u);
    EXPECT_EQ(offsetof(ShmSlot, height_px), 72u);
    EXPECT_EQ(offsetof(ShmSlot, row_bytes), 76u);
    EXPECT_EQ(offsetof(ShmSlot, binning_x), 80u);
    EXPECT_EQ(offsetof(ShmSlot, binning_y), 84u);
    EXPECT_EQ(offsetof(ShmSlot, pose_sequence), 88u);
    EXPECT_EQ(offsetof(ShmSlot, trigger_sequence), 92u);
    EXPECT_EQ(offsetof(ShmSlot, pose_tai_ns), 96u);
    EXPECT_EQ(offsetof(ShmSlot, faults), 104u);
    EXPECT_EQ(offsetof(ShmSlot, quality_level), 112u);
    EXPECT_EQ(offsetof(ShmSlot, flags), 116u);
    EXPECT_EQ(offsetof(ShmSlot, command_arrival_monotonic_ns), 120u);
    EXPECT_EQ(offsetof(ShmSlot, camera_position_m), 128u);
    EXPECT_EQ(offsetof(ShmSlot, camera_attitude_wxyz), 152u);
}

// Whatever the mask of the shell that started it: readers of other users may map it, and only read.
TEST(Shm, EverybodyMayReadItAndItsOwnerAloneWrites) {
    for (const mode_t mask : {0077u, 0u}) {
        const mode_t before = umask(mask);
        ShmSink sink = shm_sink(own_name("mode"));
        sink.start();
        struct stat file {};
        EXPECT_EQ(stat(path_of(own_name("mode")).c_str(), &file), 0);
        EXPECT_EQ(file.st_mode & 0777u, 0644u) << "mask " << mask;
        umask(before);
    }
}

TEST(Shm, NumbersHaveNoGapsWhereIdsDo) {
    ShmSink sink = shm_sink(own_name("gaps"), 3);
    sink.start();
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, own_name("gaps").c_str()), nullptr);
    std::uint64_t number = 0;
    for (const std::uint64_t id : {4u, 5u, 9u, 20u}) {
        sink.publish(even_frame(static_cast<std::uint16_t>(id)), report_record(id));
        EXPECT_EQ(hilcam_shm_newest(&ring), ++number);
        hilcam_shm_frame seen;
        ASSERT_EQ(hilcam_shm_get(&ring, number, &seen), 1);
        EXPECT_EQ(seen.report.id, id);
    }
    hilcam_shm_close(&ring);
}

TEST(Shm, AFrameThatWasOvertakenIsToldApart) {
    ShmSink sink = shm_sink(own_name("overtaken"), 3);
    sink.start();
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, own_name("overtaken").c_str()), nullptr);
    sink.publish(even_frame(1), report_record(1));
    hilcam_shm_frame first;
    ASSERT_EQ(hilcam_shm_get(&ring, 1, &first), 1);
    for (std::uint16_t n = 2; n <= 3; ++n) sink.publish(even_frame(n), report_record(n));
    EXPECT_TRUE(hilcam_shm_is_whole(&first));
    sink.publish(even_frame(4), report_record(4));  // into its slot
    EXPECT_FALSE(hilcam_shm_is_whole(&first));
    EXPECT_EQ(hilcam_shm_get(&ring, 1, &first), 0);
    ASSERT_EQ(hilcam_shm_get(&ring, 4, &first), 1);
    EXPECT_EQ(first.report.id, 4U);
    hilcam_shm_close(&ring);
}

// Another thread writes as fast as it can. What a reader takes for whole is of one frame; a reader that does
// not ask sees mixtures, so the test can see them.
TEST(Shm, WhatIsWholeIsOneFrame) {
    ShmSink sink = shm_sink(own_name("torn"), 2, 256, 256);
    sink.start();
    std::atomic<bool> ends{false};
    std::thread writer([&] {
        for (std::uint16_t n = 1; !ends.load(); ++n) sink.publish(even_frame(n, 256, 256), report_record(n));
    });
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, own_name("torn").c_str()), nullptr);
    int whole = 0, torn = 0, lies = 0;
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while ((whole < 200 || torn < 5) && std::chrono::steady_clock::now() < until) {
        hilcam_shm_frame seen;
        if (!hilcam_shm_get(&ring, hilcam_shm_newest(&ring), &seen)) continue;
        bool is_one = true;
        for (int i = 0; i < 256 * 256; ++i) {
            const std::uint16_t value = *(static_cast<const volatile std::uint16_t*>(seen.pixels) + i);
            is_one = is_one && value == static_cast<std::uint16_t>(seen.report.id);
        }
        if (hilcam_shm_is_whole(&seen)) {
            ++whole;
            lies += is_one ? 0 : 1;
        } else {
            torn += is_one ? 0 : 1;
        }
    }
    ends.store(true);
    writer.join();
    hilcam_shm_close(&ring);
    EXPECT_EQ(lies, 0);
    EXPECT_GE(whole, 200);
    EXPECT_GE(torn, 5);
}

TEST(Shm, WhatAKilledProgramLeftIsReplacedAndItsReadersAreTold) {
    const std::string name = own_name("killed");
    const pid_t child = fork();
    if (child == 0) {
        ShmSink sink = shm_sink(name);
        sink.start();
        sink.publish(even_frame(7), report_record(7));
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    hilcam_shm old;
    ASSERT_EQ(hilcam_shm_open(&old, name.c_str()), nullptr);
    EXPECT_EQ(hilcam_shm_newest(&old), 1U);
    ShmSink sink = shm_sink(name);
    ASSERT_EQ(start_error(sink), "none");
    EXPECT_TRUE(hilcam_shm_has_ended(&old));
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, name.c_str()), nullptr);
    EXPECT_EQ(hilcam_shm_newest(&ring), 0U);
    hilcam_shm_close(&ring);
    hilcam_shm_close(&old);
}

TEST(Shm, AReaderThatWaitsLearnsThatTheWriterWasKilled) {
    const std::string name = own_name("abandoned");
    std::array<int, 2> started{};
    ASSERT_EQ(pipe(started.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
        ShmSink sink = shm_sink(name);
        sink.start();
        sink.publish(even_frame(7), report_record(7));
        [[maybe_unused]] const auto told = ::write(started[1], "x", 1);
        while (true) pause();
    }
    char byte = 0;
    ASSERT_EQ(::read(started[0], &byte, 1), 1);
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, name.c_str()), nullptr);
    EXPECT_FALSE(hilcam_shm_has_ended(&ring));
    EXPECT_EQ(hilcam_shm_wait(&ring, 1, 1), HILCAM_SHM_NOTHING);
    int end = HILCAM_SHM_NOTHING;
    std::thread reader([&] { end = hilcam_shm_wait(&ring, 1, 600'000); });
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    reader.join();
    EXPECT_EQ(end, HILCAM_SHM_ENDED);
    EXPECT_TRUE(hilcam_shm_has_ended(&ring));
    hilcam_shm_close(&ring);
    unlink(path_of(name).c_str());
    for (const int end_of_pipe : started) close(end_of_pipe);
}

// Whoever cleans /dev/shm (logind does, when a user leaves) takes the name away, and the next camera takes it.
TEST(Shm, TheEndOfOneLeavesTheMemoryOfAnother) {
    const std::string name = own_name("reused");
    ShmSink first = shm_sink(name), second = shm_sink(name);
    first.start();
    ASSERT_EQ(unlink(path_of(name).c_str()), 0);
    second.start();
    first.stop();
    hilcam_shm ring;
    ASSERT_EQ(hilcam_shm_open(&ring, name.c_str()), nullptr) << "the second one's is still there";
    second.publish(even_frame(1), report_record(1));
    EXPECT_EQ(hilcam_shm_newest(&ring), 1U);
    EXPECT_FALSE(hilcam_shm_has_ended(&ring));
    second.stop();
    EXPECT_TRUE(hilcam_shm_has_ended(&ring));
    hilcam_shm_close(&ring);
    EXPECT_FALSE(std::ifstream(path_of(name)).good());
}

TEST(Shm, AnothersNameIsRefused) {
    const std::string name = own_name("other");
    ShmSink first = shm_sink(name), second = shm_sink(name);
    first.start();
    EXPECT_EQ(start_error(second), "outputs.shm.name: found '" + name + "', which process " +
                                       std::to_string(getpid()) +
                                       " writes; accepted: a name of its own for each camera");
    second.publish(even_frame(1), report_record(1));
    EXPECT_EQ(second.report().dropped, 1U);
    second.stop();
    hilcam_shm ring;
    EXPECT_EQ(hilcam_shm_open(&ring, name.c_str()), nullptr) << "the first one's is still there";
    hilcam_shm_close(&ring);
    first.stop();
    std::ofstream(path_of(name)) << "somebody's own";
    EXPECT_THAT(start_error(second), HasSubstr("a shared memory that hilcam has not made"));
    EXPECT_TRUE(std::ifstream(path_of(name)).good());
    unlink(path_of(name).c_str());
}

TEST(Shm, NoRoomIsOneMessageAndLeavesNothing) {
    const std::string name = own_name("room");
    ShmSink sink = shm_sink(name, 1024, 60000, 60000);  // 7.4 TB
    EXPECT_THAT(start_error(sink),
                AllOf(HasSubstr("/dev/shm has no room for 7372"), HasSubstr("fewer outputs.shm.slots")));
    EXPECT_FALSE(std::ifstream(path_of(name)).good());
}

TEST(Shm, NamesThatAreNoneAreRefused) {
    for (const char* name : {"", ".hidden", "a/b", "with space"}) {
        ShmConfig config;
        config.name = name;
        EXPECT_THROW(validate(config), InputError) << name;
    }
    validate(ShmConfig{});
}

TEST(Shm, AReaderRefusesWhatItDoesNotKnow) {
    const std::string name = own_name("version");
    ShmSink sink = shm_sink(name);
    sink.start();
    std::ifstream file(path_of(name), std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(file)), {});
    const auto answer = [&](std::size_t place, char value, std::size_t size) {
        std::vector<std::uint64_t> words((good.size() + 7) / 8);
        std::memcpy(words.data(), good.data(), good.size());
        reinterpret_cast<char*>(words.data())[place] = value;
        hilcam_shm ring;
        const char* problem = hilcam_shm_use(&ring, words.data(), size);
        return std::string(problem ? problem : "none");
    };
    EXPECT_EQ(answer(8, 1, good.size()), "none");
    EXPECT_EQ(answer(8, 2, good.size()), "version 2 of hilcam's shared memory; accepted: 1");
    EXPECT_EQ(answer(0, 'X', good.size()), "not a shared memory of hilcam's");
    EXPECT_EQ(answer(8, 1, 100), "too short for a shared memory of hilcam's");
    EXPECT_EQ(answer(8, 1, good.size() - 4096), "its header's figures do not fit its size");
    EXPECT_EQ(answer(16, 5, good.size()), "its header's figures do not fit its size");
}

}  // namespace
}  // namespace hilcam
