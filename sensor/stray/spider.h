#pragma once
// The spikes of a spider: vanes that hold a secondary mirror cover strips of the pupil.
//
// A strip of width w and length l sends, by Babinet's principle, the light of a slit of its size:
//     (w l)^2 / (lambda f)^2 sinc^2(w x / (lambda f)) sinc^2(l y / (lambda f)),   x across the vane, y along it
// (a slit's Fraunhofer pattern and Babinet's principle: Born & Wolf, Principles of Optics, chapter 8), a long spike across the vane and a short one along it.
// All of its light is what the open area loses once more beside what the vane covers (Parseval): vanes of area A_v
// before an open area A leave A - A_v of light, of which A_v / (A - A_v) goes into spikes. Strips are taken as each
// for itself: opposite vanes make one pattern on one another, whose fringes are finer than the core. The core's
// own change of shape (its rings' modulation by the vanes) is not in it.
//
// In the picture spikes are part of MTF_sys (`transfer`); points and what is far too bright get them drawn, as far
// as the frame reaches: the mean of sinc^2 over the spectrum along the spike, across it a Gaussian of
// the same width at half height with the pixel's.

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

// The figures of a camera's data sheet that it uses.
struct SpiderPupil {
    double diameter_m = 0, obscuration_ratio = 0, focal_length_m = 0, pitch_m = 0, diffusion_m = 0;
    double reach_px = 0;  // a frame is no longer across

    double open_area_m2() const;  // without vanes
};

// Returns the area of all vanes, from the central obscuration's rim to the aperture's [m^2].
double vane_area_m2(const SpiderConfig& spider, const SpiderPupil& pupil);
// Throws InputError where the vanes cover the pupil, or there are vanes without width.
void check_spider(const SpiderConfig& spider, const SpiderPupil& pupil);

// The spikes of one channel of light.
class SpiderSpikes {
  public:
    SpiderSpikes() = default;  // no spider
    // response: electrons of each bin per unit of radiance. Owner thread.
    SpiderSpikes(const SpiderConfig& spider, const SpiderPupil& pupil, const SpectralGrid& grid,
                 const Spectrum& response);

    // The share of a point's light that goes into spikes; 0: no spider.
    double share() const { return share_; }
    // The greatest part of a point's light that they put into a pixel.
    double peak() const { return peak_; }
    // Their transfer function, 1 at (0, 0) [cycles/px of the detector].
    double transfer(double u, double v) const;

    struct Rows {
        int begin, end;
    };
    // Adds `electrons` of spikes from a point [px of the frame] to the rows of a window, by add(x, y, electrons).
    // Loop, any thread.
    template <class Add>
    void draw(double x_px, double y_px, double electrons, int width_px, Rows rows, const Add& add) const;

  private:
    struct Bin {
        double weight, width_cy_px, length_cy_px;  // frequencies at which a strip's transfer function ends
    };
    struct Vane {
        double cosine, sine;  // direction of its spike
    };
    // Light of a spike in a step of a pixel, at whole pixels from the point, one side of it.
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
        // Steps of a pixel along the axis that the spike is nearer to; across it by the other.
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
