#include "io/system/plain_words.h"

#include <filesystem>
#include <string_view>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing value - ..."
std::string json_words(std::string_view text) {
    constexpr std::string_view kParse = "[json.exception.parse_error.", kAt = "parse error at ";
    const bool is_syntax = text.starts_with(kParse);
    const std::size_t end = text.find("] ");
    text.remove_prefix(end == std::string_view::npos ? 0 : end + 2);
    if (!is_syntax || !text.starts_with(kAt)) return std::string(text);
    text.remove_prefix(kAt.size());
    return "is no JSON at " + std::string(text.substr(0, text.find(':')));
}

}  // namespace

std::string plain_words(const std::exception& problem) {
    if (const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&problem)) {
        const std::string path = shortened(file->path1().string());
        return (path.empty() ? "" : path + ": ") + file->code().message();
    }
    const std::string text = problem.what();
    return text.starts_with("[json.exception.") ? json_words(text) : text;
}

std::string without_success(std::string message) {
    for (const std::string_view reason : {": Success", " (Success)", ": No error"})
        if (message.ends_with(reason)) message.erase(message.size() - reason.size());
    return message;
}

}  // namespace hilcam
