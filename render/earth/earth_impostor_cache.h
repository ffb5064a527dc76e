#pragma once
// Has the impostor of the Earth (earth_impostor.h) that frames ask for: at once where one needs it, and ahead of time, on a
// thread of its own, where the camera and the Sun move on as they did. What a picture shows is the same either way.

#include <array>
#include <cstdint>
#include <memory>

#include "render/earth/earth_impostor.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class EarthImpostorCache {
  public:
    // The Earth outlives this. Owner thread.
    EarthImpostorCache(const EarthModel& earth, const Spectrum& sun_irradiance_1au_w_m2_um, double pixel_rad,
                       double top_m);
    EarthImpostorCache(const EarthImpostorCache&) = delete;
    EarthImpostorCache& operator=(const EarthImpostorCache&) = delete;

    // Ends the thread (AheadThread). Owner thread.
    void stop_looking_ahead() { ahead_.stop(); }

    // Has the picture of a frame, the camera and the Sun in the Earth's axes, at this place between the maps
    // (EarthModel::numbers_at); false: for such a camera none is kept. Loop; makes it, or what the thread has left of it, where it
    // is not there yet.
    bool place(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers = {});
    // The one that was placed last. Any thread.
    const EarthImpostor& picture() const { return *pictures_[shown_].picture; }
    // Returns the memory of all pictures. The first that is made has all of them take as much.
    std::size_t bytes() const;

  private:
    struct Kept {
        std::unique_ptr<EarthImpostor> picture;
        EarthImpostor::Key key;
        bool made = false;
        std::uint64_t last_shown = 0;
    };
    struct Place {
        Vec3d camera_m, sun_dir;
        MapNumbers numbers;
    };

    const EarthModel& earth_;
    Spectrum sun_irradiance_1au_;
    double pixel_rad_;
    // Two for a camera that sways over a step, and one ahead.
    std::array<Kept, 3> pictures_;
    std::size_t shown_ = 0, asked_ = 0;
    std::uint64_t frames_ = 0;
    static constexpr std::uint64_t kStride = 16;  // frames
    Place before_, long_before_;
    AheadThread ahead_;  // the last: it ends first

    bool is_being_made(std::size_t at) const { return at == asked_ && ahead_.is_at_work(); }
    void make_rest(std::size_t at);
    std::size_t find(const EarthImpostor::Key& key) const;
    std::size_t room_for(const EarthImpostor::Key& key);
    void look_ahead(const Place& now);
};

}  // namespace hilcam
