#pragma once
// Text files line by line, with the place for messages.

#include <string>
#include <string_view>

#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

inline std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

class TextLines {
  public:
    TextLines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {}

    // The next line, without its end. False after the last.
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++number_;
        return true;
    }
    int number() const { return number_; }
    const std::string& name() const { return name_; }
    // "file:12: found 'x'; accepted: y", of the last line or of another.
    [[noreturn]] void refuse(std::string_view found, const std::string& accepted, int line = 0) const {
        fail("found " + in_quotes(found) + "; accepted: " + accepted, line);
    }
    [[noreturn]] void fail(const std::string& what, int line = 0) const {
        throw InputError(name_ + ":" + std::to_string(line ? line : number_) + ": " + what);
    }

  private:
    std::string_view rest_;
    std::string name_;
    int number_ = 0;
};

}  // namespace hilcam
