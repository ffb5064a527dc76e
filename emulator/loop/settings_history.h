#pragma once
// A camera's settings over time: each entry is valid from an instant until the next. A late frame can thus
// use the settings of the instant at which its exposure begins.
//
// Instants are int64 ns of the camera's time (clock.h). The newest 16 entries are kept; an exposure that
// begins before all of them uses the oldest.

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

    // Adds settings that are valid from then on, at the earliest from the begin of the previous entry.
    void add(const CameraSettings& settings, std::int64_t from_ns) {
        const Held next{std::max(from_ns, held_[count_ - 1].from_ns), settings};
        if (count_ == kLength) std::move(held_.begin() + 1, held_.end(), held_.begin()), --count_;
        held_[count_++] = next;
    }

    const CameraSettings& newest() const { return held_[count_ - 1].settings; }
    const CameraSettings& at(std::int64_t camera_ns) const {
        return of_exposure([=](const CameraSettings&) { return camera_ns; }).settings;
    }
    // Returns the entry for an exposure that begins at a time which depends on its settings: the first entry
    // by which it begins before the next entry becomes valid.
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
