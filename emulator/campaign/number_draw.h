#pragma once
// The way in which a number of a campaign is drawn: by a distribution, from a place between 0 and 1.
//
// The place may be random or of an even sequence (draw_source.h): every distribution is the inverse of its
// cumulative function, so that even places give even quantiles.

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
// range: all that the number may be, in the unit of the key that it is for.
Fields fields(NumberDraw& draw, Range range);
inline Fields fields(NumberDraw& draw) { return fields(draw, {}); }
// Throws KeyError when there are two distributions, or one that is none.
void validate(const NumberDraw& draw);

// Returns the number at a place in (0, 1). A normal one is cut at 6 standard deviations.
double number_at(const NumberDraw& draw, double place);

// Returns the standard normal number below which that share lies; place in (0, 1). Right to 1e-14, by
// bisection of the error function.
double normal_quantile(double place);

// Returns a number as a file takes it, with as many digits as bring it back.
std::string exact_number(double value);

}  // namespace hilcam
