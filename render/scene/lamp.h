#pragma once
// Lamps: what shines in the world besides the Sun and the bodies that it lights. Flood lights of an
// inspector, the landing light of a lander.
//
// A lamp is a point. At the angle theta off its axis it sends the radiant intensity
//     I(theta) = level I_0 b(theta)    [W sr^-1 um^-1],
// the same all around the axis; a surface at a distance d across the ray gets the irradiance I(theta) / d^2
// (Lambert, Photometria, 1760). Level 1 is the data sheet's I_0, 0 is off.
//
// Not modelled: the lamp's size (shadows have sharp edges), its warming up, a beam that is not round.

#include <array>
#include <cstddef>
#include <string>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/table.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A lamp may sit on a surface: what is nearer to it than that casts no shadow.
inline constexpr double kLampClearance_m = 1e-3;

// b(theta): intensity over that on the axis. Immutable; any thread.
class LampBeam {
  public:
    // The same in all directions.
    LampBeam() = default;
    // b = cos^n(theta), the usual model of an LED behind a lens (Moreno & Sun, Optics Express 16(3), 2008),
    // and nothing behind. The beam angle is the full one between the directions of half the intensity
    // (ANSI/IES LS-1): n = ln(1/2) / ln(cos(angle / 2)). 120 degrees are a Lambertian source. In (0, pi).
    static LampBeam of_angle(double full_rad);
    // Makes the beam from measurements: relative intensity over theta [rad], from 0 on; dark beyond the last
    // angle.
    static LampBeam of_table(Table by_angle_rad);

    // Unit vectors.
    double at(Vec3d axis, Vec3d from_lamp_dir) const;

  private:
    double power_ = 0;
    bool in_front_only_ = false;
    Table by_angle_;  // empty: none
};

// More would want another way than a shadow ray to each.
inline constexpr std::size_t kMaxLamps = 16;

// A lamp as it stands after loading.
struct SceneLamp {
    std::string name;
    std::size_t thing = 0;       // that carries it; 0: the camera's body; 1, 2, ...: of the scene's objects
    Spectrum intensity_w_sr_um;  // I_0
    LampBeam beam;
};

// A lamp at one instant, or the mean over several.
struct ShownLamp {
    Vec3d position_world_m;
    Vec3d axis{0, 0, 1};  // in the world, unit
    double level = 0;
};

// The lamps of a world, in a list that needs no memory of its own.
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
