#pragma once
// The spikes of a spider: vanes that hold a secondary mirror cover strips of the pupil.
//
// A strip of width w and length l sends, by Babinet's principle, the light of a slit of its size:
//     (w l)^2 / (lambda f)^2 sinc^2(w x / (lambda f)) sinc^2(l y / (lambda f)),   x across the vane, y along it
// (Born & Wolf, Principles of Optics, 8.5.1 and 8.3.3), a long spike across the vane and a short one along it.
// All of its light is what the open area loses once more beside what the vane covers (Parseval): vanes of area A_v
// before an open area A leave A - A_v of light, of which A_v / (A - A_v) goes into spikes. Strips are taken as each
// for itself: opposite vanes make one pattern on one another, whose fringes are finer than the core. The core's
// own change of shape (its rings' modulation by the vanes) is not in it.
//
// In the picture spikes are part of MTF_sys (`transfer`); points and what is far too bright get them drawn, as far
// as the frame reaches: the mean of sinc^2 over the spectrum along the spike, across it a Gaussian of
// the same width at half height with the pixel's.

#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct CameraModel;

struct SpiderConfig {
    std::int64_t vanes = 0;
    double width_m = 0;
    double angle_rad = 0;  // of the first vane, from the image's +x to its +y
};
Fields fields(SpiderConfig& spider);

// Of all vanes, from the central obscuration's rim to the aperture's [m^2].
double vane_area_m2(const CameraModel& camera);
// Throws InputError where the vanes cover the pupil, or there are vanes without width.
void check_spider(const CameraModel& camera);

// Of one channel of light.
class SpiderSpikes {
  public:
    SpiderSpikes() = default;  // no spider
    // response: electrons of each bin per unit of radiance. Owner thread.
    SpiderSpikes(const CameraModel& camera, const SpectralGrid& grid, const Spectrum& response);

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
        double cosine, sine;  // of its spike
    };
    // Light of a spike in a step of a pixel, at whole pixels from the point, one side of it.
    double along(double distance_px) const;

    double share_ = 0, peak_ = 0;
    std::vector<Bin> bins_;
    std::vector<Vane> vanes_;
    std::vector<float> along_;
    double across_sigma_px_ = 1;
};

}  // namespace hilcam

#include "sensor/spider_draw.h"
