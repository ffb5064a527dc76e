#include "sensor/color_filter.h"

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

Fields fields(ColorFilterConfig& c) {
    return {
        required(text("name", c.name, "letter of the filter")),
        required(
            curve("transmission", c.transmission, {0, 1}, "transmission of the filter; number or curve")),
    };
}

Fields fields(ColorFilterArrayConfig& c) {
    return {
        text("pattern", c.pattern, "filter letters row by row, with a space between rows: RG GB"),
        sections("filters", c.filters, "filters of the array, at most 8; generic_rgb is shipped"),
    };
}

void validate(const ColorFilterArrayConfig& c) {
    // Without a space, four letters would be one row, so stripes, which is never intended by these words.
    for (const std::string bayer : {"RGGB", "GRBG", "GBRG", "BGGR"})
        if (c.pattern == bayer)
            throw InputError("color_filter.pattern: found '" + bayer +
                             "', which is one row; accepted: " + bayer.substr(0, 2) + " " + bayer.substr(2) +
                             "; or all of it as color_filter: " + bayer);
    if (c.filters.size() > 8)
        throw refused("color_filter.filters", std::to_string(c.filters.size()), "at most 8");
    for (const ColorFilterConfig& filter : c.filters)
        if (filter.name.size() != 1 || filter.name == " ")
            throw InputError("color_filter.filters: name " + in_quotes(filter.name) +
                             "; accepted: one letter");
    std::size_t row = 0, width = 0;
    for (std::size_t i = 0; i <= c.pattern.size(); ++i) {
        if (i < c.pattern.size() && c.pattern[i] != ' ') {
            bool known = false;
            for (const ColorFilterConfig& filter : c.filters) known |= filter.name[0] == c.pattern[i];
            if (!known)
                throw InputError("color_filter.pattern: no filter is named '" + std::string(1, c.pattern[i]) +
                                 "'; 'filters: generic_rgb' has R, G and B");
            ++row;
            continue;
        }
        if (c.pattern.empty()) return;
        if (width != 0 && row != width)
            throw InputError("color_filter.pattern " + in_quotes(c.pattern) +
                             "; accepted: rows of one length");
        width = row;
        row = 0;
    }
}

}  // namespace hilcam
