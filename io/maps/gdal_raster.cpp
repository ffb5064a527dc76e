#include "io/maps/gdal_raster.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/maps/gdal_file.h"
#include "io/maps/longitude_latitude.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

// The type in which OGRCoordinateTransformation::Transform counts points.
#if GDAL_VERSION_NUM >= GDAL_COMPUTE_VERSION(3, 9, 0)
using TransformCount = std::size_t;
#else
using TransformCount = int;
#endif

struct DestroyTransformation {
    void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};

class GdalRaster final : public GroundRaster {
  public:
    GdalRaster(const GroundMapConfig& config, const MappedBody& body, const MapFiles& files)
        : config_(config) {
        const QuietErrors quiet;
        open(files);
        find_bands();
        if (config.bounds_deg.empty())
            find_projection(body);
        else {
            bounds_ = {config.bounds_deg[0], config.bounds_deg[1], config.bounds_deg[2],
                       config.bounds_deg[3]};
            set_bounds(*bounds_, body.figure.equatorial_radius_m, shape_);
        }
        if (config.holes == MapHoles::kRefuse) refuse_holes();
    }

    void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) override {
        if (bounds_) {
            for (std::size_t i = 0; i < places.size(); ++i) posts[i] = post_at(*bounds_, shape_, places[i]);
            return;
        }
        const QuietErrors quiet;
        x_.resize(places.size()), y_.resize(places.size()), success_.resize(places.size());
        for (std::size_t i = 0; i < places.size(); ++i)
            x_[i] = longitude_deg(places[i]), y_[i] = latitude_deg(places[i]);
        if (projection_)
            projection_->Transform(static_cast<TransformCount>(places.size()), x_.data(), y_.data(), nullptr,
                                   nullptr, success_.data());
        else
            std::fill(success_.begin(), success_.end(), 1);
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!success_[i] || !std::isfinite(x_[i] + y_[i])) {
                posts[i] = {kNone, kNone};
                continue;
            }
            double column = from_ground_[0] + from_ground_[1] * x_[i] + from_ground_[2] * y_[i] - 0.5;
            if (turn_columns_ > 0) column = within_turn(column, turn_columns_);
            posts[i] = {column, from_ground_[3] + from_ground_[4] * x_[i] + from_ground_[5] * y_[i] - 0.5};
        }
    }

    void read(int level, int column, int row, int columns, int rows, std::span<float> values) override {
        const QuietErrors quiet;
        read_window(level, column, row, columns, rows, values);
    }

  private:
    GroundMapConfig config_;
    GdalFile file_;
    struct Band {
        GDALRasterBand* band;
        double scale, offset;
        std::optional<double> none;  // value of holes
        bool has_overviews;
    };
    std::vector<Band> bands_;
    std::optional<MapBounds> bounds_;
    std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>
        projection_;  // null: longitudes, latitudes
    double from_ground_[6] = {};
    double turn_columns_ = 0;  // columns of 360 deg; 0: no such thing
    std::vector<double> x_, y_;
    std::vector<int> success_;
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

    void find_projection(const MappedBody& body) {
        const OGRSpatialReference* const found = file_->GetSpatialRef();
        double to_ground[6];
        if (!found || file_->GetGeoTransform(to_ground) != CE_None)
            refuse(
                "has no projection; accepted: one that says where it lies, or with bounds_deg: [west, south, "
                "east, north]");
        if (!GDALInvGeoTransform(to_ground, from_ground_)) refuse("its rows and columns fall together");
        OGRSpatialReference reference(*found);
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        if (!reference.IsGeographic() && !reference.IsProjected())
            refuse(
                "its projection is of neither longitudes and latitudes nor a plane; accepted: one of them");
        const double radius_m = reference.GetSemiMajor(), expected_m = body.figure.equatorial_radius_m;
        if (!(std::abs(radius_m / expected_m - 1) < 0.01))
            refuse("its projection is of a body of radius " + plain(radius_m * 1e-3) +
                   " km; accepted: that of " + body.name + ", " + plain(expected_m * 1e-3) +
                   " km, within 1 %");
        const double unit =
            reference.IsGeographic() ? reference.GetAngularUnits() * expected_m : reference.GetLinearUnits();
        shape_.spacing_m =
            unit * std::sqrt(std::abs(to_ground[1] * to_ground[5] - to_ground[2] * to_ground[4]));
        // Angles are degrees, as nearly all files have them.
        if (reference.IsGeographic() && std::abs(reference.GetAngularUnits() / kDegree_rad - 1) > 1e-6)
            refuse("has angles in other units than degrees; accepted: degrees");
        if (reference.IsProjected()) {
            const std::unique_ptr<OGRSpatialReference> angles(reference.CloneGeogCS());
            if (!angles) refuse("its projection has no longitudes and latitudes");
            angles->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
            projection_.reset(OGRCreateCoordinateTransformation(angles.get(), &reference));
            if (!projection_) refuse("its projection is unknown (" + QuietErrors::last() + ")");
        }
        find_turn(reference, to_ground);
    }

    // If the map's columns are meridians, finds how many of them make a turn, and whether its rows reach the poles.
    void find_turn(const OGRSpatialReference& reference, const double* to_ground) {
        double turn = 360, north = 90;
        if (reference.IsProjected()) {
            const char* const name = reference.GetAttrValue("PROJECTION");
            if (!name || !EQUAL(name, SRS_PT_EQUIRECTANGULAR)) return;
            const double middle_deg = reference.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0);
            double x[2] = {middle_deg, middle_deg + 90}, y[2] = {0, 90};
            if (!projection_->Transform(2, x, y)) return;
            turn = 4 * (x[1] - x[0]), north = y[1];
        }
        const double column = to_ground[1], row = -to_ground[5];
        if (to_ground[2] != 0 || to_ground[4] != 0 || !(column > 0) || !(row > 0)) return;
        turn_columns_ = turn / column;
        shape_.whole_turn = std::abs(turn_columns_ - shape_.columns) < 0.5;
        if (!shape_.whole_turn) return;
        turn_columns_ = shape_.columns;
        shape_.pole_above_first_row = std::abs(to_ground[3] - north) < 0.5 * row;
        shape_.pole_below_last_row = std::abs(to_ground[3] - row * shape_.rows + north) < 0.5 * row;
    }

    // A hole is the file's own value for it, and what is no number.
    float value_of(const Band& band, float raw) const {
        const auto value = static_cast<double>(raw);
        // No body has heights beyond a million kilometres.
        constexpr double kMost = 1e9;
        if (!std::isfinite(value) ||
            (band.none && value == static_cast<double>(static_cast<float>(*band.none))) ||
            !(std::abs(value) < kMost))
            return std::numeric_limits<float>::quiet_NaN();
        double out = band.scale * value + band.offset;
        if (config_.coding == MapCoding::kSrgb)
            out = static_cast<double>(
                linear_from_srgb(static_cast<std::uint8_t>(std::clamp(std::round(out), 0.0, 255.0))));
        return static_cast<float>(config_.scale * out + config_.offset);
    }

    void read_window(int level, int column, int row, int columns, int rows, std::span<float> values) {
        const auto channels = static_cast<std::size_t>(shape_.channels);
        raw_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        for (std::size_t c = 0; c < channels; ++c) {
            const Band& band = bands_[c];
            GDALRasterIOExtraArg how;
            INIT_RASTERIO_EXTRA_ARG(how);
            // Without overviews a mean would read all of the map.
            constexpr int kMeansTo = 3;
            how.eResampleAlg = level > 0 && (level <= kMeansTo || band.has_overviews)
                                   ? GRIORA_Average
                                   : GRIORA_NearestNeighbour;
            const CPLErr error =
                band.band->RasterIO(GF_Read, column << level, row << level, columns << level, rows << level,
                                    raw_.data(), columns, rows, GDT_Float32, 0, 0, &how);
            failed_reads_ += error != CE_None;
            for (std::size_t i = 0; i < raw_.size(); ++i)
                values[i * channels + c] =
                    error == CE_None ? value_of(band, raw_[i]) : std::numeric_limits<float>::quiet_NaN();
        }
    }

    // Looks at all posts of a small map, and at some of a large one, whose blocks would otherwise all be read.
    void refuse_holes() {
        constexpr int kAll = 2048, kSome = 32, kWithOverviews = 512;
        const int most = std::max(shape_.columns, shape_.rows) <= kAll ? kAll
                         : bands_.front().has_overviews                ? kWithOverviews
                                                                       : kSome;
        int level = 0;
        while ((std::max(shape_.columns, shape_.rows) >> level) > most &&
               (std::min(shape_.columns, shape_.rows) >> level) > 1)
            ++level;
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
