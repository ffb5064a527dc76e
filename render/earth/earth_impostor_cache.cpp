#include "render/earth/earth_impostor_cache.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

EarthImpostorCache::EarthImpostorCache(const EarthModel& earth, const Spectrum& sun_irradiance,
                                       double pixel_rad, double top_m)
    : earth_(earth), sun_irradiance_1au_(sun_irradiance), pixel_rad_(pixel_rad) {
    for (Kept& kept : pictures_)
        kept.picture = std::make_unique<EarthImpostor>(pixel_rad, top_m, earth.seen_height_m(0));
    ahead_.start([this] { make_rest(asked_); });
}

std::size_t EarthImpostorCache::bytes() const {
    std::size_t sum = 0;
    for (const Kept& kept : pictures_) sum += kept.picture->bytes();
    return sum;
}

bool EarthImpostorCache::place(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers) {
    if (!EarthImpostor::is_for(camera_m, pixel_rad_)) return false;
    const EarthImpostor::Key key = EarthImpostor::key_of(camera_m, sun_dir, numbers);
    std::size_t at = find(key);
    if (is_being_made(at)) {
        make_rest(at);
        ahead_.wait();  // for the piece in work
    }
    if (at == pictures_.size()) {
        at = room_for(key);
        make_rest(at);
        // The kernel provides pages at first use; later frames should not spend time on that.
        if (frames_ == 0)
            for (const Kept& kept : pictures_) kept.picture->take_memory_as(*pictures_[at].picture);
    }
    shown_ = at;
    pictures_[at].last_shown = ++frames_;
    look_ahead({camera_m, sun_dir, numbers});
    return true;
}

std::size_t EarthImpostorCache::find(const EarthImpostor::Key& key) const {
    const auto found = std::find_if(pictures_.begin(), pictures_.end(),
                                    [&](const Kept& kept) { return kept.made && kept.key == key; });
    return static_cast<std::size_t>(found - pictures_.begin());
}

// Returns the picture that was not shown for longest, except one that is being made.
std::size_t EarthImpostorCache::room_for(const EarthImpostor::Key& key) {
    std::size_t oldest = is_being_made(0) ? 1 : 0;
    for (std::size_t i = oldest + 1; i < pictures_.size(); ++i)
        if (pictures_[i].last_shown < pictures_[oldest].last_shown && !is_being_made(i)) oldest = i;
    Kept& kept = pictures_[oldest];
    kept.key = key, kept.made = true, kept.last_shown = frames_;
    kept.picture->begin(key);
    return oldest;
}

void EarthImpostorCache::make_rest(std::size_t at) {
    pictures_[at].picture->make_rest(earth_, sun_irradiance_1au_);
}

// Requests the first picture that the next frames will need if everything continues its motion.
void EarthImpostorCache::look_ahead(const Place& now) {
    if (frames_ % kStride == 1) long_before_ = before_, before_ = now;
    if (frames_ <= 2 * kStride || ahead_.is_busy()) return;
    const auto past = static_cast<double>(kStride + (frames_ - 1) % kStride);  // frames since long_before_
    const auto on = [&](Vec3d before, Vec3d here, double ahead) {
        return here + (ahead / past) * (here - before);
    };
    for (double ahead = 1; ahead <= 128; ahead *= 2) {
        const Vec3d camera_m = on(long_before_.camera_m, now.camera_m, ahead);
        if (!EarthImpostor::is_for(camera_m, pixel_rad_)) return;
        const auto number_on = [&](double before, double here) {
            return here + ahead / past * (here - before);
        };
        const MapNumbers numbers{number_on(long_before_.numbers.clouds, now.numbers.clouds),
                                 number_on(long_before_.numbers.ground, now.numbers.ground)};
        const EarthImpostor::Key key = EarthImpostor::key_of(
            camera_m, normalized(on(long_before_.sun_dir, now.sun_dir, ahead)), earth_.nearest(numbers));
        if (key == pictures_[shown_].key) continue;
        if (find(key) < pictures_.size()) return;
        asked_ = room_for(key);
        ahead_.ask();
        return;
    }
}

}  // namespace hilcam
