#include "io/config/config_keys.h"

namespace hilcam {
namespace {

void add_keys(const Fields& fields, const std::string& prefix, std::vector<std::string>& out) {
    for (const Field& field : fields) {
        const std::string key = prefix + field.key;
        out.push_back(key);
        if (const std::optional<SectionField> nested = section_in(field))
            add_keys(nested->fields, key + ".", out);
        if (const auto* many = std::get_if<SectionsField>(&field.target))
            add_keys(many->append().fields, key + ".N.", out);
    }
}

}  // namespace

std::vector<std::string> config_keys(const Fields& root) {
    std::vector<std::string> out;
    add_keys(root, "", out);
    return out;
}

}  // namespace hilcam
