#pragma once
// The 64-bit FNV-1a hash (Fowler, Noll & Vo, 1991), used to name cache files and to find earlier results.
// Equal hashes do not prove equal contents.

#include <cstdint>

namespace hilcam {

class Fnv1a {
  public:
    Fnv1a() = default;
    // Continues from an earlier hash.
    explicit Fnv1a(std::uint64_t value) : value_(value) {}

    // Adds a byte, as published. A longer word may be added at once, but gives another hash than its bytes
    // would.
    void take(std::uint64_t word) { value_ = (value_ ^ word) * 1099511628211u; }
    template <class Bytes>
    void take_bytes(const Bytes& bytes) {
        for (const auto byte : bytes) take(static_cast<unsigned char>(byte));
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace hilcam
