#pragma once
// `hilcam doctor`: compares what a bench needs with what this machine has, and says what to do about the
// difference. Pure functions; doctor_facts.h looks at the machine.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "io/system/confinement.h"
#include "io/v4l2/v4l2_module.h"

namespace hilcam {

// The needs of a scenario on a machine; empty: it has none.
struct BenchNeeds {
    struct Gige {
        std::string interface;
        std::int64_t packet_bytes = 0;
        double frame_bytes = 0;
        std::optional<PtpTransport> ptp{};  // its clock follows a PTP master
    };
    // A pin or a pulse per second of the machine, with what it is for: "lines.inputs.0".
    struct Wire {
        std::string key;
        PinConfig pin{};
        std::string pps{};  // empty: the pin
    };
    struct V4l2 {
        std::string device;
        bool wide_bayer = false;  // Bayer frames of more than 8 bits
    };
    struct Uvc {
        std::string udc;
    };
    // A port of this machine, "127.0.0.1:5010".
    struct Port {
        std::string key, endpoint;
        bool tcp = false;
    };
    // One entry for each camera with such an output.
    std::vector<Gige> gige;
    std::vector<V4l2> v4l2;
    std::vector<Uvc> uvc;
    std::vector<Port> ports;
    std::vector<Wire> wires;
    std::uint64_t loop_priority = 0;  // loop.priority
};
BenchNeeds needs_of(const ScenarioConfig& scenario);

struct VideoDevice {
    std::string path;
    std::string label;
    bool loopback = false;  // a v4l2loopback device
    bool openable = false;  // by this user
    bool takes_frames = false;
    bool exclusive_caps = false;
    int buffers = 0;  // buffers in use now; 0: unknown
};

struct InterfaceFacts {
    std::string fault;  // why the interface cannot be used; other members are then unknown
    std::string name;
    std::uint32_t mtu_bytes = 0;
    bool multicast = true;
    std::string port_fault;   // why UDP port 3956 cannot be used
    std::string ptp_fault{};  // why PTP cannot be received; empty: it can, or it is not needed
};

struct MachineFacts {
    // Processor and rights.
    int cores = 1;
    std::string governor;                 // the first core's; empty: unknown
    std::uint64_t realtime_priority = 0;  // RLIMIT_RTPRIO
    std::uint64_t memory_lock_bytes = 0;  // RLIMIT_MEMLOCK
    bool root = false;
    std::string kernel;  // kernel release
    Confinement confinement;
    // Network.
    std::uint64_t receive_buffer_bytes = 0, send_buffer_bytes = 0;  // net.core.rmem_max, wmem_max
    std::vector<InterfaceFacts> interfaces;                         // one for each entry of BenchNeeds::gige
    std::vector<std::string> port_faults;  // one for each entry of BenchNeeds::ports; empty: the port is free
    std::vector<std::string> wire_faults;  // one for each entry of BenchNeeds::wires; empty: it is there
    bool aravis_tools = false;
    // V4L2.
    LoopbackModule loopback;
    bool loopback_installed = false;  // modprobe finds the module
    std::vector<VideoDevice> video;
    // USB.
    std::vector<std::string> controllers;  // USB device controllers
    bool configfs = false;
    int usb_devices = 0, usb_openable = 0;
    // Files kept from earlier runs (io/cache/cache.h).
    std::string cache;        // empty: no folder for them exists
    std::string cache_fault;  // why the cache cannot be trusted; empty: it can
    std::size_t cache_files = 0;
    std::uint64_t cache_bytes = 0, cache_bound_bytes = 0;
    // Time.
    std::vector<std::string> pps;
    bool clock_synchronised = false;
    int tai_offset_s = 0;
};

struct Finding {
    enum class Level { kGood, kNote, kProblem } level;
    std::string topic;
    std::string found;
    std::string advice;  // empty: nothing needs to be done
};

// Returns the findings in the order of the topics above. kProblem: something that the bench needs is missing.
std::vector<Finding> diagnose(const BenchNeeds& needs, const MachineFacts& facts);
bool all_there(const std::vector<Finding>& findings);

std::string findings_text(const std::vector<Finding>& findings);
std::string findings_json(const std::vector<Finding>& findings);

}  // namespace hilcam
