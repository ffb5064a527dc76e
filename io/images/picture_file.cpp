#include "io/images/picture_file.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "io/images/picture_codecs.h"
#include "io/images/picture_size.h"
#include "io/system/confined.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Bytes per pixel during decoding and copying: the colours twice, a strip as it is stored, and what
// progressive JPEG and lossless WebP keep of the whole picture.
constexpr std::uint64_t kBytesPerPixel = 16;

void allow_for(std::uint64_t width, std::uint64_t height) {
    require_few_pixels(width, height);
    // 0.3 us a pixel is ten times what the slowest format, PNG, needs.
    const std::uint64_t pixels = width * height;
    allow_more(kBytesPerPixel * pixels, 3e-7 * static_cast<double>(pixels));
}

PictureKind require_size(PictureBytes bytes) {
    const std::optional<PictureSize> size = picture_size(bytes);
    if (!size) throw undecodable("");
    allow_for(size->width, size->height);
    return size->kind;
}

Texture decode_colors(PictureBytes bytes) {
    switch (require_size(bytes)) {
        case PictureKind::kPng:
            return decode_png(bytes);
        case PictureKind::kJpeg:
            return decode_jpeg(bytes);
        case PictureKind::kTiff:
            return decode_tiff(bytes);
        case PictureKind::kBmp:
            return decode_bmp(bytes);
        case PictureKind::kWebp:
            return decode_webp(bytes);
        case PictureKind::kPnm:
            return decode_pnm(bytes);
        case PictureKind::kTga:
            return decode_tga(bytes);
    }
    throw undecodable("");
}

PictureBytes bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void write_numbers(const std::string& bytes, const std::string& name, bool any_sign, ConfinedOutput& out) {
    const PixelMap numbers = [&] {
        try {
            return decode_numbers(bytes_of(bytes));
        } catch (const PictureFault& fault) {
            throw InputError(name + ": " + fault.what());
        }
    }();
    out.value(numbers.width());
    out.value(numbers.height());
    for (int y = 0; y < numbers.height(); ++y) {
        const std::span<const float> row = numbers.row(y);
        for (std::size_t x = 0; x < row.size(); ++x)
            if (!std::isfinite(row[x]) || (!any_sign && row[x] < 0))
                throw InputError(name + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " +
                                 std::to_string(row[x]) + "; accepted: finite" +
                                 (any_sign ? "" : ", not negative"));
        out.list(row);
    }
}

// The file is read before the child starts, so that its errors are reported as for every file.
ConfinedResult confine(const std::filesystem::path& file,
                       const std::function<void(const std::string&, ConfinedOutput&)>& work) {
    const std::string bytes = read_input_file(file, picture_kind());
    // The picture's header permits the rest.
    const ConfinedLimits limits{(std::uint64_t{256} << 20) + bytes.size(), 10};
    return run_confined(file.string(), limits, {}, [&](ConfinedOutput& out) { work(bytes, out); });
}

}  // namespace

const InputKind& picture_kind() {
    static const InputKind kind{std::uintmax_t{1} << 30, kPictureKinds};
    return kind;
}

PixelMap decode_numbers(PictureBytes bytes) {
    if (is_fits_picture(bytes)) {
        const FitsSize size = fits_picture_size(bytes);
        allow_for(size.width, size.height);
        return decode_fits_numbers(bytes);
    }
    const PictureKind kind = require_size(bytes);
    if (kind == PictureKind::kPng) return decode_png_numbers(bytes);
    if (kind == PictureKind::kTiff) return decode_tiff_numbers(bytes);
    if (kind == PictureKind::kPnm) return decode_pnm_numbers(bytes);
    throw PictureFault("is a picture of colours; accepted: TIFF, PNG, PGM or FITS of one channel");
}

Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what) {
    try {
        return decode_colors(bytes);
    } catch (const PictureFault& fault) {
        throw InputError(what + " " + fault.what());
    }
}

std::vector<std::uint8_t> decode_alpha(std::span<const std::uint8_t> bytes, const std::string& what) {
    try {
        const PictureKind kind = require_size(bytes);
        std::vector<std::uint8_t> alpha;
        if (kind == PictureKind::kPng) alpha = decode_png_alpha(bytes);
        if (kind == PictureKind::kWebp) alpha = decode_webp_alpha(bytes);
        const bool opaque = std::all_of(alpha.begin(), alpha.end(), [](std::uint8_t a) { return a == 255; });
        return opaque ? std::vector<std::uint8_t>{} : alpha;
    } catch (const PictureFault& fault) {
        throw InputError(what + " " + fault.what());
    }
}

Texture read_picture(const std::filesystem::path& file) {
    ConfinedResult result = confine(file, [&](const std::string& bytes, ConfinedOutput& out) {
        const Texture texture = decode_texture(bytes_of(bytes), file.string() + ":");
        out.value(texture.width);
        out.value(texture.height);
        out.list(std::span(texture.texels));
    });
    Texture texture{file.string(), result.value<int>(), result.value<int>(), {}};
    texture.texels = result.list<std::array<std::uint8_t, 3>>();
    if (texture.width < 1 || texture.height < 1 ||
        texture.texels.size() !=
            static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height))
        result.refuse();
    return texture;
}

PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign) {
    ConfinedResult result = confine(file, [&](const std::string& bytes, ConfinedOutput& out) {
        write_numbers(bytes, file.string(), any_sign, out);
    });
    const int width = result.value<int>(), height = result.value<int>();
    if (width < 1 || height < 1 ||
        static_cast<std::uint64_t>(width) > kMaxPicturePixels / static_cast<std::uint64_t>(height))
        result.refuse();
    PixelMap map(width, height);
    for (int y = 0; y < height; ++y) {
        const std::vector<float> row = result.list<float>();
        if (row.size() != map.row(y).size()) result.refuse();
        std::copy(row.begin(), row.end(), map.row(y).begin());
    }
    return map;
}

}  // namespace hilcam
