#pragma once
// Decodes a raw file: pixels row after row, of one or two bytes, after a header of known length.

#include <string>
#include <string_view>

#include "emulator/clone/frames_config.h"
#include "render/vocabulary/image.h"

namespace hilcam {

// Fills the frame, which has the file's size. Throws InputError when the file's length does not fit. Any
// thread.
void decode_raw(std::string_view bytes, const FramesConfig& config, const std::string& name, DnImage& frame);

}  // namespace hilcam
