#pragma once
// A memory of what a tile's facet lobes have been found to reflect: lobes that are alike look into the same, which lies so
// far off that it does not change within the few pixels of a tile.

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

#include "render/shading/shading_point.h"

namespace hilcam {

// Directions that differ by no more are one to a lobe: a degree, of lobes that are seven wide at least.
inline constexpr float kSameLobe = 0.9998f;  // cosine

// True when two shading points lie the same way, and are of one surface. A texture may give their facets colours of their own.
inline bool lies_alike(const ShadingPoint& a, const ShadingPoint& b) {
    return a.object == b.object && a.surface_number == b.surface_number && a.back == b.back &&
           dot(a.normal, b.normal) > kSameLobe;
}
// True when they send lobes of one kind the same way besides.
inline bool sends_alike(const ShadingPoint& a, const ShadingPoint& b) {
    return lies_alike(a, b) && a.surface.alpha == b.surface.alpha && dot(a.view_dir, b.view_dir) > kSameLobe;
}

// Keeps a value for each kind of lobe at each probe; of those that share a slot, the last. Shading points outlive this. One
// thread at a time.
template <class Value>
class LobeMemo {
    static_assert(std::is_trivially_copyable_v<Value>);

  public:
    // probe: 0 where the value belongs to none.
    // Returns the value of a lobe that is alike; null: there is none.
    const Value* find(const ShadingPoint& at, std::uint32_t probe) const {
        const std::uint16_t place = places_[number(at, probe)];
        if (place == 0) return nullptr;
        const Entry& entry = *std::launder(reinterpret_cast<const Entry*>(&memory_[place - 1]));
        return entry.probe == probe && sends_alike(*entry.at, at) ? &entry.value : nullptr;
    }
    const Value& keep(const ShadingPoint& at, std::uint32_t probe, const Value& value) {
        std::uint16_t& place = places_[number(at, probe)];
        if (place == 0) place = ++count_;
        return (new (&memory_[place - 1]) Entry{&at, probe, value})->value;
    }

  private:
    static constexpr unsigned kSlotBits = 8;
    static constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;
    struct Entry {
        const ShadingPoint* at;
        std::uint32_t probe;
        Value value;
    };
    // Entries follow each other as they come, and are made then: a memory begins with each part of a tile, most of which
    // have few.
    struct alignas(Entry) EntryMemory {
        std::array<std::byte, sizeof(Entry)> bytes;
    };
    std::array<std::uint16_t, kSlots> places_{};  // by slot, of its entry, from 1 on; 0: there is none
    std::uint16_t count_ = 0;
    std::array<EntryMemory, kSlots> memory_;

    // Normals that lean differently mostly have different slots.
    static std::size_t number(const ShadingPoint& at, std::uint32_t probe) {
        constexpr float kSteps = 8;
        const auto lean = static_cast<std::uint32_t>(static_cast<int>(kSteps * (at.normal.x + 1)) +
                                                     17 * static_cast<int>(kSteps * (at.normal.y + 1)) +
                                                     289 * static_cast<int>(kSteps * (at.normal.z + 1)));
        // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 1998, section 6.4).
        constexpr std::uint32_t kGolden = 2654435769u;
        return ((probe * 31 + at.surface_number) * 31 + lean) * kGolden >> (32 - kSlotBits);
    }
};

}  // namespace hilcam
