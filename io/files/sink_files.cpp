#include "io/files/sink_files.h"

#include <array>
#include <cstdio>

#include "io/files/image_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

constexpr std::array<const char*, 3> kEndings = {"png", "tiff", "raw"};  // by format

}  // namespace

Fields fields(FilesConfig& c) {
    return {
        path("folder", c.folder, "made when missing"),
        choice("format", c.format, {"png", "tiff", "raw"},
               "kind of picture; raw: the camera's memory, packed as it says"),
        integer("every_nth", c.every_nth, {1, 1e9}, "write every n-th frame only"),
        flag("overwrite", c.overwrite,
             "a folder that holds another run's frames: false: is refused; true: they are removed first"),
    };
}

RunFolder run_folder(const FilesConfig& c) {
    return {.key = "outputs.files", .folder = c.folder, .stem = "frame", .overwrite = c.overwrite};
}

FilesSink::FilesSink(const FilesConfig& config, int width, int height, const PixelLayout& layout)
    : config_(config), layout_(layout), mailbox_(width, height, 8) {
    require_unused(run_folder(config_));
}

void FilesSink::start() {
    claim(run_folder(config_));
    mailbox_.open();
    thread_ = std::thread([this] { run(); });
}

void FilesSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    if (offered_++ % static_cast<std::uint64_t>(config_.every_nth) == 0) mailbox_.put(frame, record);
}

void FilesSink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        char name[64];
        std::snprintf(name, sizeof name, "frame_%08llu.%s", static_cast<unsigned long long>(item->record.id),
                      kEndings[static_cast<std::size_t>(config_.format)]);
        try {
            if (config_.format == FilesConfig::Format::kRaw)
                write_raw(config_.folder / name, item->frame, layout_);
            else
                write_frame(config_.folder / name, item->frame);
            written_.fetch_add(1);
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            if (failed_++ == 0) first_failure_ = error.what();
        }
        mailbox_.done();
    }
}

void FilesSink::stop() noexcept {
    if (!thread_.joinable()) return;
    mailbox_.close();
    thread_.join();
}

bool FilesSink::has_fault() const noexcept {
    const std::lock_guard lock(mutex_);
    return failed_ > 0;
}

SinkReport FilesSink::report() const {
    const std::lock_guard lock(mutex_);
    SinkReport out{"files " + config_.folder.string(), written_.load(), mailbox_.dropped() + failed_, {}};
    if (failed_ > 0)
        out.fault =
            first_failure_ + (failed_ == 1 ? " (1 frame lost)"
                                           : " (the first of " + std::to_string(failed_) + " frames lost)");
    return out;
}

}  // namespace hilcam
