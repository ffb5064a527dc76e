#pragma once
// Writes kernels in SPICE's transfer format from what SPICELIB's DAFBT and DASBT say of it, with nothing of the readers.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/support/spice_writer.h"

namespace hilcam {

inline std::string transfer_word(std::int64_t value) {
    char text[32];
    std::snprintf(text, sizeof text, "'%s%llX'\n", value < 0 ? "-" : "",
                  static_cast<unsigned long long>(value < 0 ? -value : value));
    return text;
}
// A fraction of sixteenths, 1/16 to 1, without zeros at its end, and its power of 16.
inline std::string transfer_word(double value) {
    if (value == 0) return "'0^0'\n";
    int exponent = 0;
    double fraction = std::abs(value);
    while (fraction >= 1) fraction /= 16, ++exponent;
    while (fraction < 1.0 / 16) fraction *= 16, --exponent;
    std::string digits;
    while (fraction > 0) {
        const int digit = static_cast<int>(fraction * 16);
        digits += "0123456789ABCDEF"[digit];
        fraction = fraction * 16 - digit;
    }
    char power[16];
    std::snprintf(power, sizeof power, "%s%X", exponent < 0 ? "-" : "",
                  static_cast<unsigned>(std::abs(exponent)));
    return std::string("'") + (value < 0 ? "-" : "") + digits + "^" + power + "'\n";
}

inline std::string transfer_line(std::string text, std::size_t width) {
    text.resize(width, ' ');
    return "'" + text + "'\n";
}

// Blocks of 1024 words, each after its count.
inline std::string transfer_daf(const std::string& kind, const std::vector<WrittenArray>& arrays) {
    std::string out = "DAFETF NAIF DAF ENCODED TRANSFER FILE\n" + transfer_line("DAF/" + kind, 8) +
                      transfer_word(std::int64_t{2}) + transfer_word(std::int64_t{kind == "PCK" ? 5 : 6}) +
                      transfer_line("of the tests", 60);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const WrittenArray& a = arrays[i];
        const std::string numbers = std::to_string(i + 1) + " " + std::to_string(a.words.size()) + "\n";
        out += "BEGIN_ARRAY " + numbers + transfer_line(a.name, 40) + transfer_word(a.start) +
               transfer_word(a.stop);
        for (const std::int32_t n : a.integers) out += transfer_word(std::int64_t{n});
        for (std::size_t w = 0; w < a.words.size(); ++w) {
            if (w % 1024 == 0) out += std::to_string(std::min<std::size_t>(1024, a.words.size() - w)) + "\n";
            out += transfer_word(a.words[w]);
        }
        out += "END_ARRAY " + numbers;
    }
    return out + "TOTAL_ARRAYS " + std::to_string(arrays.size()) +
           "\n ~NAIF/SPC BEGIN COMMENTS~\nnone\n ~NAIF/SPC END COMMENTS~\n";
}

// With comments and characters, which a reader of numbers passes over.
inline std::string transfer_das(const std::vector<double>& doubles,
                                const std::vector<std::int32_t>& integers) {
    std::string out = "DASETF NAIF DAS ENCODED TRANSFER FILE\n" + transfer_line("DAS/DSK", 8) +
                      transfer_line("of the tests", 60);
    for (const std::int64_t n : {0, 0, 1, 8}) out += transfer_word(n);
    out += "BEGIN_COMMENT_BLOCK 1 8\n'it''s one'\nEND_COMMENT_BLOCK 1 8\nTOTAL_COMMENT_BLOCKS 1 8\n";
    out += transfer_word(std::int64_t{4}) + transfer_word(static_cast<std::int64_t>(doubles.size())) +
           transfer_word(static_cast<std::int64_t>(integers.size()));
    out += "BEGIN_CHARACTER_BLOCK 1 4\n'name'\nEND_CHARACTER_BLOCK 1 4\nTOTAL_CHARACTER_BLOCKS 1 4\n";
    const auto blocks = [&](const char* kind, const auto& numbers, const auto& word) {
        std::size_t block = 0;
        for (std::size_t from = 0; from < numbers.size(); from += 1024) {
            const std::size_t count = std::min<std::size_t>(1024, numbers.size() - from);
            const std::string ends = std::to_string(++block) + " " + std::to_string(count) + "\n";
            out += std::string("BEGIN_") + kind + "_BLOCK " + ends;
            for (std::size_t i = 0; i < count; ++i) out += word(numbers[from + i]);
            out += std::string("END_") + kind + "_BLOCK " + ends;
        }
        out += std::string("TOTAL_") + kind + "_BLOCKS " + std::to_string(block) + " " +
               std::to_string(numbers.size()) + "\n";
    };
    blocks("DP", doubles, [](double x) { return transfer_word(x); });
    blocks("INTEGER", integers, [](std::int32_t n) { return transfer_word(std::int64_t{n}); });
    return out;
}

}  // namespace hilcam
