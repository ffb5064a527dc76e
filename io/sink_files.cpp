#include "io/sink_files.h"

#include <cstdio>

#include "io/image_file.h"
#include "render/check.h"

namespace hilcam {

Fields fields(FilesConfig& c) {
    return {
        path("folder", c.folder, "made when missing"),
        choice("format", c.format, {"png", "tiff"}, "kind of picture"),
        integer("every_nth", c.every_nth, {1, 1e9}, "write every n-th frame only"),
    };
}

FilesSink::FilesSink(const FilesConfig& config, int width, int height)
    : config_(config), mailbox_(width, height, 8) {}

void FilesSink::start() {
    std::error_code error;
    std::filesystem::create_directories(config_.folder, error);
    if (error)
        throw DeviceError("outputs.files.folder " + config_.folder.string() +
                          " cannot be made: " + error.message());
    thread_ = std::thread([this] { run(); });
}

void FilesSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    if (offered_++ % static_cast<std::uint64_t>(config_.every_nth) == 0) mailbox_.put(frame, record);
}

void FilesSink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        char name[64];
        std::snprintf(name, sizeof name, "frame_%08llu.%s", static_cast<unsigned long long>(item->record.id),
                      config_.format == FilesConfig::Format::kPng ? "png" : "tiff");
        try {
            write_frame(config_.folder / name, item->frame);
            written_.fetch_add(1);
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            fault_ = error.what();
        }
        mailbox_.done();
    }
}

void FilesSink::stop() noexcept {
    if (!thread_.joinable()) return;
    mailbox_.close();
    thread_.join();
}

SinkReport FilesSink::report() const {
    const std::lock_guard lock(mutex_);
    return {"files " + config_.folder.string(), written_.load(), mailbox_.dropped(), fault_};
}

}  // namespace hilcam
