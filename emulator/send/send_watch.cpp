#include "emulator/send/send_watch.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "emulator/world/clock.h"
#include "io/commands/command_sender.h"
#include "io/contract/frame_flags.h"

namespace hilcam {
namespace {

// Period of renewal: over UDP a subscription ends a minute after the last packet from its sender.
constexpr std::int64_t kRenew_ns = 20'000'000'000;
constexpr int kWait_ms = 500;

std::string name_of(OperatingMode mode) {
    constexpr std::array<const char*, 3> kNames = {"free-run", "triggered", "lockstep"};
    const auto number = static_cast<std::size_t>(mode);
    return number < kNames.size() ? kNames[number] : "unknown mode";
}

std::string text(const FrameReport& r, bool several) {
    const std::string latency =
        r.latency_ns < 0 ? "no new pose"
                         : fmt::format("pose to frame {:.3f} ms", static_cast<double>(r.latency_ns) * 1e-6);
    return fmt::format(
        "{}frame {} mid-exposure {} exposure {:.3f} ms gain {:.2f} dB pose {} trigger {} {}{}{}",
        several ? fmt::format("camera {} ", r.camera) : "", r.frame, format_utc(r.exposure_mid),
        r.exposure_s * 1e3, r.gain_db, r.pose_sequence, r.trigger_sequence, latency,
        r.quality_level > 0 ? fmt::format(" quality {}", r.quality_level) : "",
        r.faults != 0 ? fmt::format(" faults {}", fmt::join(names_of_bits(r.faults), " ")) : "");
}

std::string text(const HousekeepingFigures& h) {
    return fmt::format(
        "camera {}{} up {:.1f} s, {} frames, {:.2f} frames/s, {} missed; {} commands, {} refused, {} lost; "
        "latency p50 {:.3f} ms p99 {:.3f} ms; {:.1f} C, {} faults, {} clients",
        name_of(h.mode), h.running ? "" : " paused", h.uptime_s, h.frames, h.frame_rate_hz, h.deadline_misses,
        h.commands_received, h.commands_refused, h.commands_lost, h.latency_p50_s * 1e3,
        h.latency_p99_s * 1e3, h.temperature_c, h.active_faults, h.clients);
}

nlohmann::json object_of(const FrameReport& r) {
    return {{"kind", "frame"},
            {"camera", r.camera},
            {"frame", r.frame},
            {"exposure_mid_tai_ns", r.exposure_mid.ns},
            {"exposure_mid_monotonic_ns", r.exposure_mid_monotonic_ns},
            {"exposure_s", r.exposure_s},
            {"gain_db", r.gain_db},
            {"pose_sequence", r.pose_sequence},
            {"pose_time_tai_ns", r.pose_time.ns},
            {"trigger_sequence", r.trigger_sequence},
            {"latency_ns", r.latency_ns},
            {"quality_level", r.quality_level},
            {"faults", names_of_bits(r.faults)}};
}

nlohmann::json object_of(const HousekeepingFigures& h) {
    return {{"kind", "housekeeping"},
            {"mode", name_of(h.mode)},
            {"running", h.running},
            {"simulated_time_tai_ns", h.simulated_time.ns},
            {"monotonic_ns", h.monotonic_ns},
            {"uptime_s", h.uptime_s},
            {"frames", h.frames},
            {"frame_rate_hz", h.frame_rate_hz},
            {"deadline_misses", h.deadline_misses},
            {"commands",
             {{"received", h.commands_received}, {"refused", h.commands_refused}, {"lost", h.commands_lost}}},
            {"latency_s", {{"p50", h.latency_p50_s}, {"p99", h.latency_p99_s}}},
            {"temperature_c", h.temperature_c},
            {"active_faults", h.active_faults},
            {"clients", h.clients}};
}

}  // namespace

std::string text_of(const Telemetry& telemetry, bool several) {
    const FrameReport* const report = std::get_if<FrameReport>(&telemetry);
    return report ? text(*report, several) : text(std::get<HousekeepingFigures>(telemetry));
}
std::string json_of(const Telemetry& telemetry) {
    return std::visit([](const auto& alternative) { return object_of(alternative).dump(); }, telemetry);
}

void add_watch_options(CLI::App& app, WatchOptions& o) {
    app.add_option("--duration-s", o.duration_s, "seconds until the end; left out: until Ctrl-C")
        ->check(CLI::Range(0.0, 1e9));
    app.add_option("--frames", o.frames, "end after this many frame reports");
    app.add_flag("--housekeeping", o.housekeeping_only, "print housekeeping alone, no frame reports");
    app.add_flag("--json", o.json, "print one JSON object a line");
}

int watch_telemetry(const SendTarget& target, const WatchOptions& o) {
    CommandSender sender(target.endpoint, target.dialect);
    const SubscribeCommand subscription{!o.housekeeping_only, true};
    const std::int64_t start_ns = monotonic_ns();
    std::int64_t renew_ns = start_ns;
    std::uint64_t frames = 0;
    bool several = false;  // set at the first report of a second camera
    while (true) {
        const std::int64_t now_ns = monotonic_ns();
        if (o.duration_s > 0 && static_cast<double>(now_ns - start_ns) * 1e-9 >= o.duration_s) return 0;
        if (now_ns >= renew_ns) {
            sender.send(subscription, target.timeout_ms);
            renew_ns = now_ns + kRenew_ns;
        }
        Telemetry telemetry;
        if (!sender.receive(telemetry, kWait_ms)) continue;
        const FrameReport* const report = std::get_if<FrameReport>(&telemetry);
        several = several || (report && report->camera > 1);
        fmt::print("{}\n", o.json ? json_of(telemetry) : text_of(telemetry, several));
        std::fflush(stdout);
        if (report && o.frames > 0 && ++frames >= o.frames) return 0;
    }
}

}  // namespace hilcam
