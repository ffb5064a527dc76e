#pragma once
// Big-endian numbers in byte buffers, the byte order of CCSDS packets and of GigE Vision.

#include <bit>
#include <cstdint>
#include <span>

#include "render/vocabulary/check.h"

namespace hilcam {

// Reads front to back. Past the end it returns zeros, and `ok()` turns false.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool ok() const { return ok_; }
    std::size_t left() const { return bytes_.size() - at_; }
    std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
    std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
    std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
    std::uint64_t u64() { return number(8); }
    std::int64_t i64() { return static_cast<std::int64_t>(number(8)); }
    double f64() { return std::bit_cast<double>(number(8)); }
    void skip(std::size_t count) { count <= left() ? at_ += count : fail(); }
    std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }

  private:
    std::uint64_t number(std::size_t count) {
        if (left() < count) return fail();
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes_[at_++];
        return value;
    }
    std::size_t fail() {
        ok_ = false;
        at_ = bytes_.size();
        return 0;
    }
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
    bool ok_ = true;
};

// Writes front to back into a buffer that the caller has made large enough.
class ByteWriter {
  public:
    explicit ByteWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

    std::size_t size() const { return at_; }
    ByteWriter& u8(std::uint64_t value) { return number(value, 1); }
    ByteWriter& u16(std::uint64_t value) { return number(value, 2); }
    ByteWriter& u32(std::uint64_t value) { return number(value, 4); }
    ByteWriter& u64(std::uint64_t value) { return number(value, 8); }
    ByteWriter& f64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
    ByteWriter& copy(std::span<const std::uint8_t> from) {
        for (const std::uint8_t byte : from) u8(byte);
        return *this;
    }

  private:
    ByteWriter& number(std::uint64_t value, std::size_t count) {
        HILCAM_CHECK(at_ + count <= bytes_.size());
        for (std::size_t i = count; i-- > 0;) bytes_[at_++] = static_cast<std::uint8_t>(value >> (8 * i));
        return *this;
    }
    std::span<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace hilcam
