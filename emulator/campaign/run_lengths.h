#pragma once
// Masks as run lengths in COCO's form (cocodataset/cocoapi, common/maskApi.h): column after column, how many
// pixels are outside the mask, then how many are inside, and so on.
//
// In text form a count is a base-32 number, lowest five bits first, each a character from '0' on; adding 32
// marks that more bits follow. From the third count on, the text holds the difference to the last but one
// count; the highest bit of its last character is the sign (rleToString() there).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "render/frame/frame_truth.h"

namespace hilcam {

using RunLengths = std::vector<std::uint32_t>;

// Returns the mask of the frame's pixels that have this id. The layer is at least as large as the frame.
RunLengths run_lengths_of(const IdImage& ids, const FrameRaster& raster, std::uint32_t id);
std::string run_length_text(const RunLengths& runs);
// Throws InputError for text that is not in this form.
RunLengths parse_run_lengths(std::string_view text);
// Returns the mask row by row: 255 inside, 0 outside. Throws InputError when it has more or fewer than width
// x height pixels.
std::vector<std::uint8_t> mask_of(const RunLengths& runs, int width, int height);

}  // namespace hilcam
