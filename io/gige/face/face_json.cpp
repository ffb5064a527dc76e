#include "io/gige/face/face_json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/vocabulary/quoted.h"

namespace hilcam {

using nlohmann::json;

json parsed_face_json(const std::string& text, const std::string& name) {
    // Deeper than any table is: the parser needs stack for each level.
    constexpr int kDeepestTable = 16;
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (quoted && text[i] == '\\')
            ++i;
        else if (text[i] == '"')
            quoted = !quoted;
        else if (!quoted && (text[i] == '{' || text[i] == '['))
            ++depth;
        else if (!quoted && (text[i] == '}' || text[i] == ']'))
            --depth;
        if (depth > kDeepestTable)
            throw InputError(name + ": is nested more than " + std::to_string(kDeepestTable) + " deep");
    }
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        throw InputError(name + ": is no JSON that can be read, at byte " + std::to_string(error.byte) +
                         "; accepted: the table that hilcam-camera-face bind writes");
    }
}

InputError FaceJson::refuse(const std::string& accepted) const {
    return refused(where_, in_quotes(here_.dump(-1, ' ', true, json::error_handler_t::replace)), accepted);
}

bool FaceJson::has(const char* key) const {
    if (!here_.is_object()) return false;
    const auto found = here_.find(key);
    return found != here_.end() && !found->is_null();
}

FaceJson FaceJson::at(const char* key) const {
    if (!has(key)) throw InputError(where_ + ": has no " + key);
    return {here_.at(key), where_ + ": " + key};
}

FaceJson FaceJson::at(std::size_t index) const {
    if (!here_.is_array()) throw refuse("a list");
    if (index >= here_.size()) throw refuse("a list with more values");
    return {here_.at(index), where_ + "[" + std::to_string(index) + "]"};
}

std::size_t FaceJson::size(std::size_t least, std::size_t most) const {
    if (!here_.is_array()) throw refuse("a list");
    if (here_.size() < least || here_.size() > most)
        throw refuse(std::to_string(here_.size()) + " values",
                     std::to_string(least) + " to " + std::to_string(most));
    return here_.size();
}

std::int64_t FaceJson::whole(std::int64_t least, std::int64_t most) const {
    const bool fits =
        here_.is_number_integer() &&
        (!here_.is_number_unsigned() || here_.get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX));
    const std::int64_t value = fits ? here_.get<std::int64_t>() : 0;
    if (!fits || value < least || value > most)
        throw refuse(least == most
                         ? std::to_string(least)
                         : "a whole number, " + std::to_string(least) + " to " + std::to_string(most));
    return value;
}

double FaceJson::number() const {
    if (!here_.is_number() || !std::isfinite(here_.get<double>())) throw refuse("a number");
    return here_.get<double>();
}

std::uint64_t FaceJson::bits() const {
    if (here_.is_number_unsigned()) return here_.get<std::uint64_t>();
    if (here_.is_number_integer()) return static_cast<std::uint64_t>(here_.get<std::int64_t>());
    throw refuse("a whole number");
}

std::uint32_t FaceJson::address() const {
    std::uint32_t value = 0;
    if (is_text()) {
        const auto& text = here_.get_ref<const std::string&>();
        if (text.size() > 2 && text.size() <= 10 && text[0] == '0' && text[1] == 'x') {
            const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), value, 16);
            if (error == std::errc{} && end == text.data() + text.size()) return value;
        }
    }
    throw refuse("hexadecimal digits, as \"0x0000a104\"");
}

bool FaceJson::is_text() const { return here_.is_string(); }

std::string FaceJson::text(std::size_t longest) const {
    if (!is_text() || here_.get_ref<const std::string&>().size() > longest)
        throw refuse("a text of at most " + std::to_string(longest) + " bytes");
    return harmless(here_.get_ref<const std::string&>());
}

std::size_t FaceJson::one_of(std::initializer_list<const char*> words) const {
    std::size_t index = 0;
    std::string all;
    for (const char* const word : words) {
        if (is_text() && here_.get_ref<const std::string&>() == word) return index;
        all += (index++ ? ", " : "") + std::string(word);
    }
    throw refuse(all);
}

std::pair<std::string, std::string> FaceJson::pair(std::size_t longest) const {
    if (!here_.is_object() || here_.size() != 1) throw refuse("one name and its entry");
    const std::string key = here_.begin().key();
    return {harmless(key), at(key.c_str()).text(longest)};
}

}  // namespace hilcam
