#include "io/images/fits_file.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

constexpr std::size_t kCardBytes = 80, kBlockBytes = 2880;  // sections 3.1, 3.3

void fill_block(char with, std::string& out) {
    out.resize((out.size() + kBlockBytes - 1) / kBlockBytes * kBlockBytes, with);
}

// Section 4.2.1: printable ASCII only.
std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text) out += c >= ' ' && c <= '~' ? c : '?';
    return out;
}

// Section 4.2.4: 16 digits, with a decimal point.
std::string real_text(double value) {
    std::array<char, 40> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
    std::string out(text.data(), end.ptr);
    const std::size_t exponent = out.find('e');
    if (exponent != std::string::npos) out[exponent] = 'E';
    if (out.find('.') != std::string::npos) return out;
    const std::size_t digits = std::min(exponent, out.size());
    return out.substr(0, digits).append(".0").append(out, digits);
}

class Cards {
  public:
    void logical(std::string_view key, bool value, std::string_view comment) {
        fixed(key, value ? "T" : "F", comment);
    }
    void whole(std::string_view key, std::int64_t value, std::string_view comment) {
        fixed(key, std::to_string(value), comment);
    }
    // A value that is not finite cannot be written in a header.
    void real(std::string_view key, double value, std::string_view comment) {
        if (std::isfinite(value)) fixed(key, real_text(value), comment);
    }
    // Section 4.2.1: quotes are doubled, and a text has at least eight characters. What exceeds a card is cut
    // off.
    void text(std::string_view key, std::string_view value, std::string_view comment) {
        std::string quoted;
        for (const char c : printable(value)) {
            if (quoted.size() + (c == '\'' ? 2 : 1) > 68) break;
            quoted.append(c == '\'' ? 2 : 1, c);
        }
        quoted.resize(std::max<std::size_t>(quoted.size(), 8), ' ');
        put(key, "'" + quoted + "'", comment);
    }
    // Section 4.4.2.4: as many cards as needed.
    void comment(const std::string& words) {
        constexpr std::size_t kMax = 72;
        std::istringstream in(printable(words));
        std::string line;
        for (std::string word; in >> word; line.append(line.empty() ? "" : " ").append(word)) {
            if (line.size() + 1 + word.size() <= kMax) continue;
            add("COMMENT " + line);
            line.clear();
        }
        add("COMMENT " + line);
    }

    // Section 4.4.1: END, then blanks to the end of the block.
    std::string finished() {
        add("END");
        fill_block(' ', out_);
        return std::move(out_);
    }

  private:
    std::string out_;

    void add(std::string card) {
        card.resize(kCardBytes, ' ');
        out_ += card;
    }
    // Section 4.2: the value ends in column 30.
    void fixed(std::string_view key, const std::string& value, std::string_view comment) {
        put(key, std::string(20 - std::min<std::size_t>(value.size(), 20), ' ') + value, comment);
    }
    void put(std::string_view key, const std::string& value, std::string_view comment) {
        std::string card(key);
        card.resize(8, ' ');
        card += "= " + value;
        if (!comment.empty() && card.size() + 4 < kCardBytes) card += " / " + printable(comment);
        add(std::move(card));
    }
};

void put_note(const PictureNote& note, Cards& cards) {
    if (note.fits.empty()) return;
    if (const auto* const text = std::get_if<std::string>(&note.value))
        cards.text(note.fits, *text, note.meaning);
    if (const auto* const whole = std::get_if<std::int64_t>(&note.value))
        cards.whole(note.fits, *whole, note.meaning);
    if (const auto* const real = std::get_if<double>(&note.value)) cards.real(note.fits, *real, note.meaning);
    if (const auto* const list = std::get_if<std::vector<double>>(&note.value))
        for (std::size_t i = 0; i < list->size(); ++i)
            cards.real(note.fits + std::to_string(i + 1), (*list)[i], note.meaning);
    if (const auto* const list = std::get_if<std::vector<std::int64_t>>(&note.value))
        for (std::size_t i = 0; i < list->size(); ++i)
            cards.whole(note.fits + std::to_string(i + 1), (*list)[i], note.meaning);
}

// Section 9: without the Z of other formats. To the microsecond, because exposures may be shorter than a
// millisecond.
std::string fits_time(TimeTai time) {
    std::string text = format_utc(time, 6);
    if (text.ends_with('Z')) text.pop_back();
    return text;
}

void put_times(const PictureNotes& notes, Cards& cards) {
    const PictureNote* const middle = find_note(notes, "time_tai_ns");
    const PictureNote* const exposure = find_note(notes, "exposure_s");
    if (!middle || !exposure) return;
    const TimeTai time{std::get<std::int64_t>(middle->value)};
    const std::int64_t half_ns = to_ns(std::get<double>(exposure->value) / 2);
    cards.text("TIMESYS", "UTC", "of the times below");
    cards.text("DATE-OBS", fits_time(time + -half_ns), "begin of the exposure");
    cards.text("DATE-AVG", fits_time(time), "its middle");
    cards.text("DATE-END", fits_time(time + half_ns), "its end");
}

void put_sky(const SkyMap& sky, const PictureNotes& notes, Cards& cards) {
    cards.whole("WCSAXES", 2, "");
    cards.text("RADESYS", "ICRS", "");
    cards.text("CTYPE1", sky.fisheye ? "RA---ARC" : "RA---TAN", "lens without its distortion");
    cards.text("CTYPE2", sky.fisheye ? "DEC--ARC" : "DEC--TAN", "");
    cards.text("CUNIT1", "deg", "");
    cards.text("CUNIT2", "deg", "");
    cards.real("CRVAL1", sky.ra_deg, "boresight, right ascension");
    cards.real("CRVAL2", sky.dec_deg, "boresight, declination");
    cards.real("CRPIX1", sky.reference_px.x, "boresight in the picture");
    cards.real("CRPIX2", sky.reference_px.y, "");
    cards.real("CD1_1", sky.east_deg_px[0], "");
    cards.real("CD1_2", sky.east_deg_px[1], "");
    cards.real("CD2_1", sky.north_deg_px[0], "");
    cards.real("CD2_2", sky.north_deg_px[1], "");
    if (find_note(notes, "distortion"))
        cards.comment("The WCS leaves out the lens's distortion: DISTORT1 and on.");
    cards.comment("Stars are seen aberrated by the camera's velocity; the WCS is its attitude's.");
}

struct FitsShape {
    int bits, width, height;  // bits: BITPIX
};

std::string header_of(const FitsShape& shape, const FitsHeader& header) {
    Cards cards;
    cards.logical("SIMPLE", true, "FITS 4.0");
    cards.whole("BITPIX", shape.bits, "");
    cards.whole("NAXIS", 2, "");
    cards.whole("NAXIS1", shape.width, "");
    cards.whole("NAXIS2", shape.height, "");
    if (shape.bits == 16) {
        cards.whole("BSCALE", 1, "");
        cards.whole("BZERO", 32768, "16-bit numbers without sign");
    }
    cards.text("BUNIT", header.unit, "of a pixel's number");
    cards.text("ROWORDER", "TOP-DOWN", "the first row is the frame's uppermost");
    put_times(header.notes, cards);
    for (const PictureNote& note : header.notes) put_note(note, cards);
    if (header.sky) put_sky(*header.sky, header.notes, cards);
    return cards.finished();
}

template <class Word>
void append_big_endian(Word word, std::string& out) {
    for (int shift = 8 * static_cast<int>(sizeof word) - 8; shift >= 0; shift -= 8)
        out += static_cast<char>(word >> shift);
}

}  // namespace

std::string encode_fits(const DnImage& frame, const FitsHeader& header) {
    std::string out = header_of({16, frame.width(), frame.height()}, header);
    out.reserve(out.size() + 2 * frame.pixels() + kBlockBytes);
    for (const std::uint16_t dn : frame.plane(0))
        append_big_endian(static_cast<std::uint16_t>(dn ^ 0x8000), out);
    fill_block('\0', out);
    return out;
}

std::size_t fits_header_bytes(std::string_view file) {
    // END is a card of its own; no other card begins with it.
    std::size_t card = 0;
    while (card + kCardBytes <= file.size() && !file.substr(card, kCardBytes).starts_with("END "))
        card += kCardBytes;
    return (card + kCardBytes + kBlockBytes - 1) / kBlockBytes * kBlockBytes;
}

std::string encode_fits(const ElectronImage& electrons, const FitsHeader& header) {
    std::string out = header_of({-32, electrons.width(), electrons.height()}, header);
    out.reserve(out.size() + 4 * electrons.pixels() + kBlockBytes);
    for (const float value : electrons.plane(0)) append_big_endian(std::bit_cast<std::uint32_t>(value), out);
    fill_block('\0', out);
    return out;
}

}  // namespace hilcam
