#pragma once
// A camera's settings over time: each hold from an instant on, until the next. So a frame that is late has those of the
// instant at which its exposure begins, whenever somebody comes to look.
//
// Instants are int64 ns of the camera's time (clock.h). The newest 16 settings are kept: what begins before all of them
// has the oldest.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "io/contract/camera_control.h"

namespace hilcam {

class SettingsHistory {
  public:
    struct Held {
        std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();
        CameraSettings settings;
    };
    static constexpr std::size_t kLength = 16;

    SettingsHistory() = default;
    explicit SettingsHistory(const CameraSettings& settings) { held_[0].settings = settings; }

    // Adds settings that hold from then on, but no earlier than those before them.
    void add(const CameraSettings& settings, std::int64_t from_ns) {
        const Held next{std::max(from_ns, held_[count_ - 1].from_ns), settings};
        if (count_ == kLength) std::move(held_.begin() + 1, held_.end(), held_.begin()), --count_;
        held_[count_++] = next;
    }

    const CameraSettings& newest() const { return held_[count_ - 1].settings; }
    const CameraSettings& at(std::int64_t camera_ns) const {
        return of_exposure([=](const CameraSettings&) { return camera_ns; }).settings;
    }
    // Returns what holds for an exposure whose begin depends on it: the first by which it begins before the next
    // settings hold.
    template <class Begin>
    const Held& of_exposure(const Begin& begin_ns_by) const {
        std::size_t i = 0;
        while (i + 1 < count_ && begin_ns_by(held_[i].settings) >= held_[i + 1].from_ns) ++i;
        return held_[i];
    }

  private:
    std::array<Held, kLength> held_;  // oldest first
    std::size_t count_ = 1;
};

}  // namespace hilcam
