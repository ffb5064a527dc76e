#pragma once
// User sets: named settings, kept while the program runs. "Default" is the camera as its files configure it,
// and cannot be overwritten. DeviceReset loads the set in UserSetDefault.

#include <array>

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeUserSets {
  public:
    static constexpr std::size_t kSets = 3;  // Default, UserSet1, UserSet2

    // loaded: called when settings have been replaced, to make the rest fit. To be constructed after all
    // other parts: the settings at that moment are the default set.
    GigeUserSets(GigeCore& core, std::function<void()> loaded);

    gvcp::Status load(std::size_t set);
    // Loads the default set; values that the camera refuses stay as they are.
    void reset();

  private:
    gvcp::Status save(std::size_t set);

    struct Set {
        CameraSettings camera;
        GigeSettings device;
        LineSettings lines;
    };
    GigeCore& core_;
    std::function<void()> loaded_;
    std::array<Set, kSets> sets_;
    std::uint32_t selector_ = 0, default_ = 0;
};

}  // namespace hilcam
