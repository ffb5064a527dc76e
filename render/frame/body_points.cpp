#include "render/frame/body_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hilcam {
namespace {

// The plane at distance 1 on which a body is seen, divided into square cells around it.
class LittlePicture {
  public:
    // rays_across: the least number of rays across the cone with that cosine around the body's middle.
    LittlePicture(const FrameContext& frame, const PlacedBody& body, double cone_cosine, int rays_across)
        : background_(*frame.background),
          body_(body),
          right_(normalized(
              cross(body.world_dir, std::abs(body.world_dir.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}))),
          down_(cross(body.world_dir, right_)),
          reach_(std::sqrt(1 - cone_cosine * cone_cosine) / cone_cosine) {
        const double size_px = 2 * reach_ * frame.geometry.focal_length_px;
        const int most = frame.background->scene_of(body).rings ? kMaxRingedCells : kMaxCells;
        cells_ = std::clamp(static_cast<int>(std::ceil(2 * size_px)), 1, most);
        rays_ = (rays_across + cells_ - 1) / cells_;
        step_ = 2 * reach_ / (cells_ * rays_);
    }
    int cells() const { return cells_; }

    struct Cell {
        Vec3d middle;      // mean direction of its light, times that light
        double light = 0;  // sum over the bins
        Spectrum irradiance_w_m2_um;
    };
    Cell cell(int i, int j) const {
        Cell out;
        for (int y = j * rays_; y < (j + 1) * rays_; ++y)
            for (int x = i * rays_; x < (i + 1) * rays_; ++x) {
                const Vec3d dir = body_.world_dir + ((x + kAsideX) * step_ - reach_) * right_ +
                                  ((y + kAsideY) * step_ - reach_) * down_;
                const double distance = length(dir);
                const auto angle_sr = static_cast<float>(step_ * step_ / (distance * distance * distance));
                const Spectrum light = angle_sr * background_.ground_radiance(body_, dir, step_);
                const auto all =
                    static_cast<double>(std::accumulate(light.bin.begin(), light.bin.end(), 0.0f));
                out.irradiance_w_m2_um += light;
                out.middle = out.middle + all * dir;
                out.light += all;
            }
        return out;
    }

  private:
    static constexpr int kMaxCells = 16, kMaxRingedCells = 37;
    static_assert(kMaxCells * kMaxCells == kMaxBodyPoints);
    static_assert(kMaxRingedCells * kMaxRingedCells == kMaxRingedPoints);
    // The rays' places in their cells. In a grid symmetric about the disk's middle, each error at the rim
    // would occur four or eight times.
    static constexpr double kAsideX = 0.29, kAsideY = 0.11;

    const Background& background_;
    const PlacedBody& body_;
    Vec3d right_, down_;
    double reach_;
    int cells_, rays_;  // along an axis; of a cell
    double step_;
};

// Across the body: gives the light of a Lambertian sphere at half phase to 0.2 %.
constexpr int kRaysAcross = 64;

void add_cells(const FrameContext& frame, const PlacedBody& body, const PointField& field,
               std::vector<PointSource>& points) {
    const LittlePicture picture(frame, body, body.cone_cosine, kRaysAcross);
    const std::uint32_t thing = PointSource::kFirstBody + static_cast<std::uint32_t>(index_of(body.id));
    // The body does not hide itself.
    const double before_m = body.distance_m * (1 - 1.01 * std::sqrt(1 - body.cone_cosine * body.cone_cosine));
    for (int j = 0; j < picture.cells(); ++j)
        for (int i = 0; i < picture.cells(); ++i) {
            const LittlePicture::Cell cell = picture.cell(i, j);
            if (cell.light > 0)
                field.add_from_sky(normalized(cell.middle), before_m, cell.irradiance_w_m2_um, points, thing);
        }
}

// Returns the direction from which the light of a body smaller than a pixel comes: for a crescent it differs
// from the body's middle. The density of rays is that for a body of one pixel.
Vec3d light_dir(const FrameContext& frame, const PlacedBody& body) {
    const double sine = std::sqrt(1 - body.disk_cosine * body.disk_cosine);
    const double size_px = 2 * sine / body.disk_cosine * frame.geometry.focal_length_px;
    // The light of a smaller body is within a hundredth of a pixel of its middle.
    constexpr double kSeen_px = 0.02;
    if (size_px < kSeen_px) return body.world_dir;
    const LittlePicture picture(frame, body, body.disk_cosine,
                                std::max(4, static_cast<int>(std::ceil(kRaysAcross * size_px))));
    Vec3d sum;
    for (int j = 0; j < picture.cells(); ++j)
        for (int i = 0; i < picture.cells(); ++i) sum = sum + picture.cell(i, j).middle;
    return dot(sum, sum) > 0 ? normalized(sum) : body.world_dir;
}

}  // namespace

void add_body_points(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points) {
    const Background& background = *frame.background;
    for (const PlacedBody& body : background.points())
        if (field.sees(background.seen_through_air(body.world_dir, body.distance_m).dir, body.distance_m))
            field.add_from_sky(light_dir(frame, body), body.distance_m, background.point_irradiance(body),
                               points);
    for (std::size_t i = 0; i < frame.body_box_count; ++i)
        if (background.disks()[i].in_points && !frame.body_boxes[i].empty())
            add_cells(frame, background.disks()[i], field, points);
}

}  // namespace hilcam
