#pragma once
// The parts of what the camera sees in a pixel that lean otherwise, for the Sun to be reflected by each of
// them: what a vertex of many samples has joined, and what a level of detail has flattened
// (scene/level_facets.h).

#include "render/light/frame_view.h"
#include "render/light/path_vertex.h"

namespace hilcam {

// Memory for the facets of a tile's vertices. One thread at a time.
class FacetList {
  public:
    void clear() { count_ = 0; }
    // So many more calls of add() have a place.
    std::size_t room() const { return kMost - count_; }

    struct Part {
        Vec3f geometric_normal, normal, start_m;  // as a vertex's
        float samples;
    };
    // Adds a part to a vertex, whose own is the first. Facets are made where there is more than one, and of
    // what a level has flattened: its own lobe is wider than theirs. Loop, any thread.
    void add(const FrameView& frame, const Part& part, std::uint32_t triangle, bool first, Vertex& vertex);

  private:
    // Four facets each. A vertex and what joins it take two at most: its own part comes late.
    static constexpr std::size_t kMost = 4096;
    std::array<Facets, kMost> facets_;
    std::size_t count_ = 0;

    Facets& open(Vertex& vertex);
    void add_part(const Part& part, Vertex& vertex);
    bool add_flattened(const FrameView& frame, const Part& flat, const LevelFacets& leaning, Vertex& vertex);
};

}  // namespace hilcam
