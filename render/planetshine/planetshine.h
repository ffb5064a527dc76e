#pragma once
// The light of the bodies (Earth, Moon, planets) on a surface with a free view of the sky. Made once per
// frame by quadrature over each body's disk, so nothing about it is random. See docs/rendering.md,
// "Planetshine".

#include <array>
#include <span>
#include <vector>

#include "render/background/background.h"
#include "render/planetshine/body_map.h"

namespace hilcam {

class Planetshine {
  public:
    static constexpr std::size_t kMaxBodies = 2;
    // Bodies that give less than this share of what white paint reflects in the Sun are left out.
    static constexpr float kMinOverSun = 1e-5f;

    // narrowest_alpha: smallest GGX alpha of all facets that it lights; 1: there are none.
    explicit Planetshine(float narrowest_alpha);

    // Prepares a frame; the background is placed. margin_rad: distance that is_clear_of_bodies() keeps from
    // bodies. Loop.
    void place(const Background& background, float margin_rad);

    struct Body {
        Vec3f world_dir;
        // The approximate cone of its light: a half-lit disk shines from its lit half.
        Vec3f light_dir;
        float light_cosine = 1;
        Spectrum irradiance_w_m2_um;  // on a surface that faces it
    };
    std::span<const Body> bodies() const { return {bodies_.data(), count_}; }

    // True when its disk is in this direction.
    bool is_met(std::size_t body, Vec3f world_dir) const {
        return dot(bodies_[body].world_dir, world_dir) >= disks_[body].cosine;
    }
    // Returns the body's radiance in a direction (unit, world), resolved by the 64 parts of its disk: the
    // largest bin; 0 outside the disk. Loop, any thread.
    float brightness(std::size_t body, Vec3f world_dir) const;
    // True when no body of the background, listed in bodies() or not, is in this direction or near it. Unit,
    // world.
    bool is_clear_of_bodies(Vec3f dir) const;
    // Returns the irradiance [W m^-2 um^-1] on a surface with this normal. Loop, any thread.
    Spectrum irradiance(std::size_t body, Vec3f world_normal) const {
        return irradiance_[body].at(world_normal);
    }
    // Calls visit(direction, irradiance on a surface that faces it) for each of 16 parts of a body's disk. Loop,
    // any thread.
    template <class Visit>
    void for_each_part(std::size_t body, const Visit& visit) const {
        const Disk& disk = disks_[body].of.front();
        for (std::size_t i = 0; i < kParts.front(); ++i)
            visit(Vec3f{disk.x[i], disk.y[i], disk.z[i]}, disk.irradiance[i]);
    }
    // The body's light in a facet lobe. Facets that face the body are lit at other angles than the lobe's
    // mean.
    struct Glossy {
        Spectrum radiance;       // sent to the viewer by facets that reflect everything
        float facet_cosine = 1;  // cosine at these facets, for Fresnel's term
    };
    // alpha: of GGX; 0: a mirror. Unit vectors, world. reflectance: light that is negligible with it becomes
    // zero.
    Glossy glossy(std::size_t body, Vec3f normal, Vec3f view_dir, float alpha, float reflectance) const;
    // Lobes that differ in their normals only.
    struct Lobes {
        static constexpr std::size_t kMax = 8;
        Vec3f view_dir;
        float alpha, reflectance;
        std::size_t count = 0;
        alignas(32) std::array<float, kMax> x{}, y{}, z{};  // normals

        Vec3f normal(std::size_t i) const { return {x[i], y[i], z[i]}; }
        void add(Vec3f n) { x[count] = n.x, y[count] = n.y, z[count] = n.z, ++count; }
    };
    // The same for several lobes; out: at least one entry for each.
    void glossy(std::size_t body, const Lobes& lobes, std::span<Glossy> out) const;

  private:
    // A function of direction on an octahedron's faces (Cigolle et al., JCGT 3(2), 2014); bilinear.
    struct DirectionMap {
        static constexpr int kSteps = 16;
        std::vector<Spectrum> value = std::vector<Spectrum>((kSteps + 1) * (kSteps + 1));
        static Vec3f direction(int index);
        Spectrum at(Vec3f dir) const;
    };
    // A body's disk in parts of equal solid angle: few for wide lobes, many for narrow ones. Fewer than 16
    // would save nothing, because loops process sixteen at once.
    static constexpr std::size_t kPatches = 256;
    static constexpr std::array<std::size_t, 3> kParts = {16, 64, kPatches};
    static constexpr std::size_t kLooks = kPatches;
    static constexpr std::size_t kEven = 1;  // index of the one for surfaces without lobes
    struct Look {
        Vec3f dir;
        Spectrum irradiance;  // on a surface that faces it
    };
    struct Disk {
        alignas(64) std::array<float, kPatches> x{}, y{}, z{};
        std::array<float, kPatches> brightest{};      // largest bin of `irradiance`
        std::array<Spectrum, kPatches> irradiance{};  // by each part, on a surface that faces it
        float min_alpha = 0;
    };
    struct Disks {
        std::array<Disk, kParts.size()> of;              // by index of kParts
        float cosine = 1, sine = 0, half_angle_rad = 0;  // a cone around it
        BodyMap map;                                     // for lobes too narrow for the parts
    };

    float narrowest_alpha_;
    const Background* background_ = nullptr;
    std::size_t count_ = 0;
    std::array<Body, kMaxBodies> bodies_;
    std::array<DirectionMap, kMaxBodies> irradiance_;
    std::array<Disks, kMaxBodies> disks_;
    // Cones around the bodies of the background, with a margin.
    struct Cone {
        Vec3f axis;
        float cosine;
    };
    std::array<Cone, hilcam::kMaxBodies> cones_;
    std::size_t cone_count_ = 0;

    struct Seen;
    static void look(const Disks& disks, const Disk& disk, std::size_t count, Vec3f body_dir,
                     const Lobes& lobes, Seen& seen);
    Glossy narrow_lobe(std::size_t body, Vec3f normal, Vec3f view_dir, float alpha) const;
    static void place_light(const Disk& disk, Body& body);
    static std::array<Look, kLooks> looks_at(const Background& background, std::size_t number);
    void place_disks(const Background& background, const PlanetshineSource& lamp, std::span<const Look> looks,
                     Disks& disks) const;
    static void place_parts(std::span<const Look> looks, Vec3f axis, float one_minus_cosine,
                            std::size_t count, Disk& out);
};

}  // namespace hilcam
