#include "io/files/catalogue_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxCatalogueBytes = std::uintmax_t{1} << 30;  // ten times Tycho-2's stars
constexpr double kMas_rad = kArcsecond_rad * 1e-3;

struct Column {
    std::string_view name;
    double least, most;
    void (*set)(CatalogueStar& star, double value);
    bool must_be_there = false;
};

constexpr std::array kStarColumns = {
    Column{"hip", 0, 1e7, [](CatalogueStar& s, double v) { s.hip = static_cast<int>(v); }},
    Column{"hd", 0, 1e7, [](CatalogueStar& s, double v) { s.hd = static_cast<int>(v); }},
    Column{"ra_deg", 0, 360, [](CatalogueStar& s, double v) { s.right_ascension_rad = v * kDegree_rad; },
           true},
    Column{"dec_deg", -90, 90, [](CatalogueStar& s, double v) { s.declination_rad = v * kDegree_rad; }, true},
    Column{"epoch_year", 1800, 2200, [](CatalogueStar& s, double v) { s.epoch_year = v; }},
    Column{"pm_ra_mas_yr", -20000, 20000,
           [](CatalogueStar& s, double v) { s.pm_ra_cosdec_rad_yr = v * kMas_rad; }},
    Column{"pm_dec_mas_yr", -20000, 20000,
           [](CatalogueStar& s, double v) { s.pm_dec_rad_yr = v * kMas_rad; }},
    // The nearest star's is 768.5 mas. Measured ones of far stars may come out below 0, which no place has.
    Column{"parallax_mas", -1000, 1000,
           [](CatalogueStar& s, double v) { s.parallax_rad = std::max(0.0, v) * kMas_rad; }},
    Column{"v_mag", -3, 30, [](CatalogueStar& s, double v) { s.magnitude_v = v; }, true},
    Column{"b_v", -3, 10, [](CatalogueStar& s, double v) { s.color_b_v = v; }},
};

std::string_view without_line_end(std::string_view line) {
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

// Takes what stands before the next comma off the line.
std::string_view take_field(std::string_view& line) {
    const std::size_t comma = line.find(',');
    const std::string_view field = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    return field;
}

void add_name(std::string& names, std::string_view name) {
    if (!names.empty()) names += ',';
    names += name;
}

std::string all_columns() {
    std::string names;
    for (const Column& column : kStarColumns) add_name(names, column.name);
    return names;
}

// What each column of the file is; empty: no header.
std::vector<const Column*> parse_header(std::string_view line) {
    std::vector<const Column*> found;
    while (!line.empty()) {
        const std::string_view name = take_field(line);
        const auto* column = std::find_if(kStarColumns.begin(), kStarColumns.end(),
                                          [name](const Column& c) { return c.name == name; });
        if (column == kStarColumns.end() || std::find(found.begin(), found.end(), column) != found.end())
            return {};
        found.push_back(column);
    }
    for (const Column& column : kStarColumns)
        if (column.must_be_there && std::find(found.begin(), found.end(), &column) == found.end()) return {};
    return found;
}

bool parse_row(std::string_view line, const std::vector<const Column*>& columns, CatalogueStar& star) {
    if (std::count(line.begin(), line.end(), ',') + 1 != std::ssize(columns)) return false;
    for (const Column* column : columns) {
        const std::string_view field = take_field(line);
        double value = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc{} || end != field.data() + field.size() ||
            !(value >= column->least && value <= column->most))
            return false;
        column->set(star, value);
    }
    return true;
}

}  // namespace

StarCatalogue load_catalogue(const std::filesystem::path& file) {
    InputStream in(file, {kMaxCatalogueBytes, "a star catalogue in CSV"});
    StarCatalogue catalogue;
    std::vector<const Column*> columns;
    std::string text;
    for (int number = 1; std::getline(in, text); ++number) {
        const std::string_view line = without_line_end(text);
        if (line.empty() || line.starts_with('#')) continue;
        const auto refuse = [&](const std::string& accepted) {
            throw InputError(file.string() + ":" + std::to_string(number) + ": found " + in_quotes(line) +
                             "; accepted: " + accepted);
        };
        if (columns.empty()) {
            columns = parse_header(line);
            if (columns.empty())
                refuse("the names of the columns, each once: ra_deg, dec_deg and v_mag of " + all_columns());
            continue;
        }
        CatalogueStar star;
        if (!parse_row(line, columns, star)) {
            std::string names;
            for (const Column* column : columns) add_name(names, column->name);
            refuse(names);
        }
        catalogue.stars.push_back(star);
    }
    if (catalogue.stars.empty()) throw InputError(file.string() + ": holds no star");
    return catalogue;
}

}  // namespace hilcam
