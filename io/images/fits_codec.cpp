// FITS pictures as numbers. Section numbers are those of the standard 4.0.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "io/images/picture_codecs.h"
#include "io/system/text_number.h"

namespace hilcam {
namespace {

constexpr std::size_t kCard = 80, kBlock = 2880, kKeyword = 8;
// Cameras write shorter headers.
constexpr std::size_t kMaxCards = 20'000;
constexpr double kMaxFloat = std::numeric_limits<float>::max();
constexpr std::uint64_t kMaxAxis = std::uint64_t{1} << 32;

// 4.1: cards of 80 letters in blocks of 2880 bytes; a keyword in the first eight letters, "= " before a
// value.
class Header {
  public:
    // Reads the header at a place in the file; its data begin at end().
    Header(PictureBytes bytes, std::size_t begin) {
        for (std::size_t card = 0, at = begin; card < kMaxCards && at + kCard <= bytes.size();
             ++card, at += kCard) {
            const std::string_view text(reinterpret_cast<const char*>(bytes.data() + at), kCard);
            const std::string keyword = trimmed(text.substr(0, kKeyword));
            if (keyword == "END") {
                end_ = begin + (at + kCard - begin + kBlock - 1) / kBlock * kBlock;
                return;
            }
            if (text.substr(kKeyword, 2) == "= ")
                values_.emplace(keyword, value_in(text.substr(kKeyword + 2)));
        }
        throw undecodable("FITS: a header without END");
    }

    std::size_t end() const { return end_; }
    std::string text(const std::string& keyword) const {
        const auto found = values_.find(keyword);
        return found == values_.end() ? "" : found->second;
    }
    double number(const std::string& keyword, double otherwise) const {
        std::string value = text(keyword);
        if (value.empty()) return otherwise;
        std::replace(value.begin(), value.end(), 'D', 'E');  // 4.2.4
        const std::optional<double> found = number_of(value);
        if (!found) throw undecodable("FITS: " + keyword + " is no number");
        return *found;
    }
    std::uint64_t count(const std::string& keyword, double otherwise) const {
        const double value = number(keyword, otherwise);
        if (!(value >= 0 && value <= static_cast<double>(kMaxAxis)) || value != std::floor(value))
            throw undecodable("FITS: " + keyword + " is no number of things");
        return static_cast<std::uint64_t>(value);
    }

  private:
    std::map<std::string, std::string> values_;
    std::size_t end_ = 0;

    static std::string trimmed(std::string_view text) {
        const std::size_t first = text.find_first_not_of(' ');
        if (first == std::string_view::npos) return {};
        return std::string(text.substr(first, text.find_last_not_of(' ') + 1 - first));
    }
    // 4.2.1: a quoted text, or a word up to the comment.
    static std::string value_in(std::string_view text) {
        const std::size_t first = text.find_first_not_of(' ');
        if (first == std::string_view::npos) return {};
        if (text[first] != '\'') return trimmed(text.substr(0, text.find('/')));
        const std::size_t end = text.find('\'', first + 1);
        return trimmed(text.substr(first + 1, end == std::string_view::npos ? end : end - first - 1));
    }
};

struct FitsImage {
    std::uint64_t width = 0, height = 0;
    int bits = 0;  // negative: floats
    std::size_t begin = 0;
    double scale = 1, zero = 0;
    std::optional<double> blank;
    bool bottom_up = false;
};

// 4.4.1.1 and 7.1.2: returns the length of an array, without the padding of its last block.
std::uint64_t bytes_of_data(const Header& h, std::uint64_t axes) {
    if (axes == 0) return 0;
    std::uint64_t values = 1;
    for (std::uint64_t i = 1; i <= axes; ++i) {
        const std::uint64_t length = h.count("NAXIS" + std::to_string(i), 0);
        if (length != 0 && values > kMaxAxis / length) throw undecodable("FITS: its array is too large");
        values *= length;
    }
    const std::uint64_t groups = std::min<std::uint64_t>(h.count("GCOUNT", 1), kMaxAxis);
    const double bytes = std::abs(h.number("BITPIX", 0)) / 8 * static_cast<double>(groups) *
                         (static_cast<double>(h.count("PCOUNT", 0)) + static_cast<double>(values));
    if (!(bytes <= 1e15)) throw undecodable("FITS: its array is too large");
    return static_cast<std::uint64_t>(bytes);
}

// Returns an image of one plane; nothing for tables and for other axes.
std::optional<FitsImage> image_in(const Header& h, std::uint64_t axes) {
    const bool is_image = !h.text("SIMPLE").empty() || h.text("XTENSION") == "IMAGE";
    if (!is_image || axes < 2) return std::nullopt;
    for (std::uint64_t i = 3; i <= axes; ++i)
        if (h.count("NAXIS" + std::to_string(i), 0) != 1) return std::nullopt;
    FitsImage out;
    out.width = h.count("NAXIS1", 0), out.height = h.count("NAXIS2", 0);
    const double bits = h.number("BITPIX", 0);
    if (bits != 8 && bits != 16 && bits != 32 && bits != -32 && bits != -64)
        throw undecodable("FITS: BITPIX " + h.text("BITPIX"));
    out.bits = static_cast<int>(bits);
    out.begin = h.end();
    out.scale = h.number("BSCALE", 1), out.zero = h.number("BZERO", 0);
    if (out.bits > 0 && !h.text("BLANK").empty()) out.blank = h.number("BLANK", 0);
    out.bottom_up = h.text("ROWORDER") == "BOTTOM-UP";
    return out;
}

FitsImage first_image(PictureBytes bytes) {
    constexpr int kMaxParts = 1000;
    std::size_t at = 0;
    bool compressed = false;
    for (int part = 0; part < kMaxParts && at + kBlock <= bytes.size(); ++part) {
        const Header h(bytes, at);
        const std::uint64_t axes = h.count("NAXIS", 0);
        if (axes > 999) throw undecodable("FITS: NAXIS " + std::to_string(axes));
        if (const std::optional<FitsImage> image = image_in(h, axes)) return *image;
        compressed = compressed || h.text("ZIMAGE") == "T";
        const std::uint64_t data = bytes_of_data(h, axes);
        at = h.end() + static_cast<std::size_t>((data + kBlock - 1) / kBlock * kBlock);
    }
    throw undecodable(compressed ? "FITS: its image is compressed (funpack makes it plain)"
                                 : "FITS: it has no image of two axes");
}

// 5: the most significant byte comes first; 8-bit integers are unsigned.
double value_at(const std::uint8_t* at, int bits) {
    std::uint64_t word = 0;
    for (int i = 0; i < std::abs(bits) / 8; ++i) word = word << 8 | at[i];
    switch (bits) {
        case 8:
            return static_cast<double>(word);
        case 16:
            return static_cast<std::int16_t>(word);
        case 32:
            return static_cast<std::int32_t>(word);
        case -32:
            return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
        default:
            return std::bit_cast<double>(word);
    }
}

}  // namespace

bool is_fits_picture(PictureBytes bytes) {
    constexpr std::string_view kBegin = "SIMPLE  =";
    return bytes.size() >= kBegin.size() &&
           std::equal(kBegin.begin(), kBegin.end(), bytes.begin(),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

FitsSize fits_picture_size(PictureBytes bytes) {
    const FitsImage image = first_image(bytes);
    return {image.width, image.height};
}

PixelMap decode_fits_numbers(PictureBytes bytes) {
    const FitsImage image = first_image(bytes);
    require_few_pixels(image.width, image.height);
    const std::size_t each = static_cast<std::size_t>(std::abs(image.bits)) / 8;
    const std::size_t wanted = each * image.width * image.height;
    if (image.begin > bytes.size() || wanted > bytes.size() - image.begin)
        throw undecodable("FITS: it ends before its last row");
    PixelMap out(static_cast<int>(image.width), static_cast<int>(image.height));
    const std::uint8_t* at = bytes.data() + image.begin;
    for (int y = 0; y < out.height(); ++y) {
        const std::span<float> row = out.row(image.bottom_up ? out.height() - 1 - y : y);
        for (float& value : row) {
            const double stored = value_at(at, image.bits);
            const double number = image.zero + image.scale * stored;
            const bool is_one = image.blank != stored && std::abs(number) <= kMaxFloat;
            value = is_one ? static_cast<float>(number) : std::numeric_limits<float>::quiet_NaN();
            at += each;
        }
    }
    return out;
}

}  // namespace hilcam
