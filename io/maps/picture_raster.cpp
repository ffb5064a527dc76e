#include "io/maps/picture_raster.h"

#include <algorithm>

#include "io/images/picture_file.h"
#include "io/maps/longitude_latitude.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

class PictureRaster final : public GroundRaster {
  public:
    PictureRaster(const GroundMapConfig& config, const MappedBody& body) {
        if (config.kind == GroundKind::kAlbedo)
            take_colors(config);
        else
            take_numbers(config);
        if (shape_.columns < 2 || shape_.rows < 2)
            throw InputError(config.file.string() + ": found " + std::to_string(shape_.columns) + " x " +
                             std::to_string(shape_.rows) + " pixels; accepted: 2 x 2 or more");
        if (!config.bounds_deg.empty())
            bounds_ = {config.bounds_deg[0], config.bounds_deg[1], config.bounds_deg[2],
                       config.bounds_deg[3]};
        set_bounds(bounds_, body.figure.equatorial_radius_m, shape_);
        const bool planetocentric = config.latitudes == MapLatitudes::kPlanetocentric;
        factor_ = latitude_factor(body.figure, planetocentric);
        if (body.figure.polar_radius_m == body.figure.equatorial_radius_m) return;
        reading_.taken = planetocentric ? "latitudes planetocentric (latitudes)"
                                        : "latitudes planetographic (" +
                                              std::string(config.latitudes == MapLatitudes::kLabel
                                                              ? "taken: a picture does not say"
                                                              : "latitudes") +
                                              ")";
    }

    void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) override {
        for (std::size_t i = 0; i < places.size(); ++i)
            posts[i] = post_at(bounds_, shape_, places[i], factor_);
    }

    // Reads means of the area that a post of the level covers.
    void read(int level, int column, int row, int columns, int rows, std::span<float> values) override {
        const int each = 1 << level;
        std::size_t k = 0;
        for (int y = row; y < row + rows; ++y)
            for (int x = column; x < column + columns; ++x)
                for (int c = 0; c < shape_.channels; ++c) {
                    double sum = 0;
                    for (int j = 0; j < each; ++j)
                        for (int i = 0; i < each; ++i)
                            sum += static_cast<double>(at(x * each + i, y * each + j, c));
                    values[k++] = static_cast<float>(sum / (1.0 * each * each));
                }
    }

  private:
    MapBounds bounds_;
    double factor_ = 1;  // see latitude_factor()
    std::vector<float> values_;

    float at(int column, int row, int channel) const {
        return values_[(static_cast<std::size_t>(row) * static_cast<std::size_t>(shape_.columns) +
                        static_cast<std::size_t>(column)) *
                           static_cast<std::size_t>(shape_.channels) +
                       static_cast<std::size_t>(channel)];
    }
    void take_numbers(const GroundMapConfig& config) {
        const PixelMap map = read_pixel_map(config.file, true);
        shape_.columns = map.width(), shape_.rows = map.height();
        values_.assign(map.all().begin(), map.all().end());
        for (float& v : values_)
            v = static_cast<float>(config.scale * static_cast<double>(v) + config.offset);
    }
    void take_colors(const GroundMapConfig& config) {
        const Texture picture = read_picture(config.file);
        shape_.columns = picture.width, shape_.rows = picture.height, shape_.channels = shape_.bands = 3;
        values_.reserve(3 * picture.texels.size());
        const auto decoded = [&](std::uint8_t code) {
            return config.coding == MapCoding::kSrgb ? static_cast<double>(linear_from_srgb(code)) : code;
        };
        for (const auto& texel : picture.texels)
            for (const std::uint8_t code : texel)
                values_.push_back(static_cast<float>(config.scale * decoded(code) + config.offset));
    }
};

}  // namespace

bool is_picture(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return ending == ".png";
}

std::unique_ptr<GroundRaster> open_picture_raster(const GroundMapConfig& config, const MappedBody& body) {
    if (config.bounds_deg.empty())
        throw InputError(config.file.string() +
                         ": a picture has no projection; accepted: with bounds_deg: [west, south, east, "
                         "north], [-180, -90, 180, 90] for a whole body");
    return std::make_unique<PictureRaster>(config, body);
}

}  // namespace hilcam
