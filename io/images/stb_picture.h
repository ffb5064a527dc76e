#pragma once
// Decodes BMP and TGA with stb_image. Where a file ends early, stb_image returns whatever is in memory, or
// black: callers first check that all bytes are there.

#include "io/images/picture_codecs.h"

namespace hilcam {

// Throws PictureFault when stb_image refuses the bytes or there would be too many pixels. Any thread.
Texture decode_by_stb(PictureBytes bytes);

}  // namespace hilcam
