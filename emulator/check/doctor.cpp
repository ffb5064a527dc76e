#include "emulator/check/doctor.h"
#include "render/vocabulary/quoted.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace hilcam {
namespace {

using Level = Finding::Level;

class Findings {
  public:
    void good(std::string topic, std::string found) { add(Level::kGood, topic, found, ""); }
    void note(std::string topic, std::string found, std::string advice) {
        add(Level::kNote, topic, found, std::move(advice));
    }
    void problem(std::string topic, std::string found, std::string advice) {
        add(Level::kProblem, topic, found, std::move(advice));
    }
    // A missing part is a problem if the scenario needs it, otherwise a note.
    void lacking(bool needed, std::string topic, std::string found, std::string advice) {
        add(needed ? Level::kProblem : Level::kNote, topic, found, std::move(advice));
    }
    std::vector<Finding> take() { return std::move(list_); }

  private:
    void add(Level level, std::string& topic, std::string& found, std::string advice) {
        list_.push_back({level, std::move(topic), std::move(found), std::move(advice)});
    }
    std::vector<Finding> list_;
};

constexpr double kMegabyte = 1e6;
constexpr std::uint64_t kLoopPriority = 50;  // leaves room for the loop's threads below the kernel's own

void look_at_processor(const BenchNeeds& n, const MachineFacts& m, Findings& out) {
    const std::string cores = fmt::format("{} cores, Linux {}", m.cores, m.kernel);
    if (m.cores < 4)
        out.note("processor", cores,
                 "rendering, sensing, sinks and a client share them; four or more keep rates steady");
    else
        out.good("processor", cores);
    if (m.governor.empty() || m.governor == "performance")
        out.good("governor", m.governor.empty() ? "not reported (a virtual machine, or fixed)" : m.governor);
    else
        out.note("governor", m.governor, "cpupower frequency-set -g performance keeps frame times even");
    if (m.realtime_priority < std::max(kLoopPriority, n.loop_priority) && !m.root)
        out.lacking(m.realtime_priority < n.loop_priority, "real-time rights",
                    fmt::format("rtprio limit {}", m.realtime_priority),
                    "in /etc/security/limits.d/hilcam.conf: '@video - rtprio 80' and '@video - memlock "
                    "unlimited'; then log "
                    "in again");
    else
        out.good("real-time rights", m.root ? "root" : fmt::format("rtprio limit {}", m.realtime_priority));
}

// The kernel's means that confine readers of meshes, pictures and maps in case a file exploits one of them.
void look_at_confinement(const MachineFacts& m, Findings& out) {
    const std::string found = (m.confinement.landlock > 0 ? fmt::format("Landlock {}", m.confinement.landlock)
                                                          : std::string("no Landlock")) +
                              (m.confinement.seccomp ? ", seccomp" : ", no seccomp");
    if (m.confinement.landlock > 0 && m.confinement.seccomp) return out.good("confinement", found);
    out.note("confinement", found,
             "untrusted files are read with less protection (SECURITY.md); Linux 5.13 or later has both, "
             "with 'landlock' among the kernel's lsm= where that is set");
}

void look_at_interface(const BenchNeeds::Gige& need, const InterfaceFacts& i, const MachineFacts& m,
                       Findings& out) {
    if (!i.fault.empty())
        return out.problem("gige interface", i.fault, "set outputs.gige.interface to one of them");
    if (need.packet_bytes > i.mtu_bytes)
        out.problem(
            "gige interface",
            fmt::format("{} carries {} bytes, outputs.gige.packet_bytes is {}", i.name, i.mtu_bytes,
                        need.packet_bytes),
            fmt::format("ip link set {} mtu 9000 on both ends, or packet_bytes: {}", i.name, i.mtu_bytes));
    else
        out.good("gige interface",
                 fmt::format("{} on {}, {} bytes a packet", need.interface, i.name, i.mtu_bytes));
    if (!i.multicast && i.name != "lo")
        out.note("multicast", i.name + " has none", "ip link set " + i.name + " multicast on");
    if (i.port_fault.empty())
        out.good("gige port", "UDP 3956 is free");
    else
        out.problem("gige port", i.port_fault, "one GigE Vision device fits on an address");
    if (need.ptp && i.ptp_fault.empty())
        out.good("ptp", *need.ptp == PtpTransport::kUdp
                            ? "UDP 319 and 320 on " + i.name + " can be opened"
                            : "Ethernet messages on " + i.name + " can be received");
    else if (need.ptp)
        out.problem("ptp", i.ptp_fault, "without it the camera goes on with PtpStatus Faulty");
    // A client on this machine needs buffer space for two frames; the kernel counts some 768 bytes more than
    // each packet has.
    const double each = static_cast<double>(std::max<std::int64_t>(1, need.packet_bytes));
    const double wanted = 2 * need.frame_bytes * (1 + 768 / each);
    const std::string room = fmt::format("receive {:.1f} MB, send {:.1f} MB at most",
                                         static_cast<double>(m.receive_buffer_bytes) / kMegabyte,
                                         static_cast<double>(m.send_buffer_bytes) / kMegabyte);
    if (static_cast<double>(m.receive_buffer_bytes) < wanted)
        out.note("socket buffers", room,
                 fmt::format("where the client runs: sysctl -w net.core.rmem_max={:.0f} (two frames)",
                             std::max(wanted, 33554432.0)));
    else
        out.good("socket buffers", room);
}

void look_at_network(const BenchNeeds& n, const MachineFacts& m, Findings& out) {
    for (std::size_t i = 0; i < n.gige.size() && i < m.interfaces.size(); ++i)
        look_at_interface(n.gige[i], m.interfaces[i], m, out);
    for (std::size_t i = 0; i < n.ports.size() && i < m.port_faults.size(); ++i) {
        const BenchNeeds::Port& port = n.ports[i];
        if (m.port_faults[i].empty())
            out.good("port", fmt::format("{} {} is free", port.tcp ? "TCP" : "UDP", port.endpoint));
        else
            out.problem("port", m.port_faults[i], "stop that program, or set " + port.key);
    }
    if (m.aravis_tools)
        out.good("aravis", "its tools are installed");
    else
        out.note("aravis", "its tools are not installed",
                 "apt install aravis-tools aravis-tools-cli, to look at the camera");
}

void look_at_loopback_device(const BenchNeeds::V4l2& need, const MachineFacts& m, Findings& out) {
    const auto device = std::find_if(m.video.begin(), m.video.end(),
                                     [&](const VideoDevice& v) { return v.path == need.device; });
    if (device == m.video.end()) {
        std::string others;
        for (const VideoDevice& v : m.video)
            if (v.loopback) others.append(others.empty() ? "" : ", ").append(v.path);
        return out.problem(
            "v4l2 device",
            need.device + " is not there" + (others.empty() ? std::string() : "; v4l2loopback has " + others),
            "modprobe v4l2loopback video_nr=" +
                need.device.substr(std::min(need.device.size(), std::size_t{10})) +
                " card_label=hilcam exclusive_caps=1 max_buffers=4, or set outputs.v4l2.device");
    }
    if (!device->openable)
        return out.problem("v4l2 device", need.device + " may not be opened by this user",
                           "usermod -aG video USER, then log in again");
    if (!device->takes_frames)
        return out.problem("v4l2 device",
                           need.device + " accepts no frames: another program feeds it, or it is a camera",
                           "stop that program (fuser -v " + need.device + "), or set outputs.v4l2.device");
    if (!device->exclusive_caps)
        out.note("v4l2 device", need.device + " says that it is an output and a camera at once",
                 "browsers and others refuse such a device: load the module with exclusive_caps=1");
    if (device->buffers == 1 || device->buffers == 2)
        out.note("v4l2 device", fmt::format("{} has {} buffers", need.device, device->buffers),
                 "a slow reader sees frames change while it reads them: load the module with max_buffers=4 "
                 "(before 0.14 a reader that asked for fewer limits them until the module is reloaded)");
    out.good("v4l2 device", need.device + " " + in_quotes(device->label));
}

void look_at_v4l2(const BenchNeeds& n, const MachineFacts& m, Findings& out) {
    const bool needed = !n.v4l2.empty();
    const bool wide_bayer =
        std::any_of(n.v4l2.begin(), n.v4l2.end(), [](const auto& v) { return v.wide_bayer; });
    if (!m.loopback.loaded) {
        out.lacking(
            needed, "v4l2loopback", m.loopback_installed ? "installed, not loaded" : "not installed",
            m.loopback_installed
                ? "modprobe v4l2loopback video_nr=42 card_label=hilcam exclusive_caps=1 max_buffers=4"
                : "apt install v4l2loopback-dkms linux-headers-amd64 (with secure boot: sign the module)");
        return;
    }
    if (m.loopback.shared_queue() && wide_bayer)
        out.problem("v4l2loopback", m.loopback.name() + " has no Bayer formats above 8 bits",
                    "install 0.14 or later, or set outputs.v4l2.format to BAYER8 or Y16");
    else if (m.loopback.shared_queue())
        out.note(
            "v4l2loopback", "version " + m.loopback.name(),
            "has one queue for all readers: prefer io: mmap (with io: write a reader that starts at a bad "
            "moment can "
            "crash the kernel)" +
                std::string(m.loopback.counts_mapped_frames()
                                ? ""
                                : "; frames are not counted in mmap mode: metadata_row gives their ids") +
                "; 0.14 and later are free of this");
    else
        out.good("v4l2loopback", "version " + m.loopback.name());
    for (const BenchNeeds::V4l2& need : n.v4l2) look_at_loopback_device(need, m, out);
}

void look_at_usb(const BenchNeeds& n, const MachineFacts& m, Findings& out) {
    const bool needed = !n.uvc.empty();
    const auto absent = std::find_if(n.uvc.begin(), n.uvc.end(), [&](const BenchNeeds::Uvc& need) {
        return !need.udc.empty() &&
               std::find(m.controllers.begin(), m.controllers.end(), need.udc) == m.controllers.end();
    });
    if (m.controllers.empty())
        out.lacking(
            needed, "usb device side", "no USB device controller (/sys/class/udc is empty)",
            needed ? "use a board that has one (Raspberry Pi 4 with dtoverlay=dwc2, dwc3 in peripheral mode)"
                   : "only needed for outputs.uvc and for commands from a USB host");
    else if (absent != n.uvc.end())
        out.problem(
            "usb device side",
            fmt::format("no controller '{}'; there is {}", absent->udc, fmt::join(m.controllers, ", ")),
            "set outputs.uvc.udc");
    else if (needed && !m.configfs)
        out.problem("usb device side", "configfs has no usb_gadget",
                    "modprobe libcomposite; mount -t configfs none /sys/kernel/config");
    else if (needed && !m.root)
        out.problem("usb device side", "making a gadget takes root's rights", "run hilcam as root");
    else
        out.good("usb device side", fmt::format("{}", fmt::join(m.controllers, ", ")));
    const std::string host =
        fmt::format("{} devices, {} of them open to this user", m.usb_devices, m.usb_openable);
    if (m.usb_openable < m.usb_devices)
        out.note("usb host side", host,
                 "for commands from a USB device: a udev rule 'SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1209\", "
                 "MODE=\"0660\", "
                 "GROUP=\"plugdev\"'");
    else
        out.good("usb host side", host);
}

void look_at_time(const MachineFacts& m, Findings& out) {
    if (m.clock_synchronised)
        out.good("clock", "synchronised");
    else
        out.note("clock", "not synchronised",
                 "chrony or ptp4l with phc2sys, when frames are compared across machines");
    if (m.tai_offset_s == 0)
        out.note("tai", "the kernel's TAI offset is 0", "ptp4l sets it; chrony with 'leapsectz right/UTC'");
    else
        out.good("tai", fmt::format("TAI - UTC = {} s", m.tai_offset_s));
    out.good("pps",
             m.pps.empty()
                 ? "none, and none is required; with one, chrony can lock the clock to a receiver's pulse"
                 : fmt::format("{}", fmt::join(m.pps, ", ")));
}

void look_at_wires(const BenchNeeds& n, const MachineFacts& m, Findings& out) {
    for (std::size_t i = 0; i < n.wires.size() && i < m.wire_faults.size(); ++i) {
        const BenchNeeds::Wire& wire = n.wires[i];
        const std::string what =
            wire.pps.empty() ? fmt::format("{} pin {}", wire.pin.gpio, wire.pin.pin) : wire.pps;
        if (m.wire_faults[i].empty())
            out.good("line", what);
        else
            out.problem("line", m.wire_faults[i], "set " + wire.key + " to one that is there");
    }
}

void look_at_cache(const MachineFacts& m, Findings& out) {
    if (m.cache.empty())
        return out.note("cache", "no folder: slow preparations are repeated at each start",
                        "a folder in HILCAM_CACHE, or HOME");
    if (!m.cache_fault.empty())
        return out.problem("cache", m.cache_fault, "each command that uses the cache refuses it");
    out.good("cache", fmt::format("{}: {} files, {:.0f} MB of at most {:.0f} MB (HILCAM_CACHE_MB)", m.cache,
                                  m.cache_files, static_cast<double>(m.cache_bytes) / kMegabyte,
                                  static_cast<double>(m.cache_bound_bytes) / kMegabyte));
}

const char* word_of(Level level) {
    return level == Level::kGood ? "good" : level == Level::kNote ? "note" : "problem";
}

}  // namespace

BenchNeeds needs_of(const ScenarioConfig& scenario) {
    BenchNeeds needs;
    const auto port = [&](std::string key, const std::string& address, std::int64_t number, bool tcp) {
        needs.ports.push_back({std::move(key), fmt::format("{}:{}", address, number), tcp});
    };
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const ScenarioConfig s = scenario_of_camera(scenario, i);
        const OutputsConfig& o = s.outputs;
        const auto [width, height] = frame_size(s.camera);
        const double frame_bytes = static_cast<double>(width) * height * (s.camera.frame_bits() > 8 ? 2 : 1);
        if (const auto* gige = o.find<GigeConfig>()) {
            needs.gige.push_back({gige->interface, gige->packet_bytes, frame_bytes});
            if (gige->clock.source == ClockSource::kPtp) needs.gige.back().ptp = gige->clock.transport;
        }
        if (const auto* v4l2 = o.find<V4l2Config>())
            needs.v4l2.push_back(
                {v4l2->device, v4l2->format == V4l2Format::kBayer10 || v4l2->format == V4l2Format::kBayer12});
        if (const auto* uvc = o.find<UvcConfig>()) needs.uvc.push_back({uvc->udc});
        // The port of GigE Vision is checked together with its interface.
        for (const ListeningPort& own : listening(o))
            if (own.tcp && own.port != 0) port(own.key, own.address, own.port, true);
    }
    needs.loop_priority = static_cast<std::uint64_t>(scenario.loop.real_time.priority);
    const CommandsConfig& c = scenario.commands;
    if (c.has_udp) port("commands.udp.port", c.udp.address, c.udp.port, false);
    if (c.has_tcp) port("commands.tcp.port", c.tcp.address, c.tcp.port, true);
    if (c.has_ip42 && c.ip42.role == Ip42Role::kServer)
        port("commands.ip42.port", c.ip42.address, c.ip42.port, true);
    for (std::size_t i = 0; i < scenario.lines.inputs.size(); ++i) {
        const LineInputConfig& input = scenario.lines.inputs[i];
        if (!input.pin.gpio.empty() || !input.pps.empty())
            needs.wires.push_back({fmt::format("lines.inputs.{}", i), input.pin, input.pps});
    }
    for (std::size_t i = 0; i < scenario.lines.outputs.size(); ++i)
        if (const PinConfig& pin = scenario.lines.outputs[i].pin; !pin.gpio.empty())
            needs.wires.push_back({fmt::format("lines.outputs.{}", i), pin});
    if (const auto& udp = scenario.lines.udp) port("lines.udp.port", udp->address, udp->port, false);
    return needs;
}

std::vector<Finding> diagnose(const BenchNeeds& needs, const MachineFacts& facts) {
    Findings out;
    look_at_processor(needs, facts, out);
    look_at_confinement(facts, out);
    look_at_network(needs, facts, out);
    look_at_v4l2(needs, facts, out);
    look_at_usb(needs, facts, out);
    look_at_wires(needs, facts, out);
    look_at_cache(facts, out);
    look_at_time(facts, out);
    return out.take();
}

bool all_there(const std::vector<Finding>& findings) {
    return std::none_of(findings.begin(), findings.end(),
                        [](const Finding& f) { return f.level == Level::kProblem; });
}

std::string findings_text(const std::vector<Finding>& findings) {
    std::string text;
    for (const Finding& f : findings) {
        text += fmt::format("{:<8} {:<17} {}\n", word_of(f.level), f.topic, f.found);
        if (!f.advice.empty()) text += fmt::format("{:<8} {:<17} -> {}\n", "", "", f.advice);
    }
    return text;
}

std::string findings_json(const std::vector<Finding>& findings) {
    nlohmann::json list = nlohmann::json::array();
    for (const Finding& f : findings)
        list.push_back(
            {{"topic", f.topic}, {"level", word_of(f.level)}, {"found", f.found}, {"advice", f.advice}});
    return nlohmann::json{{"ok", all_there(findings)}, {"findings", list}}.dump(2) + "\n";
}

}  // namespace hilcam
