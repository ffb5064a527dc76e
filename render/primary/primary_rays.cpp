#include "render/primary/primary_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "render/earth/earth_impostor_view.h"
#include "render/earth/earth_patch.h"
#include "render/primary/earth_limbs.h"
#include "render/shading/sample_offsets.h"
#include "render/visibility/place_sequence.h"
#include "render/visibility/visibility_buffer.h"

namespace hilcam {
namespace {

constexpr float kFarthestHit = std::numeric_limits<float>::infinity();

// The packets of one tile.
class PrimaryRays {
  public:
    PrimaryRays(Tile& tile, std::span<ShadingPoint> points)
        : tile_(tile),
          frame_(tile.frame),
          points_(points),
          bodies_(frame_.may_see_body(tile.box)),
          sun_(tile.box.overlaps(frame_.sun_box)),
          linear_(frame_.rays->linear()),
          plain_(bodies_ && linear_ && frame_.sees_plain_body_only(tile.box)) {
        const float sample_rad = static_cast<float>(1 / frame_.geometry.focal_length_px) /
                                 static_cast<float>(tile.samples_per_axis);
        width_ = {sample_rad * static_cast<float>(frame_.way_to_start_m()), sample_rad};
        std::fill_n(weight_.bin.begin(), frame_.bins, 1.0f);
        rays_.nearest.fill(0), rays_.farthest.fill(kFarthestHit);
        if (linear_) {
            // From the tile's corner on single precision suffices: 32 px of 2^-24 of a pixel's angle.
            corner_ = linear_->corner + tile.box.x0 * linear_->right + tile.box.y0 * linear_->down;
        }
        if (frame_.sees_earth_impostor_only(tile.box)) place_picture();
        picture_weight_ =
            frame_.earth_impostor_factor * (frame_.samples.weight(frame_.samples.all()) * weight_);
        patched_ = bodies_ && linear_ && !by_impostor_ && frame_.background->earth_in_patches();
    }

    // uncovered: by pixel, the samples that see no object; null: rays find the objects.
    std::size_t trace(const SampleMask* uncovered) {
        uncovered_ = uncovered;
        // Blocks of 4 x 4 pixels, so that a packet's rays are close together; they are the mask's blocks,
        // too.
        static_assert(ScreenMask::kBlock_px == 4);
        const PixelBox& box = tile_.box;
        for (int by = box.y0; by < box.y1; by += 4)
            for (int bx = box.x0; bx < box.x1; bx += 4) {
                const bool objects = !uncovered_ && frame_.object_mask->at(bx, by);
                if (!objects && !bodies_ && !sun_) continue;
                if (by_impostor_) earth_.expect(bx, by);
                if (by_impostor_ && sees_nothing_else(bx, by)) {
                    add_picture_block(bx, by);
                    continue;
                }
                if (!gather(bx, by, kAllPixels)) continue;
                const Block block = !uncovered_    ? Block::kUneven
                                    : by_impostor_ ? Block::kEven
                                                   : block_at(bx, by);
                if (block == Block::kRim) {
                    const std::uint32_t limb = limb_pixels(bx, by);
                    if (gather(bx, by, kAllPixels & ~limb)) trace_block(objects, true);
                    if (gather(bx, by, limb)) trace_block(objects, false);
                } else if (block != Block::kDark) {
                    trace_block(objects, block == Block::kEven);
                }
            }
        return count_;
    }

  private:
    Tile& tile_;
    const FrameContext& frame_;
    std::span<ShadingPoint> points_;
    const SampleMask* uncovered_ = nullptr;
    bool even_ = false;  // one ray per pixel
    bool bodies_, sun_;
    const LinearRays* linear_;
    bool plain_;                // only one body is in view, and it is computed sixteen rays at a time
    bool by_impostor_ = false;  // only the Earth is in view, and it has an impostor
    bool patched_;              // the Earth is computed in patches where that is accurate enough
    EarthImpostorView earth_;   // for the packet's samples
    Spectrum picture_weight_;   // the weight of a pixel that sees nothing else
    std::optional<EarthPatch> patch_;
    RayWidth width_;  // width of each ray, and the angle between neighbouring ones
    Spectrum weight_;
    Vec3d corner_;
    RayPacket rays_;
    HitPacket hits_;
    std::array<float, kPacketSize> x_of_{}, y_of_{};  // places of the packet's pixels, from the tile's corner
    std::array<float, kPacketSize> x_at_{}, y_at_{};  // places of their samples
    std::array<std::uint32_t, kPacketSize> word_x_{}, word_y_{};  // words of their sequences
    std::array<CameraRay, kPacketSize> exact_;  // used if rays are not linear or objects are far away
    std::size_t count_ = 0;

    // One bit for each of a block's 4 x 4 pixels, row by row.
    static constexpr std::uint32_t kAllPixels = 0xFFFF;
    // Takes those pixels of a block that are set in `pixels`. Returns false if there are none.
    bool gather(int bx, int by, std::uint32_t pixels) {
        const PixelBox& box = tile_.box;
        rays_.count = 0;
        for (int y = by; y < std::min(by + 4, box.y1); ++y)
            for (int x = bx; x < std::min(bx + 4, box.x1); ++x) {
                if (!(pixels >> (4 * (y - by) + x - bx) & 1u) || !wants(x, y)) continue;
                x_of_[static_cast<std::size_t>(rays_.count)] = static_cast<float>(x - box.x0);
                y_of_[static_cast<std::size_t>(rays_.count)] = static_cast<float>(y - box.y0);
                ++rays_.count;
            }
        return rays_.count > 0;
    }

    // Traces the selected pixels, with one ray each if the block is even.
    void trace_block(bool objects, bool even) {
        if (tile_.scattered) choose_sequences();
        const int n = even ? 1 : tile_.samples_per_axis;
        even_ = even;
        const float step = 1.0f / static_cast<float>(n);
        for (int s = 0; s < n * n; ++s) {
            const auto sample = static_cast<std::uint16_t>(s);
            if (tile_.scattered)
                scatter(sample);
            else
                center((static_cast<float>(s % n) + 0.5f) * step, (static_cast<float>(s / n) + 0.5f) * step);
            trace_packet(objects, sample);
        }
    }

    enum class Block { kDark, kEven, kRim, kUneven };
    // A block of 4 x 4 pixels is even if it is not near the rim of a body, of its air, or of the Sun: one ray
    // then represents a pixel. It is a rim if only the limb of the modelled Earth passes, so that some of its
    // pixels are even. It is dark if no body can be met.
    Block block_at(int x, int y) const {
        if (frame_.background->camera_in_air()) return Block::kUneven;
        if (frame_.sun_box.overlaps({x, y, x + 4, y + 4})) return Block::kUneven;
        const float at_x = static_cast<float>(x - tile_.box.x0) + 2,
                    at_y = static_cast<float>(y - tile_.box.y0) + 2;
        const Vec3d dir = normalized(linear_ ? corner_ + static_cast<double>(at_x) * linear_->right +
                                                   static_cast<double>(at_y) * linear_->down
                                             : direction_seen(frame_, x + 2, y + 2, {}));
        // From its middle to its corners: two rows, which a rotating camera sees elsewhere.
        const double two_rows_rad = 4 * frame_.rays->sweep_rad() / frame_.geometry.padded_height();
        const double block_rad = 3 / frame_.geometry.focal_length_px + two_rows_rad;
        Block out = Block::kDark;
        for (std::size_t i = 0; i < frame_.body_box_count; ++i) {
            const PlacedBody& body = frame_.background->disks()[i];
            const double radius_rad = std::acos(body.cone_cosine);
            const double from_middle_rad = std::acos(std::clamp(dot(dir, body.world_dir), -1.0, 1.0));
            if (from_middle_rad - block_rad >= radius_rad) continue;
            if (out == Block::kDark) out = Block::kEven;
            // The Earth is flattened by 1/300, and its air is 1/100 of its radius high.
            constexpr double kWithin = 0.97;
            const bool modelled = frame_.background->earth() && body.id == BodyId::kEarth;
            if (modelled && limbs_of(body).near(dir, rim_rad() + block_rad)) out = Block::kRim;
            if (!modelled && from_middle_rad + block_rad > kWithin * radius_rad) return Block::kUneven;
        }
        return out;
    }

    void place_picture() {
        std::array<CameraRay, EarthImpostorView::kNodes> rays;
        frame_.rays->generate(EarthImpostorView::nodes(tile_.box), rays);
        std::array<Vec3d, EarthImpostorView::kNodes> dirs;
        for (std::size_t i = 0; i < dirs.size(); ++i) dirs[i] = rays[i].dir;
        const PlacedBody& earth = frame_.background->disks()[0];
        const EarthImpostorView::Seen seen =
            earth_.place(*frame_.earth_impostor, tile_.box,
                         {earth.camera_m, earth.fixed_from_world, earth.world_dir, earth.cone_cosine}, dirs);
        bodies_ = seen != EarthImpostorView::Seen::kNothing;
        by_impostor_ = seen == EarthImpostorView::Seen::kPicture;
    }

    // True when no object covers any of a block's 4 x 4 pixels, all of which are in the tile.
    bool sees_nothing_else(int bx, int by) const {
        const PixelBox& box = tile_.box;
        if (!uncovered_ || tile_.scattered || bx + 4 > box.x1 || by + 4 > box.y1) return false;
        const SampleMask all = frame_.samples.all();
        bool whole = true;
        for (int y = by - box.y0; y < by - box.y0 + 4; ++y)
            for (int x = bx - box.x0; x < bx - box.x0 + 4; ++x)
                whole &= uncovered_[y * (box.x1 - box.x0) + x] == all;
        return whole;
    }

    void add_picture_block(int x, int y) {
        earth_.add_block(x, y, picture_weight_, tile_.pixels);
        if (!tile_.parts) return;
        // These pixels contain nothing else.
        const int width = tile_.box.x1 - tile_.box.x0, first = (y - tile_.box.y0) * width + x - tile_.box.x0;
        for (int i = 0; i < 16; ++i) {
            const auto pixel = static_cast<std::uint32_t>(first + i / 4 * width + i % 4);
            tile_.note(pixel, LightPart::kBackground, tile_.pixels[pixel]);
        }
    }

    // Looks up the packet's samples, each of which represents a part of its pixel's width.
    void look_at_picture(bool whole) {
        const float share =
            whole ? 1.0f : (tile_.scattered ? 0.0f : 1 / static_cast<float>(tile_.samples_per_axis));
        earth_.look(x_at_, y_at_, static_cast<std::size_t>(rays_.count), share);
    }

    // The Earth's model filters over the ray's cone, so it is uneven only within this distance of its limbs.
    static constexpr double kRim_px = 1.0;
    double rim_rad() const { return kRim_px / frame_.geometry.focal_length_px; }
    EarthLimbs limbs_of(const PlacedBody& earth) const { return {earth, *frame_.background->earth()}; }
    // Returns the pixels of a rim that a limb passes or nearly passes.
    std::uint32_t limb_pixels(int bx, int by) const {
        std::uint32_t out = 0;
        for (int i = 0; i < 16; ++i)
            if (meets_limb(bx + i % 4, by + i / 4)) out |= 1u << i;
        return out;
    }
    bool meets_limb(int x, int y) const {
        for (std::size_t i = 0; i < frame_.body_box_count; ++i) {
            const PlacedBody& body = frame_.background->disks()[i];
            if (body.id != BodyId::kEarth) continue;
            const Vec3d dir = normalized(linear_ ? corner_ + (x - tile_.box.x0 + 0.5) * linear_->right +
                                                       (y - tile_.box.y0 + 0.5) * linear_->down
                                                 : direction_seen(frame_, x, y, {0.5f, 0.5f}));
            return limbs_of(body).near(dir, rim_rad());
        }
        return false;
    }

    bool wants(int x, int y) const {
        return !uncovered_ ||
               uncovered_[(y - tile_.box.y0) * (tile_.box.x1 - tile_.box.x0) + x - tile_.box.x0] != 0;
    }

    // Puts the packet's samples at the same place in their pixels.
    void center(float dx, float dy) {
        for (std::size_t k = 0; k < kPacketSize; ++k) x_at_[k] = x_of_[k] + dx, y_at_[k] = y_of_[k] + dy;
    }
    // Chooses the sequences of the packet's pixels, the same for all their samples.
    void choose_sequences() {
        for (std::size_t k = 0; k < static_cast<std::size_t>(rays_.count); ++k) {
            const std::uint32_t pixel = tile_.frame_pixel(tile_.box.x0 + static_cast<int>(x_of_[k]),
                                                          tile_.box.y0 + static_cast<int>(y_of_[k]));
            const auto words = random_words(frame_.key, RandomPurpose::kPixelPlace, pixel);
            word_x_[k] = words[0], word_y_[k] = words[1];
        }
    }
    // Puts each sample at a place of its pixel's own sequence.
    void scatter(std::uint16_t sample) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(rays_.count); ++k) {
            const auto [dx, dy] = place_in_sequence(sample, word_x_[k], word_y_[k]);
            x_at_[k] = x_of_[k] + dx;
            y_at_[k] = y_of_[k] + dy;
        }
    }

    void aim() {
        if (linear_ && frame_.start_before_m <= 0) {
            const Vec3f corner = to_float(corner_), right = to_float(linear_->right),
                        down = to_float(linear_->down);
            const Vec3f origin = to_float(frame_.camera_m);
            rays_.origin_x.fill(origin.x), rays_.origin_y.fill(origin.y), rays_.origin_z.fill(origin.z);
            for (std::size_t k = 0; k < kPacketSize; ++k) {
                rays_.dir_x[k] = corner.x + x_at_[k] * right.x + y_at_[k] * down.x;
                rays_.dir_y[k] = corner.y + x_at_[k] * right.y + y_at_[k] * down.y;
                rays_.dir_z[k] = corner.z + x_at_[k] * right.z + y_at_[k] * down.z;
            }
            return;
        }
        std::array<Vec2d, kPacketSize> points;
        const auto n = static_cast<std::size_t>(rays_.count);
        for (std::size_t k = 0; k < n; ++k)
            points[k] = {static_cast<double>(x_at_[k]) + tile_.box.x0,
                         static_cast<double>(y_at_[k]) + tile_.box.y0};
        frame_.rays->generate({points.data(), n}, {exact_.data(), n});
        for (std::size_t k = 0; k < n; ++k) {
            const Vec3d dir = normalized(exact_[k].dir);
            const Vec3f start = frame_.start_of(dir, exact_[k].from_camera_m);
            rays_.set(static_cast<int>(k), start, to_float(dir), 0, kFarthestHit);
        }
    }

    // In double precision: a planet's limb must not crawl.
    Vec3d exact_dir(std::size_t k) const {
        if (!linear_) return exact_[k].dir;
        return corner_ + static_cast<double>(x_at_[k]) * linear_->right +
               static_cast<double>(y_at_[k]) * linear_->down;
    }

    // True when the ray met an object that the camera sees.
    bool meets_object(std::size_t k) const {
        const std::uint32_t object = hits_.object[k];
        if (object == HitPacket::kMiss || frame_.is_point[object]) return false;
        if (!frame_.bodies_may_hide) return true;
        const Vec3d dir = normalized(exact_dir(k));
        const Vec3d point =
            Vec3d{rays_.origin_x[k], rays_.origin_y[k], rays_.origin_z[k]} +
            static_cast<double>(hits_.distance[k]) * Vec3d{rays_.dir_x[k], rays_.dir_y[k], rays_.dir_z[k]};
        return !frame_.background->hides_seen(dir, length(point - frame_.camera_m));
    }

    void add_backdrop(std::size_t k, float sun_cosine, Spectrum weight, Spectrum& pixel) {
        if (by_impostor_) {
            pixel += frame_.earth_impostor_factor * weight * earth_.light(k);
            return;
        }
        if (plain_) {
            if (sun_cosine > EarthRays::kMiss)
                return frame_.background->add_plain_at(sun_cosine, weight, pixel);
            if (sun_) frame_.background->add_sun_disk_seen(exact_dir(k), weight, pixel);
            return;
        }
        if (patched_) {
            if (!patch_) {
                patch_.emplace();
                frame_.background->place_earth_patch(tile_.box, corner_, linear_->right, linear_->down,
                                                     *patch_);
            }
            if (patch_->add(static_cast<float>(tile_.box.x0) + x_at_[k],
                            static_cast<float>(tile_.box.y0) + y_at_[k], weight, pixel))
                return;
        }
        const Vec3d dir = exact_dir(k);
        if (bodies_ && frame_.background->add_bodies_seen(dir, weight, pixel)) return;
        if (sun_) frame_.background->add_sun_disk_seen(dir, weight, pixel);
    }

    void trace_packet(bool objects, std::uint16_t sample) {
        if (!by_impostor_ || objects) aim();
        if (by_impostor_) look_at_picture(uncovered_ != nullptr);
        if (objects) {
            frame_.scene->intersect(rays_, Coherence::kCoherent, hits_);
            tile_.stats.primary_rays += static_cast<std::uint64_t>(rays_.count);
            prefetch_shading_points(frame_, hits_, rays_.count);
        } else {
            hits_.object.fill(HitPacket::kMiss);
        }
        EarthRays::Floats sun_cosine{};
        if (plain_)
            frame_.background->plain_rays(corner_, linear_->right, linear_->down)
                .sun_cosines(x_at_, y_at_, sun_cosine);
        const int width = tile_.box.x1 - tile_.box.x0;
        for (int i = 0; i < rays_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto pixel =
                static_cast<std::uint32_t>(static_cast<int>(y_of_[k]) * width + static_cast<int>(x_of_[k]));
            if (objects && meets_object(k)) {
                tile_.stats.covered_px += 1.0 / (tile_.samples_per_axis * tile_.samples_per_axis);
                add_vertex(i, pixel, sample);
            } else if (bodies_ || sun_) {
                add_backdrop_to(pixel, k, sample, sun_cosine[k]);
            }
        }
    }

    // A ray represents its own sample; the single ray of an even pixel represents all samples that see no
    // object.
    void add_backdrop_to(std::uint32_t pixel, std::size_t k, std::uint16_t sample, float sun_cosine) {
        const PixelSamples& grid = frame_.samples;
        if (even_ && uncovered_[pixel] == grid.all()) {
            const Spectrum weight = grid.weight(grid.all()) * weight_;
            if (tile_.parts) {
                Spectrum light;
                add_backdrop(k, sun_cosine, weight, light);
                tile_.note(pixel, LightPart::kBackground, light);
            }
            return add_backdrop(k, sun_cosine, weight, tile_.pixels[pixel]);
        }
        if (!even_) tile_.set_kind(pixel, SubpixelKind::kBackground);
        float samples = 1;
        SubpixelMoments moments = subpixel_moments_at(x_at_[k] - x_of_[k], y_at_[k] - y_of_[k]);
        if (uncovered_) {
            const SampleMask seen = uncovered_[pixel] & (even_ ? grid.all() : grid.about(sample));
            if (seen == 0) return;
            samples = grid.weight(seen);
            moments = grid.moments(seen);
        }
        Spectrum light;
        add_backdrop(k, sun_cosine, samples * weight_, light);
        tile_.add(pixel, LightPart::kBackground, moments, light);
    }

    void add_vertex(int lane, std::uint32_t pixel, std::uint16_t sample) {
        const auto k = static_cast<std::size_t>(lane);
        const Vec3f origin{rays_.origin_x[k], rays_.origin_y[k], rays_.origin_z[k]};
        const Vec3f dir{rays_.dir_x[k], rays_.dir_y[k], rays_.dir_z[k]};
        ShadingPoint& point = points_[count_];
        if (!make_shading_point(frame_, hits_, lane, origin, dir, 0, width_, point)) return;
        point.pixel = pixel;
        point.sample = sample;
        point.depth = 1;
        point.throughput = weight_;
        point.moments = subpixel_moments_at(x_at_[k] - x_of_[k], y_at_[k] - y_of_[k]);
        tile_.set_kind(pixel, SubpixelKind::kObject);
        tile_.clusters.add(frame_, {point.geometric_normal, point.normal, point.start(), 1},
                           hits_.triangle[k], true, {}, point);
        ++count_;
        add_air_before(tile_, exact_dir(k), point);
    }
};

}  // namespace

void add_air_before(Tile& tile, Vec3d dir, ShadingPoint& point) {
    const FrameContext& frame = tile.frame;
    if (!frame.background->camera_in_air()) return;
    const double distance_m = length(to_double(point.point_m) - frame.camera_m);
    const Atmosphere::Sight sight = frame.background->air_before(dir, distance_m);
    tile.add(point, LightPart::kAir, point.throughput * sight.radiance_sr);
    point.throughput = point.throughput * sight.transmittance;
}

std::size_t trace_primary_rays(Tile& tile, std::span<ShadingPoint> points) {
    tile.clusters.clear();
    return PrimaryRays(tile, points).trace(nullptr);
}

void add_backdrop(Tile& tile, const SampleMask* uncovered) { PrimaryRays(tile, {}).trace(uncovered); }

}  // namespace hilcam
