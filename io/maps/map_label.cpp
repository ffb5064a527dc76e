#include "io/maps/map_label.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/maps/label_statements.h"
#include "io/system/text_number.h"

namespace hilcam {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";

// Returns the first word of a value, or the contents of its first quotation.
std::string first_word(std::string_view value) {
    const std::size_t begin = value.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    value.remove_prefix(begin);
    if (value.front() == '"' || value.front() == '\'') {
        const char quote = value.front();
        value.remove_prefix(1);
        return std::string(value.substr(0, std::min(value.find(quote), value.size())));
    }
    return std::string(value.substr(0, std::min(value.find_first_of(kBlanks), value.size())));
}

std::optional<double> number_in(std::string_view value) {
    // A unit may follow without a blank: 45<DEG>.
    const std::string word = first_word(value);
    const std::optional<double> number = number_of(std::string_view(word).substr(0, word.find('<')));
    return number && std::isfinite(*number) ? number : std::nullopt;
}

bool has(const std::string& text, std::string_view word) { return text.find(word) != std::string::npos; }

// The edges of a map as its label gives them, while the direction of its longitudes is unknown.
struct Edges {
    std::optional<double> west, south, east, north;
};

void set_latitudes(MapLabel& out, std::string_view key, const std::string& word) {
    // The frame's name decides only where no other keyword does; its endings are CENTRIC, GRAPHIC and DETIC.
    const bool centric = has(word, "centric"), graphic = has(word, "graphic") || has(word, "detic");
    if (centric == graphic || out.planetocentric) return;
    out.planetocentric = centric;
    out.latitudes_by = key;
}

void set_longitudes(MapLabel& out, std::string_view key, const std::string& word) {
    const bool east = has(word, "east"), west = has(word, "west");
    if (east == west) return;
    out.longitudes_west = west;
    out.longitudes_by = key;
}

// Converts the edges to degrees east.
void set_edges(MapLabel& out, const Edges& e) {
    if (!e.west || !e.south || !e.east || !e.north || !(*e.south < *e.north)) return;
    MapBounds b{*e.west, *e.south, *e.east, *e.north};
    if (out.longitudes_west.value_or(false)) b.west_deg = -b.west_deg, b.east_deg = -b.east_deg;
    constexpr double kTurn_deg = 360, kMax_deg = 1080;
    if (!(std::abs(b.west_deg) <= kMax_deg && std::abs(b.east_deg) <= kMax_deg)) return;
    while (b.west_deg >= kTurn_deg) b.west_deg -= kTurn_deg, b.east_deg -= kTurn_deg;
    while (b.west_deg < -kTurn_deg / 2) b.west_deg += kTurn_deg, b.east_deg += kTurn_deg;
    while (b.east_deg <= b.west_deg) b.east_deg += kTurn_deg;
    if (b.east_deg - b.west_deg <= kTurn_deg) out.bounds = b;
}

// PDS3 and ISIS have the same form of statements and no conflicting keywords.
class StatementReader {
  public:
    MapLabel read(const std::string& text) {
        out_.format = has(text, "IsisCube") ? MapLabel::Format::kIsis3 : MapLabel::Format::kPds3;
        visit_label_statements(
            without_label_comments(text),
            [&](std::string_view key, std::string_view value) { take(small_letters(key), value); });
        // MOLA and others give westernmost and easternmost longitudes. ISIS gives least and greatest ones,
        // which are west and east where longitudes count to the east.
        if (out_.format == MapLabel::Format::kIsis3 && out_.longitudes_west.value_or(false))
            std::swap(edges_.west, edges_.east);
        set_edges(out_, edges_);
        return std::move(out_);
    }

  private:
    MapLabel out_;
    Edges edges_;
    std::string object_;  // the innermost object that has begun

    void take(const std::string& key, std::string_view value) {
        if (key == "object" || key == "group") object_ = small_letters(first_word(value));
        if (key == "end_object" || key == "end_group") object_.clear();
        take_angles(key, value);
        take_edges(key, value);
        const bool of_values = has(object_, "image") && !has(object_, "projection");
        if (key == "unit" && of_values && out_.unit.empty()) out_.unit = first_word(value);
    }

    void take_angles(const std::string& key, std::string_view value) {
        const std::string word = small_letters(first_word(value));
        if (key == "projection_latitude_type" || key == "coordinate_system_name" || key == "latitudetype")
            set_latitudes(out_, spelt(key), word);
        if (key == "positive_longitude_direction" || key == "longitudedirection")
            set_longitudes(out_, spelt(key), word);
        if (key == "center_longitude" || key == "centerlongitude")
            out_.center_longitude_deg = number_in(value);
        if (key == "map_projection_type" || key == "projectionname") out_.oblique = has(word, "oblique");
    }

    void take_edges(const std::string& key, std::string_view value) {
        const std::array<std::pair<std::array<std::string_view, 2>, std::optional<double>*>, 4> all = {
            {{{"westernmost_longitude", "minimumlongitude"}, &edges_.west},
             {{"minimum_latitude", "minimumlatitude"}, &edges_.south},
             {{"easternmost_longitude", "maximumlongitude"}, &edges_.east},
             {{"maximum_latitude", "maximumlatitude"}, &edges_.north}}};
        for (const auto& [names, edge] : all)
            if (key == names[0] || key == names[1]) *edge = number_in(value);
    }

    // Returns a keyword in the spelling of its standard.
    std::string_view spelt(const std::string& key) const {
        constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kSpelt = {
            {{"projection_latitude_type", "PROJECTION_LATITUDE_TYPE"},
             {"coordinate_system_name", "COORDINATE_SYSTEM_NAME"},
             {"latitudetype", "LatitudeType"},
             {"positive_longitude_direction", "POSITIVE_LONGITUDE_DIRECTION"},
             {"longitudedirection", "LongitudeDirection"}}};
        for (const auto& [small, right] : kSpelt)
            if (key == small) return right;
        return key;
    }
};

// Returns the text of the first element with this name, whatever its prefix; empty when there is none.
std::string element_text(const std::string& text, std::string_view name) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
        const std::size_t after = at + name.size();
        const bool whole = at > 0 && (text[at - 1] == ':' || text[at - 1] == '<') && after < text.size() &&
                           (text[after] == '>' || kBlanks.find(text[after]) != std::string_view::npos);
        const std::size_t begin = whole ? text.find('>', after) : std::string::npos;
        if (begin == std::string::npos || text[begin - 1] == '/') continue;
        return text.substr(begin + 1, text.find('<', begin) - begin - 1);
    }
    return {};
}

MapLabel read_pds4(const std::string& text) {
    MapLabel out;
    out.format = MapLabel::Format::kPds4;
    set_latitudes(out, "latitude_type", small_letters(element_text(text, "latitude_type")));
    set_longitudes(out, "longitude_direction", small_letters(element_text(text, "longitude_direction")));
    const auto edge = [&](std::string_view name) { return number_in(element_text(text, name)); };
    set_edges(out, {edge("west_bounding_coordinate"), edge("south_bounding_coordinate"),
                    edge("east_bounding_coordinate"), edge("north_bounding_coordinate")});
    const std::size_t array = text.find("<Element_Array>");
    if (array != std::string::npos)
        out.unit = element_text(text.substr(array, text.find("</Element_Array>", array) - array), "unit");
    return out;
}

}  // namespace

MapLabel read_map_label(const std::string& text) {
    if (text.empty()) return {};
    if (text.find("<Product_") != std::string::npos) return read_pds4(text);
    return StatementReader().read(text);
}

std::optional<double> metres_of_unit(std::string_view unit) {
    const std::string word = small_letters(first_word(unit));
    // The international foot, and the United States' survey foot of 1200/3937 m (NIST SP 811, 2008, appendix
    // B.6).
    constexpr double kFoot_m = 0.3048, kSurveyFoot_m = 1200.0 / 3937.0;
    constexpr std::array<std::pair<std::string_view, double>, 20> kUnits = {
        {{"m", 1},
         {"meter", 1},
         {"meters", 1},
         {"metre", 1},
         {"metres", 1},
         {"km", 1e3},
         {"kilometer", 1e3},
         {"kilometers", 1e3},
         {"kilometre", 1e3},
         {"kilometres", 1e3},
         {"dm", 0.1},
         {"decimeter", 0.1},
         {"cm", 0.01},
         {"centimeter", 0.01},
         {"mm", 1e-3},
         {"ft", kFoot_m},
         {"foot", kFoot_m},
         {"feet", kFoot_m},
         {"us_survey_foot", kSurveyFoot_m},
         {"us-ft", kSurveyFoot_m}}};
    for (const auto& [name, metres] : kUnits)
        if (word == name) return metres;
    if (small_letters(unit) == "us survey foot") return kSurveyFoot_m;
    return std::nullopt;
}

}  // namespace hilcam
