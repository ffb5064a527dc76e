#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include "io/images/picture_codecs.h"
#include "io/images/picture_size.h"

namespace hilcam {
namespace {

// The bytes that libtiff reads or writes, and its first complaint.
struct TiffPort {
    PictureBytes in;
    std::string* out = nullptr;
    toff_t at = 0;
    char complaint[160] = {};

    toff_t size() const { return out ? out->size() : in.size(); }
};

TiffPort& port_of(thandle_t handle) { return *static_cast<TiffPort*>(handle); }

tmsize_t read_tiff(thandle_t handle, void* to, tmsize_t size) {
    TiffPort& port = port_of(handle);
    if (size <= 0 || port.at >= port.size()) return 0;
    const auto count = std::min<toff_t>(static_cast<toff_t>(size), port.size() - port.at);
    const void* const from = port.out ? static_cast<const void*>(port.out->data()) : port.in.data();
    std::memcpy(to, static_cast<const char*>(from) + port.at, count);
    port.at += count;
    return static_cast<tmsize_t>(count);
}

tmsize_t write_tiff(thandle_t handle, void* from, tmsize_t size) {
    TiffPort& port = port_of(handle);
    if (!port.out || size < 0) return 0;
    // Keeps exceptions from passing through libtiff.
    try {
        const auto end = port.at + static_cast<toff_t>(size);
        if (end > port.out->size()) port.out->resize(end);
        std::memcpy(port.out->data() + port.at, from, static_cast<std::size_t>(size));
        port.at = end;
    } catch (const std::exception&) {
        return 0;
    }
    return size;
}

toff_t seek_port(thandle_t handle, toff_t offset, int whence) {
    TiffPort& port = port_of(handle);
    port.at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? port.at + offset : port.size() + offset;
    return port.at;
}
int close_port(thandle_t) { return 0; }
toff_t size_of_port(thandle_t handle) { return port_of(handle).size(); }

int keep_complaint(TIFF*, void* user, const char*, const char* format, va_list values) {
    auto* const port = static_cast<TiffPort*>(user);
    if (port->complaint[0] == 0) {
        char text[140];
        std::vsnprintf(text, sizeof text, format, values);
        std::snprintf(port->complaint, sizeof port->complaint, "libtiff: %s", text);
    }
    return 1;  // no other handler is called
}
int pass_over(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
    void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};
using OpenTiff = std::unique_ptr<TIFF, Close>;

// mode: for TIFFOpen(); M: do not map the bytes.
OpenTiff open_port(TiffPort& port, const char* mode) {
    const std::unique_ptr<TIFFOpenOptions, Close> options(TIFFOpenOptionsAlloc());
    if (!options) throw std::bad_alloc();
    // Large enough for one strip of the largest picture with four samples of 16 bits.
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(8 * kMaxPicturePixels));
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_complaint, &port);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_over, nullptr);
    return OpenTiff(TIFFClientOpenExt("picture", mode, &port, read_tiff, write_tiff, seek_port, close_port,
                                      size_of_port, nullptr, nullptr, options.get()));
}

OpenTiff open_picture(TiffPort& port) {
    OpenTiff tiff = open_port(port, "rM");
    if (!tiff) throw undecodable(port.complaint);
    return tiff;
}

std::uint32_t field(TIFF* tiff, std::uint32_t tag) {
    std::uint32_t value = 0;
    TIFFGetField(tiff, tag, &value);
    return value;
}
std::uint16_t short_field(TIFF* tiff, std::uint32_t tag) {
    std::uint16_t value = 0;
    TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

// The layout of the samples of a picture of numbers in its file.
struct NumberLayout {
    std::uint32_t width, height;
    std::uint16_t bits, format;
    std::size_t bytes_px() const { return bits / 8u; }
};

NumberLayout number_layout(TIFF* tiff) {
    const std::uint16_t channels = short_field(tiff, TIFFTAG_SAMPLESPERPIXEL);
    if (channels != 1) throw PictureFault("has " + std::to_string(channels) + " channels; accepted: one");
    if (short_field(tiff, TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_PALETTE)
        throw PictureFault("has a palette of colours; accepted: one channel");
    if (short_field(tiff, TIFFTAG_ORIENTATION) != ORIENTATION_TOPLEFT)
        throw PictureFault("is stored turned or mirrored (its tag Orientation); accepted: rows from the top");
    const NumberLayout l{field(tiff, TIFFTAG_IMAGEWIDTH), field(tiff, TIFFTAG_IMAGELENGTH),
                         short_field(tiff, TIFFTAG_BITSPERSAMPLE), short_field(tiff, TIFFTAG_SAMPLEFORMAT)};
    const bool floats = l.format == SAMPLEFORMAT_IEEEFP && (l.bits == 32 || l.bits == 64);
    const bool whole = (l.format == SAMPLEFORMAT_UINT || l.format == SAMPLEFORMAT_INT) &&
                       (l.bits == 8 || l.bits == 16 || l.bits == 32);
    if (!floats && !whole)
        throw PictureFault("has samples of " + std::to_string(l.bits) +
                           " bits of another kind; accepted: whole numbers of 8, 16 or 32 bits, floats of 32 "
                           "or 64");
    require_few_pixels(l.width, l.height);
    return l;
}

template <class T>
float number_at(const std::uint8_t* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<float>(value);
}

float sample_of(const NumberLayout& l, const std::uint8_t* from) {
    if (l.format == SAMPLEFORMAT_IEEEFP)
        return l.bits == 32 ? number_at<float>(from) : number_at<double>(from);
    const bool has_sign = l.format == SAMPLEFORMAT_INT;
    if (l.bits == 8) return has_sign ? number_at<std::int8_t>(from) : number_at<std::uint8_t>(from);
    if (l.bits == 16) return has_sign ? number_at<std::int16_t>(from) : number_at<std::uint16_t>(from);
    return has_sign ? number_at<std::int32_t>(from) : number_at<std::uint32_t>(from);
}

void read_rows(TIFF* tiff, const TiffPort& port, const NumberLayout& l, PixelMap& map) {
    std::vector<std::uint8_t> row(std::size_t{l.width} * l.bytes_px());
    if (TIFFScanlineSize64(tiff) != row.size()) throw undecodable("libtiff: rows of another length");
    for (std::uint32_t y = 0; y < l.height; ++y) {
        if (TIFFReadScanline(tiff, row.data(), y, 0) != 1) throw undecodable(port.complaint);
        for (std::size_t x = 0; x < l.width; ++x)
            map.row(static_cast<int>(y))[x] = sample_of(l, row.data() + x * l.bytes_px());
    }
}

void read_tiles(TIFF* tiff, const TiffPort& port, const NumberLayout& l, PixelMap& map) {
    const std::uint32_t across = field(tiff, TIFFTAG_TILEWIDTH), down = field(tiff, TIFFTAG_TILELENGTH);
    const std::uint64_t bytes = std::uint64_t{across} * down * l.bytes_px();
    if (bytes == 0 || bytes > 8 * kMaxPicturePixels || TIFFTileSize64(tiff) != bytes)
        throw undecodable("libtiff: tiles of another size");
    std::vector<std::uint8_t> tile(bytes);
    for (std::uint64_t top = 0; top < l.height; top += down)
        for (std::uint64_t left = 0; left < l.width; left += across) {
            if (TIFFReadTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                             static_cast<std::uint32_t>(top), 0, 0) < 0)
                throw undecodable(port.complaint);
            for (std::uint64_t y = top; y < std::min<std::uint64_t>(top + down, l.height); ++y)
                for (std::uint64_t x = left; x < std::min<std::uint64_t>(left + across, l.width); ++x)
                    map.row(static_cast<int>(y))[x] =
                        sample_of(l, tile.data() + ((y - top) * across + (x - left)) * l.bytes_px());
        }
}

void set_text(TIFF* tiff, std::uint32_t tag, const std::string& text) {
    if (!text.empty()) TIFFSetField(tiff, tag, text.c_str());
}

}  // namespace

Texture decode_tiff(PictureBytes bytes) {
    TiffPort port{bytes};
    const OpenTiff tiff = open_picture(port);
    Texture texture =
        blank_texture(field(tiff.get(), TIFFTAG_IMAGEWIDTH), field(tiff.get(), TIFFTAG_IMAGELENGTH));
    char why[1024] = {};
    if (!TIFFRGBAImageOK(tiff.get(), why)) throw undecodable(std::string("libtiff: ") + why);
    std::vector<std::uint32_t> rgba(texture.texels.size());
    // The last argument stops at an error, because an incomplete picture is refused.
    if (!TIFFReadRGBAImageOriented(tiff.get(), static_cast<std::uint32_t>(texture.width),
                                   static_cast<std::uint32_t>(texture.height), rgba.data(),
                                   ORIENTATION_TOPLEFT, 1))
        throw undecodable(port.complaint);
    std::transform(rgba.begin(), rgba.end(), texture.texels.begin(), [](std::uint32_t v) {
        return std::array<std::uint8_t, 3>{static_cast<std::uint8_t>(TIFFGetR(v)),
                                           static_cast<std::uint8_t>(TIFFGetG(v)),
                                           static_cast<std::uint8_t>(TIFFGetB(v))};
    });
    return texture;
}

PixelMap decode_tiff_numbers(PictureBytes bytes) {
    TiffPort port{bytes};
    const OpenTiff tiff = open_picture(port);
    const NumberLayout layout = number_layout(tiff.get());
    PixelMap map(static_cast<int>(layout.width), static_cast<int>(layout.height));
    if (TIFFIsTiled(tiff.get()))
        read_tiles(tiff.get(), port, layout, map);
    else
        read_rows(tiff.get(), port, layout, map);
    return map;
}

std::string encode_tiff(const PictureSamples& p, const TiffNotes& notes) {
    std::string out;
    TiffPort port;
    port.out = &out;
    bool written = true;
    {
        // Little-endian on any machine, so that the same picture gives the same bytes everywhere.
        const OpenTiff tiff = open_port(port, "wl");
        if (!tiff) return {};
        const bool color = p.kind == SampleKind::kRgb8;
        TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, p.width);
        TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, p.height);
        TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, p.kind == SampleKind::kGray16 ? 16 : 8);
        TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, color ? 3 : 1);
        TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, color ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
        TIFFSetField(tiff.get(), TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
        TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff.get(), 0));
        set_text(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, notes.description);
        set_text(tiff.get(), TIFFTAG_SOFTWARE, notes.software);
        set_text(tiff.get(), TIFFTAG_MODEL, notes.model);
        set_text(tiff.get(), TIFFTAG_DATETIME, notes.date_time);
        const std::size_t row_bytes = p.bytes.size() / static_cast<std::size_t>(p.height);
        std::vector<std::uint8_t> row(row_bytes);  // libtiff may change what it writes
        for (int y = 0; written && y < p.height; ++y) {
            std::copy_n(p.bytes.data() + static_cast<std::size_t>(y) * row_bytes, row_bytes, row.data());
            written = TIFFWriteScanline(tiff.get(), row.data(), static_cast<std::uint32_t>(y), 0) == 1;
        }
        written = written && TIFFFlush(tiff.get()) == 1;
    }
    return written ? out : std::string();
}

}  // namespace hilcam
