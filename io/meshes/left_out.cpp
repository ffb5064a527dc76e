#include "io/meshes/left_out.h"

#include <algorithm>

#include "render/vocabulary/quoted.h"

namespace hilcam {

void LeftOut::add(const std::string& what, const std::string& whose) {
    std::vector<std::string>& names = names_[what];
    if (std::find(names.begin(), names.end(), whose) == names.end()) names.push_back(whose);
}

std::vector<std::string> LeftOut::lines() const {
    constexpr std::size_t kNamed = 3;
    std::vector<std::string> out;
    for (const auto& [what, names] : names_) {
        std::string line = what;
        std::size_t named = 0;
        for (const std::string& name : names)
            if (!name.empty() && named < kNamed) line += (named++ == 0 ? " of " : ", ") + in_quotes(name);
        if (named > 0 && names.size() > named)
            line += " and " + std::to_string(names.size() - named) + " others";
        out.push_back(line + ": not used");
    }
    return out;
}

}  // namespace hilcam
