#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <string_view>

#include "io/images/picture_codecs.h"

namespace hilcam {
namespace {

// The bytes that libpng reads or writes, and its last complaint.
struct PngPort {
    PictureBytes in;
    std::size_t at = 0;
    std::string* out = nullptr;
    char complaint[160] = {};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* const port = static_cast<PngPort*>(png_get_error_ptr(png));
    std::snprintf(port->complaint, sizeof port->complaint, "libpng: %s", message);
    png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

void read_png(png_structp png, png_bytep to, std::size_t size) {
    auto* const port = static_cast<PngPort*>(png_get_io_ptr(png));
    if (size > port->in.size() - port->at) png_error(png, "the file ends too early");
    std::memcpy(to, port->in.data() + port->at, size);
    port->at += size;
}

void write_png(png_structp png, png_bytep from, std::size_t size) {
    auto* const port = static_cast<PngPort*>(png_get_io_ptr(png));
    // Keeps exceptions from passing through libpng.
    bool written = true;
    try {
        port->out->append(reinterpret_cast<const char*>(from), size);
    } catch (const std::exception&) {
        written = false;
    }
    if (!written) png_error(png, "no memory");
}
void flush_png(png_structp) {}

// Returns false when libpng gives up. It uses longjmp, so `work`, and what it calls of ours, must not hold
// objects with destructors.
template <class Work>
bool guarded(png_structp png, const Work& work) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    work();
    return true;
}

class PngReader {
  public:
    explicit PngReader(PictureBytes bytes)
        : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &port_, on_error, on_warning)) {
        if (!png_) throw std::bad_alloc();
        port_.in = bytes;
        info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &port_, read_png);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    void read_header() {
        require(guarded(png_, [this] { png_read_info(png_, info_); }));
    }
    png_uint_32 width() const { return png_get_image_width(png_, info_); }
    png_uint_32 height() const { return png_get_image_height(png_, info_); }
    int bits() const { return png_get_bit_depth(png_, info_); }
    int channels() const { return png_get_channels(png_, info_); }
    bool has_palette() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE; }

    // Converts any kind of samples to three of 8 bits.
    void ask_for_colors() {
        require(guarded(png_, [this] {
            png_set_strip_16(png_);
            png_set_expand(png_);
            png_set_strip_alpha(png_);
            png_set_gray_to_rgb(png_);
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        }));
    }
    // Converts any kind of samples to four of 8 bits, the last one alpha.
    void ask_for_alpha() {
        require(guarded(png_, [this] {
            png_set_strip_16(png_);
            png_set_expand(png_);
            png_set_gray_to_rgb(png_);
            png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        }));
    }
    // Converts grey to 8 bits, or to 16 in the machine's byte order.
    void ask_for_numbers() {
        require(guarded(png_, [this] {
            png_set_expand_gray_1_2_4_to_8(png_);
            if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        }));
    }
    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    void read(std::vector<png_bytep>& rows) {
        require(guarded(png_, [this, &rows] {
            png_read_image(png_, rows.data());
            png_read_end(png_, nullptr);
        }));
    }

  private:
    PngPort port_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;

    void require(bool done) const {
        if (!done) throw undecodable(port_.complaint);
    }
};

std::vector<png_bytep> rows_of(std::span<std::uint8_t> bytes, std::size_t row_bytes, std::size_t height) {
    if (row_bytes * height != bytes.size()) throw undecodable("libpng: rows of another length");
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = bytes.data() + y * row_bytes;
    return rows;
}

class PngWriter {
  public:
    explicit PngWriter(std::string& out)
        : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &port_, on_error, on_warning)) {
        if (!png_) throw std::bad_alloc();
        port_.out = &out;
        info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, &port_, write_png, flush_png);
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    bool write(const PictureSamples& p, double gamma, std::vector<png_text>& texts) {
        return guarded(png_, [&] {
            // The low bits of frames are noise, so stronger compression costs time and saves nothing.
            png_set_compression_level(png_, 1);
            png_set_IHDR(png_, info_, static_cast<png_uint_32>(p.width), static_cast<png_uint_32>(p.height),
                         p.kind == SampleKind::kGray16 ? 16 : 8,
                         p.kind == SampleKind::kRgb8 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
                         PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            if (gamma > 0) png_set_gAMA(png_, info_, 1 / gamma);
            if (!texts.empty()) png_set_text(png_, info_, texts.data(), static_cast<int>(texts.size()));
            png_write_info(png_, info_);
            if constexpr (std::endian::native == std::endian::little)
                if (p.kind == SampleKind::kGray16) png_set_swap(png_);
            const std::size_t row_bytes = p.bytes.size() / static_cast<std::size_t>(p.height);
            for (int y = 0; y < p.height; ++y)
                png_write_row(png_, p.bytes.data() + static_cast<std::size_t>(y) * row_bytes);
            png_write_end(png_, nullptr);
        });
    }

  private:
    PngPort port_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

// libpng does not change its input, but asks for non-const pointers.
png_text text_of(const std::pair<std::string, std::string>& note) {
    png_text out{};
    out.compression = is_ascii(note.second) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    out.key = const_cast<char*>(note.first.c_str());
    out.text = const_cast<char*>(note.second.c_str());
    if (out.compression == PNG_TEXT_COMPRESSION_NONE)
        out.text_length = note.second.size();
    else
        out.itxt_length = note.second.size();
    return out;
}

}  // namespace

Texture decode_png(PictureBytes bytes) {
    PngReader reader(bytes);
    reader.read_header();
    Texture texture = blank_texture(reader.width(), reader.height());
    reader.ask_for_colors();
    std::vector<png_bytep> rows = rows_of(bytes_of(texture), reader.row_bytes(), reader.height());
    reader.read(rows);
    return texture;
}

std::vector<std::uint8_t> decode_png_alpha(PictureBytes bytes) {
    PngReader reader(bytes);
    reader.read_header();
    require_few_pixels(reader.width(), reader.height());
    reader.ask_for_alpha();
    std::vector<std::uint8_t> samples(std::size_t{4} * reader.width() * reader.height());
    std::vector<png_bytep> rows = rows_of(samples, reader.row_bytes(), reader.height());
    reader.read(rows);
    return every_fourth(samples);
}

PixelMap decode_png_numbers(PictureBytes bytes) {
    PngReader reader(bytes);
    reader.read_header();
    if (reader.has_palette()) throw PictureFault("has a palette of colours; accepted: one channel");
    if (reader.channels() != 1)
        throw PictureFault("has " + std::to_string(reader.channels()) + " channels; accepted: one");
    require_few_pixels(reader.width(), reader.height());
    const bool wide = reader.bits() == 16;
    reader.ask_for_numbers();
    const std::size_t row_bytes = std::size_t{reader.width()} * (wide ? 2 : 1);
    std::vector<std::uint8_t> samples(row_bytes * reader.height());
    if (reader.row_bytes() != row_bytes) throw undecodable("libpng: rows of another length");
    std::vector<png_bytep> rows = rows_of(samples, row_bytes, reader.height());
    reader.read(rows);
    PixelMap map(static_cast<int>(reader.width()), static_cast<int>(reader.height()));
    for (std::size_t i = 0; i < map.pixels(); ++i) {
        std::uint16_t value = samples[i];
        if (wide) std::memcpy(&value, samples.data() + 2 * i, 2);
        map.all()[i] = value;
    }
    return map;
}

std::string encode_png(const PictureSamples& picture, const PngNotes& notes) {
    std::string out;
    std::vector<png_text> texts;
    for (const auto& note : notes.texts) texts.push_back(text_of(note));
    PngWriter writer(out);
    if (!writer.write(picture, notes.gamma, texts)) return {};
    return out;
}

}  // namespace hilcam
