#include "io/gige/face/small_file.h"

#include <fstream>
#include <system_error>

#include "render/vocabulary/check.h"

namespace hilcam {

std::string read_small_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) throw InputError(file.string() + ": cannot be read: " + error.message());
    if (bytes > max_bytes)
        throw InputError(file.string() + ": has " + std::to_string(bytes) + " bytes; accepted: at most " +
                         std::to_string(max_bytes));
    std::ifstream in(file, std::ios::binary);
    std::string text(static_cast<std::size_t>(bytes), '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!in) throw InputError(file.string() + ": cannot be read");
    return text;
}

}  // namespace hilcam
