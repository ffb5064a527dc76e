#pragma once
// Writes frames as files in a folder, "frame_00000001.png", each with its notes (image_file.h). On request it
// adds a picture for the eye, "frame_00000001.view.png", or a PDS4 label, "frame_00000001.xml". A frame that
// cannot be written leaves no file; the next one is tried all the same, because space may be freed.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "io/contract/frame_fates.h"
#include "io/contract/frame_mailbox.h"
#include "io/contract/output_shape.h"
#include "io/contract/run_folder.h"
#include "io/contract/when_slow.h"
#include "io/files/file_name_pattern.h"
#include "io/images/image_file.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct FilesConfig {
    static constexpr const char* kKey = "files";
    static constexpr const char* kMeaning = "frames as picture files";

    enum class Format { kPng, kTiff, kRaw, kFits } format = Format::kPng;
    std::filesystem::path folder = "frames";
    std::string name = "frame_%08d";  // file_name_pattern.h
    bool view = false;
    bool label = false;
    std::int64_t every_nth = 1;
    bool overwrite = false;
    WhenSlow when_slow = WhenSlow::kAuto;
};
// Returns the folder, which must not be mixed with another run's.
RunFolder run_folder(const FilesConfig& config);
Fields fields(FilesConfig& config);
void validate(const FilesConfig& config);
std::unique_ptr<FrameSink> make_sink(const FilesConfig& config, const SinkContext& context,
                                     const OutputShape& shape);
// Returns the warning that the pictures will be dark in a viewer, to be given before they are written; or
// nothing.
std::string dark_picture_warning(const FilesConfig& config, int bits);

class FilesSink : public FrameSink {
  public:
    // width, height: of the largest frame. waits: the loop waits for room. fates: may be null; must outlive
    // the sink. Throws InputError when the folder holds another run's frames.
    FilesSink(const FilesConfig& config, int width, int height, const PictureRun& run, bool waits = true,
              FrameFates* fates = nullptr);
    ~FilesSink() override { stop(); }

    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override { return mailbox_.has_room(); }
    bool must_be_waited_for() const noexcept override { return waits_; }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;

  private:
    void run();
    void write(const FrameMailbox::Item& item);
    std::string report_of_loss() const;

    FilesConfig config_;
    bool waits_;
    FrameFates* fates_;
    FileNamePattern names_;
    FileNamePattern::Camera camera_;
    PictureWriter writer_;
    FrameMailbox mailbox_;
    std::thread thread_;
    std::uint64_t offered_ = 0;
    std::atomic<std::uint64_t> written_{0};
    mutable std::mutex mutex_;
    std::uint64_t failed_ = 0, first_failed_ = 0;  // frames that could not be written, id of the first
    std::string first_failure_;
};

}  // namespace hilcam
