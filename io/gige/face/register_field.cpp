#include "io/gige/face/register_field.h"

#include <bit>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

std::uint64_t mask_of(const RegisterField& f) {
    return f.bits() >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << f.bits()) - 1;
}
std::size_t place_of(const RegisterField& f, std::size_t significance) {
    return f.little_endian ? significance : f.bytes - 1 - significance;
}
std::uint64_t whole(const RegisterField& f, std::span<const std::uint8_t> bytes) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < f.bytes; ++i) number |= std::uint64_t{bytes[place_of(f, i)]} << 8 * i;
    return number;
}

}  // namespace

std::uint32_t RegisterField::first_byte() const {
    return static_cast<std::uint32_t>(little_endian ? low / 8 : static_cast<int>(bytes) - 1 - high / 8);
}
std::uint32_t RegisterField::end_byte() const {
    return static_cast<std::uint32_t>(little_endian ? high / 8 : static_cast<int>(bytes) - 1 - low / 8) + 1;
}

std::uint64_t bits_in(const RegisterField& f, std::span<const std::uint8_t> bytes) {
    return whole(f, bytes) >> f.low & mask_of(f);
}

void put_bits(const RegisterField& f, std::uint64_t bits, std::span<std::uint8_t> bytes) {
    const std::uint64_t mask = mask_of(f) << f.low;
    const std::uint64_t number = (whole(f, bytes) & ~mask) | (bits << f.low & mask);
    for (std::size_t i = 0; i < f.bytes; ++i)
        bytes[place_of(f, i)] = static_cast<std::uint8_t>(number >> 8 * i);
}

double number_of(const RegisterField& f, std::uint64_t bits) {
    switch (f.kind) {
        case RegisterField::Kind::kFloat:
            return f.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                                : std::bit_cast<double>(bits);
        case RegisterField::Kind::kSigned: {
            const int unused = 64 - f.bits();
            return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
        }
        case RegisterField::Kind::kUnsigned:
            break;
    }
    return static_cast<double>(bits);
}

std::uint64_t bits_of(const RegisterField& f, double number) {
    if (std::isnan(number)) return 0;
    if (f.kind == RegisterField::Kind::kFloat) {
        if (f.bytes == 8) return std::bit_cast<std::uint64_t>(number);
        constexpr double kMost = std::numeric_limits<float>::max();
        return std::bit_cast<std::uint32_t>(static_cast<float>(std::fmin(std::fmax(number, -kMost), kMost)));
    }
    const double nearest = std::nearbyint(number);
    if (f.kind == RegisterField::Kind::kSigned) {
        const double end = std::ldexp(1.0, f.bits() - 1);
        if (nearest >= end) return mask_of(f) >> 1;
        if (nearest < -end) return (mask_of(f) >> 1) + 1;
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(nearest)) & mask_of(f);
    }
    if (nearest <= 0) return 0;
    return nearest >= std::ldexp(1.0, f.bits()) ? mask_of(f) : static_cast<std::uint64_t>(nearest);
}

}  // namespace hilcam
