#include "io/uvc/uvc_gadget.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "io/system/fd.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

const fs::path kGadget = "hilcam";
const fs::path kUvc = kGadget / "functions/uvc.camera";

std::string hex(std::int64_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04llx", static_cast<unsigned long long>(value));
    return text;
}

// Writes the whole content with one write(), as configfs requires. False: see errno.
bool write_file(const fs::path& path, const std::string& content) {
    const Fd fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    const std::string line = content + "\n";
    return fd && ::write(fd.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

std::string reason() { return std::strerror(errno); }

}  // namespace

Fields fields(UvcConfig& c) {
    return {
        text("udc", c.udc, "name of the USB device controller in /sys/class/udc; empty: the first"),
        integer("vendor_id", c.vendor_id, {0, 65535}, "USB VID"),
        integer("product_id", c.product_id, {0, 65535}, "USB PID"),
        text("serial", c.serial, "serial number"),
        text("manufacturer", c.manufacturer, "manufacturer name shown by hosts"),
        text("product", c.product, "product name shown by hosts"),
        integer("packet_bytes", c.packet_bytes, {64, 3072},
                "size of an isochronous packet; high speed carries 8000 packets a second"),
        text("command_function", c.command_function,
             "name of a FunctionFS instance for commands on the same cable; empty: none"),
    };
}

std::vector<ConfigfsStep> uvc_gadget_tree(const UvcConfig& c, const UvcStreamShape& shape) {
    std::vector<ConfigfsStep> steps;
    const auto folder = [&](const fs::path& path) {
        steps.push_back({ConfigfsStep::Kind::kFolder, path, "", false});
    };
    const auto file = [&](const fs::path& path, const std::string& content) {
        steps.push_back({ConfigfsStep::Kind::kFile, path, content, false});
    };
    const auto link = [&](const fs::path& path, const fs::path& target) {
        steps.push_back({ConfigfsStep::Kind::kLink, path, target.string(), false});
    };
    const auto try_file = [&](const fs::path& path, const std::string& content) {
        steps.push_back({ConfigfsStep::Kind::kFile, path, content, true});
    };

    folder(kGadget);
    file(kGadget / "idVendor", hex(c.vendor_id));
    file(kGadget / "idProduct", hex(c.product_id));
    // 0xEF: several interfaces form one function, as association descriptors say.
    file(kGadget / "bDeviceClass", "0xEF");
    file(kGadget / "bDeviceSubClass", "0x02");
    file(kGadget / "bDeviceProtocol", "0x01");
    folder(kGadget / "strings/0x409");
    file(kGadget / "strings/0x409/manufacturer", c.manufacturer);
    file(kGadget / "strings/0x409/product", c.product);
    file(kGadget / "strings/0x409/serialnumber", c.serial);

    folder(kUvc);
    file(kUvc / "streaming_maxpacket", std::to_string(c.packet_bytes));
    file(kUvc / "streaming_interval", "1");
    // Camera terminal: bit 1 automatic exposure, bit 3 exposure time. Processing unit: bit 0 brightness, bit
    // 9 gain. One byte per line. (Kernels before 6.4 refuse this and show the first of each.)
    try_file(kUvc / "control/terminal/camera/default/bmControls", "0x0a\n0\n0");
    try_file(kUvc / "control/processing/default/bmControls", "0x01\n0x02");

    const fs::path format = kUvc / "streaming/uncompressed/yuyv";  // YUYV is the kernel's default GUID
    const fs::path frame = format / "frame";
    folder(format);
    folder(frame);
    file(frame / "wWidth", std::to_string(shape.width));
    file(frame / "wHeight", std::to_string(shape.height));
    file(frame / "dwMaxVideoFrameBufferSize", std::to_string(shape.frame_bytes()));
    const auto bits_per_second = [&](std::uint32_t interval_100ns) {
        const double rate = 8e7 * shape.frame_bytes() / interval_100ns;
        return std::to_string(static_cast<std::uint32_t>(std::min(rate, 4294967295.0)));
    };
    file(frame / "dwMinBitRate", bits_per_second(shape.intervals_100ns.back()));
    file(frame / "dwMaxBitRate", bits_per_second(shape.intervals_100ns.front()));
    file(frame / "dwDefaultFrameInterval", std::to_string(shape.preset_100ns));
    std::string intervals;
    for (const std::uint32_t interval : shape.intervals_100ns)
        intervals.append(intervals.empty() ? "" : "\n").append(std::to_string(interval));
    file(frame / "dwFrameInterval", intervals);

    folder(kUvc / "streaming/header/h");
    link(kUvc / "streaming/header/h/yuyv", format);
    for (const char* speed : {"fs", "hs", "ss"})
        link(kUvc / "streaming/class" / speed / "h", kUvc / "streaming/header/h");
    folder(kUvc / "control/header/h");
    for (const char* speed : {"fs", "ss"})
        link(kUvc / "control/class" / speed / "h", kUvc / "control/header/h");

    const fs::path configuration = kGadget / "configs/c.1";
    folder(configuration);
    folder(configuration / "strings/0x409");
    file(configuration / "strings/0x409/configuration", "camera");
    link(configuration / "uvc.camera", kUvc);
    if (!c.command_function.empty()) {
        const std::string name = "ffs." + c.command_function;
        folder(kGadget / "functions" / name);
        link(configuration / name, kGadget / "functions" / name);
    }
    return steps;
}

std::vector<std::string> usb_device_controllers() {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/sys/class/udc", error))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

UvcGadget::UvcGadget(UvcConfig config, UvcStreamShape shape)
    : config_(std::move(config)), shape_(std::move(shape)), steps_(uvc_gadget_tree(config_, shape_)) {}

void UvcGadget::make() {
    const std::vector<std::string> controllers = usb_device_controllers();
    if (controllers.empty())
        throw DeviceError(
            "outputs.uvc: this machine has no USB device controller (/sys/class/udc is empty); boards that "
            "can "
            "be a USB device have one (Raspberry Pi 4 and Zero 2: dtoverlay=dwc2, BeagleBone, boards with "
            "dwc3 in "
            "peripheral mode), PCs have none");
    udc_ = config_.udc.empty() ? controllers.front() : config_.udc;
    if (std::find(controllers.begin(), controllers.end(), udc_) == controllers.end()) {
        std::string list;
        for (const std::string& name : controllers) list.append(list.empty() ? "" : ", ").append(name);
        throw DeviceError("outputs.uvc.udc: found " + in_quotes(udc_) + "; this machine has: " + list);
    }
    std::error_code error;
    if (!fs::is_directory(root(), error))
        throw DeviceError("outputs.uvc: " + root().string() +
                          " is missing; modprobe libcomposite, and mount -t configfs none " +
                          config_.configfs.string());
    if (fs::exists(root() / kGadget, error)) {
        made_ = true;
        remove();
    }
    for (const ConfigfsStep& step : steps_) {
        const fs::path path = root() / step.path;
        errno = 0;
        if (step.kind == ConfigfsStep::Kind::kFolder) {
            fs::create_directories(path, error);
            if (error) errno = error.value();
        } else if (step.kind == ConfigfsStep::Kind::kLink) {
            fs::create_symlink(root() / step.content, path, error);
            if (error) errno = error.value();
        } else {
            error.clear();
            if (!write_file(path, step.content)) error.assign(errno, std::system_category());
            if (step.optional) shows_exposure_ = !error;
        }
        if (!error || step.optional) continue;
        const std::string why = reason();
        made_ = true;
        remove();
        throw DeviceError("outputs.uvc: " + path.string() + " cannot be made: " + why +
                          (why == std::strerror(EACCES) || why == std::strerror(EPERM)
                               ? "; run as root, or make the gadget's folder writable"
                               : "; modprobe usb_f_uvc may be needed"));
    }
    made_ = true;
}

bool UvcGadget::bind() { return write_file(root() / kGadget / "UDC", udc_); }

void UvcGadget::remove() noexcept {
    if (!made_) return;
    made_ = false;
    write_file(root() / kGadget / "UDC", "");
    // Steps are undone in reverse order; the kernel's own files are removed with their folders.
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
        if (step->kind == ConfigfsStep::Kind::kLink) ::unlink((root() / step->path).c_str());
        if (step->kind == ConfigfsStep::Kind::kFolder) ::rmdir((root() / step->path).c_str());
    }
}

fs::path UvcGadget::video_device() const {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", error)) {
        const std::string real = fs::canonical(entry.path(), error).string();
        if (real.find("/" + udc_ + "/") != std::string::npos && real.find("/gadget") != std::string::npos)
            return "/dev" / entry.path().filename();
    }
    return {};
}

int UvcGadget::streaming_interface() const {
    std::ifstream in(root() / kUvc / "streaming/bInterfaceNumber");
    int number = 1;
    in >> number;
    return in ? number : 1;
}

}  // namespace hilcam
