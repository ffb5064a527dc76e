#pragma once
// The first bytes of a picture, for readers of headers. A byte beyond the end reads as 0.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hilcam {

class PictureOpening {
  public:
    explicit PictureOpening(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint64_t size() const { return bytes_.size(); }
    std::uint8_t byte(std::uint64_t at) const { return at < bytes_.size() ? bytes_[at] : std::uint8_t{0}; }
    // little() and big() return a number of `count` bytes, least or most significant byte first.
    std::uint64_t little(std::uint64_t at, unsigned count) const {
        std::uint64_t value = 0;
        for (unsigned i = count; i-- > 0;) value = value << 8 | byte(at + i);
        return value;
    }
    std::uint64_t big(std::uint64_t at, unsigned count) const {
        std::uint64_t value = 0;
        for (unsigned i = 0; i < count; ++i) value = value << 8 | byte(at + i);
        return value;
    }
    bool has(std::uint64_t at, std::string_view text) const {
        return at <= bytes_.size() && text.size() <= bytes_.size() - at &&
               std::equal(text.begin(), text.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at),
                          [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
    }

  private:
    std::span<const std::uint8_t> bytes_;
};

}  // namespace hilcam
