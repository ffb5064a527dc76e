#include "io/spice/text_kernel.h"

#include <algorithm>

#include "io/files/text_lines.h"
#include "io/system/text_number.h"

namespace hilcam {
namespace {

// Limits of one variable; KernelPool limits all together.
constexpr std::size_t kMaxKernelValues = 10'000'000, kMaxTextsOfValue = 2'000'000;

// The numbers of kernels may have Fortran's exponents.
std::optional<double> kernel_number(std::string_view text) {
    std::string plain_text(text);
    std::replace_if(
        plain_text.begin(), plain_text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'E');
    return number_of(plain_text);
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool ends_word(char c) { return is_blank(c) || c == ',' || c == '(' || c == ')' || c == '='; }

// Reads the assignments of data blocks, one after another.
class Assignments {
  public:
    Assignments(std::string_view text, const std::string& name, KernelPool& pool)
        : lines_(text, name), pool_(pool) {}

    void read() {
        bool data = false;
        for (std::string_view line; lines_.next(line);) {
            const std::string_view word = trimmed(line);
            if (word == "\\begindata") {
                data = true;
            } else if (word == "\\begintext") {
                data = false;
            } else if (data) {
                read_line(line);
            }
        }
        finish();
    }

  private:
    TextLines lines_;
    KernelPool& pool_;
    enum class Expect { kName, kOperator, kValue, kList } expect_ = Expect::kName;
    std::string name_;
    int line_of_name_ = 0;
    bool append_ = false;
    KernelVariable value_;

    void read_line(std::string_view line) {
        for (std::size_t i = 0; i < line.size();) {
            if (is_blank(line[i]) || line[i] == ',') {
                ++i;
                continue;
            }
            i = read_token(line, i);
        }
    }
    // Reads the token at i and returns where the next begins.
    std::size_t read_token(std::string_view line, std::size_t i) {
        const char c = line[i];
        switch (expect_) {
            case Expect::kName: {
                std::size_t end = i;
                while (end < line.size() && !ends_word(line[end])) ++end;
                // "NAME+=": the sign belongs to the operator.
                if (end > i && end < line.size() && line[end] == '=' && line[end - 1] == '+') --end;
                if (end == i) lines_.refuse(line.substr(i), "NAME = value");
                name_ = line.substr(i, end - i);
                line_of_name_ = lines_.number();
                expect_ = Expect::kOperator;
                return end;
            }
            case Expect::kOperator:
                append_ = c == '+';
                if (append_ && (i + 1 == line.size() || line[i + 1] != '='))
                    lines_.refuse(line.substr(i), "= or +=");
                if (!append_ && c != '=') lines_.refuse(line.substr(i), "= or += after " + in_quotes(name_));
                value_ = {};
                expect_ = Expect::kValue;
                return i + (append_ ? 2 : 1);
            case Expect::kValue:
                if (c == '(') {
                    expect_ = Expect::kList;
                    return i + 1;
                }
                i = read_value(line, i);
                store();
                return i;
            case Expect::kList:
                if (c == ')') {
                    if (value_.numbers.empty() && value_.texts.empty())
                        lines_.fail(in_quotes(name_) + ": found no value; accepted: one or more");
                    store();
                    return i + 1;
                }
                return read_value(line, i);
        }
        return line.size();
    }
    std::size_t read_value(std::string_view line, std::size_t i) {
        if (value_.numbers.size() + value_.texts.size() == kMaxKernelValues)
            lines_.fail(in_quotes(name_) + ": has more than 10000000 values");
        if (value_.texts.size() == kMaxTextsOfValue)
            lines_.fail(in_quotes(name_) + ": has more than 2000000 texts");
        if (line[i] == '\'') return read_text(line, i);
        std::size_t end = i;
        while (end < line.size() && !ends_word(line[end])) ++end;
        const std::string_view word = line.substr(i, end - i);
        const auto number = word.starts_with('@') ? kernel_date_s(word.substr(1)) : kernel_number(word);
        if (!number)
            lines_.refuse(end == i ? line.substr(i, 1) : word,
                          "a number, a text between single quotes, or @ and a date");
        if (!value_.texts.empty()) lines_.refuse(word, "texts, as before in " + in_quotes(name_));
        value_.numbers.push_back(*number);
        return end;
    }
    // A quote is doubled inside.
    std::size_t read_text(std::string_view line, std::size_t i) {
        std::string text;
        for (std::size_t at = i + 1; at < line.size(); ++at) {
            if (line[at] != '\'') {
                text += line[at];
                continue;
            }
            if (at + 1 < line.size() && line[at + 1] == '\'') {
                text += line[at++];
                continue;
            }
            if (!value_.numbers.empty()) lines_.refuse(text, "numbers, as before in " + in_quotes(name_));
            value_.texts.push_back(std::move(text));
            return at + 1;
        }
        lines_.refuse(line.substr(i), "a text that ends with a single quote on its line");
    }
    void store() {
        value_.where = lines_.name() + ":" + std::to_string(line_of_name_);
        pool_.assign(name_, std::move(value_), append_);
        value_ = {};
        expect_ = Expect::kName;
    }
    void finish() const {
        if (expect_ != Expect::kName)
            lines_.fail(in_quotes(name_) + " has no end; accepted: a value, and ) after a list",
                        line_of_name_);
    }
};

}  // namespace

void read_text_kernel(std::string_view text, const std::string& name, KernelPool& pool) {
    Assignments(text, name, pool).read();
}

}  // namespace hilcam
