#include "io/files/catalogue_file.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/m_stars.h"
#include "io/system/input_file.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
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
    bool may_be_empty = false;  // may be empty in some lines
    bool is_text = false;       // the spectral class, which gives V-I where v_i is missing
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
    // The nearest star has 768.5 mas. Measured parallaxes of far stars may be negative, which no distance
    // has.
    Column{"parallax_mas", -1000, 1000,
           [](CatalogueStar& s, double v) { s.parallax_rad = std::max(0.0, v) * kMas_rad; }},
    Column{"v_mag", -3, 30, [](CatalogueStar& s, double v) { s.magnitude_v = v; }, true},
    Column{"b_v", -3, 10, [](CatalogueStar& s, double v) { s.color_b_v = v; }},
    Column{"v_i", -3, 15, [](CatalogueStar& s, double v) { s.color_v_i = v; }, false, true},
    Column{"spectral_type", 0, 0, nullptr, false, true, true},
};

std::string_view without_line_end(std::string_view line) {
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

// Removes the field up to the next comma from the line, and returns it.
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

// Returns the meaning of each column of the file; empty when there is no header.
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

std::string names_of(const std::vector<const Column*>& columns) {
    std::string names;
    for (const Column* column : columns) add_name(names, column->name);
    return names;
}

// Throws InputError that begins with `where` and names the malformed value.
CatalogueStar parse_row(const std::string& where, std::string_view line,
                        const std::vector<const Column*>& columns) {
    const std::string_view whole = line;
    const auto fields = std::count(line.begin(), line.end(), ',') + 1;
    if (fields != std::ssize(columns))
        throw refused(where, std::to_string(fields) + " values in " + in_quotes(whole),
                      std::to_string(columns.size()) + ": " + names_of(columns));
    CatalogueStar star;
    std::optional<double> v_i_of_class;
    for (const Column* column : columns) {
        const std::string_view field = take_field(line);
        if (field.empty() && column->may_be_empty) continue;
        if (column->is_text) {
            v_i_of_class = m_star_v_i(field);
            continue;
        }
        const auto value = parsed_as<double>(field);
        if (!value || !(*value >= column->least && *value <= column->most))
            throw refused(where + ": " + std::string(column->name),
                          in_quotes(field) + " in " + in_quotes(whole),
                          "a number, " + plain(column->least) + " to " + plain(column->most));
        column->set(star, *value);
    }
    if (!star.color_v_i) star.color_v_i = v_i_of_class;
    return star;
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
        const std::string where = file.string() + ":" + std::to_string(number);
        if (columns.empty()) {
            columns = parse_header(line);
            if (columns.empty())
                throw refused(
                    where, in_quotes(line),
                    "the names of the columns, each once: ra_deg, dec_deg and v_mag of " + all_columns());
            catalogue.tells_red_stars = std::any_of(columns.begin(), columns.end(), [](const Column* c) {
                return c->name == "v_i" || c->is_text;
            });
            continue;
        }
        catalogue.stars.push_back(parse_row(where, line, columns));
    }
    if (catalogue.stars.empty()) throw InputError(file.string() + ": holds no star");
    return catalogue;
}

}  // namespace hilcam
