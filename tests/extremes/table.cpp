#include "tests/extremes/table.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

namespace hilcam::extremes {
namespace {

enum Column : std::size_t { kTable, kVaried, kValue, kQuantity, kTruth, kError, kLimit, kColumns };
constexpr std::array<const char*, kColumns> kNames = {"table", "varied", "value", "quantity",
                                                      "truth", "error",  "limit"};
using Line = std::vector<std::string>;

std::string formatted(const char* format, double value) {
    char out[48];
    std::snprintf(out, sizeof out, format, value);
    return out;
}
// Two digits are what an error is worth.
std::string short_text(double value) { return value == 0 ? "0" : formatted("%.1e", value); }
std::string truth_text(double value) { return formatted("%.6g", value); }

// CSV after RFC 4180: a cell with a comma or a quote is quoted, and its quotes are doubled.
std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string out(1, '"');
    for (const char c : text) out.append(c == '"' ? 2 : 1, c);
    return out + '"';
}
std::string csv_line(const Line& cells) {
    std::string line;
    for (const std::string& cell : cells) line.append(line.empty() ? "" : ",").append(csv_cell(cell));
    return line + "\n";
}
Line cells_in(const std::string& line) {
    Line cells(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}
// The lines below the head.
std::vector<Line> lines_in(const std::string& file) {
    std::vector<Line> lines;
    std::istringstream in(file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) lines.push_back(cells_in(line));
    return lines;
}

Line expected_line(const Group& group, const Case& row, std::size_t quantity, const Measured& measured) {
    const bool known = quantity < measured.size();
    return {group.title,
            group.varied,
            row.value,
            group.quantities[quantity],
            known ? truth_text(measured[quantity].truth) : "",
            known ? short_text(measured[quantity].error) : "",
            short_text(row.limits[quantity])};
}

bool same_truth(const std::string& in_file, double truth) {
    const double said = std::strtod(in_file.c_str(), nullptr);
    return std::abs(said - truth) <= 0.01 * std::abs(truth) + 1e-300;
}

}  // namespace

std::string head_line() { return csv_line({kNames.begin(), kNames.end()}); }

std::string lines_of(const Group& group, const std::vector<Measured>& measured) {
    std::string out;
    for (std::size_t i = 0; i < group.cases.size(); ++i)
        for (std::size_t q = 0; q < group.quantities.size(); ++q)
            out += csv_line(expected_line(group, group.cases[i], q, measured[i]));
    return out;
}

std::vector<std::string> titles_in(const std::string& file) {
    std::vector<std::string> titles;
    for (const Line& line : lines_in(file))
        if (titles.empty() || titles.back() != line[kTable]) titles.push_back(line[kTable]);
    return titles;
}

std::vector<std::string> differences(const std::string& file, const Group& group,
                                     const std::vector<Measured>& measured) {
    std::vector<Line> lines = lines_in(file);
    std::erase_if(lines, [&](const Line& line) { return line[kTable] != group.title; });
    std::vector<std::string> out;
    const std::size_t quantities = group.quantities.size(), expected = group.cases.size() * quantities;
    if (lines.size() != expected)
        out.push_back(std::to_string(lines.size()) + " lines, not " + std::to_string(expected));
    for (std::size_t i = 0; i < std::min(lines.size(), expected); ++i) {
        const Case& row = group.cases[i / quantities];
        const Measured& found = measured[i / quantities];
        const std::size_t q = i % quantities;
        const Line right = expected_line(group, row, q, found);
        const Line& line = lines[i];
        const auto differs = [&](const std::string& what) {
            out.push_back(row.value + ", " + group.quantities[q] + ": " + what);
        };
        if (line.size() != kColumns) {
            differs(std::to_string(line.size()) + " cells");
            continue;
        }
        for (const Column column : {kVaried, kValue, kQuantity, kLimit})
            if (line[column] != right[column])
                differs(std::string("the ") + kNames[column] + " is " + line[column]);
        if (q < found.size() && !same_truth(line[kTruth], found[q].truth))
            differs("the truth is " + line[kTruth]);
        if (!(std::strtod(line[kError].c_str(), nullptr) <= row.limits[q]))
            differs("the error is " + line[kError]);
    }
    return out;
}

}  // namespace hilcam::extremes
