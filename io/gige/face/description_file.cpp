#include "io/gige/face/description_file.h"

#include <algorithm>
#include <string_view>

#include "io/gige/face/small_file.h"
#include "io/gige/face/unzip.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

std::string read_description(const std::filesystem::path& file) {
    return description_of(read_small_file(file, kMaxDescriptionBytes), file.string());
}

std::string description_of(const std::string& bytes, const std::string& name) {
    const std::span raw(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const std::string text = is_zip(raw) ? unzip_first(raw, kMaxDescriptionBytes, name) : bytes;
    constexpr std::string_view kRoot = "<RegisterDescription", kClosing = "</RegisterDescription>";
    const std::size_t begin = std::min(text.find("<?xml"), text.find(kRoot));
    if (begin == std::string::npos)
        throw InputError(name + ": found " + in_quotes(std::string_view(text).substr(0, 40)) +
                         "; accepted: a GenICam description, which has <RegisterDescription");
    if (text.find(kRoot, begin) == std::string::npos)
        throw InputError(name + ": is an XML without <RegisterDescription; accepted: a GenICam description");
    if (text.rfind(kClosing) == std::string::npos)
        throw InputError(name + ": has no </RegisterDescription>; it is cut");
    return text.substr(begin);
}

}  // namespace hilcam
