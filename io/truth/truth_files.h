#pragma once
// Truth as files. Of a run: truth.jsonl, whose first line names the run and each further one tells of a
// frame, truth_00000001.exr with that frame's layers, and the object layer once more as
// truth_00000001.object.png, 16 bits, for readers without OpenEXR. Of a single picture: files that are named
// after it.
//
// Channels of the picture, all 32 bit: object.ID (unsigned whole numbers), range.D, depth.Z, normal.X Y Z,
// position.X Y Z. Its header has each layer's unit ("range.unit") and the numbers' names ("object.names").

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/system/fd.h"
#include "render/frame/frame_truth.h"

namespace hilcam {

// Writes only the layers that were asked for. DeviceError when it cannot be written; then there is no file.
void write_truth_exr(const std::filesystem::path& file, const FrameTruth& truth,
                     std::span<const std::string> legend);

// Numbers of a frame of that size, a channel each, and the unit of all of them. DeviceError as above.
struct NamedChannel {
    const char* name;
    std::span<const float> values;
};
void write_channels_exr(const std::filesystem::path& file, int width_px, int height_px,
                        const std::string& unit, std::span<const NamedChannel> channels);

// The object layer as a mask: objects have their numbers, bodies 60000 and their NAIF number (60399 is the
// Earth), the sky 0; the PNG's text "object.names" has them: "1 target; 60399 earth". An object beyond 59999
// is 65535.
void write_object_mask(const std::filesystem::path& file, const FrameTruth& truth,
                       std::span<const std::string> legend);
// Returns the number that stands for an id in it.
std::uint16_t mask_number(std::uint32_t id);
inline constexpr std::string_view kTruthLines = "truth.jsonl";

class TruthFiles {
  public:
    // Begins truth.jsonl with the line `header` in a folder that is there and has none (run_folder.h).
    // DeviceError when that cannot be.
    TruthFiles(const std::filesystem::path& folder, std::string_view header);

    // These throw a DeviceError: what there was no room for is left out whole.
    // line: without a newline; it is there for readers when this returns.
    void add_line(std::string_view line);
    // Writes the layers that were asked for.
    void write_layers(const FrameTruth& truth, std::uint64_t frame,
                      std::span<const std::string> legend) const;

  private:
    std::filesystem::path folder_;
    Fd lines_;
    off_t lines_bytes_ = 0;  // bytes of whole lines
};

// The files for the truth of a single picture: FOLDER/NAME.truth.jsonl and FOLDER/NAME.truth.exr for
// NAME.png. No run has files of such names.
struct PictureTruthFiles {
    std::filesystem::path lines, layers, mask;
};
PictureTruthFiles picture_truth_files(const std::filesystem::path& folder,
                                      const std::filesystem::path& picture);
// Makes the folder. text: whole lines. DeviceError when it cannot be written.
void write_picture_truth(const PictureTruthFiles& files, std::string_view text, const FrameTruth& truth,
                         std::span<const std::string> legend);

}  // namespace hilcam
