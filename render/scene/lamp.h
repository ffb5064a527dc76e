#pragma once
// Lamps: sources of light besides the Sun and the bodies that it lights, such as flood lights of an inspector
// or the landing light of a lander.
//
// A lamp is a point. At the angle theta from its axis its radiant intensity is
//     I(theta) = level I_0 b(theta)    [W sr^-1 um^-1],
// the same all around the axis; a surface across the ray at a distance d receives the irradiance I(theta) /
// d^2 (Lambert, Photometria, 1760). Level 1 is the data sheet's I_0, level 0 is off.
//
// Not modelled: the lamp's size (shadows have sharp edges), its warm-up, beams that are not round.

#include <array>
#include <cstddef>
#include <string>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/table.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A lamp may be mounted on a surface, so anything nearer to it than this casts no shadow.
inline constexpr double kLampClearance_m = 1e-3;

// b(theta): the intensity relative to that on the axis. Immutable; any thread.
class LampBeam {
  public:
    // The same intensity in all directions.
    LampBeam() = default;
    // Returns b = cos^n(theta), the usual model of an LED behind a lens (Moreno & Sun, Optics Express 16(3),
    // 2008); nothing is emitted backwards. The beam angle, in (0, pi), is the full angle between the two
    // directions of half intensity (ANSI/IES LS-1): n = ln(1/2) / ln(cos(angle / 2)). 120 degrees give a
    // Lambertian source.
    static LampBeam of_angle(double full_rad);
    // Makes the beam from measured relative intensity over theta [rad], which starts at 0; dark beyond the
    // last angle.
    static LampBeam of_table(Table by_angle_rad);

    // Returns b along a direction from the lamp. Both are unit vectors.
    double at(Vec3d axis, Vec3d from_lamp_dir) const;

  private:
    double power_ = 0;
    bool in_front_only_ = false;
    Table by_angle_;  // empty: none
};

// Each lamp costs a shadow ray at each shading point; more lamps would need another method.
inline constexpr std::size_t kMaxLamps = 16;

// A lamp after loading.
struct SceneLamp {
    std::string name;
    // The thing that carries it; 0: the camera's body; 1, 2, ...: objects of the scene.
    std::size_t thing = 0;
    Spectrum intensity_w_sr_um;  // I_0
    LampBeam beam;
};

// The state of a lamp at one instant, or its mean over several.
struct ShownLamp {
    Vec3d position_world_m;
    Vec3d axis{0, 0, 1};  // unit vector in the world
    double level = 0;
};

// The lamps of a world, in a list that does not allocate.
class ShownLamps {
  public:
    std::size_t size() const { return size_; }
    // Sets the number of lamps, at most kMaxLamps.
    void resize(std::size_t size);
    ShownLamp& operator[](std::size_t i) { return lamps_[i]; }
    const ShownLamp& operator[](std::size_t i) const { return lamps_[i]; }

  private:
    std::array<ShownLamp, kMaxLamps> lamps_;
    std::size_t size_ = 0;
};

}  // namespace hilcam
