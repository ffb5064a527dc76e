#include "render/earth/kept_earth.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace hilcam {

KeptEarth::KeptEarth(const EarthModel& earth, const Spectrum& sun_irradiance, double pixel_rad, double top_m)
    : earth_(earth), sun_irradiance_1au_(sun_irradiance), pixel_rad_(pixel_rad) {
    for (Kept& kept : pictures_) kept.picture = std::make_unique<EarthPicture>(pixel_rad, top_m);
    thread_ = std::thread([this] { work(); });
}

KeptEarth::~KeptEarth() {
    wait();
    state_.store(State::kStop), state_.notify_one();
    thread_.join();
}

std::size_t KeptEarth::bytes() const {
    std::size_t sum = 0;
    for (const Kept& kept : pictures_)
        if (kept.made) sum += kept.picture->bytes();
    return sum;
}

bool KeptEarth::place(Vec3d camera_m, Vec3d sun_dir) {
    if (!EarthPicture::is_for(camera_m, pixel_rad_)) return false;
    const EarthPicture::Key key = EarthPicture::key_of(camera_m, sun_dir);
    std::size_t at = find(key);
    const bool is_being_made = at == asked_ && state_.load(std::memory_order_acquire) == State::kAsked;
    if (at == pictures_.size() || is_being_made) wait();
    if (at == pictures_.size()) {
        at = room_for(key);
        make(at);
    }
    shown_ = at;
    pictures_[at].last_shown = ++frames_;
    look_ahead({camera_m, sun_dir});
    return true;
}

std::size_t KeptEarth::find(const EarthPicture::Key& key) const {
    const auto found = std::find_if(pictures_.begin(), pictures_.end(),
                                    [&](const Kept& kept) { return kept.made && kept.key == key; });
    return static_cast<std::size_t>(found - pictures_.begin());
}

// Takes the place of the one that was not shown for longest.
std::size_t KeptEarth::room_for(const EarthPicture::Key& key) {
    const auto oldest =
        std::min_element(pictures_.begin(), pictures_.end(),
                         [](const Kept& a, const Kept& b) { return a.last_shown < b.last_shown; });
    oldest->key = key, oldest->made = true, oldest->last_shown = frames_;
    return static_cast<std::size_t>(oldest - pictures_.begin());
}

void KeptEarth::make(std::size_t at) {
    pictures_[at].picture->make(earth_, pictures_[at].key, sun_irradiance_1au_);
}

// Has the first picture made that the next frames will ask for, if everything moves on as it did.
void KeptEarth::look_ahead(const Place& now) {
    if (frames_ % kStride == 1) long_before_ = before_, before_ = now;
    if (frames_ <= 2 * kStride || state_.load(std::memory_order_acquire) != State::kIdle) return;
    const auto past = static_cast<double>(kStride + (frames_ - 1) % kStride);  // frames since long_before_
    const auto on = [&](Vec3d before, Vec3d here, double ahead) {
        return here + (ahead / past) * (here - before);
    };
    for (double ahead = 1; ahead <= 128; ahead *= 2) {
        const Vec3d camera_m = on(long_before_.camera_m, now.camera_m, ahead);
        if (!EarthPicture::is_for(camera_m, pixel_rad_)) return;
        const EarthPicture::Key key =
            EarthPicture::key_of(camera_m, normalized(on(long_before_.sun_dir, now.sun_dir, ahead)));
        if (key == pictures_[shown_].key) continue;
        if (find(key) < pictures_.size()) return;
        asked_ = room_for(key);
        state_.store(State::kAsked, std::memory_order_release), state_.notify_one();
        return;
    }
}

void KeptEarth::wait() {
    for (State state; (state = state_.load(std::memory_order_acquire)) == State::kAsked;) state_.wait(state);
}

void KeptEarth::work() {
    // Frames come first; and one core of those that they leave is enough.
    constexpr int kNicer = 10;  // niceness above that of the program, which may be nice itself
    setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kNicer);
    tbb::task_arena alone(1, 1);
    while (true) {
        state_.wait(State::kIdle);
        if (state_.load(std::memory_order_acquire) == State::kStop) return;
        alone.execute([this] { make(asked_); });
        state_.store(State::kIdle, std::memory_order_release), state_.notify_one();
    }
}

}  // namespace hilcam
