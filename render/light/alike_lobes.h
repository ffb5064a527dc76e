#pragma once
// A memory of what a tile's facet lobes have been found to reflect: lobes that are alike look into the same, which lies so
// far off that it does not change within the few pixels of a tile.

#include <array>
#include <cstdint>
#include <optional>

#include "render/light/path_vertex.h"

namespace hilcam {

// True when two vertices send lobes of one kind the same way, within a degree: of lobes that are seven wide at least.
inline bool sends_alike(const Vertex& a, const Vertex& b) {
    constexpr float kSame = 0.9998f;  // cosine
    return a.object == b.object && a.surface_number == b.surface_number && a.back == b.back &&
           a.surface.alpha == b.surface.alpha && a.surface.material->texture < 0 &&
           dot(a.normal, b.normal) > kSame && dot(a.view_dir, b.view_dir) > kSame;
}

// Keeps a value for each kind of lobe at each node; of those that share a slot, the last. Vertices outlive this. One
// thread at a time.
template <class Value>
class AlikeLobes {
  public:
    // node: 0 where the value belongs to none.
    // Returns the value of a lobe that is alike; null: there is none.
    const Value* find(const Vertex& at, std::uint32_t node) const {
        const Slot& slot = slots_[number(at, node)];
        return slot.value && slot.node == node && sends_alike(*slot.at, at) ? &*slot.value : nullptr;
    }
    const Value& keep(const Vertex& at, std::uint32_t node, const Value& value) {
        Slot& slot = slots_[number(at, node)];
        slot.at = &at, slot.node = node;
        return slot.value.emplace(value);
    }

  private:
    static constexpr std::size_t kSlots = 256;
    // A value that is not there is not made either: a memory begins with each part of a tile.
    struct Slot {
        const Vertex* at;
        std::uint32_t node;
        std::optional<Value> value;
    };
    std::array<Slot, kSlots> slots_;

    // Normals that lean differently mostly have different slots.
    static std::size_t number(const Vertex& at, std::uint32_t node) {
        constexpr float kSteps = 8;
        const auto lean = static_cast<std::uint32_t>(static_cast<int>(kSteps * (at.normal.x + 1)) +
                                                     17 * static_cast<int>(kSteps * (at.normal.y + 1)) +
                                                     289 * static_cast<int>(kSteps * (at.normal.z + 1)));
        // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 1998, section 6.4).
        constexpr std::uint32_t kGolden = 2654435769u;
        return ((node * 31 + at.surface_number) * 31 + lean) * kGolden >> 24;
    }
};

}  // namespace hilcam
