#pragma once
// Says which way each pixel of a picture looks, as astronomers write it: a World Coordinate System of FITS.
//
// Greisen & Calabretta, "Representations of world coordinates in FITS", A&A 395 (2002) 1061, and Calabretta &
// Greisen, "Representations of celestial coordinates in FITS", ibid. 1077. TAN is a lens that leaves straight
// lines straight, ARC one whose image height goes with the angle; distortion is not in it. Directions are
// those of the camera's attitude in ICRF axes: stars appear beside their places by aberration, 20 arcsec in
// orbit about the Sun.

#include "io/images/picture_notes.h"

namespace hilcam {

struct SkyMap {
    bool fisheye = false;             // ARC; else TAN
    double ra_deg = 0, dec_deg = 0;   // right ascension and declination of the boresight: CRVAL
    Vec2d reference_px;               // where it is, the centre of the first pixel at (1, 1): CRPIX
    double east_deg_px[2] = {0, 0};   // to the east for a pixel to the right, and one down: CD1_1, CD1_2
    double north_deg_px[2] = {0, 0};  // CD2_1, CD2_2
};

SkyMap sky_map(const Pose& camera, const CameraModel& model, const PictureLayout& layout);

}  // namespace hilcam
