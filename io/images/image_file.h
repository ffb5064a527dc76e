#pragma once
// Writes pictures to disk, each with its notes (picture_notes.h): frames as PNG, TIFF, FITS or raw, radiance
// as OpenEXR, electrons as OpenEXR or FITS. The file's ending selects the format.
//
// In PNG and TIFF a DN is right-aligned in 16 bits: a 12-bit camera's numbers are 0 to 4095, and most viewers
// show them as black (view_picture.h makes pictures for viewers). PNG files have no sBIT chunk: by the PNG
// specification it would say that the numbers are in the upper bits, and readers that honour it (Netpbm's
// pngtopnm) would shift them away. The note `bits` has the number of significant bits.
//
// Functions that write throw InputError for another ending, and DeviceError when the file cannot be written;
// then there is no file.

#include <filesystem>
#include <string>

#include "io/images/picture_notes.h"
#include "io/images/view_picture.h"
#include "render/vocabulary/light_parts.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class PictureWriter {
  public:
    explicit PictureWriter(PictureRun run);

    // Writes a frame as .png, .tiff, .tif, .fits, .fit or .raw (the camera's memory, row after row, without a
    // header). Owner thread, as all functions here.
    void write_frame(const std::filesystem::path& file, const DnImage& frame,
                     const FrameRecord& record) const;
    // Writes FILE.xml, the PDS4 label of the frame that write_frame() wrote as FILE.fits (pds4_label.h).
    void write_label(const std::filesystem::path& file, const DnImage& frame,
                     const FrameRecord& record) const;
    // Writes the frame as .png for the eye.
    void write_view(const std::filesystem::path& file, const DnImage& frame, const FrameRecord& record);
    // Writes electrons as .exr, .fits or .fit, without binning.
    void write_electrons(const std::filesystem::path& file, const ElectronImage& electrons,
                         const FrameRecord& record) const;
    // Writes radiance as .exr, without binning; frame and parts as in exr_file.h. oversampling: pixels of the
    // image across one pixel of the frame.
    void write_radiance(const std::filesystem::path& file, const RadianceImage& radiance,
                        const PixelRectangle& frame, int oversampling, const FrameRecord& record,
                        const LightParts* parts = nullptr) const;

  private:
    PictureRun run_;
    PictureView view_;
};

// Writes numbers up to 65535 as .png or .tiff.
void write_numbers(const std::filesystem::path& file, const DnImage& numbers, const PictureNotes& notes = {});

// Return the same as a file's bytes; kind is ".png" or ".tiff". encode_frame() adds the notes of a camera's
// frame.
std::string encode_numbers(const std::string& kind, const DnImage& numbers, const PictureNotes& notes);
std::string encode_frame(const std::string& kind, const DnImage& frame, const PictureRun& run,
                         const FrameRecord& record);

// Returns a warning when a user may want to look at such a file and it will be dark; empty: no warning.
// remedy: what makes a picture to look at.
std::string dark_picture_warning(const std::filesystem::path& file, int bits, const std::string& remedy);

// Removes the incomplete file and throws DeviceError.
[[noreturn]] void give_up_file(const std::filesystem::path& file, const std::string& why);

}  // namespace hilcam
