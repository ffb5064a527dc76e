#include "io/files/defect_list.h"

#include <array>
#include <cmath>

#include "io/files/value_table_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::array kKinds = {"hot", "dead", "blinking"};  // in the order of DefectKind
constexpr double kMostPixel = 16383, kMostValue = 1e9;

[[noreturn]] void refuse(const ValueTable& table, std::size_t row, const std::string& found,
                         const std::string& accepted) {
    throw InputError(table.name + ":" + std::to_string(table.lines[row]) + ": found " + found +
                     "; accepted: " + accepted);
}

DefectKind kind_in(const ValueTable& table, std::size_t row, const std::string& word) {
    for (std::size_t i = 0; i < kKinds.size(); ++i)
        if (word == kKinds[i]) return static_cast<DefectKind>(i);
    refuse(table, row, "the kind " + in_quotes(word), "hot, dead, blinking");
}

int place_in(const ValueTable& table, std::size_t row, std::size_t column) {
    const double value = table.number(row, column);
    if (!(value >= 0 && value <= kMostPixel) || value != std::floor(value))
        refuse(table, row, table.columns[column] + " " + in_quotes(table.rows[row][column]),
               "a whole number from 0 to 16383");
    return static_cast<int>(value);
}

std::vector<ListedDefect> defects_in(const ValueTable& table) {
    const std::size_t kind = table.column("kind"), x = table.column("x"), y = table.column("y"),
                      value = table.column("value");
    std::vector<ListedDefect> out;
    out.reserve(table.rows.size());
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        ListedDefect defect;
        defect.kind = kind_in(table, row, table.rows[row][kind]);
        defect.x = place_in(table, row, x), defect.y = place_in(table, row, y);
        defect.value = table.number(row, value);
        if (!(defect.value >= 0 && defect.value <= kMostValue))
            refuse(table, row, "the value " + in_quotes(table.rows[row][value]), "0 to 1e9");
        out.push_back(defect);
    }
    return out;
}

}  // namespace

std::vector<ListedDefect> read_defect_list(const std::filesystem::path& file) {
    return defects_in(read_value_table(file));
}

std::vector<ListedDefect> parse_defect_list(std::string_view text, const std::string& name) {
    return defects_in(parse_value_table(text, name));
}

std::string defect_list_text(const std::vector<ListedDefect>& defects) {
    std::string out =
        "# Pixels are counted from 0. hot: dark current [e-/s]; blinking: difference of its states [e-]\n"
        "kind,x,y,value\n";
    for (const ListedDefect& d : defects)
        out += std::string(kKinds[static_cast<std::size_t>(d.kind)]) + "," + std::to_string(d.x) + "," +
               std::to_string(d.y) + "," + plain(d.value) + "\n";
    return out;
}

}  // namespace hilcam
