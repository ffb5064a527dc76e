#pragma once
// Frames as files in a folder, "frame_00000001.png", 16 bits right-aligned; or ".raw", the bytes of the
// camera's memory. A frame that cannot be written leaves no file; the next is tried all the same, as a disk
// may be emptied.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <thread>

#include "io/contract/frame_mailbox.h"
#include "io/contract/run_folder.h"
#include "render/vocabulary/config_field.h"
#include "sensor/packing.h"

namespace hilcam {

struct FilesConfig {
    enum class Format { kPng, kTiff, kRaw } format = Format::kPng;
    std::filesystem::path folder = "frames";
    std::int64_t every_nth = 1;
    bool overwrite = false;
};
// What of it must not be mixed with another run.
RunFolder run_folder(const FilesConfig& config);
Fields fields(FilesConfig& config);

class FilesSink : public FrameSink {
  public:
    // Throws InputError when the folder holds another run's frames.
    FilesSink(const FilesConfig& config, int width, int height, const PixelLayout& layout);
    ~FilesSink() override { stop(); }

    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override { return mailbox_.has_room(); }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;

  private:
    void run();

    FilesConfig config_;
    PixelLayout layout_;
    FrameMailbox mailbox_;
    std::thread thread_;
    std::uint64_t offered_ = 0;
    std::atomic<std::uint64_t> written_{0};
    mutable std::mutex mutex_;
    std::uint64_t failed_ = 0;  // frames that could not be written
    std::string first_failure_;
};

}  // namespace hilcam
