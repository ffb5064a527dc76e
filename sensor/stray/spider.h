#pragma once
// The spikes of a spider: the vanes that hold a secondary mirror cover strips of the pupil.
//
// By Babinet's principle, a strip of width w and length l diffracts the light of a slit of its size:
//     (w l)^2 / (lambda f)^2 sinc^2(w x / (lambda f)) sinc^2(l y / (lambda f)),   x across the vane, y along
//                                                                                 it
// (a slit's Fraunhofer pattern and Babinet's principle: Born & Wolf, Principles of Optics, chapter 8): a long
// spike across the vane and a short one along it. The open area loses that light in addition to the light
// that the vane covers (Parseval): with vanes of area A_v in front of an open area A, A - A_v of the light
// remains, of which A_v / (A - A_v) goes into spikes. Strips are treated independently: the patterns of
// opposite vanes coincide, with fringes that are finer than the core. The change of the core's own shape (the
// vanes modulate its rings) is not modelled.
//
// In the picture, spikes are part of MTF_sys (`transfer`). For points and light that is far too bright they
// are drawn across the frame: along the spike the mean of sinc^2 over the spectrum, across it a Gaussian with
// the same width at half height, including the pixel's.

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct SpiderConfig {
    std::int64_t vanes = 0;
    double width_m = 0;
    double angle_rad = 0;  // angle of the first vane, from the image's +x to its +y
};
Fields fields(SpiderConfig& spider);

// The camera data that this model uses.
struct SpiderPupil {
    double diameter_m = 0, obscuration_ratio = 0, focal_length_m = 0, pitch_m = 0, diffusion_m = 0;
    double reach_px = 0;  // at least the frame's diagonal

    double open_area_m2() const;  // area without the vanes
};

// Returns the area of all vanes, from the rim of the central obscuration to that of the aperture [m^2].
double vane_area_m2(const SpiderConfig& spider, const SpiderPupil& pupil);
// Throws InputError when the vanes cover the pupil, or have no width.
void check_spider(const SpiderConfig& spider, const SpiderPupil& pupil);

// The spikes in one channel of light.
class SpiderSpikes {
  public:
    SpiderSpikes() = default;  // without a spider
    // response: electrons of each bin per unit of radiance. Owner thread.
    SpiderSpikes(const SpiderConfig& spider, const SpiderPupil& pupil, const SpectralGrid& grid,
                 const Spectrum& response);

    // Returns the share of a point's light in the spikes; 0: no spider.
    double share() const { return share_; }
    // Returns the largest share of a point's light that the spikes put into a pixel.
    double peak() const { return peak_; }
    // Returns their transfer function, 1 at (0, 0). u, v: in cycles/px of the detector.
    double transfer(double u, double v) const;

    struct Rows {
        int begin, end;
    };
    // Adds the spikes of a point [px of the frame], with `electrons` in total, to rows of a window by calling
    // add(x, y, electrons). Loop, any thread.
    template <class Add>
    void draw(double x_px, double y_px, double electrons, int width_px, Rows rows, const Add& add) const;

  private:
    struct Bin {
        double weight, width_cy_px, length_cy_px;  // frequencies at which a strip's transfer function ends
    };
    struct Vane {
        double cosine, sine;  // direction of its spike
    };
    // Returns the light of one side of a spike in a step of a pixel, at whole pixels from the point.
    double along(double distance_px) const;

    double share_ = 0, peak_ = 0;
    std::vector<Bin> bins_;
    std::vector<Vane> vanes_;
    std::vector<float> along_;
    double across_sigma_px_ = 1;
};

template <class Add>
void SpiderSpikes::draw(double x_px, double y_px, double electrons, int width_px, Rows rows,
                        const Add& add) const {
    const double each = electrons / static_cast<double>(vanes_.size());
    for (const Vane& vane : vanes_) {
        // Step by pixels along the axis that the spike is closer to, and spread the light along the other.
        const bool flat = std::abs(vane.cosine) >= std::abs(vane.sine);
        const double step = std::abs(flat ? vane.cosine : vane.sine);
        const double slope = flat ? vane.sine / vane.cosine : vane.cosine / vane.sine;
        const double from_px = flat ? x_px : y_px, across_px = flat ? y_px : x_px;
        const double sigma = across_sigma_px_ / step, reach = 3.5 * sigma + 0.5;
        const auto least = [](double v, double most) { return std::clamp(v, 0.0, most); };
        int begin = flat ? 0 : rows.begin, end = flat ? width_px : rows.end;
        if (flat && std::abs(slope) > 1e-9) {
            // Columns in which the spike can be in these rows.
            const double a = (rows.begin - reach - y_px) / slope + x_px,
                         b = (rows.end + reach - y_px) / slope + x_px;
            begin = static_cast<int>(least(std::floor(std::min(a, b)), width_px));
            end = static_cast<int>(least(std::ceil(std::max(a, b)) + 1, width_px));
        }
        const int across_begin = flat ? rows.begin : 0, across_end = flat ? rows.end : width_px;
        for (int i = begin; i < end; ++i) {
            const double way = i + 0.5 - from_px, middle = across_px + slope * way;
            const double light = each * along(std::abs(way) / step) / step;
            if (!(light > 1e-6)) continue;
            const int first = static_cast<int>(least(std::floor(middle - reach), across_end)),
                      last = static_cast<int>(least(std::ceil(middle + reach), across_end));
            const auto below = [&](double edge) {
                return 0.5 * std::erf((edge - middle) / (sigma * 1.4142135623730951));
            };
            double before = below(std::max(first, across_begin));
            for (int k = std::max(first, across_begin); k < last; ++k) {
                const double after = below(k + 1.0);
                add(flat ? i : k, flat ? k : i, static_cast<float>(light * (after - before)));
                before = after;
            }
        }
    }
}

}  // namespace hilcam
