#pragma once
// Builds a USB camera from the kernel's UVC function (f_uvc) in configfs: which folders, files and links, in
// which order. make() creates the gadget on a machine with a USB device controller (UDC), remove() takes it
// down.
//
// Kernels before 6.4 show hosts a fixed set of controls (automatic exposure, brightness). Later kernels show
// exposure time and gain as well.

#include <filesystem>
#include <string>
#include <vector>

#include "io/uvc/uvc_stream.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct UvcConfig {
    static constexpr const char* kKey = "uvc";
    static constexpr const char* kMeaning = "frames by USB as a camera, with a USB device controller";
    static constexpr bool kLive = true;
    static constexpr bool kFixedSize = true;

    std::string udc;                   // empty: the only one
    std::int64_t vendor_id = 0x1209;   // pid.codes
    std::int64_t product_id = 0x0001;  // its test number
    std::string serial = "1";
    std::string manufacturer = "hilcam";
    std::string product = "hilcam camera";
    std::int64_t packet_bytes = 1024;
    std::string command_function;  // a FunctionFS instance on the same cable
    std::filesystem::path configfs = "/sys/kernel/config";
};
Fields fields(UvcConfig& config);

struct ConfigfsStep {
    enum class Kind { kFolder, kFile, kLink } kind;
    std::filesystem::path path;  // relative to configfs/usb_gadget
    std::string content;         // content of a file; target of a link, relative as well
    bool optional = false;       // older kernels refuse it
};
// Returns the whole tree, without the binding to a controller.
std::vector<ConfigfsStep> uvc_gadget_tree(const UvcConfig& config, const UvcStreamShape& shape);

class UvcGadget {
  public:
    UvcGadget(UvcConfig config, UvcStreamShape shape);
    ~UvcGadget() { remove(); }

    // Throws DeviceError: no controller, no configfs, no permission, or a gadget of that name that cannot be
    // removed.
    void make();
    // Binds the gadget to the controller. False: see errno. With a command function, it fails until that one
    // is ready.
    bool bind();
    // Takes the gadget down, also one that a killed run has left. Idempotent.
    void remove() noexcept;

    const std::string& udc() const { return udc_; }
    // Returns the video device that takes the pictures, "/dev/video0"; empty: not there (yet).
    std::filesystem::path video_device() const;
    // True when hosts see exposure time and gain.
    bool shows_exposure() const { return shows_exposure_; }
    // Returns the number of the interface that carries the pictures; composite gadgets shift it.
    int streaming_interface() const;

  private:
    std::filesystem::path root() const { return config_.configfs / "usb_gadget"; }

    UvcConfig config_;
    UvcStreamShape shape_;
    std::vector<ConfigfsStep> steps_;
    std::string udc_;
    bool made_ = false, shows_exposure_ = false;
};

// Returns the names of the machine's USB device controllers.
std::vector<std::string> usb_device_controllers();

}  // namespace hilcam
