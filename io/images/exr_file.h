#pragma once
// Writes radiance and electrons as OpenEXR: 32-bit floats, with the picture's notes as attributes of the
// header.
//
// A picture with one plane has the channel "Y", which OpenCV, GIMP and tev show as grey. A picture with
// several spectral bins has a channel for each, "L_0.450_0.550um", and for viewers "R", "G" and "B": the
// means of the bins above 0.58 um, from 0.49 to 0.58 um and below (render/scene/color_bands.h). Where one of
// these three has no bin, "Y", the mean of all bins, takes their place.

#include <filesystem>

#include "io/images/picture_notes.h"
#include "render/vocabulary/light_parts.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Writes radiance [W m^-2 sr^-1 um^-1]. The display window is the frame, with its corner at (0, 0); the data
// window is the whole picture.
// - frame: the camera's frame in the radiance image [px of the image], without guard band and black columns.
//   It may begin before the image and end after it.
// - parts: layers of the file beside the picture, with the parts' names: `direct.sun.Y`, or `direct.sun.R`
//   and so on and a channel for each bin, `direct.sun.L_450_550nm` (the layer's name ends at the last dot).
//   Null: no layers.
//
// Throws DeviceError when the file cannot be written; then there is no file.
void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame, const PictureNotes& notes,
                        const LightParts* parts = nullptr);
// Writes electrons [e-]. Throws DeviceError as above.
void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons,
                         const PictureNotes& notes);

}  // namespace hilcam
