#pragma once
// Masks as run lengths, as COCO has them (cocodataset/cocoapi, common/maskApi.h): down each column in turn,
// how many pixels are not in the mask, then how many are, and so on.
//
// In text a count is a number in base 32, its lowest five bits first, each a character from '0' on; 32 more
// says that bits follow, and from the third count on it is the difference to the one before the last, whose
// sign is the last character's highest bit (rleToString() there).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "render/frame/frame_truth.h"

namespace hilcam {

using RunLengths = std::vector<std::uint32_t>;

// The pixels of the frame that have that number; the layer is at least of the frame's size.
RunLengths run_lengths_of(const IdImage& ids, const FrameRaster& raster, std::uint32_t id);
std::string run_length_text(const RunLengths& runs);
// Throws InputError for what is no such text.
RunLengths parse_run_lengths(std::string_view text);
// The mask's pixels, row by row: 255 or 0. Throws InputError when there are more or fewer than width x height.
std::vector<std::uint8_t> mask_of(const RunLengths& runs, int width, int height);

}  // namespace hilcam
