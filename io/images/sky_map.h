#pragma once
// The direction of each pixel in astronomers' form: a World Coordinate System of FITS.
//
// Greisen & Calabretta, "Representations of world coordinates in FITS", A&A 395 (2002) 1061, and Calabretta &
// Greisen, "Representations of celestial coordinates in FITS", ibid. 1077. TAN is a rectilinear lens, ARC a
// lens with image height proportional to the angle; distortion is left out. Directions follow from the
// camera's attitude in ICRF axes: aberration moves stars from these places, by 20 arcsec in orbit about the
// Sun.

#include "io/images/picture_notes.h"

namespace hilcam {

struct SkyMap {
    bool fisheye = false;             // ARC; else TAN
    double ra_deg = 0, dec_deg = 0;   // right ascension and declination of the boresight: CRVAL
    Vec2d reference_px;               // its pixel, with the centre of the first pixel at (1, 1): CRPIX
    double east_deg_px[2] = {0, 0};   // eastward per pixel to the right, and per pixel down: CD1_1, CD1_2
    double north_deg_px[2] = {0, 0};  // northward, in the same order: CD2_1, CD2_2
};

SkyMap sky_map(const Pose& camera, const CameraModel& model, const PictureLayout& layout);

}  // namespace hilcam
