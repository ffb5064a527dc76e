#pragma once
// Writes numbers in either byte order.

#include <cstring>
#include <string>

namespace hilcam {

// Returns the bytes of a number. The tests' machines are little-endian.
template <class T>
std::string ordered(T value, bool big_endian) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    if (big_endian) out.assign(out.rbegin(), out.rend());
    return out;
}

}  // namespace hilcam
