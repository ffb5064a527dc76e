#pragma once
// Writes a recording while the run goes on.
//
// Whoever has something to record puts it into a queue and goes on: no lock, no allocation, nobody waits. A
// thread of the recorder's own writes it to the file every 10 ms, so that a program that is killed leaves all
// but the newest of it. What the queue has no room for, because the disk is too slow, is counted; the file
// says where, and a replay ends there. The run is not disturbed.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator/loop/frame_recorder.h"
#include "emulator/recording/recording.h"
#include "io/system/bounded_queue.h"
#include "io/system/fd.h"

namespace hilcam {

struct RecorderReport {
    std::string file;
    std::uint64_t frames = 0, commands = 0, bytes = 0;
    std::uint64_t lost = 0;  // records
    std::string fault;       // empty, or why the recording is not complete
};

class Recorder : public FrameRecorder {
  public:
    // Makes the file, with its header. Throws DeviceError, or InputError for a scenario that is too long.
    Recorder(const std::filesystem::path& file, const RecordingHeader& header);
    ~Recorder() override { stop(); }

    void start();
    // Writes what is left; idempotent.
    void stop() noexcept;

    // Any thread; loop.
    void put(const Record& record) noexcept {
        if (!queue_->push(record)) lost_.fetch_add(1, std::memory_order_release);
    }
    void keep_shown(std::uint16_t camera, std::uint32_t thing, std::uint64_t number) noexcept override {
        put(RecordedShown{camera, thing, number});
    }
    void keep_frame(std::uint16_t camera, const FrameUse& use) noexcept override {
        put(RecordedFrame{camera, use});
    }
    // The number of the next command: by whoever puts commands in, one at a time.
    std::uint64_t next_number() noexcept { return ++numbers_; }

    // Any thread.
    RecorderReport report() const;

  private:
    static constexpr std::size_t kQueueLength = 16384;  // records: 8 s of a command and a frame per ms

    void run();
    void drain();
    void write(const Record& record);
    void flush();

    std::string name_;
    Fd file_;
    std::unique_ptr<BoundedQueue<Record, kQueueLength>> queue_;
    std::atomic<std::uint64_t> lost_{0};
    std::uint64_t numbers_ = 0;
    // The writing thread's.
    std::vector<std::uint8_t> buffer_;
    std::size_t filled_ = 0;
    std::uint64_t lost_told_ = 0;

    std::atomic<std::uint64_t> frames_{0}, commands_{0}, bytes_{0};
    mutable std::mutex mutex_;
    std::string fault_;
    std::atomic<bool> failed_{false}, stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
