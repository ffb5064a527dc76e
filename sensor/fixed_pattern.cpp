#include "sensor/fixed_pattern.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/random.h"
#include "sensor/array_places.h"
#include "sensor/noise.h"

namespace hilcam {

Fields fields(FixedPatternConfig& c) {
    return {
        integer("seed", c.seed, {0, 9e15},
                "seed of the fixed pattern: another seed stands for another camera of the same type"),
        number("dark_current_fraction", c.dark_current_fraction, 1, {0, 10},
               "standard deviation of the dark current from pixel to pixel, over its mean"),
        number("row_e", c.row_e, 1, {0, 1e5}, "standard deviation of the offset from row to row"),
        number("column_e", c.column_e, 1, {0, 1e5}, "standard deviation of the offset from column to column"),
        number("column_gain_fraction", c.column_gain_fraction, 1, {0, 0.5},
               "standard deviation of the gain from column to column"),
        path("prnu_map", c.prnu_map, "gain of each pixel, mean 1: TIFF or FITS of the sensor's size"),
        path("offset_map", c.offset_map, "offset of each pixel [e-]: TIFF or FITS of the sensor's size"),
        path("dark_map", c.dark_map, "dark current of each pixel [e-/s]: TIFF or FITS of the sensor's size"),
        optional(number("dark_map_c", c.dark_map_c, 1, {-200, 150},
                        "temperature at which dark_map and the hot pixels of defects.list were measured; "
                        "default: temperature_c"),
                 c.has_dark_map_c),
    };
}

Fields fields(DefectsConfig& c) {
    return {
        number("hot_fraction", c.hot_fraction, 1, {0, 1}, "share of hot pixels"),
        number("hot_e_s", c.hot_e_s, 1, {0, 1e9}, "mean extra dark current of the hot pixels"),
        number("dead_fraction", c.dead_fraction, 1, {0, 1}, "share of dead pixels"),
        numbers("dead_columns", c.dead_columns, 1, {0, 16383}, {0, 1024},
                "numbers of the dead columns, counted from 0"),
        numbers("hot_columns", c.hot_columns, 1, {0, 16383}, {0, 1024},
                "numbers of the hot columns, counted from 0"),
        number("telegraph_fraction", c.telegraph_fraction, 1, {0, 1}, "share of telegraph pixels"),
        number("telegraph_e", c.telegraph_e, 1, {0, 1e5},
               "difference of charge between the two states of a telegraph pixel"),
        integer("telegraph_frames", c.telegraph_frames, {1, 1e6},
                "number of frames between two random draws of a telegraph pixel's state"),
        path("list", c.list,
             "pixels of this very sensor, in addition: CSV with columns kind (hot, dead, blinking), x, y, "
             "value (hot: dark current [e-/s]; blinking: difference of its states [e-])"),
    };
}

namespace {

// Returns the standard normal deviate for a random word; see normal_quantile().
float normal(std::uint32_t word) { return normal_quantile(uniform01(word)); }

RandomKey key_of(const CameraModel& c) { return {static_cast<std::uint64_t>(c.fixed_pattern.seed), 0}; }

bool has_listed(const DetectorPictures& pictures, DefectKind kind) {
    return std::any_of(pictures.defects.begin(), pictures.defects.end(),
                       [kind](const ListedDefect& d) { return d.kind == kind; });
}

bool has_gain_map(const CameraModel& c, const DetectorPictures& pictures) {
    return has_listed(pictures, DefectKind::kDead) || c.prnu_fraction > 0 ||
           c.fixed_pattern.column_gain_fraction > 0 || c.defects.dead_fraction > 0 ||
           !c.defects.dead_columns.empty() || pictures.prnu.width() > 0;
}
bool has_dark_map(const CameraModel& c, const DetectorPictures& pictures) {
    return has_listed(pictures, DefectKind::kHot) || has_listed(pictures, DefectKind::kDead) ||
           (c.fixed_pattern.dark_current_fraction > 0 && c.dark_current_e_s > 0) ||
           ((c.defects.hot_fraction > 0 || !c.defects.hot_columns.empty()) && c.defects.hot_e_s > 0) ||
           pictures.dark_e_s.width() > 0;
}
bool has_offset_map(const CameraModel& c, const DetectorPictures& pictures) {
    return c.dsnu_e > 0 || c.fixed_pattern.row_e > 0 || c.fixed_pattern.column_e > 0 ||
           pictures.offset_e.width() > 0;
}

void require_size(const PixelMap& map, const CameraModel& c, const char* key) {
    if (map.width() == 0 || (map.width() == c.width_px && map.height() == c.height_px)) return;
    throw InputError("fixed_pattern." + std::string(key) + ": a picture of " + std::to_string(map.width()) +
                     " x " + std::to_string(map.height()) + "; accepted: the sensor's " +
                     std::to_string(c.width_px) + " x " + std::to_string(c.height_px));
}

void require_inside(const ListedDefect& d, const CameraModel& c) {
    if (d.x >= 0 && d.x < c.width_px && d.y >= 0 && d.y < c.height_px) return;
    throw InputError("defects.list: pixel (" + std::to_string(d.x) + ", " + std::to_string(d.y) +
                     "); accepted: on the sensor of " + std::to_string(c.width_px) + " x " +
                     std::to_string(c.height_px));
}

bool listed(const std::vector<double>& columns, std::uint32_t column) {
    return std::find(columns.begin(), columns.end(), static_cast<double>(column)) != columns.end();
}

// Draws a pixel's own values from the means.
class PixelDraw {
  public:
    PixelDraw(const CameraModel& c, const DetectorPictures& pictures)
        : c_(c),
          pictures_(pictures),
          dark_e_s_(c.dark_current_now_e_s()),
          now_from_map_(c.fixed_pattern.has_dark_map_c
                            ? std::exp2((c.temperature_c - c.fixed_pattern.dark_map_c) / c.dark_doubling_k)
                            : 1),
          offset_row_e_(0) {
        for (const ListedDefect& d : pictures.defects) {
            require_inside(d, c);
            listed_.emplace_back(
                sensor_pixel(static_cast<std::uint32_t>(d.x), static_cast<std::uint32_t>(d.y)), &d);
        }
        std::sort(listed_.begin(), listed_.end());
        for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(c.width_px); ++x) {
            const auto words = random_words(key_of(c), RandomPurpose::kRowPattern, x, 1);
            column_gain_.push_back(static_cast<double>(normal(words[0])) *
                                   c.fixed_pattern.column_gain_fraction);
            column_e_.push_back(static_cast<double>(normal(words[1])) * c.fixed_pattern.column_e);
            dead_column_.push_back(listed(c.defects.dead_columns, x));
            hot_column_.push_back(listed(c.defects.hot_columns, x));
        }
    }
    void begin_row(std::uint32_t row) {
        const auto words = random_words(key_of(c_), RandomPurpose::kRowPattern, row, 0);
        offset_row_e_ = static_cast<double>(normal(words[0])) * c_.fixed_pattern.row_e;
    }
    void draw(std::uint32_t x, std::uint32_t y, bool black) {
        pixel_ = sensor_pixel(x, y);
        const auto words = random_words(key_of(c_), RandomPurpose::kFixedPattern, pixel_);
        const double kind = static_cast<double>(uniform01(words[3]));
        // One uniform number selects pixels: dead from 0 up, hot after them, telegraph from 1 down.
        const bool sensor = !black && x < column_e_.size();
        dead_ = kind < c_.defects.dead_fraction || (sensor && dead_column_[x]);
        hot_ = (!dead_ && kind < c_.defects.dead_fraction + c_.defects.hot_fraction) ||
               (sensor && hot_column_[x]);
        height_e_ = kind > 1 - c_.defects.telegraph_fraction ? c_.defects.telegraph_e : 0;
        gain_ = 1 + static_cast<double>(normal(words[0])) * c_.prnu_fraction + (sensor ? column_gain_[x] : 0);
        offset_e_ =
            static_cast<double>(normal(words[1])) * c_.dsnu_e + offset_row_e_ + (sensor ? column_e_[x] : 0);
        dark_ =
            dark_e_s_ * (1 + static_cast<double>(normal(words[2])) * c_.fixed_pattern.dark_current_fraction);
        if (hot_) {
            const auto more = random_words(key_of(c_), RandomPurpose::kFixedPattern, pixel_, 1);
            dark_ -= c_.defects.hot_e_s * std::log(static_cast<double>(uniform01(more[0])));
        }
        if (black) return;
        const auto at = [&](const PixelMap& map) {
            return static_cast<double>(map.row(static_cast<int>(y))[x]);
        };
        if (pictures_.prnu.width() > 0) gain_ *= at(pictures_.prnu);
        if (pictures_.offset_e.width() > 0) offset_e_ += at(pictures_.offset_e);
        if (pictures_.dark_e_s.width() > 0) dark_ += at(pictures_.dark_e_s) * now_from_map_ - dark_e_s_;
        const auto first = std::lower_bound(listed_.begin(), listed_.end(), pixel_,
                                            [](const auto& a, std::uint32_t b) { return a.first < b; });
        for (auto it = first; it != listed_.end() && it->first == pixel_; ++it) apply(*it->second);
    }
    float gain() const { return dead_ ? 0.0f : static_cast<float>(std::max(0.0, gain_)); }
    float dark_e_s() const { return dead_ ? 0.0f : static_cast<float>(std::max(0.0, dark_)); }
    float offset_e() const { return static_cast<float>(offset_e_); }
    bool telegraph() const { return height_e_ > 0; }
    float height_e() const { return static_cast<float>(height_e_); }
    std::uint32_t pixel() const { return pixel_; }

  private:
    void apply(const ListedDefect& defect) {
        if (defect.kind == DefectKind::kDead) dead_ = true;
        if (defect.kind == DefectKind::kHot) dark_ = defect.value * now_from_map_;
        if (defect.kind == DefectKind::kBlinking) height_e_ = defect.value;
    }

    const CameraModel& c_;
    const DetectorPictures& pictures_;
    double dark_e_s_;
    double now_from_map_;  // dark current at the operating temperature over that at dark_map_c
    double offset_row_e_;
    std::vector<std::pair<std::uint32_t, const ListedDefect*>> listed_;  // by pixel
    std::vector<double> column_gain_, column_e_;
    std::vector<bool> dead_column_, hot_column_;
    std::uint32_t pixel_ = 0;
    bool dead_ = false, hot_ = false;
    double gain_ = 1, offset_e_ = 0, dark_ = 0, height_e_ = 0;
};

}  // namespace

FixedPattern draw_fixed_pattern(const CameraModel& c, const DetectorPictures& pictures) {
    require_size(pictures.prnu, c, "prnu_map");
    require_size(pictures.offset_e, c, "offset_map");
    require_size(pictures.dark_e_s, c, "dark_map");
    const auto [width, height] = array_size(c);
    FixedPattern out;
    out.uniform_dark_e_s = c.dark_current_now_e_s();
    if (has_gain_map(c, pictures)) out.gain = PixelMap(width, height);
    if (has_dark_map(c, pictures)) out.dark_e_s = PixelMap(width, height);
    if (has_offset_map(c, pictures)) out.offset_e = PixelMap(width, height);
    const bool telegraph = (c.defects.telegraph_fraction > 0 && c.defects.telegraph_e > 0) ||
                           has_listed(pictures, DefectKind::kBlinking);
    if (out.gain.width() + out.dark_e_s.width() + out.offset_e.width() == 0 && !telegraph) return out;

    const ArrayPlaces places(c);
    // All lines of a line camera have the same pixels.
    const bool one_row = c.shutter.kind == ShutterKind::kLineScan;
    PixelDraw pixel(c, pictures);
    for (int y = 0; y < height; ++y) {
        const std::uint32_t row = one_row ? 0 : places.row(y);
        pixel.begin_row(row);
        for (int x = 0; x < width; ++x) {
            const auto at = static_cast<std::size_t>(x);
            pixel.draw(places.column(x), row, places.black(x, y));
            if (out.gain.width() > 0) out.gain.row(y)[at] = pixel.gain();
            if (out.dark_e_s.width() > 0) out.dark_e_s.row(y)[at] = pixel.dark_e_s();
            if (out.offset_e.width() > 0) out.offset_e.row(y)[at] = pixel.offset_e();
            if (telegraph && pixel.telegraph())
                out.telegraph.push_back({x, y, pixel.pixel(), pixel.height_e()});
        }
    }
    return out;
}

}  // namespace hilcam
