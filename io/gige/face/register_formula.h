#pragma once
// The meaning of a register's number in hilcam's units: the vendor's converters, resolved
// (docs/camera_face.md). A pure function and its inverse.

#include <cstdint>
#include <utility>
#include <vector>

namespace hilcam {

struct RegisterFormula {
    // kLinear: scale * raw + offset. kReciprocal: scale / raw + offset. kLogarithm: scale * ln(raw) +
    // offset. kPoints: between the points, whose numbers and values rise or fall all along.
    enum class Kind : std::uint8_t { kLinear, kReciprocal, kLogarithm, kPoints } kind = Kind::kLinear;
    double scale = 1, offset = 0;
    std::vector<std::pair<double, double>> points{};  // raw, value

    // Both are finite for every finite argument: beyond where the formula has a value, the nearest one.
    double value(double raw) const;
    double raw(double value) const;
};

}  // namespace hilcam
