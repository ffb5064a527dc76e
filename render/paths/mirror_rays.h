#pragma once
// The rays of one pixel of a good mirror, where one from its middle would meet but a part of what the mirror shows: from each
// sample that sees it, by a facet of its own.

#include <array>
#include <cstdint>
#include <span>

#include "render/shading/tile.h"

namespace hilcam {

// True when a lane's ray has met an object before which no body stands. origin_m: ray space. Loop, any thread.
bool meets_object(const FrameContext& frame, const HitPacket& hits, std::size_t lane, Vec3f origin_m,
                  Vec3f dir);

class MirrorRays {
  public:
    struct Packet {
        RayPacket rays;  // those that leave the mirror
        HitPacket hits;
        std::uint32_t met = 0;  // a bit for each ray that meets an object
    };

    // Traces sixteen, far from each other, and where not all is dark that these meet, one from each sample, `most` at most.
    // at: what samples of the visibility buffer see. Returns how many stand for the mirror's lobe: a facet may lean so far that
    // its ray does not leave. Loop, any thread.
    std::size_t trace(Tile& tile, const ShadingPoint& at, std::size_t most);
    // Returns the packets of the last trace().
    std::span<const Packet> packets() const { return std::span(packets_).first(count_); }

  private:
    std::array<Packet, kMaxVisibilitySamples / kPacketSize> packets_;
    std::size_t count_ = 0;
};

}  // namespace hilcam
