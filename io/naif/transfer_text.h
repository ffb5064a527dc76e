#pragma once
// Kernels in SPICE's transfer format: the text that NAIF's toxfr and spacit write for a binary kernel, and
// that tobin turns back.
//
// The format is that of SPICELIB's DAFBT and DASBT. The first line begins with DAFETF or DASETF. Then come
// words in single quotes, and markers without quotes (BEGIN_ARRAY, BEGIN_DP_BLOCK...) with decimal numbers.
// Integers are hexadecimal ("-7F"). Doubles are hexadecimal fractions with a hexadecimal exponent of 16
// (DP2HX): "-1D8^2" is -0.1D8 (hex) times 16^2, -29.5.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

enum class TransferKind { kDaf, kDas };
// Returns the kind by a file's first six bytes; nothing when it is not a transfer file.
std::optional<TransferKind> transfer_kind_of(std::string_view first_bytes);

// Returns the double in such a word; nothing when it is malformed or not finite.
std::optional<double> transfer_double(std::string_view word);
std::optional<std::int32_t> transfer_integer(std::string_view word);

// Reads a text word by word. Every function throws InputError with file:line when the text has something
// else.
class TransferText {
  public:
    // text: must outlive this. Skips the first line.
    TransferText(std::string_view text, const std::string& name);

    // Reads a quoted line, which is a name; removes trailing blanks.
    std::string quoted_line();
    double next_double();
    std::int32_t next_integer();
    // Reads a marker with its two numbers and returns the second, the count of what follows. Only `marker` is
    // accepted.
    std::int64_t require_marker(std::string_view marker);
    // Reads a decimal number without quotes.
    std::int64_t next_count();
    // Skips blanks and line ends; true when the text goes on with that marker, which stays to be read.
    bool comes(std::string_view marker);
    // Skips to the line after the one that begins with a marker.
    void pass(std::string_view marker);

    [[noreturn]] void fail(const std::string& what) const;

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::string name_;

    void skip_blanks();
    std::string_view rest_of_line();
    std::string_view quoted_word();
    std::string_view plain_word();
};

}  // namespace hilcam
