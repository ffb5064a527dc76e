#include "render/vocabulary/point_diameter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hilcam {
namespace {

constexpr std::size_t kLeafPoints = 16;

double component(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// A binary tree over points that are sorted in place. A node's points are contiguous, and are split at the
// middle of the longest side of their box.
class PointTree {
  public:
    explicit PointTree(std::span<const Vec3d> points) : points_(points.begin(), points.end()) {
        nodes_.reserve(4 * points.size() / kLeafPoints + 1);
        build(0, points_.size());
    }

    double diameter() {
        best_squared_ = 0;
        search(0, 0);
        return std::sqrt(best_squared_);
    }

  private:
    struct Node {
        Vec3d least, most;
        std::size_t first, last;
        std::size_t right = 0;  // the other child; the first comes right after its parent. 0: a leaf

        bool is_leaf() const { return right == 0; }
        double size_squared() const { return dot(most - least, most - least); }
    };
    std::vector<Vec3d> points_;
    std::vector<Node> nodes_;
    double best_squared_ = 0;

    void build(std::size_t first, std::size_t last) {
        Node node{points_[first], points_[first], first, last};
        for (std::size_t i = first; i < last; ++i) {
            const Vec3d& p = points_[i];
            node.least = {std::min(node.least.x, p.x), std::min(node.least.y, p.y),
                          std::min(node.least.z, p.z)};
            node.most = {std::max(node.most.x, p.x), std::max(node.most.y, p.y), std::max(node.most.z, p.z)};
        }
        const std::size_t number = nodes_.size();
        nodes_.push_back(node);
        if (last - first <= kLeafPoints) return;
        const Vec3d size = node.most - node.least;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t middle = first + (last - first) / 2;
        const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle), at(last), [axis](const Vec3d& a, const Vec3d& b) {
            return component(a, axis) < component(b, axis);
        });
        build(first, middle);
        nodes_[number].right = nodes_.size();
        build(middle, last);
    }

    // Returns an upper bound of the distance between a point of one node and a point of the other, squared.
    double bound_squared(std::size_t a, std::size_t b) const {
        const Node &m = nodes_[a], &n = nodes_[b];
        const Vec3d far{std::max(m.most.x - n.least.x, n.most.x - m.least.x),
                        std::max(m.most.y - n.least.y, n.most.y - m.least.y),
                        std::max(m.most.z - n.least.z, n.most.z - m.least.z)};
        return dot(far, far);
    }

    void search(std::size_t a, std::size_t b) {
        if (bound_squared(a, b) <= best_squared_) return;
        const Node &m = nodes_[a], &n = nodes_[b];
        if (m.is_leaf() && n.is_leaf()) {
            for (std::size_t i = m.first; i < m.last; ++i)
                for (std::size_t j = n.first; j < n.last; ++j)
                    best_squared_ =
                        std::max(best_squared_, dot(points_[i] - points_[j], points_[i] - points_[j]));
            return;
        }
        // Splits the larger of two boxes (both, if they are the same); the farthest pair comes first.
        std::array<std::array<std::size_t, 2>, 3> pairs{};
        std::size_t count = 0;
        if (a == b) {
            pairs = {{{a + 1, m.right}, {a + 1, a + 1}, {m.right, m.right}}}, count = 3;
        } else if (n.is_leaf() || (!m.is_leaf() && m.size_squared() >= n.size_squared())) {
            pairs[0] = {a + 1, b}, pairs[1] = {m.right, b}, count = 2;
        } else {
            pairs[0] = {a, b + 1}, pairs[1] = {a, n.right}, count = 2;
        }
        const auto nearer = [this](const auto& p, const auto& q) {
            return bound_squared(p[0], p[1]) < bound_squared(q[0], q[1]);
        };
        // A selection sort suffices for so few pairs. GCC 14 warns wrongly that std::sort leaves the array.
        const auto last = pairs.begin() + static_cast<std::ptrdiff_t>(count);
        for (auto next = pairs.begin(); next != last; ++next) {
            std::iter_swap(next, std::max_element(next, last, nearer));
            search((*next)[0], (*next)[1]);
        }
    }
};

}  // namespace

double point_diameter(std::span<const Vec3d> points) {
    return points.size() < 2 ? 0.0 : PointTree(points).diameter();
}

}  // namespace hilcam
