#pragma once
// Reads tables of texts: CSV with the columns' names in the first line (RFC 4180; the separator is a comma
// or, if the first line has none, a semicolon). Lines that begin with # and empty lines are skipped. Blanks
// around an unquoted field are removed.

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
    std::vector<int> lines;                      // line of each row in the file

    // Returns the index of a column. Throws InputError, which lists the file's columns, when there is no such
    // one.
    std::size_t column(std::string_view column) const;
    // Returns the field as a number. Throws InputError when it is not one.
    double number(std::size_t row, std::size_t column) const;
};

// Throw InputError, one line: the file is not readable, a row has another length, a column has no name or a
// name twice, or there is no row.
ValueTable read_value_table(const std::filesystem::path& file);
ValueTable parse_value_table(std::string_view text, const std::string& name);

// Returns the text as a field of CSV, quoted if necessary.
std::string csv_field(std::string_view text);

}  // namespace hilcam
