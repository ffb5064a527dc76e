#pragma once
// `hilcam doctor`: what a bench needs against what this machine has, and what to do about the difference.
// Pure: doctor_facts.h looks at the machine.

#include <cstdint>
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
    };
    struct V4l2 {
        std::string device;
        bool wide_bayer = false;  // a mosaic of more than 8 bits
    };
    struct Uvc {
        std::string udc;
    };
    // A port of this machine, "127.0.0.1:5010".
    struct Port {
        std::string key, endpoint;
        bool tcp = false;
    };
    // One for each camera that has such an output.
    std::vector<Gige> gige;
    std::vector<V4l2> v4l2;
    std::vector<Uvc> uvc;
    std::vector<Port> ports;
    std::uint64_t loop_priority = 0;  // loop.priority
};
BenchNeeds needs_of(const ScenarioConfig& scenario);

struct VideoDevice {
    std::string path;
    std::string label;
    bool loopback = false;  // it is a device of v4l2loopback
    bool openable = false;  // by this user
    bool takes_frames = false;
    bool exclusive_caps = false;
    int buffers = 0;  // that go round now; 0: not told
};

struct InterfaceFacts {
    std::string fault;  // why it is not there; then nothing else is known
    std::string name;
    std::uint32_t mtu_bytes = 0;
    bool multicast = true;
    std::string port_fault;  // why UDP 3956 cannot be had
};

struct MachineFacts {
    // Processor and rights.
    int cores = 1;
    std::string governor;                 // governor of the first core; empty: not told
    std::uint64_t realtime_priority = 0;  // RLIMIT_RTPRIO
    std::uint64_t memory_lock_bytes = 0;  // RLIMIT_MEMLOCK
    bool root = false;
    std::string kernel;  // release
    Confinement confinement;
    // Network.
    std::uint64_t receive_buffer_bytes = 0, send_buffer_bytes = 0;  // net.core.rmem_max, wmem_max
    std::vector<InterfaceFacts> interfaces;                         // for each of BenchNeeds::gige
    std::vector<std::string> port_faults;  // faults of BenchNeeds::ports; empty: it can be had
    bool aravis_tools = false;
    // V4L2.
    LoopbackModule loopback;
    bool loopback_installed = false;  // modprobe would find it
    std::vector<VideoDevice> video;
    // USB.
    std::vector<std::string> controllers;  // for being a device
    bool configfs = false;
    int usb_devices = 0, usb_openable = 0;
    // Remains of earlier runs (io/cache/cache.h).
    std::string cache;        // empty: there is no folder for them
    std::string cache_fault;  // why it cannot be trusted; empty: it can
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
    std::string advice;  // empty: nothing to do
};

// Returns findings in the order of topics above. A kProblem is something needed that is not there.
std::vector<Finding> diagnose(const BenchNeeds& needs, const MachineFacts& facts);
bool all_there(const std::vector<Finding>& findings);

std::string findings_text(const std::vector<Finding>& findings);
std::string findings_json(const std::vector<Finding>& findings);

}  // namespace hilcam
