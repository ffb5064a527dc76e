#pragma once
// The file record that begins SPICE's binary kernels, both DAF and DAS, and numbers in either byte order
// (NAIF, "Kernel Required Reading", "DAF Required Reading", "DAS Required Reading").

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace hilcam {

inline constexpr std::size_t kNaifRecordBytes = 1024;

// Reads numbers in the byte order of the machine that wrote the kernel.
struct NaifNumbers {
    bool big_endian = false;

    std::uint64_t whole(const char* bytes, std::size_t count) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t at = big_endian ? i : count - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes[at]);
        }
        return value;
    }
    double double_at(const char* bytes) const { return std::bit_cast<double>(whole(bytes, 8)); }
    std::int32_t integer_at(const char* bytes) const {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(whole(bytes, 4)));
    }
};

// Returns a text without trailing blanks and zeros.
std::string without_tail(std::string_view text);
// Returns false when a transfer as text has changed the file: the FTP string of its file record holds all
// characters that such a transfer changes. Older files have no such string and pass.
bool arrived_as_binary(std::string_view record);

}  // namespace hilcam
