#pragma once
// Veiling glare and ghosts of light from beside the picture: the Sun near the field, the Earth below it.
//
// A lens is described by its point source transmittance PST(theta): irradiance on the detector over that of the
// source on a plane that faces it, theta its angle from the boresight (Fest, Stray Light Analysis and Control,
// SPIE, 2013, 2.2.1). Either as measured, then even over the picture: at the wavelength that the glass passes
// best; at others less, as the glass. Or, without a curve, by what the camera's file says of light in the field
// already: the halo of `veiling_glare_fraction` and the diffraction wings (far_wings.h) go on beyond it. In a
// pixel at the direction p light from s makes
//     electrons = E A T QE t cos(theta) B(theta) D(f |s - p|)        s, p: the direction's parts across the boresight
// D the share of a point's light in a pixel at a distance in px. Differences of direction cosines in place of
// places in the picture are Harvey's: scatter of a polished face depends on them alone, whatever the angle
// (Harvey, Light-Scattering Characteristics of Optical Surfaces, PhD thesis, Arizona, 1976); the halo is his law
// with slope -3, shoulder r / f and total integrated scatter `veiling_glare_fraction`. That slope is the halo's of light in
// the field (stray_light.h); polished faces are given -0.5 to -2, super-polished ones less than -2.5 (the manual of FRED, Photon
// Engineering): a lens of the former glares more far from the source, and is better given as measured. B is the share of the
// aperture that a round baffle leaves lit: all up to one angle, none from the baffle angle on, between the two
// the overlap of two disks whose distance grows with tan theta. Light that meets the baffle's wall comes
// on by `baffle_leak` of it. Nothing comes from behind the aperture's plane.
//
// Ghosts: sharp or blurred images by two reflections, each a disk (with the pupil's hole) whose light is `gain` of
// what enters the aperture from an angle within a range; it fades over the range's first and last tenth.
//
// Not modelled: scatter of second order off baffles' edges, polarisation, and what the spectrum of a coating does to a ghost's
// colour.

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
    double scale = -1;     // the ghost's distance from the principal point over that of the source's image
    double defocus_m = 0;  // from where the ghost is sharp to the detector
};
Fields fields(OutsideGhostConfig& ghost);
void validate(const OutsideGhostConfig& ghost);

struct OutsideLightConfig {
    Table transmittance;          // angle [deg], PST
    double baffle_rad = 0;        // 0: no baffle
    double baffle_field_rad = 0;  // all of the aperture is lit up to here
    double baffle_leak = 0;
    std::vector<OutsideGhostConfig> ghosts;
};
Fields fields(OutsideLightConfig& config);
void validate(const OutsideLightConfig& config);

// The share of the aperture that a baffle leaves lit, 0..1. Any thread.
double lit_share(double angle_rad, double field_rad, double baffle_rad);

// The figures of a camera's data sheet that it uses.
struct OutsideLens {
    double f_number = 4, obscuration_ratio = 0, pitch_m = 0, fill_factor = 1;
    double aperture_area_m2 = 0;
    double best_transmission = 1;  // transmission of the glass, at the wavelength that it passes best
};

// One for each channel of light (light_channel.h).
class OutsideLight {
  public:
    // per_irradiance: e- s^-1 of all the aperture per W m^-2 um^-1. wings: the channel's. Owner thread.
    OutsideLight(const OutsideLightConfig& config, const OutsideLens& lens, const ImageGeometry& detector,
                 const Spectrum& per_irradiance, int bins, const FarWings& wings);

    // The light of this exposure; nothing to add when false. Loop, one thread; no allocation.
    bool collect(std::span<const SideLight> lights, double exposure_s);
    // Adds to pixels of a row from x on, every `step`th: electrons of the veil and the ghosts. Any thread.
    void add_to_row(int y, std::size_t x, std::size_t step, std::span<float> row) const;

    // PST of the light that the glass passes best, at the picture's middle. Any thread.
    double transmittance(double angle_rad) const;

  private:
    struct Ghost {
        Vec2d at_px;
        double radius_px, hole_px;
        float electrons_px;  // in each pixel of it
    };
    static constexpr int kNodes = 33;  // the veil's samples along an axis: it is smooth

    double electrons_of(const SideLight& light, double exposure_s) const;
    double veil_px(Vec3f source_dir, double cosine, Vec2d across) const;
    void add_ghosts(const SideLight& light, double angle_rad, double electrons);

    const FarWings& wings_;
    ImageGeometry geometry_;
    Table curve_;
    double baffle_rad_, field_rad_, leak_;
    std::vector<OutsideGhostConfig> ghost_kinds_;
    OutsideLens lens_;
    double area_px_;      // area of the aperture
    double measured_px_;  // at PST 1 and best transmission, electrons of a pixel over those of the aperture
    Spectrum per_irradiance_;
    int bins_;
    std::vector<Vec2d> node_across_;  // directions that the nodes see, across the boresight
    std::vector<float> veil_;         // [kNodes][kNodes]
    std::vector<Ghost> ghosts_;
};

}  // namespace hilcam
