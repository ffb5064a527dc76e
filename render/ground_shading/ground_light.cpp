#include "render/ground_shading/ground_light.h"

#include <algorithm>
#include <variant>

#include "render/ground_shading/ground_packet.h"
#include "render/shading/shadow_rays.h"
#include "render/visibility/visibility_buffer.h"

namespace hilcam {
namespace {

// A pixel that has to test whether it is in the Sun.
struct AskedPoint {
    std::uint32_t pixel;
    Spectrum light;
};

// The blocks of 4 x 4 pixels of one tile.
template <class Shadow>
class GroundTileLight {
  public:
    GroundTileLight(Tile& tile, Shadow& shadow)
        : tile_(tile),
          view_(tile.frame),
          shadow_(shadow),
          world_from_body_(view_.world_from_body.front()),
          material_(view_.objects->front()->materials.front()),
          hapke_(std::get_if<brdf::Hapke>(&material_.brdf)) {
        const Mat3f body_from_world = transposed(world_from_body_);
        const VisibilityBuffer::Shown& shown = *view_.ground->seen(0).shown;
        const Vec3d body_m = shown.pose.position_world_m - view_.rays_world_m;
        frame_.mesh = shown.mesh;
        frame_.surfaces = view_.objects->front();
        camera_m_ = to_float(view_.camera_m);
        frame_.camera_m = body_from_world * to_float(view_.camera_m - body_m);
        sun_dir_ = to_float(view_.background->sun_world_dir());
        frame_.sun_dir = body_from_world * sun_dir_;
        const LinearRays& rays = *view_.rays->linear();
        const double step_px = view_.ground_step_px;
        const Vec3d right = step_px * rays.right, down = step_px * rays.down;
        corner_ = body_from_world * to_float(rays.corner + tile.box.x0 * right + tile.box.y0 * down);
        right_ = body_from_world * to_float(right), down_ = body_from_world * to_float(down);
        // With maps the law's other parameters differ by place, and slopes are computed one place at a time.
        vectors_ =
            hapke_ && hapke_->parameters.roughness_tangent == 0 && frame_.surfaces->corner_hapke.empty();
    }

    // x, y: the block's corner in the picture. ids: of its pixels.
    void add(int x, int y, const std::uint32_t* ids) {
        aim(x, y, ids);
        find_ground(frame_, packet_);
        if (vectors_)
            reflect_in_vectors();
        else
            reflect_one_by_one();
        give(x, y);
    }

  private:
    Tile& tile_;
    const FrameContext& view_;
    Shadow& shadow_;
    const Mat3f& world_from_body_;
    const Material& material_;
    const brdf::Hapke* hapke_;
    bool vectors_;
    GroundInFrame frame_;
    Vec3f camera_m_, sun_dir_;     // ray space, world axes
    Vec3f corner_, right_, down_;  // the tile's rays, body axes
    GroundPacket packet_;
    std::array<GroundPacket::Floats, kMaxBins> light_;  // radiance if the Sun is visible

    void aim(int x, int y, const std::uint32_t* ids) {
        const auto left = static_cast<float>(x - tile_.box.x0) + 0.5f,
                   top = static_cast<float>(y - tile_.box.y0) + 0.5f;
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            // Places outside the picture may have no id.
            packet_.triangle[i] = ids[i] == VisibilityTile::kNothing ? ids[0] : ids[i];
            const float dx = left + static_cast<float>(i % 4), dy = top + static_cast<float>(i / 4);
            packet_.dir.x[i] = corner_.x + dx * right_.x + dy * down_.x;
            packet_.dir.y[i] = corner_.y + dx * right_.y + dy * down_.y;
            packet_.dir.z[i] = corner_.z + dx * right_.z + dy * down_.z;
        }
    }

    void reflect_in_vectors() {
        HapkePacket hapke;
        find_hapke(hapke_->parameters, packet_, hapke);
        const Spectrum& sun = view_.background->sun_irradiance_w_m2_um();
        const auto& [red, green, blue] = packet_.color;
        for (int b = 0; b < view_.bins; ++b) {
            const std::array<float, 3> shares = view_.bands->shares(b);
            const float base = material_.base[b];
            alignas(64) GroundPacket::Floats albedo;
            for (std::size_t i = 0; i < kPacketSize; ++i)
                albedo[i] = base * (shares[0] * red[i] + shares[1] * green[i] + shares[2] * blue[i]);
            reflect_hapke(hapke, packet_, sun[b], albedo, light_[static_cast<std::size_t>(b)]);
        }
    }

    void reflect_one_by_one() {
        const Spectrum& sun = view_.background->sun_irradiance_w_m2_um();
        Bsdf surface(&material_, 0, material_.base, material_.highlight);
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            Spectrum light;
            if (packet_.ni[i] > 0 && packet_.sun[i] != SunVisibility::kDark) {
                if (!frame_.surfaces->corner_colors.empty())
                    surface.base =
                        material_.base * view_.bands->spectrum(
                                             {packet_.color[0][i], packet_.color[1][i], packet_.color[2][i]});
                if (!frame_.surfaces->corner_hapke.empty())
                    surface.hapke =
                        frame_.surfaces->hapke_at(packet_.triangle[i], packet_.u[i], packet_.v[i]);
                light = packet_.ni[i] *
                        (sun * brdf_value(surface, {packet_.no[i], packet_.ni[i], packet_.io[i]}));
            }
            for (int b = 0; b < view_.bins; ++b) light_[static_cast<std::size_t>(b)][i] = light[b];
        }
    }

    // Adds the block's light to its pixels, or tests the Sun for it.
    void give(int x, int y) {
        const int width = tile_.box.x1 - tile_.box.x0;
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            if (!(packet_.ni[i] > 0) || packet_.sun[i] == SunVisibility::kDark) continue;
            const int px = x + static_cast<int>(i) % 4, py = y + static_cast<int>(i) / 4;
            if (px >= tile_.box.x1 || py >= tile_.box.y1) continue;
            const auto pixel = static_cast<std::uint32_t>((py - tile_.box.y0) * width + px - tile_.box.x0);
            if (packet_.sun[i] == SunVisibility::kAsk)
                ask(i, pixel);
            else
                tile_.add(pixel, LightPart::kSun, {}, light_of(i));
        }
    }

    Spectrum light_of(std::size_t i) const {
        Spectrum light;
        for (int b = 0; b < view_.bins; ++b) light[b] = light_[static_cast<std::size_t>(b)][i];
        return light;
    }

    // Starts at the same point as ShadingPoint::start().
    void ask(std::size_t i, std::uint32_t pixel) {
        const AskedPoint asked{pixel, light_of(i)};
        const auto& corners = frame_.mesh.triangles[packet_.triangle[i]];
        const auto corner = [&](std::size_t c) { return frame_.mesh.vertices_m[corners[c]]; };
        const float u = packet_.u[i], v = packet_.v[i];
        const Vec3f in_body_m = (1 - u - v) * corner(0) + u * corner(1) + v * corner(2);
        const Vec3f point_m = camera_m_ + world_from_body_ * (in_body_m - frame_.camera_m);
        const Vec3f up = world_from_body_ * normalized(packet_.geometric.at(i));
        shadow_.add(point_m + rounding_m(point_m, camera_m_) * up, sun_dir_, asked);
    }
};

}  // namespace

ImageGeometry ground_geometry(const ImageGeometry& picture, int step_px) {
    const int block_px = kGroundBlock * step_px;
    const auto blocks = [&](int px) { return (px + block_px - 1) / block_px; };
    ImageGeometry out = picture;
    out.width_px = blocks(picture.padded_width()), out.height_px = blocks(picture.padded_height());
    out.guard_px = 0;
    out.focal_length_px = picture.focal_length_px / block_px;
    const Vec2d center = picture.center_px();
    out.principal_offset_px = {(center.x + picture.guard_px) / block_px - 0.5 * out.width_px,
                               (center.y + picture.guard_px) / block_px - 0.5 * out.height_px};
    return out;
}

bool is_plain_ground(const Material& material) {
    return !material.has_facets() && !material.transmits() && material.texture < 0 &&
           material.emission.none();
}

bool add_ground_light(Tile& tile) {
    const PixelBox& box = tile.box;
    const FrameContext& frame = tile.frame;
    const int step_px = frame.ground_step_px;
    const PixelBox box_px{box.x0 * step_px, box.y0 * step_px, box.x1 * step_px, box.y1 * step_px};
    if (frame.bodies_may_hide && frame.may_see_body(box_px)) return false;
    const int left = box.x0 / kGroundTile * kGroundTile, top = box.y0 / kGroundTile * kGroundTile;
    const auto ids_at = [&](int x, int y) {
        return tile.ground->ids((x - left) / kGroundBlock, (y - top) / kGroundBlock);
    };
    const auto each_block = [&](const auto& use) {
        for (int y = box.y0; y < box.y1; y += kGroundBlock)
            for (int x = box.x0; x < box.x1; x += kGroundBlock)
                if (!use(x, y)) return false;
        return true;
    };
    const bool all = each_block([&](int x, int y) {
        const std::uint32_t* const ids = ids_at(x, y);
        bool ground = true;
        for (int i = 0; i < kPacketSize; ++i)
            ground =
                ground && (x + i % 4 >= box.x1 || y + i / 4 >= box.y1 || ids[i] != VisibilityTile::kNothing);
        return ground;
    });
    if (!all) return false;
    tile.stats.covered_px += (box.x1 - box.x0) * (box.y1 - box.y0);
    if (max_component(frame.background->sun_irradiance_w_m2_um()) <= 0) return true;
    const auto lit = [&](const AskedPoint& asked, const Spectrum*) {
        tile.add(asked.pixel, LightPart::kSun, {}, asked.light);
    };
    ShadowRays<AskedPoint, decltype(lit)> shadow(frame, tile.stats.shadow_rays, lit);
    GroundTileLight light(tile, shadow);
    return each_block([&](int x, int y) {
        light.add(x, y, ids_at(x, y));
        return true;
    });
}

}  // namespace hilcam
