#pragma once
// `spice` in a scenario: SPICE's kernels, and what of the world they say (docs/spice.md).

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/spice/spice_kernels.h"
#include "render/vocabulary/config_field.h"
#include "sensor/camera_model.h"

namespace hilcam {

struct KernelFileConfig {
    std::filesystem::path file;
};
Fields fields(KernelFileConfig& kernel);

struct SpiceConfig {
    std::vector<KernelFileConfig> kernels;
    enum class Bodies { kKernels, kOwn } bodies = Bodies::kKernels;
    std::string camera;  // empty: the data sheet is all
    double tolerance_s = 0;
    std::shared_ptr<SpiceKernels> loaded;  // no key: load_spice()
};
Fields fields(SpiceConfig& spice);
void validate(const SpiceConfig& spice);

// A thing of the kernels, as the place of a motion or of a body.
struct SpiceObjectConfig {
    std::string object;
};
Fields fields(SpiceObjectConfig& object);

// A frame of the kernels as an attitude, and how a camera sits in it.
struct SpiceFrameConfig {
    std::string frame, instrument;
    Vec3d boresight{0, 0, 1}, right{1, 0, 0};
    bool has_boresight = false;
};
Fields fields(SpiceFrameConfig& frame);
void validate(const SpiceFrameConfig& frame);

// Reads the kernels, and makes their leap seconds those of the program. Returns a warning where they end before those in use,
// or empty. Throws InputError.
std::string load_spice(SpiceConfig& spice);
// Puts an instrument kernel's focal length, pixel pitch and pixels into a camera; returns a line for what of the kernel's
// field of view does not agree, or nothing. Throws InputError.
std::string apply_instrument(const SpiceConfig& spice, CameraModel& camera);
// The frame's name, and the camera's axes in it: z along the boresight, x as near as can be to `right`.
struct SpiceMounting {
    std::string frame;
    Quat frame_from_camera;
};
SpiceMounting mounting_of(const SpiceFrameConfig& config, const SpiceKernels& kernels);

}  // namespace hilcam
