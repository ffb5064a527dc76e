#pragma once
// The picture of one colour filter on the detector, and everything it is computed with. A camera without a
// colour filter array has one channel.

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

// The geometry that all parts of the focal plane share.
struct DetectorView {
    DetectorView(const CameraModel& camera, const SensorSampling& sampling);

    CameraModel camera;
    SensorSampling sampling;
    ImageGeometry detector;  // geometry in detector pixels
    ImageGeometry image;     // geometry of the radiance image
    RelativeIllumination lens;
    Mosaic mosaic;

    // Factors on the illumination of the image by an extended source and by a point: the lens's, without the
    // ghost's share.
    double light_at(double x_px, double y_px) const { return in_image() * lens.at(x_px, y_px); }
    double light_of_point(double x_px, double y_px) const { return in_image() * lens.of_point(x_px, y_px); }
    double in_image() const { return 1 - camera.stray_light.ghost_fraction; }
    // Returns the centre of a radiance pixel (padded px) in px of the detector's frame.
    double detector_px(int padded) const {
        return (padded + 0.5) / sampling.oversampling - sampling.guard_px;
    }
};

struct LightChannel {
    // filter: from the array, or null. Owner thread.
    LightChannel(const DetectorView& view, const SpectralGrid& grid, const Curve* filter);

    Spectrum per_radiance;             // e- s^-1 per W m^-2 sr^-1 um^-1
    Spectrum per_irradiance;           // e- s^-1 per W m^-2 um^-1
    std::vector<SystemMtf> mtfs;       // one for each field zone, at least one
    std::vector<PointSpread> spreads;  // one for each field zone, at least one
    // The same images without the halo of glare, which point_halos.h draws; empty without a halo.
    std::vector<PointSpread> cores;
    std::optional<Convolver> convolver;
    // Compact kernels that give the convolver's result faster, for some of the ray grids.
    struct GridKernel {
        RayGrid rays;
        CompactKernel kernel;
    };
    std::vector<GridKernel> kernels;
    std::vector<MomentKernels> moments;  // by field zone; empty if no frame has moments
    float max_e = 0;                     // limit to which brighter pixels of this frame were cut
    std::optional<Ghost> ghost;

    // Returns null when the grid has no kernel.
    CompactKernel* kernel_of(RayGrid rays);
    // Returns the photo-electrons of a point on the axis of a detector with full fill factor.
    double electrons_of(const Spectrum& irradiance_w_m2_um, int bins, double exposure_s) const;
};

// Returns the weight of zone i in the image at a field height: smooth between zones, because a kink would
// show as a ring in an even picture, and constant outside them.
double zone_weight(const std::vector<FieldZone>& zones, std::size_t i, double field_fraction);

}  // namespace hilcam
