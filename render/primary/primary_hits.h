#pragma once
// Finds what the camera sees in a tile, as shading points: by rays (primary_rays.cpp), or from the frame's
// visibility buffer. In the latter case each triangle that samples of a pixel see becomes one shading point
// at their middle, with the throughput of all of them.

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

    // Writes the next shading points, at most PathModel::kMaxShadingPoints (for which `points` must have
    // room), and adds the background to the tile's pixels. Returns their number; 0: there are no more. Loop,
    // any thread.
    std::size_t next(std::span<ShadingPoint> points);

  private:
    // A triangle in a pixel.
    struct Fragment {
        std::uint32_t id;
        std::uint16_t pixel;  // in the tile
        std::uint8_t x, y;    // place in the pixel
        SampleMask samples;
    };
    Tile& tile_;
    bool begun_ = false, ended_ = false;
    PixelBox part_{};                                           // the part of the tile that the buffer holds
    int part_px_ = 0;                                           // edge of that part
    int next_pixel_ = 0, pixels_ = 0;                           // in that part
    std::array<SampleMask, PathModel::kMaxSamples> uncovered_;  // by pixel: samples that see no object
    std::array<Fragment, kPacketSize + kMaxVisibilitySamples> fragments_;
    std::size_t fragment_count_ = 0;
    // The packet of fragments in work: arguments and results of find_surface_frames(), and its rays.
    FragmentPacket packet_;
    HitPacket hits_;
    FragmentMesh mesh_{};  // the packet's object and its position [ray space]
    Vec3f body_m_;
    std::array<Vec2f, kPacketSize> places_px_;  // in the fragments' pixels
    std::array<Vec3d, kPacketSize> dirs_;
    std::array<Vec3f, kPacketSize> origins_;
    // Fragments for which one look is not enough, because their normals vary much or they have a texture, are
    // looked at from several of their samples. Those of fragment k are first_look_[k] to first_look_[k + 1].
    static constexpr std::size_t kLooks = NormalClusters::kTurns;
    FragmentPacket looked_at_;
    std::array<Vec3f, kPacketSize * kLooks> look_normals_;
    std::array<Vec2f, kPacketSize * kLooks> look_places_;  // u and v in the triangle
    std::array<std::size_t, kPacketSize + 1> first_look_;
    std::array<bool, kPacketSize> turns_;
    // The coverage map that was met last, as the frame shows it.
    struct ShownCoverageMap {
        const CoverageMap* is = nullptr;
        std::uint32_t object = 0;
        Vec3f normal, across, down;  // world axes
        Vec3d corner_m;              // world axes, from the body's origin
        Vec2f to_sun{};              // movement of a ray to the Sun along the sides while it rises by one

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
        // Its middle from the camera, and the steps of one pixel.
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

// Traces the camera's rays through a tile in packets of 4 x 4 pixels. Writes at most points.size() shading
// points (PathModel::kMaxSamples are enough), adds the background to the tile's pixels, and returns the
// number of points. Loop, any thread.
std::size_t trace_primary_rays(Tile& tile, std::span<ShadingPoint> points);
// Adds the background alone. uncovered: by pixel, row by row, the samples that see no object. Loop, any
// thread.
void add_backdrop(Tile& tile, const SampleMask* uncovered);
// Adds the air between the camera and a shading point that it sees along dir, and dims the point by it.
void add_air_before(Tile& tile, Vec3d dir, ShadingPoint& point);

}  // namespace hilcam
