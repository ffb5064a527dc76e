#pragma once
// The kept light of all objects (kept_light.h) as one frame has it: brought up to where the sources are, and
// looked up where a path meets a surface.
//
// Kept are the light between the parts of an object, and what of the bodies' light reaches it through its own
// parts. The Sun and lamps shine on what a path meets by rays as ever. Not kept: light from one object to
// another, terrain.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/light/kept_light.h"
#include "render/light/sky_light.h"
#include "render/light/tile.h"
#include "render/scene/shown_object.h"

namespace hilcam {

class KeptScene {
  public:
    struct Settings {
        float step_rad = 0;  // of the grid that sources are rounded to
        std::size_t lamps = 0;
        bool emission = false;
    };
    // Light is kept on the objects that have a table. They outlive this. Owner thread.
    KeptScene(std::span<const ShownObject> objects, const ColorBands& bands, const Settings& settings);

    // For a frame, after everything else is placed; solves for what has moved by a step. Loop.
    void place(const FrameView& frame, const WorldSnapshot& world);

    bool keeps(std::size_t object) const { return object < objects_.size() && objects_[object].light; }
    const KeptLight& light(std::size_t object) const { return *objects_[object].light; }
    // What is kept on an object, for people.
    std::string describe(std::size_t object) const;

    // Adds to the tile's pixels what vertices that keep light reflect of it; narrow lobes apart. Loop, any
    // thread.
    void add_reflected(Tile& tile, std::span<const Vertex> vertices) const;
    // An object may stand in a direction (world, unit) from a vertex that keeps light. Loop, any thread.
    bool is_near(const FrameView& frame, const Vertex& at, Vec3f dir) const;

  private:
    struct Object {
        std::unique_ptr<KeptLight> light;
        KeptTerm sun, glow;
        std::array<KeptTerm, SkyLight::kMostBodies> bodies;
        std::vector<KeptTerm> lamps;
        Vec3f origin_m;  // in ray space
    };
    std::vector<Object> objects_;
    KeptLight::Workspace work_;
    SkyLight sky_;

    void solve(const FrameView& frame, std::size_t object, const KeptSource& source, KeptTerm& term);
    Spectrum reflected(const FrameView& frame, const Vertex& at, LightNodes::Hint& hint) const;
    NodesAbout nodes_about(const FrameView& frame, const Vertex& at, bool& found,
                           LightNodes::Hint& hint) const;
};

}  // namespace hilcam
