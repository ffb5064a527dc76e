#pragma once
// A record says what a pixel is made of, entry by entry: which light reached it from which surface. It is filled while a picture is traced.

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct PixelRecord {
    static constexpr std::uint32_t kNoObject = 0xFFFFFFFF;
    // Light of one part from one triangle, along rays of one depth.
    struct Entry {
        LightPart part = LightPart::kBackground;
        int depth = 0;  // 1: what the camera sees; 2: what a ray from there meets; 0: no surface
        bool is_shared =
            false;  // found by rays that several pixels share, before it is known how much each has of it
        std::uint32_t object = kNoObject;  // number in the scene
        std::uint32_t triangle = 0;        // in the level of detail that the frame shows
        std::uint16_t surface = 0;         // number in the object's mesh
        bool back = false;                 // the side that its triangle's own normal points away from
        Vec3f point_m, geometric_normal;   // ray space, world axes; of the first of them
        float alpha = 0;                   // width of the facet lobe
        float samples =
            0;  // number of sixteen a pixel that see it, or see where the ray that met it began; 0: not known
        std::uint32_t count = 1;  // times that light was added
        Spectrum light;           // radiance [W m^-2 sr^-1 um^-1], summed over the pixels that are recorded

        bool is_like(const Entry& other) const {
            return part == other.part && depth == other.depth && is_shared == other.is_shared &&
                   object == other.object && triangle == other.triangle;
        }
    };
    PixelBox box{};  // pixels that are recorded, of the padded image
    std::vector<Entry> entries;

    bool holds(int x, int y) const { return x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1; }

    // Any thread.
    void add(const Entry& entry) {
        const std::lock_guard lock(mutex_);
        const auto like =
            std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.is_like(entry); });
        if (like == entries.end()) return entries.push_back(entry);
        like->light += entry.light, ++like->count;
    }

  private:
    std::mutex mutex_;
};

}  // namespace hilcam
