#include "io/files/value_table_file.h"

#include <algorithm>

#include "io/files/text_lines.h"
#include "io/system/input_file.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxColumns = 1000;

// A quoted field ends on its line, because these tables hold numbers and words.
std::vector<std::string> fields_of(std::string_view line, char between, const TextLines& lines) {
    std::vector<std::string> out;
    while (true) {
        line = trimmed(line);
        std::string field;
        if (line.starts_with('"')) {
            line.remove_prefix(1);
            while (true) {
                const std::size_t end = line.find('"');
                if (end == std::string_view::npos) lines.fail("a quoted field does not end on its line");
                field += line.substr(0, end);
                line.remove_prefix(end + 1);
                if (!line.starts_with('"')) break;
                field += '"';
                line.remove_prefix(1);
            }
            line = trimmed(line);
            if (!line.empty() && line.front() != between)
                lines.refuse(line, "the next field after a quoted one");
        } else {
            const std::string_view plain = line.substr(0, line.find(between));
            field = trimmed(plain);
            line.remove_prefix(plain.size());
        }
        out.push_back(std::move(field));
        if (out.size() > kMaxColumns)
            lines.fail("found more than " + std::to_string(kMaxColumns) + " fields");
        if (line.empty()) return out;
        line.remove_prefix(1);
    }
}

}  // namespace

ValueTable parse_value_table(std::string_view text, const std::string& name) {
    ValueTable table;
    table.name = name;
    TextLines lines(text, name);
    char between = ',';
    for (std::string_view line; lines.next(line);) {
        if (lines.number() == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
        if (trimmed(line).empty() || line.starts_with('#')) continue;
        if (table.columns.empty()) {
            if (line.find(',') == std::string_view::npos && line.find(';') != std::string_view::npos)
                between = ';';
            table.columns = fields_of(line, between, lines);
            for (auto column = table.columns.begin(); column != table.columns.end(); ++column) {
                if (column->empty()) lines.refuse("", "a name for each column");
                if (std::find(table.columns.begin(), column, *column) != column)
                    lines.refuse(*column, "each column once");
            }
            continue;
        }
        std::vector<std::string> row = fields_of(line, between, lines);
        if (row.size() != table.columns.size())
            lines.fail("found " + std::to_string(row.size()) +
                       " fields; accepted: " + std::to_string(table.columns.size()) + ", as many as columns");
        table.rows.push_back(std::move(row));
        table.lines.push_back(lines.number());
    }
    if (table.rows.empty())
        throw InputError(name +
                         ": found no row; accepted: a line of columns' names, then a line for each row");
    return table;
}

ValueTable read_value_table(const std::filesystem::path& file) {
    const InputKind kind{64u << 20, "a table (CSV)"};
    return parse_value_table(read_input_file(file, kind), file.string());
}

std::size_t ValueTable::column(std::string_view wanted) const {
    const auto found = std::find(columns.begin(), columns.end(), wanted);
    if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
    std::string known;
    for (const std::string& c : columns)
        if (known.size() < 400) known += (known.empty() ? "" : ", ") + in_quotes(c);
    throw InputError(name + ": has no column " + in_quotes(wanted) + "; its columns: " + known);
}

double ValueTable::number(std::size_t row, std::size_t column) const {
    const auto value = number_of(rows[row][column]);
    if (!value)
        throw InputError(name + ":" + std::to_string(lines[row]) + ": " + columns[column] + ": found " +
                         in_quotes(rows[row][column]) + "; accepted: a number");
    return *value;
}

std::string csv_field(std::string_view text) {
    if (text.find_first_of(",;\"\r\n#") == std::string_view::npos && trimmed(text).size() == text.size())
        return std::string(text);
    std::string out = "\"";
    for (const char c : text) out.append(c == '"' ? 2 : 1, c == '\n' || c == '\r' ? ' ' : c);
    return out + '"';
}

}  // namespace hilcam
