#include "io/naif/transfer_text.h"

#include <algorithm>
#include <cmath>

#include "io/naif/naif_record.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// A double has 53 bits, 14 hexadecimal digits at most.
constexpr std::size_t kMaxTransferDigits = 16;
// 16^256 is 2^1024, just beyond the largest double.
constexpr int kMaxExponent = 300;

// Parses at most `most` hexadecimal digits in capitals.
std::optional<std::uint64_t> hex_of(std::string_view digits, std::size_t most) {
    if (digits.empty() || digits.size() > most) return {};
    std::uint64_t value = 0;
    for (const char c : digits) {
        const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
        if (digit < 0) return {};
        value = value << 4 | static_cast<std::uint64_t>(digit);
    }
    return value;
}

bool take_sign(std::string_view& word) {
    const bool negative = word.starts_with('-');
    if (negative) word.remove_prefix(1);
    return negative;
}

}  // namespace

std::optional<TransferKind> transfer_kind_of(std::string_view first_bytes) {
    if (first_bytes.starts_with("DAFETF")) return TransferKind::kDaf;
    if (first_bytes.starts_with("DASETF")) return TransferKind::kDas;
    return {};
}

std::optional<double> transfer_double(std::string_view word) {
    const std::size_t caret = word.find('^');
    if (caret == std::string_view::npos) return {};
    std::string_view mantissa = word.substr(0, caret), exponent = word.substr(caret + 1);
    const bool negative = take_sign(mantissa), down = take_sign(exponent);
    const auto digits = hex_of(mantissa, kMaxTransferDigits);
    const auto power = hex_of(exponent, 3);
    if (!digits || !power || *power > kMaxExponent) return {};
    const int bits = 4 * ((down ? -1 : 1) * static_cast<int>(*power) - static_cast<int>(mantissa.size()));
    const double value = std::ldexp(static_cast<double>(*digits), bits);
    if (!std::isfinite(value)) return {};
    return negative ? -value : value;
}

std::optional<std::int32_t> transfer_integer(std::string_view word) {
    const bool negative = take_sign(word);
    const auto value = hex_of(word, 8);
    if (!value || *value > (negative ? 0x80000000u : 0x7FFFFFFFu)) return {};
    const auto whole = static_cast<std::int64_t>(*value);
    return static_cast<std::int32_t>(negative ? -whole : whole);
}

TransferText::TransferText(std::string_view text, const std::string& name) : text_(text), name_(name) {
    rest_of_line();
}

void TransferText::fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line_) + ": " + what);
}

void TransferText::skip_blanks() {
    for (; at_ < text_.size(); ++at_) {
        const char c = text_[at_];
        if (c != ' ' && c != '\n' && c != '\r' && c != '\t' && c != ',') return;
        if (c == '\n') ++line_;
    }
    fail("the file ends; accepted: a whole kernel in transfer format");
}

// Returns the rest of the line and moves behind its end.
std::string_view TransferText::rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string TransferText::quoted_line() {
    skip_blanks();
    const std::string_view line = rest_of_line();
    const std::size_t end = line.rfind('\'');
    if (!line.starts_with('\'') || end == 0) {
        --line_;
        fail("found " + in_quotes(line) + "; accepted: a name in single quotes");
    }
    return without_tail(line.substr(1, end - 1));
}

std::string_view TransferText::quoted_word() {
    skip_blanks();
    const std::size_t begin = at_ + 1, end = text_.find_first_of("'\n", begin);
    if (text_[at_] != '\'' || end == std::string_view::npos || text_[end] != '\'')
        fail("found " + in_quotes(text_.substr(at_, 40)) + "; accepted: a number in single quotes");
    at_ = end + 1;
    return text_.substr(begin, end - begin);
}

std::string_view TransferText::plain_word() {
    skip_blanks();
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
}

double TransferText::next_double() {
    const std::string_view word = quoted_word();
    const auto value = transfer_double(word);
    if (!value) fail("found " + in_quotes(word) + "; accepted: a finite double as '-1D8^2'");
    return *value;
}

std::int32_t TransferText::next_integer() {
    const std::string_view word = quoted_word();
    const auto value = transfer_integer(word);
    if (!value) fail("found " + in_quotes(word) + "; accepted: a hexadecimal whole number as '-7F'");
    return *value;
}

std::int64_t TransferText::next_count() {
    const std::string_view word = plain_word();
    const auto count = parsed_as<std::int64_t>(word);
    if (!count || *count < 0) fail("found " + in_quotes(word) + "; accepted: a count");
    return *count;
}

std::int64_t TransferText::require_marker(std::string_view marker) {
    const std::string_view word = plain_word();
    if (word != marker) fail("found " + in_quotes(word) + "; accepted: " + std::string(marker));
    next_count();
    return next_count();
}

bool TransferText::comes(std::string_view marker) {
    skip_blanks();
    return text_.substr(at_).starts_with(marker);
}

void TransferText::pass(std::string_view marker) {
    for (;;) {
        skip_blanks();
        if (rest_of_line().starts_with(marker)) return;
    }
}

}  // namespace hilcam
