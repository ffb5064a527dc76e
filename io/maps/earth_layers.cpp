#include "io/maps/earth_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/earth/cloud_table.h"
#include "render/earth/land_colors.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using LayerKind = EarthLayerConfig::Kind;

// From a picture's grey to the scale of clouds, and their top heights: the figures of
// tools/make_earth_map.py, which gives the sources.
constexpr float kCloudPower = 1.33f, kLowestTop_m = 2000, kTopRise_m = 8000;
constexpr float kSea = 0.999f;  // share of water from which a texel has no land

// Values of all layers in a window.
class LayerValues {
  public:
    bool read(std::vector<EarthLayerRaster>& layers, const LayerGrid& grid, const LayerWindow& window) {
        bool whole = true;
        for (EarthLayerRaster& layer : layers) {
            Channel& own = channels_[static_cast<std::size_t>(layer.config().kind)];
            whole = layer.read(grid, window, own.values) && whole;
            own.count = static_cast<std::size_t>(layer.channels());
            own.coding = layer.config().coding;
        }
        return whole;
    }

    // Returns a texel in which the layers' values of the i-th cell replace those of the map below.
    EarthMap::Texel texel(std::size_t i, EarthSample out) const {
        float value;
        if (finds(LayerKind::kWater, i, value))
            out.value[EarthSample::kWater] = std::clamp(value, 0.0f, 1.0f);
        put_land(i, out);
        if (finds(LayerKind::kClouds, i, value))
            put_cloud(std::pow(std::clamp(value, 0.0f, 1.0f), kCloudPower), out);
        if (finds(LayerKind::kCloudThickness, i, value)) {
            const float x = CloudTable::kB * std::clamp(value, 0.0f, 1e4f);
            put_cloud(x / (1 + x), out);
        }
        if (finds(LayerKind::kCloudTops, i, value))
            out.value[EarthSample::kCloudTop] = std::clamp(value / EarthSample::kHighestTop_m, 0.0f, 1.0f);
        if (finds(LayerKind::kLights, i, value))
            out.value[EarthSample::kLights] = std::clamp(value, 0.0f, 1.0f) * (1 - out.water());
        return EarthMap::coded(out);
    }

  private:
    struct Channel {
        std::vector<float> values;  // empty: there is no such layer
        std::size_t count = 1;
        EarthLayerConfig::Coding coding = EarthLayerConfig::Coding::kLinear;
    };
    std::array<Channel, 7> channels_;

    const Channel& of(LayerKind kind) const { return channels_[static_cast<std::size_t>(kind)]; }
    bool finds(LayerKind kind, std::size_t i, float& value) const {
        if (of(kind).values.empty()) return false;
        value = of(kind).values[i];
        return std::isfinite(value);
    }
    void put_land(std::size_t i, EarthSample& out) const {
        const Channel& land = of(LayerKind::kLand);
        if (!land.values.empty()) {
            const float* const rgb = land.values.data() + 3 * i;
            const Vec3f color{rgb[0], rgb[1], rgb[2]};
            if (std::isfinite(color.x + color.y + color.z)) {
                const BandReflectances bands = land.coding == EarthLayerConfig::Coding::kBlueMarble
                                                   ? bands_of_blue_marble(color)
                                                   : bands_of_reflectances(color);
                std::copy(bands.begin(), bands.end(), out.value.begin());
            }
        }
        float infrared;
        if (finds(LayerKind::kInfrared, i, infrared))
            out.value[EarthSample::kInfrared] = std::clamp(infrared, 0.0f, 1.0f);
        // Open water has the sea's own colour.
        if (out.water() >= kSea) std::fill_n(out.value.begin(), 4, 0.0f);
    }
    static void put_cloud(float cloud, EarthSample& out) {
        out.value[EarthSample::kCloud] = cloud;
        out.value[EarthSample::kCloudTop] = (kLowestTop_m + kTopRise_m * cloud) / EarthSample::kHighestTop_m;
    }
};

class LayerDetail final : public EarthDetail {
  public:
    LayerDetail(std::vector<EarthLayerRaster> layers, const Shape& shape) : layers_(std::move(layers)) {
        shape_ = shape;
    }

    bool read(const DetailKey& key, const EarthMap& below, std::span<EarthMap::Texel> texels) override {
        const LayerGrid grid{std::ldexp(shape_.columns, -key.level), std::ldexp(shape_.rows, -key.level)};
        const LayerWindow window{key.column * kTile, key.row * kTile, kSide, kSide};
        const bool whole = values_.read(layers_, grid, window);
        std::size_t i = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x, ++i) {
                const auto u = static_cast<float>((window.column + x + 0.5) / grid.columns),
                           v = static_cast<float>((window.row + y + 0.5) / grid.rows);
                texels[i] = values_.texel(i, below.sample(u, v, 0.0f));
            }
        return whole;
    }
    std::string files() const override {
        std::string out;
        for (const EarthLayerRaster& layer : layers_)
            out += (out.empty() ? "" : ", ") + layer.config().file.filename().string();
        return out;
    }

  private:
    std::vector<EarthLayerRaster> layers_;
    LayerValues values_;
};

// Returns the map with the layers on it; works on a strip of rows at a time.
EarthMap overlaid(const EarthMap& map, std::vector<EarthLayerRaster>& layers) {
    EarthMap::Level out{map.width(), map.height(), {}};
    out.texels.reserve(map.finest().texels.size());
    LayerValues values;
    const LayerGrid grid{1.0 * map.width(), 1.0 * map.height()};
    const int strip = std::min(64, map.height());
    for (int row = 0; row < map.height(); row += strip) {
        if (!values.read(layers, grid, {0, row, map.width(), strip}))
            for (const EarthLayerRaster& layer : layers)
                if (layer.has_failed())
                    throw InputError(layer.name() + ": something of it cannot be read, about row " +
                                     std::to_string(row * (layer.rows() / map.height())));
        for (int y = 0; y < strip; ++y)
            for (int x = 0; x < map.width(); ++x) {
                const auto u = static_cast<float>((x + 0.5) / grid.columns),
                           v = static_cast<float>((row + y + 0.5) / grid.rows);
                const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width()) +
                               static_cast<std::size_t>(x);
                out.texels.push_back(values.texel(i, map.sample(u, v, 0.0f)));
            }
    }
    return EarthMap(EarthMap::halves(std::move(out)));
}

}  // namespace

LayeredEarth with_layers(EarthMap map, const std::vector<EarthLayerConfig>& configs) {
    std::vector<EarthLayerRaster> layers;
    for (const EarthLayerConfig& config : configs) layers.emplace_back(config);
    return with_layers(std::move(map), std::move(layers));
}

LayeredEarth with_layers(EarthMap map, std::vector<EarthLayerRaster> layers) {
    if (layers.empty()) return {std::move(map), nullptr};
    int rows = 0;
    for (const EarthLayerRaster& layer : layers) rows = std::max(rows, layer.rows());
    LayeredEarth out{overlaid(map, layers), nullptr};
    const EarthDetail::Shape shape = EarthDetail::shape_above(2 * rows, rows, out.map.height());
    if (shape.levels > 0) out.detail = std::make_shared<LayerDetail>(std::move(layers), shape);
    return out;
}

}  // namespace hilcam
