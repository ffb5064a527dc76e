#pragma once
// Pictures written to disk, each with what it says of itself (picture_notes.h): frames as PNG, TIFF, FITS or
// raw, radiance and electrons as OpenEXR, electrons as FITS, too. The kind follows from the ending.
//
// In PNG and TIFF a DN lies right-aligned in 16 bits: a 12-bit camera's numbers are 0 to 4095, and most
// viewers show them as black (view_picture.h is for those). PNG has no sBIT chunk: by its specification that
// would say that the numbers lie in the upper bits, and readers that heed it (Netpbm's pngtopnm) would shift
// them away. The note `bits` says how many there are.
//
// Functions that write throw InputError for another ending, and DeviceError when the file cannot be written:
// then there is none.

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

    // .png, .tiff, .tif, .fits, .fit; or .raw, the bytes of the camera's memory, row after row without a
    // header. Owner thread, as all here.
    void write_frame(const std::filesystem::path& file, const DnImage& frame,
                     const FrameRecord& record) const;
    // A PDS4 label, FILE.xml, of the frame that write_frame() wrote as FILE.fits (pds4_label.h).
    void write_label(const std::filesystem::path& file, const DnImage& frame,
                     const FrameRecord& record) const;
    // .png: the frame as it is to be looked at.
    void write_view(const std::filesystem::path& file, const DnImage& frame, const FrameRecord& record);
    // .exr, .fits, .fit; not binned.
    void write_electrons(const std::filesystem::path& file, const ElectronImage& electrons,
                         const FrameRecord& record) const;
    // .exr; frame and oversampling as in exr_file.h, not binned.
    void write_radiance(const std::filesystem::path& file, const RadianceImage& radiance,
                        const PixelRectangle& frame, int oversampling, const FrameRecord& record,
                        const LightParts* parts = nullptr) const;

  private:
    PictureRun run_;
    PictureView view_;
};

// Numbers to 65535 as .png or .tiff, without notes unless given.
void write_numbers(const std::filesystem::path& file, const DnImage& numbers, const PictureNotes& notes = {});

// The same as a file's bytes, kind ".png" or ".tiff"; with the notes of a camera's frame.
std::string encode_numbers(const std::string& kind, const DnImage& numbers, const PictureNotes& notes);
std::string encode_frame(const std::string& kind, const DnImage& frame, const PictureRun& run,
                         const FrameRecord& record);

// Returns a warning when such numbers are written for somebody who may want to look at them; empty: none.
// remedy: what would make a picture to look at.
std::string dark_picture_warning(const std::filesystem::path& file, int bits, const std::string& remedy);

// A picture that ends half-way is worse than none.
[[noreturn]] void give_up_file(const std::filesystem::path& file, const std::string& why);

}  // namespace hilcam
