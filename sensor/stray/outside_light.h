#pragma once
// Veiling glare and ghosts of light from outside the picture: the Sun near the field, the Earth below it.
//
// A lens is described by its point source transmittance PST(theta): irradiance on the detector over that from
// the source on a plane that faces it, with theta the source's angle from the boresight (Fest, Stray Light
// Analysis and Control, SPIE, 2013, 2.2.1). A measured PST is even over the picture; it applies at the
// wavelength of the best transmission of the glass, and scales with the transmission at others. Without a
// measured curve, the model for light in the field continues beyond it: the halo of `veiling_glare_fraction`,
// and the diffraction wings (far_wings.h). In a pixel at the direction p, light from s makes
//     electrons = E A T QE t cos(theta) B(theta) D(f |s - p|)        s, p: components across the boresight
// with D the share of a point's light in a pixel at a distance in px. Using differences of direction cosines
// instead of distances in the picture is Harvey's rule: the scatter of a polished face depends on them alone,
// whatever the angle (Harvey, Light-Scattering Characteristics of Optical Surfaces, PhD thesis, Arizona,
// 1976). The halo is his law with slope -3, shoulder r / f and total integrated scatter
// `veiling_glare_fraction`. That slope belongs to the halo of light in the field (stray_light.h). Polished
// faces are given -0.5 to -2, super-polished ones less than -2.5 (the manual of FRED, Photon Engineering). A
// polished lens therefore glares more far from the source than this halo, and a measured curve describes it
// better.
//
// B is the share of the aperture that a round baffle leaves lit: all of it up to one angle, nothing from the
// baffle angle on, and between the two the overlap of two disks whose distance grows with tan theta. The
// share `baffle_leak` of the light on the baffle's wall still arrives. No light comes from behind the
// aperture's plane.
//
// Ghosts are sharp or blurred images by two reflections. Each is a disk (with the pupil's hole) with the
// share `gain` of the light that enters the aperture from within a range of angles; it fades over the first
// and last tenth of that range.
//
// Not modelled: second-order scatter off baffle edges, polarisation, and the effect of a coating's spectrum
// on a ghost's colour.

#include <span>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/side_light.h"
#include "render/vocabulary/units.h"
#include "sensor/stray/far_wings.h"

namespace hilcam {

struct OutsideGhostConfig {
    double from_rad = 0, to_rad = 0.5 * kPi;  // angle of the source from the boresight
    double gain = 0;                          // share of the light that enters the aperture
    double scale = -1;     // distance of the ghost from the principal point over that of the source's image
    double defocus_m = 0;  // distance from the ghost's focus to the detector
};
Fields fields(OutsideGhostConfig& ghost);
void validate(const OutsideGhostConfig& ghost);

struct OutsideLightConfig {
    Table transmittance;          // angle [deg], PST
    double baffle_rad = 0;        // 0: no baffle
    double baffle_field_rad = 0;  // the whole aperture is lit up to this angle
    double baffle_leak = 0;
    std::vector<OutsideGhostConfig> ghosts;
};
Fields fields(OutsideLightConfig& config);
void validate(const OutsideLightConfig& config);

// Returns the share of the aperture that a baffle leaves lit, 0..1. Any thread.
double lit_share(double angle_rad, double field_rad, double baffle_rad);

// The camera data that this model uses.
struct OutsideLens {
    double f_number = 4, obscuration_ratio = 0, pitch_m = 0, fill_factor = 1;
    double aperture_area_m2 = 0;
    double best_transmission = 1;  // transmission of the glass at its best wavelength
};

// The light from outside the picture in one channel (light_channel.h).
class OutsideLight {
  public:
    // per_irradiance: e- s^-1 of the whole aperture per W m^-2 um^-1. wings: the channel's. Owner thread.
    OutsideLight(const OutsideLightConfig& config, const OutsideLens& lens, const ImageGeometry& detector,
                 const Spectrum& per_irradiance, int bins, const FarWings& wings);

    // Collects the light of this exposure; false: nothing to add. Loop, one thread; no allocation.
    bool collect(std::span<const SideLight> lights, double exposure_s);
    // Adds the electrons of veil and ghosts to every `step`th pixel of a row, from x on. Any thread.
    void add_to_row(int y, std::size_t x, std::size_t step, std::span<float> row) const;

    // Returns the PST at the picture's centre for light at the best transmission of the glass. Any thread.
    double transmittance(double angle_rad) const;

  private:
    struct Ghost {
        Vec2d at_px;
        double radius_px, hole_px;
        float electrons_px;  // in each pixel of the ghost
    };
    static constexpr int kNodes = 33;  // samples of the veil along each axis; the veil is smooth

    double electrons_of(const SideLight& light, double exposure_s) const;
    double veil_px(Vec3f source_dir, double cosine, Vec2d across) const;
    void add_ghosts(const SideLight& light, double angle_rad, double electrons);

    const FarWings& wings_;
    ImageGeometry geometry_;
    Table curve_;
    double baffle_rad_, field_rad_, leak_;
    std::vector<OutsideGhostConfig> ghost_kinds_;
    OutsideLens lens_;
    double area_px_;      // aperture area in pixels
    double measured_px_;  // electrons of a pixel over those of the aperture, at PST 1 and best transmission
    Spectrum per_irradiance_;
    int bins_;
    std::vector<Vec2d> node_across_;  // directions that the nodes see, across the boresight
    std::vector<float> veil_;         // [kNodes][kNodes]
    std::vector<Ghost> ghosts_;
};

}  // namespace hilcam
