#include "io/maps/earth_layer_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/maps/map_helper.h"
#include "io/maps/picture_raster.h"
#include "render/scene/color_bands.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::unique_ptr<GroundRaster> opened(const EarthLayerConfig& layer) {
    const GroundMapConfig map = map_of_layer(layer);
    return is_picture(map.file) ? open_picture_raster(map, earth_body())
                                : open_map_by_helper(map, earth_body());
}

}  // namespace

const MappedBody& earth_body() {
    static const MappedBody earth{"earth", kFigures[index_of(BodyId::kEarth)]};
    return earth;
}

GroundMapConfig map_of_layer(const EarthLayerConfig& layer) {
    GroundMapConfig out;
    out.file = layer.file, out.where = layer.where;
    out.kind = layer.kind == EarthLayerConfig::Kind::kLand ? GroundKind::kAlbedo : GroundKind::kHeights;
    // The map below shows through a layer's holes.
    out.holes = MapHoles::kFill;
    out.bounds_deg = layer.bounds_deg;
    if (is_picture(layer.file) && layer.bounds_deg.empty()) out.bounds_deg = {-180, -90, 180, 90};
    return out;
}

std::string EarthLayerRaster::name() const {
    return (config_.where.empty() ? "" : config_.where + ": ") + config_.file.string();
}

void EarthLayerRaster::refuse(const std::string& what) const { throw InputError(name() + ": " + what); }

EarthLayerRaster::EarthLayerRaster(const EarthLayerConfig& config)
    : EarthLayerRaster(config, opened(config)) {}

EarthLayerRaster::EarthLayerRaster(const EarthLayerConfig& config, std::unique_ptr<GroundRaster> raster)
    : config_(config), raster_(std::move(raster)) {
    require_whole_earth();
    const GroundRaster::Shape& shape = raster_->shape();
    const std::string channels = std::to_string(shape.bands) + (shape.bands == 1 ? " channel" : " channels");
    if (config.kind == EarthLayerConfig::Kind::kLand) {
        // A fourth channel is opacity.
        if (shape.bands != 3 && shape.bands != 4)
            refuse("has " + channels + "; accepted: red, green and blue (kind: land)");
    } else if (shape.bands != 1) {
        refuse("has " + channels + "; accepted: one (gdal_translate -b 1 takes it out of several)");
    }
    constexpr int kMaxWithout = 16384;
    if (!shape.has_overviews && shape.columns > kMaxWithout)
        refuse(
            "has " + std::to_string(shape.columns) + " x " + std::to_string(shape.rows) +
            " posts and no overviews; accepted: with overviews (gdaladdo -r average FILE 2 4 8 16 32), or " +
            std::to_string(kMaxWithout) + " columns at most");
    const Vec3d date_line{-1, 0, 0};
    Vec2d post;
    raster_->find_posts({&date_line, 1}, {&post, 1});
    if (!std::isfinite(post.x)) refuse("has no column at 180 W; accepted: the whole Earth");
    first_column_ = post.x + 0.5;
}

void EarthLayerRaster::require_whole_earth() const {
    const GroundRaster::Shape& shape = raster_->shape();
    if (!shape.whole_turn || !shape.pole_above_first_row || !shape.pole_below_last_row)
        refuse(
            "does not cover the whole Earth in longitude and latitude; accepted: 360 degrees of longitude, "
            "from 90 N "
            "to 90 S (gdalwarp -t_srs EPSG:4326 -te -180 -90 180 90 makes it)");
    if (shape.columns != 2 * shape.rows)
        refuse("has " + std::to_string(shape.columns) + " x " + std::to_string(shape.rows) +
               " posts; accepted: twice as many columns as rows");
}

float EarthLayerRaster::decoded(float raw) const {
    if (!std::isfinite(raw)) return std::numeric_limits<float>::quiet_NaN();
    auto value = static_cast<double>(raw);
    if (config_.coding != EarthLayerConfig::Coding::kLinear)
        value = static_cast<double>(
            linear_from_srgb(static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0))));
    return static_cast<float>(config_.scale * value + config_.offset);
}

// Reads posts of a level of the file into posts_; columns wrap around.
void EarthLayerRaster::read_posts(int level, const LayerWindow& w) {
    const int columns = raster_->shape().columns >> level;
    const auto channels = static_cast<std::size_t>(this->channels());
    posts_.resize(static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows) * channels);
    for (int done = 0; done < w.columns;) {
        const int first = ((w.column + done) % columns + columns) % columns;
        const int count = std::min(w.columns - done, columns - first);
        part_.resize(static_cast<std::size_t>(count) * static_cast<std::size_t>(w.rows) * channels);
        raster_->read(level, first, w.row, count, w.rows, part_);
        for (std::size_t y = 0; y < static_cast<std::size_t>(w.rows); ++y)
            for (std::size_t i = 0; i < static_cast<std::size_t>(count) * channels; ++i)
                posts_[(y * static_cast<std::size_t>(w.columns) + static_cast<std::size_t>(done)) * channels +
                       i] = decoded(part_[y * static_cast<std::size_t>(count) * channels + i]);
        done += count;
    }
}

bool EarthLayerRaster::read(const LayerGrid& grid, const LayerWindow& w, std::vector<float>& values) {
    // Chooses the coarsest level that is as fine as the grid.
    int level = 0;
    while ((rows() >> (level + 1)) >= grid.rows && (rows() >> (level + 1)) >= 2) ++level;
    const double per_post = std::ldexp(1.0, -level), columns = this->columns() * per_post,
                 rows = this->rows() * per_post;
    const double first = first_column_ * per_post;
    const auto x_of = [&](int i) { return (w.column + i + 0.5) / grid.columns * columns + first - 0.5; };
    const int last_row = (this->rows() >> level) - 1;
    const auto y_of = [&](int j) {
        return std::clamp((w.row + j + 0.5) / grid.rows * rows - 0.5, 0.0, static_cast<double>(last_row));
    };
    const int left = static_cast<int>(std::floor(x_of(0))), top = static_cast<int>(std::floor(y_of(0)));
    const int right = static_cast<int>(std::floor(x_of(w.columns - 1))) + 1,
              bottom = std::min(static_cast<int>(std::floor(y_of(w.rows - 1))) + 1, last_row);
    const std::uint64_t failed = raster_->failed_reads();
    const LayerWindow posts{left, top, right - left + 1, bottom - top + 1};
    read_posts(level, posts);

    const auto channels = static_cast<std::size_t>(this->channels());
    values.resize(static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows) * channels);
    std::size_t k = 0;
    for (int j = 0; j < w.rows; ++j) {
        const double y = y_of(j);
        const int above = static_cast<int>(y), below = std::min(above + 1, bottom);
        const auto fy = static_cast<float>(y - above);
        for (int i = 0; i < w.columns; ++i) {
            const double x = x_of(i);
            const int column = static_cast<int>(std::floor(x));
            const auto fx = static_cast<float>(x - column);
            const auto at = [&](int c, int r) {
                return posts_.data() +
                       (static_cast<std::size_t>(r - top) * static_cast<std::size_t>(posts.columns) +
                        static_cast<std::size_t>(c - left)) *
                           channels;
            };
            const float *a = at(column, above), *b = at(column + 1, above), *c = at(column, below),
                        *d = at(column + 1, below);
            for (std::size_t n = 0; n < channels; ++n) {
                // A neighbour with no weight may be a hole.
                const auto mixed = [](float p, float q, float share) {
                    return share < 1e-4f ? p : p + share * (q - p);
                };
                values[k++] = mixed(mixed(a[n], b[n], fx), mixed(c[n], d[n], fx), fy);
            }
        }
    }
    return raster_->failed_reads() == failed;
}

}  // namespace hilcam
