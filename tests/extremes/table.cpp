#include "tests/extremes/table.h"

#include <cstdlib>
#include <sstream>

namespace hilcam::extremes {
namespace {

constexpr const char* kHeading = "## ";

std::string formatted(const char* format, double value) {
    char out[48];
    std::snprintf(out, sizeof out, format, value);
    return out;
}
// Two digits are what an error is worth.
std::string short_text(double value) { return value == 0 ? "0" : formatted("%.1e", value); }
std::string truth_text(double value) { return formatted("%.6g", value); }

std::string line_of(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const std::string& cell : cells) line.append(" ").append(cell).append(" |");
    return line + "\n";
}

// The value, then truth, error and limit of each quantity.
std::vector<std::string> head_of(const Group& group) {
    std::vector<std::string> cells = {group.varied};
    for (const std::string& quantity : group.quantities) {
        cells.push_back(quantity);
        cells.push_back("error");
        cells.push_back("limit");
    }
    return cells;
}
std::vector<std::string> cells_of(const Case& row, const Measured& measured) {
    std::vector<std::string> cells = {row.value};
    for (std::size_t i = 0; i < row.limits.size(); ++i) {
        const bool known = i < measured.size();
        cells.push_back(known ? truth_text(measured[i].truth) : "");
        cells.push_back(known ? short_text(measured[i].error) : "");
        cells.push_back(short_text(row.limits[i]));
    }
    return cells;
}

std::vector<std::string> cells_in(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    std::string cell;
    std::getline(in, cell, '|');
    while (std::getline(in, cell, '|')) {
        const std::size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
        cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    return cells;
}

// The rows of a table, without its head.
std::vector<std::vector<std::string>> rows_in(const std::string& document, const std::string& title) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(document);
    std::string line;
    while (std::getline(in, line) && line != kHeading + title) {
    }
    while (std::getline(in, line) && line.rfind(kHeading, 0) != 0)
        if (line.rfind("| ", 0) == 0) rows.push_back(cells_in(line));
    if (!rows.empty()) rows.erase(rows.begin());
    return rows;
}

bool same_truth(const std::string& in_document, double truth) {
    const double said = std::strtod(in_document.c_str(), nullptr);
    return std::abs(said - truth) <= 0.01 * std::abs(truth) + 1e-300;
}

}  // namespace

std::string preface() {
    return R"(# Extremes

How far the program is from the truth where values are very small, very large or nearly meaningless. Each line
is a test (ctest label `extremes`): what is varied, its value, and for each quantity the truth, the error that was found and the limit
that the test holds it to. Truths are closed forms in double precision, or published values; limits come from the grain of
single and double precision, from numbers of samples, or from the accuracy that a source states. An error of 0 is exact.

Written in the source tree by `build/ci/bin/extremes --table > docs/extremes.md`. The tests fail when this page and the suite (`tests/extremes/`)
disagree about values, truths or limits; errors differ in their last digits from machine to machine.

)";
}

std::string section(const Group& group, const std::vector<Measured>& measured) {
    std::string out = std::string(kHeading) + group.title + "\n\nTruth: " + group.truth +
                      "\n\nLimit: " + group.limit + "\n\n" + line_of(head_of(group)) + "|---";
    for (std::size_t i = 0; i < 3 * group.quantities.size(); ++i) out += "|---:";
    out += "|\n";
    for (std::size_t i = 0; i < group.cases.size(); ++i)
        out += line_of(cells_of(group.cases[i], measured[i]));
    return out;
}

std::vector<std::string> titles_in(const std::string& document) {
    std::vector<std::string> titles;
    std::istringstream in(document);
    std::string line;
    while (std::getline(in, line))
        if (line.rfind(kHeading, 0) == 0) titles.push_back(line.substr(std::string(kHeading).size()));
    return titles;
}

std::vector<std::string> differences(const std::string& document, const Group& group,
                                     const std::vector<Measured>& measured) {
    const std::vector<std::vector<std::string>> rows = rows_in(document, group.title);
    std::vector<std::string> out;
    if (rows.size() != group.cases.size())
        out.push_back(std::to_string(rows.size()) + " rows, not " + std::to_string(group.cases.size()));
    for (std::size_t i = 0; i < std::min(rows.size(), group.cases.size()); ++i) {
        const Case& row = group.cases[i];
        const std::vector<std::string> expected = cells_of(row, measured[i]);
        const auto differs = [&](const std::string& what) { out.push_back(row.value + ": " + what); };
        if (rows[i].size() != expected.size()) {
            differs(std::to_string(rows[i].size()) + " cells");
            continue;
        }
        if (rows[i][0] != expected[0]) differs("the value is " + rows[i][0]);
        for (std::size_t q = 0; q < row.limits.size(); ++q) {
            const std::string &truth = rows[i][3 * q + 1], &error = rows[i][3 * q + 2],
                              &limit = rows[i][3 * q + 3];
            if (q < measured[i].size() && !same_truth(truth, measured[i][q].truth))
                differs("the truth is " + truth);
            if (!(std::strtod(error.c_str(), nullptr) <= row.limits[q])) differs("the error is " + error);
            if (limit != expected[3 * q + 3]) differs("the limit is " + limit);
        }
    }
    return out;
}

}  // namespace hilcam::extremes
