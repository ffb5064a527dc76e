#pragma once
// Finds what the camera sees of a tile, as shading points: by rays (primary_rays.cpp), or out of the frame's
// visibility buffer. There each triangle that a pixel's samples see is one shading point at their middle, with the
// throughput of so many samples.

#include <array>
#include <cstdint>
#include <span>

#include "render/lod/coverage_map.h"
#include "render/shading/path_model.h"
#include "render/visibility/fragment_packet.h"

namespace hilcam {

class PrimaryHits {
  public:
    explicit PrimaryHits(Tile& tile) : tile_(tile) {}

    // Writes the next shading points, PathModel::kMaxShadingPoints at a time at most, and adds the background to the
    // tile's pixels. Returns how many; 0: that was all. shading points: room for kMaxShadingPoints. Loop, any thread.
    std::size_t next(std::span<ShadingPoint> points);

  private:
    // A triangle in a pixel.
    struct Fragment {
        std::uint32_t id;
        std::uint16_t pixel;  // in the tile
        std::uint8_t x, y;    // where it is there [px]
        SampleMask samples;
    };
    Tile& tile_;
    bool begun_ = false, ended_ = false;
    PixelBox part_{};                                           // the part of the tile that the buffer has
    int part_px_ = 0;                                           // its edge
    int next_pixel_ = 0, pixels_ = 0;                           // there
    std::array<SampleMask, PathModel::kMaxSamples> uncovered_;  // samples that see no object, by pixel
    std::array<Fragment, kPacketSize + kMaxVisibilitySamples> fragments_;
    std::size_t fragment_count_ = 0;
    // The packet of fragments that is looked at: what find_surface_frames() takes and gives, and its rays.
    FragmentPacket packet_;
    HitPacket hits_;
    FragmentMesh mesh_{};  // the packet's object, and its place [ray space]
    Vec3f body_m_;
    std::array<Vec2f, kPacketSize> places_px_;  // in their pixels
    std::array<Vec3d, kPacketSize> dirs_;
    std::array<Vec3f, kPacketSize> origins_;
    // Those of them that one look does not tell, as they turn much or a texture paints them, from several of their samples:
    // fragment k has the looks from first_look_[k] to first_look_[k + 1].
    static constexpr std::size_t kLooks = NormalClusters::kTurns;
    FragmentPacket looked_at_;
    std::array<Vec3f, kPacketSize * kLooks> look_normals_;
    std::array<Vec2f, kPacketSize * kLooks> look_places_;  // in the triangle: u and v
    std::array<std::size_t, kPacketSize + 1> first_look_;
    std::array<bool, kPacketSize> turns_;
    // The coverage map that was met last, as the frame shows it.
    struct ShownCoverageMap {
        const CoverageMap* is = nullptr;
        std::uint32_t object = 0;
        Vec3f normal, across, down;  // world axes
        Vec3d corner_m;              // world axes, from the body's origin
        Vec2f to_sun{};              // way of a ray to the Sun along the sides while it rises by one

        Vec2f slopes(Vec3f dir) const;
    };
    ShownCoverageMap coverage_map_;

    std::size_t next_fragments(std::span<ShadingPoint> points);
    bool open_next_part();
    void take_next_pixel();
    void take_pixel(int x, int y);
    bool has_impostor(std::uint32_t id) const;
    bool leave_to_body(std::size_t k);
    struct Aim {
        Vec3d dir;
        Vec3f origin_m;
    };
    Aim aim_at(const Fragment& fragment, Vec2f place_px) const;
    std::size_t look_at_fragments();
    bool turns_much(std::size_t k) const;
    float pixel_m(std::size_t k) const;
    bool is_textured(std::size_t k) const;
    std::size_t looks_at_texture(std::size_t k, float samples) const;
    std::size_t add_looks(std::size_t k);
    void find_looks(std::size_t first);
    void look_at_samples();
    template <class T>
    std::span<const T> looks_of(std::size_t k, const std::array<T, kPacketSize * kLooks>& looks) const {
        return std::span(looks).subspan(first_look_[k], first_look_[k + 1] - first_look_[k]);
    }
    std::span<const Vec3f> turns_of(std::size_t k) const {
        return turns_[k] ? looks_of(k, look_normals_) : std::span<const Vec3f>{};
    }
    Spectrum texture_of(std::size_t k, const ShadingPoint& point) const;
    void mix_colors(std::size_t k, float share, ShadingPoint& point) const;
    std::size_t make_shading_points(std::span<ShadingPoint> points, std::size_t count);
    struct PixelRays {
        Vec3d middle, right, down;
    };
    PixelRays rays_of(const Fragment& fragment) const;
    const ShownCoverageMap& shown(const CoverageMap& coverage_map);
    struct CoverageMapPixel {
        // Where its middle is from the camera, and how far a step of a pixel goes.
        Vec3d middle_m, per_x_m, per_y_m;
        CoverageMap::Coverage coverage;
    };
    CoverageMapPixel look_at_coverage_map(std::size_t k, Vec3f view_dir) const;
    std::size_t make_covered_points(std::size_t k, const SurfaceFrame& surface_frame,
                                    std::span<ShadingPoint> points, std::size_t count);
    void finish(std::size_t k, float samples, SubpixelMoments moments, Vec2f place_px, ShadingPoint& point);
    void take_in(std::size_t k, const SurfaceFrame& surface_frame, ShadingPoint& point);
    static ShadingPoint* join(std::span<ShadingPoint> so_far, std::uint32_t pixel, std::uint32_t object,
                              std::uint16_t surface, const SurfaceFrame& surface_frame);
};

// The camera's rays through a tile, in packets of 4 x 4 pixels. Writes at most shading points.size() shading points
// (PathModel::kMaxSamples are enough) and adds the background to the tile's pixels. Returns how many. Loop, any
// thread.
std::size_t trace_primary_rays(Tile& tile, std::span<ShadingPoint> points);
// Adds the background alone. uncovered: the samples that see no object, by pixel, row by row. Loop, any thread.
void add_backdrop(Tile& tile, const SampleMask* uncovered);
// Adds the air between the camera and a shading point that it sees along dir, and dims the shading point by it.
void add_air_before(Tile& tile, Vec3d dir, ShadingPoint& point);

}  // namespace hilcam
