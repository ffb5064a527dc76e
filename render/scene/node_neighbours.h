#pragma once
// Which places where light is kept lie side by side on one surface.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

struct NodeNeighbours {
    std::vector<std::uint32_t> first;  // by node, and one more: where its list begins
    std::vector<std::uint32_t> node;   // the lists, each in the order of numbers, without the node itself

    std::span<const std::uint32_t> of(std::size_t n) const {
        return std::span(node).subspan(first[n], first[n + 1] - first[n]);
    }
    std::size_t bytes() const { return (first.size() + node.size()) * sizeof(std::uint32_t); }
};

}  // namespace hilcam
