#pragma once
// Tables of texts: CSV whose first line names the columns (RFC 4180, with a comma or, where the first line has
// none, a semicolon between the fields). Lines that begin with # and empty ones are skipped; blanks about a
// field that is not quoted are not part of it.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

struct ValueTable {
    std::string name;  // the file's name, for messages
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;  // each as long as columns
    std::vector<int> lines;                      // where each row stands

    // Throws InputError that names the file's columns when it has no such one.
    std::size_t column(std::string_view column) const;
    // Throws InputError unless the field is a number.
    double number(std::size_t row, std::size_t column) const;
};

// Throw InputError, one line: not readable, a row of another length, a column without a name or given twice,
// no row.
ValueTable read_value_table(const std::filesystem::path& file);
ValueTable parse_value_table(std::string_view text, const std::string& name);

// Returns a field as CSV has it, quoted where it must be.
std::string csv_field(std::string_view text);

}  // namespace hilcam
