#include "render/sky/star_block.h"

#include <cmath>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr std::size_t kStarsTogether = 8;

struct StarPlaces {
    double* x;
    double* y;
    double* z;
};

// Normalises vectors. count: a multiple of kStarsTogether, here and below.
[[gnu::always_inline]] inline void normalize(double& x, double& y, double& z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    x /= length, y /= length, z /= length;
}

// The same steps as StarObserver::apparent_dir(). at: where the observer sees the stars, without aberration.
HILCAM_CLONES void aberrate(std::size_t count, const StarObserver& observer, StarPlaces at) {
    const Vec3d beta = observer.beta();
    const double inverse_lorentz = observer.inverse_lorentz();
    for (std::size_t first = 0; first < count; first += kStarsTogether)
        for (std::size_t i = first; i < first + kStarsTogether; ++i) {
            double x = at.x[i], y = at.y[i], z = at.z[i];
            normalize(x, y, z);
            const double along = x * beta.x + y * beta.y + z * beta.z;
            const double forward = 1 + along / (1 + inverse_lorentz);
            x = inverse_lorentz * x + forward * beta.x;
            y = inverse_lorentz * y + forward * beta.y;
            z = inverse_lorentz * z + forward * beta.z;
            normalize(x, y, z);
            at.x[i] = x, at.y[i] = y, at.z[i] = z;
        }
}

}  // namespace

void StarBlock::find_dirs(const StarObserver& observer) {
    for (std::size_t i = 0; i < count_; ++i) {
        const Vec3d displaced = observer.displaced(*stars_[i]);
        x_[i] = displaced.x, y_[i] = displaced.y, z_[i] = displaced.z;
    }
    const std::size_t padded = (count_ + kStarsTogether - 1) / kStarsTogether * kStarsTogether;
    for (std::size_t i = count_; i < padded; ++i) x_[i] = 1, y_[i] = z_[i] = 0;
    aberrate(padded, observer, {x_.data(), y_.data(), z_.data()});
}

}  // namespace hilcam
