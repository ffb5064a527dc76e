#pragma once
// Draws a number of a campaign: a distribution turns a place between 0 and 1 into a value.
//
// Places may be random or belong to an even sequence (draw_source.h). Every distribution is applied as the
// inverse of its cumulative function, so that even places give even quantiles.

#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct NumberDraw {
    enum class Kind { kNone, kValue, kUniform, kLogUniform, kNormal, kChoice };

    double value = 0;
    std::vector<double> uniform, log_uniform, normal, choice;
    bool has_value = false, has_uniform = false, has_log_uniform = false, has_normal = false,
         has_choice = false;

    Kind kind() const;
    explicit operator bool() const { return kind() != Kind::kNone; }
};
// range: the values that the number may have, in the unit of its key.
Fields fields(NumberDraw& draw, Range range);
inline Fields fields(NumberDraw& draw) { return fields(draw, {}); }
// Throws KeyError when the draw has two distributions, or an invalid one.
void validate(const NumberDraw& draw);

// Returns the number at a place in (0, 1). A normal distribution is cut at 6 standard deviations.
double number_at(const NumberDraw& draw, double place);

// Returns the quantile of the standard normal distribution at a place in (0, 1). Right to 1e-14, by bisection
// of the error function.
double normal_quantile(double place);

// Returns a number as text with enough digits to restore it exactly.
std::string exact_number(double value);

}  // namespace hilcam
