#include "emulator/zoo/pan_change.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

double mean_root(double squares, std::size_t count) {
    return count > 0 ? std::sqrt(std::max(0.0, squares) / static_cast<double>(count)) : 0;
}

}  // namespace

PanChange& PanChange::operator+=(const PanChange& other) {
    lit_px += other.lit_px;
    squares += other.squares, own_squares += other.own_squares, moved_squares += other.moved_squares;
    return *this;
}

double PanChange::excess_rms() const { return mean_root(squares - own_squares, lit_px); }
double PanChange::reference_rms() const { return mean_root(moved_squares - own_squares, lit_px); }

PanChange pan_change(const PannedPictures& pictures, const KnownPicture& reference, const KnownChange& known,
                     const SurfacePixels& surface, const SensorNoise& noise) {
    HILCAM_CHECK(pictures.still.pixels() == pictures.moved.pixels() &&
                 pictures.still.pixels() == known.change.pixels() &&
                 pictures.still.pixels() == surface.near_object.size());
    PanChange out;
    for (std::size_t i = 0; i < known.change.pixels(); ++i) {
        if (surface.near_object[i] == 0) continue;
        const auto at = [i](const ElectronImage& image) { return static_cast<double>(image.data()[i]); };
        const double dark_e = at(reference.dark), mean_e = at(reference.mean);
        const double most_e = std::max({at(pictures.still), at(pictures.moved), mean_e});
        if (most_e - dark_e <= noise.sigma_e(dark_e, dark_e)) continue;
        const double sigma_e = noise.sigma_e(mean_e, dark_e), change_e = at(known.change);
        ++out.lit_px;
        out.squares += square((at(pictures.moved) - at(pictures.still) - change_e) / sigma_e);
        out.own_squares += square(at(known.error) / sigma_e);
        out.moved_squares += square(change_e / sigma_e);
    }
    return out;
}

}  // namespace hilcam
