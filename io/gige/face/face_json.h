#pragma once
// A place in a face table's JSON, which knows where it is: what is not as expected ends in an InputError
// that says so.

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "render/vocabulary/check.h"

namespace hilcam {

// Throws InputError for what is no JSON.
nlohmann::json parsed_face_json(const std::string& text, const std::string& name);

// Refers to the document, which must live longer.
class FaceJson {
  public:
    FaceJson(const nlohmann::json& here, std::string where) : here_(here), where_(std::move(where)) {}

    bool has(const char* key) const;  // and it is not null
    FaceJson at(const char* key) const;
    FaceJson at(std::size_t index) const;
    std::size_t size(std::size_t least, std::size_t most) const;  // number of a list's values

    std::int64_t whole(std::int64_t least, std::int64_t most) const;
    double number() const;          // finite
    std::uint64_t bits() const;     // a whole number of at most 64 bits; a negative one as two's complement
    std::uint32_t address() const;  // "0x0000a104"
    bool is_text() const;
    std::string text(std::size_t longest) const;
    // Returns the index of the text among the words.
    std::size_t one_of(std::initializer_list<const char*> words) const;
    // Returns a mapping's only key and its text.
    std::pair<std::string, std::string> pair(std::size_t longest) const;

    InputError refuse(const std::string& found, const std::string& accepted) const {
        return refused(where_, found, accepted);
    }

  private:
    InputError refuse(const std::string& accepted) const;  // shows what is here
    const nlohmann::json& here_;
    std::string where_;
};

}  // namespace hilcam
