#include "io/maps/gdal_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "io/maps/gdal_file.h"
#include "io/maps/gdal_placement.h"
#include "io/maps/map_label.h"
#include "io/maps/value_judge.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

class GdalRaster final : public GroundRaster {
  public:
    GdalRaster(const GroundMapConfig& config, const MappedBody& body, const MapFiles& files)
        : config_(config), label_(read_map_label(files.label)) {
        const QuietErrors quiet;
        open(files);
        find_bands();
        placement_.emplace(*file_, label_, config_, body, shape_, reading_);
        judge_values(body.figure);
        if (config.holes == MapHoles::kRefuse) refuse_holes();
    }

    void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) override {
        const QuietErrors quiet;
        placement_->find_posts(places, shape_, posts);
    }

    void read(int level, int column, int row, int columns, int rows, std::span<float> values) override {
        const QuietErrors quiet;
        read_window(level, column, row, columns, rows, values);
    }

  private:
    GroundMapConfig config_;
    MapLabel label_;
    GdalFile file_;
    struct Band {
        GDALRasterBand* band;
        double scale, offset;
        std::optional<double> none;  // value of holes
        bool has_overviews;
    };
    std::vector<Band> bands_;
    std::optional<GdalPlacement> placement_;
    double unit_ = 1;                  // metres per unit of the file's heights
    std::vector<float> unsaid_holes_;  // values that mean holes, besides the file's own
    std::vector<float> raw_;

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(map_name(config_) + ": " + what);
    }

    void open(const MapFiles& files) {
        file_ = open_gdal_file(files, map_name(config_));
        shape_.columns = file_->GetRasterXSize(), shape_.rows = file_->GetRasterYSize();
        if (shape_.columns < 2 || shape_.rows < 2)
            refuse("found " + std::to_string(shape_.columns) + " x " + std::to_string(shape_.rows) +
                   " posts; accepted: 2 x 2 or more");
    }

    void find_bands() {
        const int count = file_->GetRasterCount();
        shape_.channels = config_.kind == GroundKind::kAlbedo && count >= 3 ? 3 : 1;
        shape_.bands = count;
        for (int i = 1; i <= shape_.channels; ++i) {
            GDALRasterBand* const band = file_->GetRasterBand(i);
            if (GDALDataTypeIsComplex(band->GetRasterDataType()))
                refuse("has complex numbers; accepted: real ones");
            int has_none = 0, has_scale = 0, has_offset = 0;
            const double none = band->GetNoDataValue(&has_none);
            double scale = band->GetScale(&has_scale), offset = band->GetOffset(&has_offset);
            if (!has_scale || !std::isfinite(scale) || scale == 0) scale = 1;
            if (!has_offset || !std::isfinite(offset)) offset = 0;
            bands_.push_back({band, scale, offset, has_none ? std::optional(none) : std::nullopt,
                              band->GetOverviewCount() > 0});
            shape_.has_overviews = shape_.has_overviews && bands_.back().has_overviews;
        }
    }

    // Finds the unit of heights: the channel's own, else the label's.
    void find_unit() {
        if (config_.kind != GroundKind::kHeights) return;
        const char* const own = bands_.front().band->GetUnitType();
        const std::string unit = own && *own ? own : label_.unit;
        if (unit.empty()) return;
        const std::optional<double> metres = metres_of_unit(unit);
        if (!metres)
            reading_.doubts.push_back("its heights are in " + in_quotes(unit) +
                                      ", which is no unit of length that is known; they are taken as metres");
        unit_ = metres.value_or(1);
        if (metres && unit_ != 1)
            reading_.taken += (reading_.taken.empty() ? "" : ", ") + ("heights in " + unit) + " (label)";
    }

    // Returns the level for a sample: all posts of a small map, and some of a large one, because otherwise
    // all of its blocks would be read.
    int level_of_sample() const {
        constexpr int kAll = 2048, kSome = 32, kWithOverviews = 512;
        const int most = std::max(shape_.columns, shape_.rows) <= kAll ? kAll
                         : bands_.front().has_overviews                ? kWithOverviews
                                                                       : kSome;
        int level = 0;
        while ((std::max(shape_.columns, shape_.rows) >> level) > most &&
               (std::min(shape_.columns, shape_.rows) >> level) > 1)
            ++level;
        return level;
    }

    void judge_values(const Figure& figure) {
        find_unit();
        const int level = level_of_sample(), columns = shape_.columns >> level, rows = shape_.rows >> level;
        const Band& band = bands_.front();
        if (read_raw(band, level, 0, 0, columns, rows, GRIORA_NearestNeighbour) != CE_None) return;
        for (const double value : config_.no_data) unsaid_holes_.push_back(static_cast<float>(value));
        if (config_.no_data.empty()) {
            unsaid_holes_ = unsaid_holes(raw_);
            // GDAL invents a value for PDS3 labels without one.
            if (band.none) std::erase(unsaid_holes_, static_cast<float>(*band.none));
            for (const float value : unsaid_holes_)
                reading_.doubts.push_back(
                    "the value " + plain(static_cast<double>(value)) +
                    " is taken as a hole: it stands alone, and the file does not say what it is "
                    "(no_data)");
        }
        if (config_.kind != GroundKind::kHeights) return;
        for (float& value : raw_) value = value_of(band, value);
        if (const std::string why = judge_heights(raw_, figure, shape_.whole_turn, reading_.doubts);
            !why.empty())
            refuse(why);
    }

    // Returns a post's value. Holes are the file's own value for them, and what is not a number.
    float value_of(const Band& band, float raw) const {
        const auto value = static_cast<double>(raw);
        // No body has heights beyond a million kilometres.
        constexpr double kMax = 1e9;
        if (!std::isfinite(value) ||
            (band.none && value == static_cast<double>(static_cast<float>(*band.none))) ||
            is_unsaid_hole(raw) || !(std::abs(value) < kMax))
            return std::numeric_limits<float>::quiet_NaN();
        double out = unit_ * (band.scale * value + band.offset);
        if (config_.coding == MapCoding::kSrgb)
            out = static_cast<double>(
                linear_from_srgb(static_cast<std::uint8_t>(std::clamp(std::round(out), 0.0, 255.0))));
        return static_cast<float>(config_.scale * out + config_.offset);
    }

    // Reads a channel's raw values into raw_.
    CPLErr read_raw(const Band& band, int level, int column, int row, int columns, int rows,
                    GDALRIOResampleAlg alg) {
        raw_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        GDALRasterIOExtraArg how;
        INIT_RASTERIO_EXTRA_ARG(how);
        how.eResampleAlg = alg;
        return band.band->RasterIO(GF_Read, column << level, row << level, columns << level, rows << level,
                                   raw_.data(), columns, rows, GDT_Float32, 0, 0, &how);
    }

    // Reads a level's values into raw_. Without overviews, a mean would read all of the map; and where the
    // file does not know its holes, GDAL would average them in.
    CPLErr read_level(const Band& band, int level, int column, int row, int columns, int rows) {
        constexpr int kMeansTo = 3;
        const bool is_mean = level > 0 && (level <= kMeansTo || band.has_overviews);
        if (!is_mean || unsaid_holes_.empty())
            return read_raw(band, level, column, row, columns, rows,
                            is_mean ? GRIORA_Average : GRIORA_NearestNeighbour);
        if (level > kMeansTo)
            return read_raw(band, level, column, row, columns, rows, GRIORA_NearestNeighbour);
        const CPLErr error = read_raw(band, 0, column << level, row << level, columns << level, rows << level,
                                      GRIORA_NearestNeighbour);
        const std::vector<float> fine = std::move(raw_);
        raw_.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
        if (error != CE_None) return error;
        const int each = 1 << level;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                raw_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(x)] =
                    mean_beside_holes(fine, columns << level, x * each, y * each, each);
        return error;
    }

    // Returns the mean of a square of values without its holes; a hole when all are.
    float mean_beside_holes(const std::vector<float>& fine, int stride, int column, int row, int each) const {
        double sum = 0, count = 0;
        for (int y = row; y < row + each; ++y)
            for (int x = column; x < column + each; ++x) {
                const float value = fine[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) +
                                         static_cast<std::size_t>(x)];
                if (!std::isfinite(value) || is_unsaid_hole(value)) continue;
                sum += static_cast<double>(value), count += 1;
            }
        return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
    }
    bool is_unsaid_hole(float raw) const {
        return std::find(unsaid_holes_.begin(), unsaid_holes_.end(), raw) != unsaid_holes_.end();
    }

    void read_window(int level, int column, int row, int columns, int rows, std::span<float> values) {
        const auto channels = static_cast<std::size_t>(shape_.channels);
        for (std::size_t c = 0; c < channels; ++c) {
            const Band& band = bands_[c];
            const CPLErr error = read_level(band, level, column, row, columns, rows);
            failed_reads_ += error != CE_None;
            for (std::size_t i = 0; i < raw_.size(); ++i)
                values[i * channels + c] =
                    error == CE_None ? value_of(band, raw_[i]) : std::numeric_limits<float>::quiet_NaN();
        }
    }

    void refuse_holes() {
        const int level = level_of_sample();
        const int columns = shape_.columns >> level, rows = shape_.rows >> level;
        std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                                  static_cast<std::size_t>(shape_.channels));
        read_window(level, 0, 0, columns, rows, values);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (std::isnan(values[i])) {
                const std::size_t post = i / static_cast<std::size_t>(shape_.channels);
                refuse("has a hole (no-data) at column " +
                       std::to_string((post % static_cast<std::size_t>(columns)) << level) + ", row " +
                       std::to_string((post / static_cast<std::size_t>(columns)) << level) +
                       "; accepted: with holes: fill, which shows what lies below");
            }
    }
};

}  // namespace

std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body,
                                               const MapFiles& files) {
    return std::make_unique<GdalRaster>(config, body, files);
}

std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body) {
    return open_gdal_raster(config, body, find_map_files(config.file, map_name(config)));
}

std::string map_name(const GroundMapConfig& config) {
    return (config.where.empty() ? "" : config.where + ": ") + config.file.string();
}

}  // namespace hilcam
