#include "tests/realtime/watched_run.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "emulator/run/emulator.h"
#include "tests/realtime/allocation_guard.h"
#include "tests/realtime/frame_readers.h"

namespace hilcam {
namespace {

// Bytes that the process has read so far (proc(5), /proc/pid/io), and the readers of maps that it has started.
std::uint64_t bytes_read() {
    const auto read_by = [](const std::string& process) {
        std::string name;
        std::uint64_t bytes = 0;
        std::ifstream("/proc/" + process + "/io") >> name >> bytes;  // "rchar:", the first line
        return bytes;
    };
    std::uint64_t bytes = read_by("self");
    for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream children(thread.path() / "children");
        for (std::string child; children >> child;) bytes += read_by(child);
    }
    return bytes;
}

RunLimits limits_of(Loop loop, const std::filesystem::path& record) {
    RunLimits limits;
    limits.frames = loop == Loop::kStreaming ? 300 : loop == Loop::kLookedAt ? 150 : 80;
    limits.paced = loop != Loop::kUnpaced && loop != Loop::kTold;
    limits.outputs = loop == Loop::kStreaming || loop == Loop::kLookedAt || loop == Loop::kTold;
    limits.record = record;
    return limits;
}

// A rate that no frame holds, and one that all hold, for five frames each.
void change_rate(Emulator& emulator) {
    SettingsChange change;
    change.frame_rate_hz = emulator.loop().counters().frames / 5 % 2 == 0 ? 5000 : 2;
    if (emulator.first().settings().settings().frame_rate_hz == *change.frame_rate_hz) return;
    EXPECT_TRUE(emulator.first().settings().change(change));
}

// Those who take a run's frames; made, they have got some.
class Readers {
  public:
    Readers(Loop loop, const FrameLoop& watched) {
        if (loop == Loop::kStreaming) {
            stream_.emplace();
            int packets = 0;
            for (int i = 0; i < 5000 && packets == 0; ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                packets += stream_->drain();
            }
            EXPECT_GT(packets, 0);
        }
        if (loop == Loop::kLookedAt) {
            viewer_.emplace();
            while ((viewer_->with_truth() < 2 || viewer_->of_light() < 2) && !watched.finished())
                std::this_thread::yield();
            seen_ = viewer_->with_truth(), of_light_ = viewer_->of_light();
            EXPECT_GE(seen_, 2);
            EXPECT_GE(of_light_, 2);
        }
    }
    bool any() const { return stream_ || viewer_; }
    void take() {
        if (stream_) packets_ += stream_->drain();
    }
    // They have got more since.
    void leave() {
        // A leader, a trailer and one packet at the least, of each frame that the machine had time to send.
        if (stream_) {
            EXPECT_GE(packets_, 10 * 3);
        }
        if (viewer_) {
            EXPECT_GT(viewer_->with_truth(), seen_);
            EXPECT_GT(viewer_->of_light(), of_light_ + 1);  // one of them began before the watch
        }
        viewer_.reset();
    }

  private:
    std::optional<StreamReader> stream_;
    std::optional<PreviewReader> viewer_;
    int packets_ = 0, seen_ = 0, of_light_ = 0;
};

}  // namespace

Seen watch_run(const std::vector<std::string>& overrides, Loop loop, const std::filesystem::path& record,
               const char* scenario_file) {
    ScenarioConfig scenario = load_scenario(std::string(HILCAM_SOURCE_DIR) + "/" + scenario_file, overrides);
    scenario.loop.holds_rate = loop == Loop::kGoverned;
    Emulator emulator(scenario, limits_of(loop, record));
    std::thread runner([&] { emulator.run([] {}); });
    const LoopCounters& counters = emulator.loop().counters();
    while (counters.frames < 20 && !emulator.loop().finished()) std::this_thread::yield();
    Readers readers(loop, emulator.loop());
    const std::uint64_t until = readers.any() ? counters.frames + 50 : 70;
    const std::uint32_t changes = counters.level_changes;
    const std::uint64_t read = bytes_read();
    arm_allocation_guard();
    Motion motion;
    motion.pose.position_world_m = {22, 15, 7};
    for (std::uint32_t i = 0; counters.frames < until && !emulator.loop().finished(); ++i) {
        motion.time = emulator.clock().now();
        motion.rate_body_rad_s = scenario.camera_pose.rate_body_rad_s;
        if (!scenario.camera_motion) emulator.world().set(0, motion, {i, monotonic_ns()});
        if (loop == Loop::kGoverned) change_rate(emulator);
        readers.take();
        std::this_thread::yield();
    }
    const Allocations counted = counted_allocations();
    const std::uint64_t read_meanwhile = bytes_read() - read;
    const std::uint64_t measured = counters.frames;
    readers.leave();
    const std::uint32_t changed = counters.level_changes - changes;
    runner.join();
    EXPECT_GE(measured, until);
    return {counted.own, counted.terrain, read_meanwhile, changed};
}

}  // namespace hilcam
