#pragma once
// One filter's picture on the detector, and what it is made with. A camera without a colour filter array has
// one.

#include <optional>
#include <vector>

#include "sensor/convolution/compact_kernel.h"
#include "sensor/convolution/convolve.h"
#include "sensor/convolution/moment_kernels.h"
#include "sensor/convolution/psf.h"
#include "sensor/exposure.h"
#include "sensor/mosaic.h"
#include "sensor/optics.h"
#include "sensor/stray/stray_light.h"
#include "sensor/system_mtf.h"

namespace hilcam {

// The view is shared by all parts of the focal plane.
struct DetectorView {
    DetectorView(const CameraModel& camera, const SensorSampling& sampling);

    CameraModel camera;
    SensorSampling sampling;
    ImageGeometry detector;  // its pixels
    ImageGeometry image;     // the radiance image's
    RelativeIllumination lens;
    Mosaic mosaic;

    // The factors by which the image of an extended source, and of a point, is lit: what the lens leaves and no ghost has.
    double light_at(double x_px, double y_px) const { return in_image() * lens.at(x_px, y_px); }
    double light_of_point(double x_px, double y_px) const { return in_image() * lens.of_point(x_px, y_px); }
    double in_image() const { return 1 - camera.stray_light.ghost_fraction; }
    // Middle of a radiance pixel (padded px) [px of the detector's frame].
    double detector_px(int padded) const {
        return (padded + 0.5) / sampling.oversampling - sampling.guard_px;
    }
};

struct LightChannel {
    // filter: of the array, or null. Owner thread.
    LightChannel(const DetectorView& view, const SpectralGrid& grid, const Curve* filter);

    Spectrum per_radiance;             // e- s^-1 per W m^-2 sr^-1 um^-1
    Spectrum per_irradiance;           // e- s^-1 per W m^-2 um^-1
    std::vector<SystemMtf> mtfs;       // by zone of the field, at least one
    std::vector<PointSpread> spreads;  // likewise
    // Likewise, without the halo of glare that point_halos.h draws; none where there is no halo.
    std::vector<PointSpread> cores;
    std::optional<Convolver> convolver;
    // Do the same, faster, for pictures of the grids that there are.
    struct GridKernel {
        RayGrid rays;
        CompactKernel kernel;
    };
    std::vector<GridKernel> kernels;
    std::vector<MomentKernels> moments;  // by zone; none where no frame has moments
    float max_e = 0;                     // the limit to which the present frame's brighter pixels were cut
    std::optional<Ghost> ghost;

    // Null: there is none.
    CompactKernel* kernel_of(RayGrid rays);
    // Photo-electrons of a point on a full-fill detector, on the axis.
    double electrons_of(const Spectrum& irradiance_w_m2_um, int bins, double exposure_s) const;
};

// Share of zone i in the image at a field height: smooth between zones, without a kink, which would show as a
// ring in an even picture; constant outside them.
double zone_weight(const std::vector<FieldZone>& zones, std::size_t i, double field_fraction);

}  // namespace hilcam
