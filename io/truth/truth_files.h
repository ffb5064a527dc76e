#pragma once
// Truth as files. A run has truth.jsonl, with a first line for the run and one line per frame;
// truth_00000001.exr with the layers of a frame; and truth_00000001.object.png with its object layer, 16
// bits, for readers without OpenEXR. A single picture has files with names derived from the picture's.
//
// Channels of the OpenEXR file, all 32 bits: object.ID (unsigned integers), range.D, depth.Z, normal.X Y Z,
// position.X Y Z. Its header has each layer's unit ("range.unit") and the names of the numbers
// ("object.names").

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/system/fd.h"
#include "render/frame/frame_truth.h"

namespace hilcam {

// Writes the layers that were asked for. Throws DeviceError when the file cannot be written; then there is no
// file.
void write_truth_exr(const std::filesystem::path& file, const FrameTruth& truth,
                     std::span<const std::string> legend);

// A channel for write_channels_exr(), which writes numbers of a frame of that size in one unit. Throws
// DeviceError as above.
struct NamedChannel {
    const char* name;
    std::span<const float> values;
};
void write_channels_exr(const std::filesystem::path& file, int width_px, int height_px,
                        const std::string& unit, std::span<const NamedChannel> channels);

// Writes the object layer as a mask. Objects have their numbers, or 65535 beyond 59999; bodies have 60000
// plus their NAIF number (60399 is the Earth); the sky is 0. The PNG's text "object.names" lists them: "1
// target; 60399 earth".
void write_object_mask(const std::filesystem::path& file, const FrameTruth& truth,
                       std::span<const std::string> legend);
// Returns the mask's number for an id.
std::uint16_t mask_number(std::uint32_t id);
inline constexpr std::string_view kTruthLines = "truth.jsonl";

class TruthFiles {
  public:
    // Begins truth.jsonl with the line `header` in an existing folder without such a file (run_folder.h).
    // Throws DeviceError when that fails.
    TruthFiles(const std::filesystem::path& folder, std::string_view header);

    // Appends a line, given without a newline, and makes it visible to readers. Throws DeviceError when there
    // is no room, and then leaves nothing of it behind.
    void add_line(std::string_view line);
    // Writes the layers that were asked for. Throws DeviceError as above.
    void write_layers(const FrameTruth& truth, std::uint64_t frame,
                      std::span<const std::string> legend) const;

  private:
    std::filesystem::path folder_;
    Fd lines_;
    off_t lines_bytes_ = 0;  // bytes of whole lines
};

// The files for a single picture NAME.png: FOLDER/NAME.truth.jsonl and FOLDER/NAME.truth.exr. No run uses
// such names.
struct PictureTruthFiles {
    std::filesystem::path lines, layers, mask;
};
PictureTruthFiles picture_truth_files(const std::filesystem::path& folder,
                                      const std::filesystem::path& picture);
// Creates the folder and writes the files. text: whole lines. Throws DeviceError when they cannot be written.
void write_picture_truth(const PictureTruthFiles& files, std::string_view text, const FrameTruth& truth,
                         std::span<const std::string> legend);

}  // namespace hilcam
