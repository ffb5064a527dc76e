#pragma once
// Frames as files in a folder, "frame_00000001.png", 16 bits right-aligned.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <thread>

#include "io/frame_mailbox.h"
#include "render/config_field.h"

namespace hilcam {

struct FilesConfig {
    enum class Format { kPng, kTiff } format = Format::kPng;
    std::filesystem::path folder = "frames";
    std::int64_t every_nth = 1;
};
Fields fields(FilesConfig& config);

class FilesSink : public FrameSink {
  public:
    FilesSink(const FilesConfig& config, int width, int height);
    ~FilesSink() override { stop(); }

    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;

  private:
    void run();

    FilesConfig config_;
    FrameMailbox mailbox_;
    std::thread thread_;
    std::uint64_t offered_ = 0;
    std::atomic<std::uint64_t> written_{0};
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace hilcam
