#pragma once
// Pictures by stb_image: BMP and TGA. It gives what is missing at the end of a file as it finds it in memory, or as black, so that whoever calls
// it has found before that all bytes are there.

#include "io/images/picture_codecs.h"

namespace hilcam {

// Throws PictureFault for bytes that stb_image does not take or that would be too many pixels. Any thread.
Texture decode_by_stb(PictureBytes bytes);

}  // namespace hilcam
