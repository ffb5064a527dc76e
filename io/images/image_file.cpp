#include "io/images/image_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

#include "io/images/exr_file.h"
#include "io/images/fits_file.h"
#include "io/images/pds4_label.h"
#include "io/images/picture_codecs.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Writes the whole file or none.
void write_file(const std::filesystem::path& file, std::string_view bytes) {
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    if (!out) throw DeviceError(file.string() + ": cannot be written: " + std::strerror(errno));
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) give_up_file(file, std::strerror(errno));
}

void write_encoded(const std::filesystem::path& file, const std::string& bytes) {
    if (bytes.empty()) throw DeviceError(file.string() + ": cannot be encoded");
    write_file(file, bytes);
}

[[noreturn]] void refuse_ending(const std::filesystem::path& file, const char* accepted) {
    throw InputError(file.string() + ": found the ending " + in_quotes(file.extension().string()) +
                     "; accepted " + accepted);
}

bool is_fits(const std::filesystem::path& file) {
    return file.extension() == ".fits" || file.extension() == ".fit";
}

// TIFF 6.0, DateTime: "2026:03:20 06:00:00", of UTC.
TiffNotes tiff_notes(const PictureNotes& notes) {
    TiffNotes out;
    if (notes.empty()) return out;
    const auto text = [&](const char* key) {
        const PictureNote* const note = find_note(notes, key);
        return note ? text_of(*note) : std::string();
    };
    out.description = json_of(notes);
    out.software = text("software");
    out.model = text("camera_name");
    out.date_time = text("time_utc").substr(0, 19);
    if (out.date_time.size() == 19) out.date_time[4] = out.date_time[7] = ':', out.date_time[10] = ' ';
    return out;
}

PictureSamples samples_of(const DnImage& image) {
    return {{reinterpret_cast<const std::uint8_t*>(image.data()), 2 * image.pixels()},
            image.width(),
            image.height(),
            SampleKind::kGray16};
}

std::optional<SkyMap> sky_of(const PictureRun& run, const FrameRecord& record, const PictureLayout& layout) {
    if (!record.camera) return {};
    return sky_map(*record.camera, run.model, layout);
}

}  // namespace

void give_up_file(const std::filesystem::path& file, const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw DeviceError(file.string() + ": cannot be written: " + why);
}

void write_numbers(const std::filesystem::path& file, const DnImage& numbers, const PictureNotes& notes) {
    const std::string kind = file.extension().string();
    if (kind != ".png" && kind != ".tiff" && kind != ".tif")
        refuse_ending(file, "for frames: .png .tiff .fits .raw");
    write_encoded(file, encode_numbers(kind, numbers, notes));
}

std::string encode_numbers(const std::string& kind, const DnImage& numbers, const PictureNotes& notes) {
    return kind == ".png" ? encode_png(samples_of(numbers), {png_texts(notes), 0})
                          : encode_tiff(samples_of(numbers), tiff_notes(notes));
}

std::string encode_frame(const std::string& kind, const DnImage& frame, const PictureRun& run,
                         const FrameRecord& record) {
    return encode_numbers(kind, frame, notes_of(run, record, layout_of(record), "DN"));
}

PictureWriter::PictureWriter(PictureRun run) : run_(std::move(run)), view_(run_) {}

void PictureWriter::write_frame(const std::filesystem::path& file, const DnImage& frame,
                                const FrameRecord& record) const {
    const PictureLayout layout = layout_of(record);
    if (file.extension() == ".raw") {
        const PixelLayout pixels = run_.model.pixel_layout();
        std::vector<std::uint8_t> bytes(packed_bytes(frame.pixels(), pixels));
        pack(frame.plane(0), pixels, bytes);
        write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    } else if (is_fits(file)) {
        write_encoded(file, encode_fits(frame, {notes_of(run_, record, layout, "DN"), "adu",
                                                sky_of(run_, record, layout)}));
    } else {
        write_numbers(file, frame, notes_of(run_, record, layout, "DN"));
    }
}

void PictureWriter::write_label(const std::filesystem::path& file, const DnImage& frame,
                                const FrameRecord& record) const {
    if (!is_fits(file)) refuse_ending(file, "for a labelled frame: .fits");
    const PictureLayout layout = layout_of(record);
    const FitsHeader header{notes_of(run_, record, layout, "DN"), "adu", sky_of(run_, record, layout)};
    const std::string bytes = encode_fits(frame, header);
    std::filesystem::path label = file;
    write_encoded(label.replace_extension(".xml"),
                  pds4_label(header.notes, {file.filename().string(), frame.width(), frame.height(),
                                            fits_header_bytes(bytes), bytes.size()}));
}

void PictureWriter::write_view(const std::filesystem::path& file, const DnImage& frame,
                               const FrameRecord& record) {
    if (file.extension() != ".png") refuse_ending(file, "for a picture to look at: .png");
    write_encoded(file, view_.png(frame, record, notes_of(run_, record, layout_of(record), "8-bit view")));
}

void PictureWriter::write_electrons(const std::filesystem::path& file, const ElectronImage& electrons,
                                    const FrameRecord& record) const {
    const PictureLayout layout;
    const PictureNotes notes = notes_of(run_, record, layout, "e-");
    if (file.extension() == ".exr")
        write_electrons_exr(file, electrons, notes);
    else if (is_fits(file))
        write_encoded(file, encode_fits(electrons, {notes, "electron", sky_of(run_, record, layout)}));
    else
        refuse_ending(file, "for electrons: .exr .fits");
}

void PictureWriter::write_radiance(const std::filesystem::path& file, const RadianceImage& radiance,
                                   const PixelRectangle& frame, int oversampling, const FrameRecord& record,
                                   const LightParts* parts) const {
    if (file.extension() != ".exr") refuse_ending(file, "for radiance: .exr");
    PictureNotes notes = notes_of(run_, record, {{}, oversampling}, "W m^-2 sr^-1 um^-1");
    std::vector<double> edges_um = {run_.grid.from_um(0)};
    for (int b = 0; b < run_.grid.size(); ++b) edges_um.push_back(run_.grid.to_um(b));
    notes.push_back({"spectrum_edges_um", "", edges_um, "um, edges of the spectral bins"});
    write_radiance_exr(file, radiance, run_.grid, frame, notes, parts);
}

std::string dark_picture_warning(const std::filesystem::path& file, int bits, const std::string& remedy) {
    const std::string kind = file.extension().string();
    if (bits <= 8 || (kind != ".png" && kind != ".tiff" && kind != ".tif")) return {};
    return file.string() + ": " + std::to_string(bits) +
           "-bit DN right-aligned in 16 bits, dark in a viewer; " + remedy;
}

}  // namespace hilcam
