#pragma once
// The section `spice`: SPICE kernels, and what they determine in the world (docs/spice.md).

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
    std::string camera;  // empty: only the data sheet describes the camera
    double tolerance_s = 0;
    std::shared_ptr<SpiceKernels> loaded;  // not a key: set by load_spice()
};
Fields fields(SpiceConfig& spice);
void validate(const SpiceConfig& spice);

// An object of the kernels that gives the place of a motion or body.
struct SpiceObjectConfig {
    std::string object;
};
Fields fields(SpiceObjectConfig& object);

// A frame of the kernels that gives an attitude, and how a camera is mounted in it.
struct SpiceFrameConfig {
    std::string frame, instrument;
    Vec3d boresight{0, 0, 1}, right{1, 0, 0};
    bool has_boresight = false;
};
Fields fields(SpiceFrameConfig& frame);
void validate(const SpiceFrameConfig& frame);

// Reads the kernels and makes their leap seconds the program's. Returns a warning when these end before the
// leap seconds in use; otherwise empty. Throws InputError.
std::string load_spice(SpiceConfig& spice);
// Sets a camera's focal length, pixel pitch and pixel numbers from an instrument kernel. Returns a line about
// any disagreement with the kernel's field of view; otherwise empty. Throws InputError.
std::string apply_instrument(const SpiceConfig& spice, CameraModel& camera);
// A frame's name, and the camera's axes in it: z along the boresight, x as close as possible to `right`.
struct SpiceMounting {
    std::string frame;
    Quat frame_from_camera;
};
SpiceMounting mounting_of(const SpiceFrameConfig& config, const SpiceKernels& kernels);

}  // namespace hilcam
