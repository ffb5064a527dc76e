#pragma once
// A number in some bits of a register, as a GenICam description's IntReg, MaskedIntReg, StructEntry and
// FloatReg have it (GenICam Standard 2.1.1, 2.8.8 to 2.8.11). Pure functions.

#include <cstdint>
#include <span>

namespace hilcam {

struct RegisterField {
    enum class Kind : std::uint8_t { kUnsigned, kSigned, kFloat };
    std::uint32_t address = 0;
    std::uint32_t bytes = 4;  // size of the register, 1 to 8; a float has 4 or 8
    bool little_endian = false;
    int low = 0, high = 31;  // bits of the register's number; bit 0 is the least significant
    Kind kind = Kind::kUnsigned;

    int bits() const { return high - low + 1; }
    // Returns the first byte that the field's bits are in, from the register's address, and the one behind
    // the last.
    std::uint32_t first_byte() const;
    std::uint32_t end_byte() const;
};

// A field's bits, right-aligned. `bytes`: those of the register.
std::uint64_t bits_in(const RegisterField& field, std::span<const std::uint8_t> bytes);
void put_bits(const RegisterField& field, std::uint64_t bits, std::span<std::uint8_t> bytes);

// The number that the bits are, and the bits of the nearest number that the field can hold.
double number_of(const RegisterField& field, std::uint64_t bits);
std::uint64_t bits_of(const RegisterField& field, double number);

}  // namespace hilcam
