#include "emulator/recording/recorder.h"

#include <fcntl.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "emulator/recording/recording_codec.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kBufferBytes = 1u << 16;
constexpr auto kPause = std::chrono::milliseconds(10);

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, const RecordingHeader& header)
    : name_(file.string()),
      queue_(std::make_unique<BoundedQueue<Record, kQueueLength>>()),
      buffer_(kBufferBytes) {
    const std::vector<std::uint8_t> first = encode_header(header);
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    file_ = Fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (!file_) throw DeviceError("recording " + name_ + " cannot be made: " + std::strerror(errno));
    buffer_.assign(kRecordingMagic.begin(), kRecordingMagic.end());
    buffer_.insert(buffer_.end(), first.begin(), first.end());
    filled_ = buffer_.size();
    flush();
    buffer_.resize(kBufferBytes);
    if (failed_) throw DeviceError(fault_);
}

void Recorder::start() {
    thread_ = std::thread([this] { run(); });
}

void Recorder::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_.store(true);
    thread_.join();
}

void Recorder::run() {
    while (!stopping_.load()) {
        drain();
        std::this_thread::sleep_for(kPause);
    }
    drain();
    write(RecordedEnd{monotonic_ns()});
    flush();
}

void Recorder::drain() {
    Record record;
    while (queue_->pop(record)) {
        // Any record that was put in after a lost one comes after the loss, because the thread that lost it
        // counted the loss before it went on.
        const std::uint64_t lost = lost_.load(std::memory_order_acquire);
        if (lost != lost_told_) write(RecordedLoss{lost - lost_told_});
        lost_told_ = lost;
        write(record);
        if (std::holds_alternative<RecordedFrame>(record)) frames_.fetch_add(1, std::memory_order_relaxed);
        if (std::holds_alternative<RecordedCommand>(record))
            commands_.fetch_add(1, std::memory_order_relaxed);
    }
    flush();
}

void Recorder::write(const Record& record) {
    constexpr std::size_t kMax = kRecordPrefixBytes + kMaxRecordBytes;
    if (buffer_.size() - filled_ < kMax) flush();
    filled_ += encode_record(record, std::span(buffer_).subspan(filled_, kMax));
}

// Writes the queue. After an error it writes nothing more, so the file ends with a whole record or within
// one.
void Recorder::flush() {
    std::size_t done = 0;
    while (done < filled_ && !failed_.load(std::memory_order_relaxed)) {
        const ssize_t count = ::write(file_.get(), buffer_.data() + done, filled_ - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            const std::lock_guard lock(mutex_);
            fault_ = "recording " + name_ + " cannot be written: " + std::strerror(errno);
            failed_.store(true);
            break;
        }
        done += static_cast<std::size_t>(count);
    }
    bytes_.fetch_add(done, std::memory_order_relaxed);
    filled_ = 0;
}

RecorderReport Recorder::report() const {
    const std::lock_guard lock(mutex_);
    RecorderReport report{name_, frames_.load(), commands_.load(), bytes_.load(), lost_.load(), fault_};
    if (report.fault.empty() && report.lost > 0)
        report.fault = "recording " + name_ + ": " + std::to_string(report.lost) +
                       " records were lost, the disk is too slow; a replay ends at the first";
    return report;
}

}  // namespace hilcam
