#pragma once
// Provides the Earth's impostor (earth_impostor.h) for a frame: made at once if needed, or ahead of time on a
// thread of its own if camera and Sun continue their motion. The picture is the same either way.

#include <array>
#include <cstdint>
#include <memory>

#include "render/earth/earth_impostor.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class EarthImpostorCache {
  public:
    // The Earth must outlive this. Owner thread.
    EarthImpostorCache(const EarthModel& earth, const Spectrum& sun_irradiance_1au_w_m2_um, double pixel_rad,
                       double top_m);
    EarthImpostorCache(const EarthImpostorCache&) = delete;
    EarthImpostorCache& operator=(const EarthImpostorCache&) = delete;

    // Ends the thread (AheadThread). Owner thread.
    void stop_looking_ahead() { ahead_.stop(); }

    // Provides the picture for a frame, with camera and Sun in the Earth's axes and this position between the
    // maps (EarthModel::numbers_at). Makes what the thread has not finished. Returns false if no picture is
    // kept for such a camera. Loop.
    bool place(Vec3d camera_m, Vec3d sun_dir, MapNumbers numbers = {});
    // Returns the picture that was placed last. Any thread.
    const EarthImpostor& picture() const { return *pictures_[shown_].picture; }
    // Returns the memory of all pictures. The first picture determines the memory of the others.
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
    // Two for a camera that moves back and forth across a step, and one ahead.
    std::array<Kept, 3> pictures_;
    std::size_t shown_ = 0, asked_ = 0;
    std::uint64_t frames_ = 0;
    static constexpr std::uint64_t kStride = 16;  // frames
    Place before_, long_before_;
    AheadThread ahead_;  // last member, so that it ends first

    bool is_being_made(std::size_t at) const { return at == asked_ && ahead_.is_at_work(); }
    void make_rest(std::size_t at);
    std::size_t find(const EarthImpostor::Key& key) const;
    std::size_t room_for(const EarthImpostor::Key& key);
    void look_ahead(const Place& now);
};

}  // namespace hilcam
