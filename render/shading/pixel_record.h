#pragma once
// Records what a pixel consists of, entry by entry: which light came from which surface. Filled while a
// picture is traced.

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
        // 1: the surface that the camera sees; 2: one that a ray from there meets; 0: no surface.
        int depth = 0;
        bool is_shared =
            false;  // found by a ray that several pixels share, whose share for each is not known yet
        std::uint32_t object = kNoObject;  // number in the scene
        std::uint32_t triangle = 0;        // in the level of detail that the frame uses
        std::uint16_t surface = 0;         // number in the object's mesh
        bool back = false;                 // seen on the side that its triangle's own normal points away from
        Vec3f point_m, geometric_normal;   // ray space, world axes; of the first contribution
        float alpha = 0;                   // GGX alpha of the facet lobe
        float samples =
            0;  // samples (16 per pixel) that see it, or see the point where its ray started; 0: unknown
        std::uint32_t count = 1;  // number of contributions
        Spectrum light;           // radiance [W m^-2 sr^-1 um^-1], summed over the recorded pixels

        bool is_like(const Entry& other) const {
            return part == other.part && depth == other.depth && is_shared == other.is_shared &&
                   object == other.object && triangle == other.triangle;
        }
    };
    PixelBox box{};  // the recorded pixels, in the padded image
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
