#include "io/files/sink_files.h"

#include <array>

#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

const char* ending_of(FilesConfig::Format format) {
    constexpr std::array<const char*, 4> kEndings = {".png", ".tiff", ".raw", ".fits"};
    return kEndings[static_cast<std::size_t>(format)];
}

}  // namespace

Fields fields(FilesConfig& c) {
    return {
        path("folder", c.folder, "folder of the pictures, created if missing"),
        choice("format", c.format, {"png", "tiff", "raw", "fits"},
               "picture format (docs/pictures.md); raw: the camera's memory in its own packing"),
        text("name", c.name,
             "name of each file: %08d or {frame:8} is the frame's number; also {camera}, {camera_name}, "
             "{time_tai_ns}"),
        flag("view", c.view, "true: each frame also has an 8-bit picture to look at, NAME.view.png"),
        flag("label", c.label, "true: each FITS file also has a PDS4 label, NAME.xml"),
        integer("every_nth", c.every_nth, {1, 1e9}, "number n of which every n-th frame is written"),
        flag("overwrite", c.overwrite,
             "treatment of a folder with frames of another run. false: it is refused; true: the frames are "
             "removed first"),
        when_slow(c.when_slow),
    };
}

RunFolder run_folder(const FilesConfig& c) {
    return {.key = "outputs.files",
            .folder = c.folder,
            .is_own = [names = FileNamePattern(c.name, ending_of(c.format))](
                          std::string_view name) { return names.may_have_named(name); },
            .overwrite = c.overwrite};
}

void validate(const FilesConfig& c) {
    [[maybe_unused]] const FileNamePattern names(c.name, ending_of(c.format));  // throws for a bad one
    if (c.label && c.format != FilesConfig::Format::kFits)
        throw KeyError("label", "describes FITS files; accepted: with format: fits, or no 'label'");
}

std::string dark_picture_warning(const FilesConfig& c, int bits) {
    if (c.view) return {};
    return dark_picture_warning(c.folder / ("*" + std::string(ending_of(c.format))), bits,
                                "outputs.files.view: true writes pictures to look at beside them");
}

FilesSink::FilesSink(const FilesConfig& config, int width, int height, const PictureRun& run, bool waits,
                     FrameFates* fates)
    : config_(config),
      waits_(waits),
      fates_(fates),
      names_(config.name, ending_of(config.format)),
      camera_{run.camera, run.model.name},
      writer_(run),
      mailbox_(width, height, 8) {
    require_unused(run_folder(config_));
}

void FilesSink::start() {
    claim(run_folder(config_));
    mailbox_.open();
    thread_ = std::thread([this] { run(); });
}

void FilesSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    if (offered_++ % static_cast<std::uint64_t>(config_.every_nth) != 0) return;
    if (fates_) fates_->expect(record.id);  // the writing thread may finish the frame before put() returns
    if (!mailbox_.put(frame, record) && fates_) fates_->settle(record.id, false);
}

void FilesSink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        bool written = false;
        try {
            write(*item);
            written = true;
            written_.fetch_add(1);
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            if (failed_++ == 0) first_failure_ = plain_words(error), first_failed_ = item->record.id;
        }
        if (fates_) fates_->settle(item->record.id, written);
        mailbox_.done();
    }
}

void FilesSink::write(const FrameMailbox::Item& item) {
    const std::string stem = names_.stem(item.record, camera_);
    writer_.write_frame(config_.folder / (stem + names_.ending()), item.frame, item.record);
    if (config_.label)
        writer_.write_label(config_.folder / (stem + names_.ending()), item.frame, item.record);
    if (config_.view) writer_.write_view(config_.folder / (stem + ".view.png"), item.frame, item.record);
}

void FilesSink::stop() noexcept {
    if (!thread_.joinable()) return;
    mailbox_.close();
    thread_.join();
}

bool FilesSink::has_fault() const noexcept {
    if (config_.when_slow != WhenSlow::kDrop && mailbox_.dropped() > 0) return true;
    const std::lock_guard lock(mutex_);
    return failed_ > 0;
}

// Reports files that could not be written before frames that came too fast.
std::string FilesSink::report_of_loss() const {
    if (failed_ > 0) return report_of_failures(first_failure_, failed_);
    const std::uint64_t dropped = mailbox_.dropped();
    return dropped == 0 || config_.when_slow == WhenSlow::kDrop
               ? ""
               : report_of_drops("outputs.files", config_.folder, dropped, written_.load());
}

SinkReport FilesSink::report() const {
    const std::lock_guard lock(mutex_);
    return {.name = "files " + config_.folder.string(),
            .frames = written_.load(),
            .dropped = mailbox_.dropped() + failed_,
            .fault = report_of_loss(),
            .first_dropped = first_of({mailbox_.first_dropped(), first_failed_})};
}

std::unique_ptr<FrameSink> make_sink(const FilesConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    return std::make_unique<FilesSink>(config, shape.width, shape.height, *shape.run,
                                       waits(config.when_slow, shape.has_live_output),
                                       context.fates ? context.fates->claim() : nullptr);
}

}  // namespace hilcam
