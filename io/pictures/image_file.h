#pragma once
// Pictures written to disk: frames as 16-bit PNG or TIFF, radiance as OpenEXR.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "render/vocabulary/image.h"
#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"
#include "sensor/packing.h"

namespace hilcam {

// Frames as they are: DN, right-aligned in 16 bits. The kind follows from the ending, .png or .tiff.
// InputError for another ending, DeviceError when the file cannot be written: then there is none.
void write_frame(const std::filesystem::path& file, const DnImage& frame);
// The bytes of a camera's memory, row after row without a header. DeviceError as before.
void write_raw(const std::filesystem::path& file, const DnImage& frame, const PixelLayout& layout);
// One 32-bit float channel per bin, named "L_0.450_0.550um" [W m^-2 sr^-1 um^-1], or "electrons" [e-].
// OpenEXR's display window is the frame, whose corner is (0, 0) in both, its data window all of the picture.
// frame: where the camera's frame lies in the radiance image [px of that], guard band and black columns apart
// (it may begin before the image and end after it). DeviceError as before.
void write_radiance_exr(const std::filesystem::path& file, const RadianceImage& radiance,
                        const SpectralGrid& grid, const PixelRectangle& frame);
void write_electrons_exr(const std::filesystem::path& file, const ElectronImage& electrons);

}  // namespace hilcam
