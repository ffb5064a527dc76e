#pragma once
// Truth as files in a folder: truth.jsonl, a line for each frame, and truth_00000001.exr with the layers.
//
// Channels of the picture, all 32 bit: object.ID (unsigned whole numbers), range.D, depth.Z, normal.X Y Z,
// position.X Y Z. Its header has each layer's unit ("range.unit") and the numbers' names ("object.names").

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "render/frame_truth.h"

namespace hilcam {

// Only the layers that were asked for. DeviceError when it cannot be written.
void write_truth_exr(const std::filesystem::path& file, const FrameTruth& truth,
                     std::span<const std::string> legend);

class TruthFiles {
  public:
    // Makes the folder and an empty truth.jsonl. DeviceError when that cannot be.
    explicit TruthFiles(const std::filesystem::path& folder);

    // line: without a newline; it is there for readers when this returns. DeviceError.
    void write(const FrameTruth& truth, std::uint64_t frame, std::string_view line,
               std::span<const std::string> legend);

  private:
    std::filesystem::path folder_;
    std::ofstream lines_;
};

}  // namespace hilcam
