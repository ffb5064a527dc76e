#pragma once
// FNV-1a of 64 bits (Fowler, Noll & Vo, 1991), by which kept files are named and answers are found again.
// Equal hashes do not prove equal contents.

#include <cstdint>

namespace hilcam {

class Fnv1a {
  public:
    Fnv1a() = default;
    // Goes on from a hash.
    explicit Fnv1a(std::uint64_t value) : value_(value) {}

    // Takes a byte, as published, or a longer word at once, which is another hash.
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
