#pragma once
// A number as messages and the manual show it: ten digits, so that unit conversion leaves no rounding tail.

#include <sstream>
#include <string>

namespace hilcam {

inline std::string plain(double value) {
    std::ostringstream out;
    out.precision(10);
    out << value;
    return out.str();
}

}  // namespace hilcam
