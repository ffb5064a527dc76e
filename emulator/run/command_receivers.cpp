#include "emulator/run/command_receivers.h"

#include <spdlog/spdlog.h>

#include "emulator/loop/latency.h"

namespace hilcam {

std::vector<std::unique_ptr<CommandReceiver>> make_receivers(const CommandsConfig& c, CommandHandler& handler,
                                                             FaultBoard& faults) {
    std::vector<std::unique_ptr<CommandReceiver>> out;
    if (c.has_udp) out.push_back(std::make_unique<UdpCommandReceiver>(c.udp, handler));
    if (c.has_tcp) out.push_back(make_tcp_receiver(c.tcp, handler));
    if (c.has_unix) out.push_back(make_unix_receiver(c.unix_socket, handler));
    if (c.has_usb) out.push_back(make_usb_receiver(c.usb, handler, faults));
    if (c.has_functionfs) out.push_back(make_functionfs_receiver(c.functionfs, handler, faults));
    return out;
}

std::unique_ptr<CommandReceiver> make_vizard(const ScenarioConfig& scenario,
                                             const std::vector<std::unique_ptr<CameraStation>>& stations,
                                             CommandHandler& handler) {
    std::vector<VizardCameraPart> parts;
    for (const auto& station : stations) {
        const CameraModel& camera = station->scenario().camera;
        const auto [width, height] = array_size(camera);  // largest size of a frame
        auto sink =
            std::make_unique<VizardSink>("vizard camera " + std::to_string(station->number()), width, height);
        parts.push_back({sink.get(), station->settings().limits().color_pattern});
        station->add_sink(std::move(sink));
    }
    return make_vizard_receiver(scenario.commands.vizard, vizard_bench(scenario), std::move(parts), handler,
                                [](const std::string& text) { spdlog::warn("vizard: {}", text); });
}

std::unique_ptr<CommandReceiver> make_ip42(const ScenarioConfig& scenario,
                                           const std::vector<std::unique_ptr<CameraStation>>& stations,
                                           CommandHandler& handler) {
    Ip42Setup setup;
    setup.config = scenario.commands.ip42;
    setup.bench = ip42_bench(scenario);
    setup.lockstep = scenario.mode == CameraMode::kLockstep;
    const auto holds = std::make_shared<DurationHistogram>();
    setup.held = [holds](std::int64_t ns) { holds->record(ns); };
    setup.note = [](const std::string& text) { spdlog::info("ip42: {}", text); };
    setup.remark = [](const std::string& text) { spdlog::warn("ip42: {}", text); };
    const auto figures = [holds, counts = setup.counts] {
        return std::vector<std::pair<std::string, double>>{
            {"steps", static_cast<double>(counts->steps)},
            {"late_frames", static_cast<double>(counts->late_frames)},
            {"dropped_steps", static_cast<double>(counts->dropped_steps)},
            {"skipped_lines", static_cast<double>(counts->skipped_lines)},
            {"held_p50_ms", holds->quantile_ms(0.5)},
            {"held_p99_ms", holds->quantile_ms(0.99)},
            {"held_max_ms", holds->max_ms()},
        };
    };
    for (const auto& station : stations) {
        auto sink = std::make_unique<Ip42Sink>("ip42 camera " + std::to_string(station->number()), figures);
        if (setup.lockstep) setup.sinks.push_back(sink.get());
        station->add_sink(std::move(sink));
    }
    return make_ip42_receiver(std::move(setup), handler);
}

CommandReport report_of(const std::vector<std::unique_ptr<CommandReceiver>>& receivers) {
    CommandReport sum;
    for (const auto& receiver : receivers) sum += receiver->report();
    return sum;
}

}  // namespace hilcam
