#include "io/files/file_name_pattern.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <regex>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxDigits = 20, kMaxLength = 200;

std::string padded(const std::string& number, std::size_t digits) {
    return std::string(digits - std::min(digits, number.size()), '0') + number;
}

// Turns a name into part of a file name that is valid on any system.
std::string plain_name(std::string_view name) {
    std::string out(name);
    for (char& c : out) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '.' || c == '-';
        if (!plain) c = '_';
    }
    return out;
}

// Parses "", "6" or "06": zeros up to that many digits.
std::size_t digits_of(std::string_view text, std::string_view pattern) {
    std::size_t digits = 1;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), digits);
    if (!text.empty() && (read.ec != std::errc() || read.ptr != text.data() + text.size() || digits < 1 ||
                          digits > kMaxDigits))
        throw InputError("name: " + in_quotes(pattern) + " has a number of " + in_quotes(text) +
                         " digits; accepted: 1 to " + std::to_string(kMaxDigits));
    return digits;
}

}  // namespace

FileNamePattern::FileNamePattern(std::string_view pattern, std::string_view ending) : ending_(ending) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("name: found " + in_quotes(pattern) + "; " + why);
    };
    if (pattern.find('/') != std::string_view::npos)
        refuse("accepted: a name without folders, which is `folder`");
    if (pattern.empty() || pattern.size() > kMaxLength)
        refuse("accepted: 1 to " + std::to_string(kMaxLength) + " characters");
    std::string_view stem = pattern;
    if (stem.ends_with(ending)) stem.remove_suffix(ending.size());
    for (const std::string_view other : {".png", ".tiff", ".tif", ".raw", ".fits", ".fit"})
        if (stem.ends_with(other))
            refuse("its ending is not that of `format`; accepted: " + in_quotes(ending) + ", or none");
    parse(stem);
    if (std::none_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& piece) { return piece.kind == Kind::kFrame; }))
        refuse(
            "each frame would be written over the one before; accepted: a name with the frame's number, as "
            "%08d or {frame:8}");
}

void FileNamePattern::parse(std::string_view pattern) {
    std::size_t at = 0;
    while (at < pattern.size()) {
        const std::string_view rest = pattern.substr(at);
        if (rest.starts_with("%%") || rest.starts_with("{{") || rest.starts_with("}}")) {
            add_text(rest.substr(0, 1));
            at += 2;
        } else if (rest[0] == '%') {
            const std::size_t end = rest.find_first_not_of("0123456789", 1);
            if (end == std::string_view::npos || rest[end] != 'd')
                throw InputError("name: " + in_quotes(pattern) +
                                 " has a % that begins no number; accepted: %d, %08d, and %% for a %");
            pieces_.push_back({Kind::kFrame, {}, digits_of(rest.substr(1, end - 1), pattern)});
            at += end + 1;
        } else if (rest[0] == '{') {
            const std::size_t end = rest.find('}');
            if (end == std::string_view::npos)
                throw InputError("name: " + in_quotes(pattern) + " has a { without its }");
            add_field(rest.substr(1, end - 1));
            at += end + 1;
        } else {
            add_text(rest.substr(0, 1));
            ++at;
        }
    }
}

void FileNamePattern::add_text(std::string_view text) {
    if (pieces_.empty() || pieces_.back().kind != Kind::kText) pieces_.push_back({});
    pieces_.back().text += text;
}

void FileNamePattern::add_field(std::string_view field) {
    const std::size_t colon = std::min(field.find(':'), field.size());
    const std::string_view name = field.substr(0, colon);
    if (name == "frame") {
        const std::string_view digits = colon < field.size() ? field.substr(colon + 1) : std::string_view();
        pieces_.push_back({Kind::kFrame, {}, digits_of(digits, field)});
        return;
    }
    constexpr std::array<std::pair<std::string_view, Kind>, 3> kFields = {
        {{"camera", Kind::kCamera}, {"camera_name", Kind::kCameraName}, {"time_tai_ns", Kind::kTime}}};
    for (const auto& [word, kind] : kFields)
        if (field == word) return pieces_.push_back({kind, {}, 1});
    throw refused("name", "the field " + in_quotes(field),
                  "{frame}, {frame:8}, {camera}, {camera_name}, {time_tai_ns}");
}

std::string FileNamePattern::stem(const FrameRecord& record, const Camera& camera) const {
    std::string out;
    for (const Piece& piece : pieces_) switch (piece.kind) {
            case Kind::kText:
                out += piece.text;
                break;
            case Kind::kFrame:
                out += padded(std::to_string(record.id), piece.digits);
                break;
            case Kind::kCamera:
                out += std::to_string(camera.number);
                break;
            case Kind::kCameraName:
                out += plain_name(camera.name);
                break;
            case Kind::kTime:
                out += std::to_string(record.exposure_mid.ns);
                break;
        }
    return out;
}

bool FileNamePattern::may_have_named(std::string_view file_name) const {
    std::string pattern;
    for (const Piece& piece : pieces_) switch (piece.kind) {
            case Kind::kText:
                pattern += std::regex_replace(piece.text, std::regex(R"([^A-Za-z0-9_])"), R"(\$&)");
                break;
            case Kind::kFrame:
                pattern += "[0-9]{" + std::to_string(piece.digits) + ",}";
                break;
            case Kind::kCamera:
                pattern += "[0-9]+";
                break;
            case Kind::kCameraName:
                pattern += "[A-Za-z0-9._-]*";
                break;
            case Kind::kTime:
                pattern += "-?[0-9]+";
                break;
        }
    pattern += R"((\.view)?\.(png|tiff|raw|fits|xml))";
    return std::regex_match(file_name.begin(), file_name.end(), std::regex(pattern));
}

}  // namespace hilcam
