#pragma once
// Reads text files line by line and keeps the place for messages.

#include <string>
#include <string_view>
#include <vector>

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

// Names the first blank in a text that is not ASCII, as word processors, web pages and PDF use: "U+00A0, a
// non-breaking blank"; empty when there is none. A lone byte 0xA0 counts as Latin 1's.
std::string odd_blank_in(std::string_view text);

class TextLines {
  public:
    // Skips a byte-order mark of UTF-8, as editors on Windows write. Throws InputError for UTF-16.
    TextLines(std::string_view text, std::string name);

    // Gets the next line without its end; false after the last.
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++count_;
        number_ = numbers_ ? (*numbers_)[count_ - 1] : static_cast<int>(count_);
        return true;
    }
    int number() const { return number_; }
    const std::string& name() const { return name_; }
    // Throws InputError, "file:12: found 'x'; accepted: y", about the last line or another. It names a blank
    // that only looks like a plain one.
    [[noreturn]] void refuse(std::string_view found, const std::string& accepted, int line = 0) const {
        const std::string odd = odd_blank_in(found);
        fail("found " + in_quotes(found) + (odd.empty() ? "" : ", which has " + odd) +
                 "; accepted: " + accepted + (odd.empty() ? "" : ", with plain blanks"),
             line);
    }
    [[noreturn]] void fail(const std::string& what, int line = 0) const {
        throw InputError(name_ + ":" + std::to_string(line ? line : number_) + ": " + what);
    }

  protected:
    // Continues with another text, made from the file's; numbers[i] is the file's line for its line i. Both
    // must outlive this.
    void go_on_with(std::string_view text, const std::vector<int>& numbers) {
        rest_ = text, numbers_ = &numbers, count_ = 0;
    }
    std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
    std::string name_;
    const std::vector<int>* numbers_ = nullptr;
    std::size_t count_ = 0;
    int number_ = 0;
};

}  // namespace hilcam
