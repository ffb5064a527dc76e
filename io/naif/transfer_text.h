#pragma once
// Kernels in SPICE's transfer format: the text that NAIF's toxfr and spacit make of a binary kernel and tobin turns back.
//
// As SPICELIB's DAFBT and DASBT write it: a line that begins with DAFETF or DASETF, then words in single quotes and markers
// without (BEGIN_ARRAY, BEGIN_DP_BLOCK...) with decimal numbers behind them. Whole numbers are hexadecimal ("-7F"); doubles
// are hexadecimal fractions with a hexadecimal exponent of 16 (DP2HX): "-1D8^2" is -0.1D8 (hex) times 16^2, -29.5.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

enum class TransferKind { kDaf, kDas };
// The kind by a file's first six bytes; nothing for what is no transfer file.
std::optional<TransferKind> transfer_kind_of(std::string_view first_bytes);

// A double by such words; nothing for what is none, or is not finite.
std::optional<double> transfer_double(std::string_view word);
std::optional<std::int32_t> transfer_integer(std::string_view word);

// Word by word. All throw InputError with file:line where the text has something else.
class TransferText {
  public:
    // The text is the caller's. Passes over its first line.
    TransferText(std::string_view text, const std::string& name);

    // A line in quotes, which is a name: blanks at its end go.
    std::string quoted_line();
    double next_double();
    std::int32_t next_integer();
    // A marker with its two numbers, the second of which counts what follows; `marker` is accepted alone.
    std::int64_t require_marker(std::string_view marker);
    // A decimal number without quotes.
    std::int64_t next_count();
    // Goes on at the next line when a marker of that name comes now.
    bool comes(std::string_view marker);
    // Goes behind the line that begins with a marker: what is before it is not wanted.
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
