#include "emulator/check/doctor_facts.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <thread>

#include "io/cache/cache.h"
#include "io/cache/cache_room.h"
#include "io/lines/gpio_pin.h"
#include "io/lines/pps_source.h"
#include "io/ptp/ptp_sockets.h"
#include "io/system/fd.h"
#include "io/system/net_interface.h"
#include "io/uvc/uvc_gadget.h"
#include "io/v4l2/v4l2_buffers.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kGvcpPort = 3956;

std::string first_line(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

std::uint64_t number_in(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    in >> value;
    return value;
}

std::uint64_t limit_of(decltype(RLIMIT_RTPRIO) which) {
    rlimit limit{};
    getrlimit(which, &limit);
    return limit.rlim_cur;
}

// Returns why a UDP port cannot be used, or an empty text.
std::string udp_fault(std::uint32_t address, std::uint16_t port) {
    try {
        open_udp(address, port);
        return "";
    } catch (const DeviceError& error) {
        return error.what();
    }
}

std::string port_fault(const BenchNeeds::Port& port) {
    const sockaddr_in where = parse_endpoint(port.endpoint);
    if (!port.tcp) return udp_fault(ntohl(where.sin_addr.s_addr), ntohs(where.sin_port));
    const Fd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const int on = 1;
    setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0) return "";
    return "TCP " + port.endpoint + ": " + std::strerror(errno);
}

// Returns why a PTP port cannot be opened, or an empty text.
std::string ptp_fault(const NetInterface& interface, PtpTransport transport) {
    try {
        PtpSockets(interface, transport);
        return "";
    } catch (const DeviceError& error) {
        return error.what();
    }
}

InterfaceFacts look_at_interface(const BenchNeeds::Gige& need) {
    InterfaceFacts facts;
    try {
        const NetInterface interface = find_interface(need.interface);
        facts.name = interface.name;
        facts.mtu_bytes = interface.mtu_bytes;
        std::ifstream in("/sys/class/net/" + interface.name + "/flags");
        std::uint64_t flags = 0;
        in >> std::hex >> flags;
        facts.multicast = (flags & IFF_MULTICAST) != 0;
        facts.port_fault = udp_fault(interface.address, kGvcpPort);
        if (need.ptp) facts.ptp_fault = ptp_fault(interface, *need.ptp);
    } catch (const InputError& error) {
        facts.fault = error.what();
    }
    return facts;
}

void look_at_processor(MachineFacts& m) {
    m.cores = static_cast<int>(std::thread::hardware_concurrency());
    m.governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    m.realtime_priority = limit_of(RLIMIT_RTPRIO);
    m.memory_lock_bytes = limit_of(RLIMIT_MEMLOCK);
    m.root = geteuid() == 0;
    utsname name{};
    uname(&name);
    m.kernel = name.release;
    m.confinement = confinement_here();
}

void look_at_network(const BenchNeeds& needs, MachineFacts& m) {
    m.receive_buffer_bytes = number_in("/proc/sys/net/core/rmem_max");
    m.send_buffer_bytes = number_in("/proc/sys/net/core/wmem_max");
    for (const BenchNeeds::Gige& need : needs.gige) m.interfaces.push_back(look_at_interface(need));
    for (const BenchNeeds::Port& port : needs.ports) m.port_faults.push_back(port_fault(port));
    for (const BenchNeeds::Wire& wire : needs.wires)
        m.wire_faults.push_back(wire.pps.empty() ? fault_of(wire.pin) : fault_of_pps(wire.pps));
    m.aravis_tools = fs::exists("/usr/bin/arv-camera-test-0.8") || fs::exists("/usr/bin/arv-tool-0.8");
}

VideoDevice look_at_device(const std::string& name) {
    VideoDevice device;
    const fs::path about = "/sys/class/video4linux/" + name;
    device.path = "/dev/" + name;
    device.label = first_line(about / "name");
    // Only v4l2loopback's devices report how many buffers are in use.
    device.buffers = static_cast<int>(number_in(about / "buffers"));
    const Fd fd(::open(device.path.c_str(), O_RDWR | O_CLOEXEC));
    device.openable = static_cast<bool>(fd);
    v4l2_capability capability{};
    if (!fd || v4l2_ioctl(fd.get(), VIDIOC_QUERYCAP, &capability) < 0) return device;
    const std::uint32_t can =
        capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
    device.loopback = std::string_view(reinterpret_cast<const char*>(capability.driver)) == "v4l2 loopback";
    device.takes_frames = (can & V4L2_CAP_VIDEO_OUTPUT) != 0;
    device.exclusive_caps = !(can & V4L2_CAP_VIDEO_OUTPUT) || !(can & V4L2_CAP_VIDEO_CAPTURE);
    return device;
}

void look_at_video(MachineFacts& m) {
    m.loopback = loaded_loopback_module();
    std::error_code error;
    const fs::path modules = "/lib/modules/" + m.kernel;
    const auto deep = fs::directory_options::skip_permission_denied;
    for (const char* folder : {"updates", "extra"})
        for (auto it = fs::recursive_directory_iterator(modules / folder, deep, error);
             it != fs::recursive_directory_iterator() && !error; it.increment(error))
            if (it->path().filename().string().starts_with("v4l2loopback.ko")) m.loopback_installed = true;
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", error))
        if (entry.path().filename().string().starts_with("video")) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) m.video.push_back(look_at_device(name));
}

void look_at_usb(MachineFacts& m) {
    std::error_code error;
    m.controllers = usb_device_controllers();
    m.configfs = fs::is_directory("/sys/kernel/config/usb_gadget", error);
    for (auto it = fs::recursive_directory_iterator("/dev/bus/usb", error);
         it != fs::recursive_directory_iterator() && !error; it.increment(error)) {
        if (!it->is_character_file(error)) continue;
        ++m.usb_devices;
        if (access(it->path().c_str(), R_OK | W_OK) == 0) ++m.usb_openable;
    }
}

void look_at_time(MachineFacts& m) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/dev", error))
        if (entry.path().filename().string().starts_with("pps")) m.pps.push_back(entry.path());
    std::sort(m.pps.begin(), m.pps.end());
    timex state{};
    m.clock_synchronised = adjtimex(&state) >= 0 && !(state.status & STA_UNSYNC);
    m.tai_offset_s = state.tai;
}

void look_at_cache_folder(MachineFacts& m) {
    const fs::path folder = cache_folder();
    m.cache = folder.string();
    m.cache_fault = mistrust_of(folder);
    const CacheSize size = cache_size(folder);
    m.cache_files = size.files;
    m.cache_bytes = size.bytes;
    try {
        m.cache_bound_bytes = cache_bound_bytes();
    } catch (const InputError& problem) {
        m.cache_fault = problem.what();
    }
}

}  // namespace

MachineFacts look_at_machine(const BenchNeeds& needs) {
    MachineFacts facts;
    look_at_processor(facts);
    look_at_network(needs, facts);
    look_at_video(facts);
    look_at_usb(facts);
    look_at_time(facts);
    look_at_cache_folder(facts);
    return facts;
}

}  // namespace hilcam
