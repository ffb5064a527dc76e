#include "io/meshes/node_names.h"

#include "render/vocabulary/quoted.h"

namespace hilcam {

int taken_by(std::span<const std::string> names, const std::string& node) {
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::string& pattern = names[k];
        const bool open = !pattern.empty() && pattern.back() == '*';
        if (open ? node.starts_with(pattern.substr(0, pattern.size() - 1)) : node == pattern)
            return static_cast<int>(k);
    }
    return -1;
}

std::string empty_part(std::span<const std::string> names, int part, std::span<const std::string> nodes) {
    constexpr std::size_t kLongest = 400;
    if (part < 0)
        return names.empty() ? "holds no triangle; accepted: a mesh with at least one"
                             : "holds no triangle besides its parts";
    std::string all;
    for (const std::string& node : nodes)
        if (all.size() < kLongest) all.append(" ").append(node);
    return "no triangle under a node " + in_quotes(names[static_cast<std::size_t>(part)]) +
           "; its nodes:" + harmless(all);
}

}  // namespace hilcam
