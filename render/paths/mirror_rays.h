#pragma once
// Many rays for one pixel of a good mirror, one from each sample that sees it, each with its own facet. Used
// when a single ray would meet only a part of what the mirror shows there.

#include <array>
#include <cstdint>
#include <span>

#include "render/shading/tile.h"

namespace hilcam {

// True when a lane's ray has met an object and no body is in front of it. origin_m: ray space. Loop, any
// thread.
bool meets_object(const FrameContext& frame, const HitPacket& hits, std::size_t lane, Vec3f origin_m,
                  Vec3f dir);

class MirrorRays {
  public:
    struct Packet {
        RayPacket rays;  // rays that leave the mirror
        HitPacket hits;
        std::uint32_t met = 0;  // one bit per ray that meets an object
    };

    // Traces sixteen rays from samples far apart and, unless all that they meet is dark, one from each
    // sample, `most` at most. at: seen by samples of the visibility buffer. Returns how many rays represent
    // the mirror's lobe; that includes those that do not leave the surface because their facet leans too far.
    // Loop, any thread.
    std::size_t trace(Tile& tile, const ShadingPoint& at, std::size_t most);
    // Returns the packets of the last trace().
    std::span<const Packet> packets() const { return std::span(packets_).first(count_); }

  private:
    std::array<Packet, kMaxVisibilitySamples / kPacketSize> packets_;
    std::size_t count_ = 0;
};

}  // namespace hilcam
