#pragma once
// Writes a recording while the run goes on.
//
// A thread with something to record puts it into a queue and goes on, without lock, allocation or wait. The
// recorder's own thread writes the queue to the file every 10 ms, so a killed program loses only the newest
// records. If the disk is too slow and the queue is full, records are lost and counted. The file says where,
// and a replay ends there. The run is not disturbed.

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
    std::uint64_t lost = 0;  // lost records
    std::string fault;       // why the recording is incomplete; empty: it is complete
};

class Recorder : public FrameRecorder {
  public:
    // Creates the file and writes its header. Throws DeviceError, or InputError for a scenario that is too
    // long.
    Recorder(const std::filesystem::path& file, const RecordingHeader& header);
    ~Recorder() override { stop(); }

    void start();
    // Writes the rest of the queue. Idempotent.
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
    // Returns the number of the next command. Callers that add commands take turns.
    std::uint64_t next_number() noexcept { return ++numbers_; }

    // Any thread.
    RecorderReport report() const;

  private:
    static constexpr std::size_t kQueueLength = 16384;  // records: 8 s, with a command and a frame every ms

    void run();
    void drain();
    void write(const Record& record);
    void flush();

    std::string name_;
    Fd file_;
    std::unique_ptr<BoundedQueue<Record, kQueueLength>> queue_;
    std::atomic<std::uint64_t> lost_{0};
    std::uint64_t numbers_ = 0;
    // Used by the writing thread alone.
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
