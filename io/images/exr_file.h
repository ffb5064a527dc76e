#pragma once
// Radiance and electrons as OpenEXR, 32-bit floats, the picture's notes as attributes of the header.
//
// One plane is the channel "Y": what OpenCV, GIMP and tev show as grey. Of several spectral bins each is a
// channel of its own, "L_0.450_0.550um", and "R", "G" and "B" stand beside them for viewers: the means of the
// bins above 0.58 um, from 0.49 to 0.58 um and below (render/scene/color_bands.h). Where one of the three has
// no bin, "Y", the mean of all, stands for them.

#include <filesystem>

#include "io/images/picture_notes.h"
#include "render/vocabulary/light_parts.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// OpenEXR's display window is the frame, whose corner is (0, 0) in both, its data window all of the picture.
// frame: where the camera's frame lies in the radiance image [px of that], guard band and black columns apart
// (it may begin before the image and end after it). [W m^-2 sr^-1 um^-1]. DeviceError when the file cannot be
// written: then there is none.
// parts: layers of the file beside the picture, named as the parts are: `direct.sun.Y`, or `direct.sun.R` and so on and a channel for
// each bin, `direct.sun.L_450_550nm` (a dot ends a layer's name). Null: none.
void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame, const PictureNotes& notes,
                        const LightParts* parts = nullptr);
// [e-]
void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons,
                         const PictureNotes& notes);

}  // namespace hilcam
