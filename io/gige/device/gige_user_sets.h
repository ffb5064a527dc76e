#pragma once
// User sets: settings by name, kept as long as the program runs. "Default" is the camera as its files
// configure it and cannot be overwritten. UserSetDefault is what a DeviceReset begins with.

#include <array>

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeUserSets {
  public:
    static constexpr std::size_t kSets = 3;  // Default, UserSet1, UserSet2

    // `loaded`: the settings have been replaced and are to be made to fit. After all other parts: the present
    // settings are the default set.
    GigeUserSets(GigeCore& core, std::function<void()> loaded);

    gvcp::Status load(std::size_t set);
    // Loads the default; what of it the camera refuses stays as it is.
    void reset();

  private:
    gvcp::Status save(std::size_t set);

    struct Set {
        CameraSettings camera;
        GigeSettings device;
    };
    GigeCore& core_;
    std::function<void()> loaded_;
    std::array<Set, kSets> sets_;
    std::uint32_t selector_ = 0, default_ = 0;
};

}  // namespace hilcam
