#include "io/naif/naif_record.h"

namespace hilcam {
namespace {

constexpr std::string_view kFtpBegin = "FTPSTR", kFtpEnd = "ENDFTP";
constexpr std::string_view kFtpString("FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP", 28);

}  // namespace

std::string without_tail(std::string_view text) {
    while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
    return std::string(text);
}

bool arrived_as_binary(std::string_view record) {
    const std::size_t begin = record.find(kFtpBegin), end = record.find(kFtpEnd);
    return begin == std::string_view::npos ||
           (end != std::string_view::npos && end >= begin &&
            record.substr(begin, end + kFtpEnd.size() - begin) == kFtpString);
}

}  // namespace hilcam
