#include "emulator/send_command.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <memory>

#include "emulator/clock.h"
#include "emulator/flight.h"
#include "io/command_sender.h"
#include "render/units.h"

namespace hilcam {
namespace {

struct SendOptions {
    std::string to = "127.0.0.1:5010";
    int timeout_ms = 1000;
    // pose
    unsigned object = 0;
    std::array<double, 3> position_m{}, velocity_m_s{}, rate_deg_s{}, look_at_m{}, up{0, 0, 1};
    std::array<double, 4> attitude{1, 0, 0, 0};
    bool looks = false;
    // joint
    unsigned joint = 1;
    double angle_deg = 0, joint_rate_deg_s = 0;
    // settings
    double exposure_ms = 0, gain_db = 0, frame_rate_hz = 0;
    // fly
    std::array<double, 3> around_m{}, from_m{0, -40, 0}, axis{0, 0, 1};
    double period_s = 60, rate_hz = 50, duration_s = 20;
};

Vec3d vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

int print(const Acknowledgement& a) {
    const bool good = a.status == CommandStatus::kAccepted;
    fmt::print("{}{}{} simulated time {}\n", name_of(a.status), a.reason.empty() ? "" : ": ", a.reason,
               format_utc(a.simulated_time));
    return good ? 0 : 1;
}

int send_one(const SendOptions& o, const Command& command) {
    return print(CommandSender(o.to).send(command, o.timeout_ms));
}

PoseCommand pose_of(const SendOptions& o) {
    PoseCommand command;
    command.object = static_cast<std::uint16_t>(o.object);
    Motion& m = command.motion;
    m.pose.position_world_m = vec(o.position_m);
    m.pose.world_from_body = {o.attitude[0], o.attitude[1], o.attitude[2], o.attitude[3]};
    if (o.looks) m.pose.world_from_body = look_along(vec(o.look_at_m) - vec(o.position_m), vec(o.up));
    m.velocity_world_m_s = vec(o.velocity_m_s);
    m.rate_body_rad_s = kDegree_rad * vec(o.rate_deg_s);
    return command;
}

// Poses with time tags, on the emulator's own simulated time.
int fly(const SendOptions& o) {
    CommandSender sender(o.to);
    CircleFlight flight;
    flight.center_m = vec(o.around_m), flight.start_m = vec(o.from_m), flight.axis = vec(o.axis),
    flight.up = vec(o.up);
    flight.period_s = o.period_s;
    const std::int64_t asked_ns = monotonic_now_ns();
    const Acknowledgement first = sender.send(PingCommand{}, o.timeout_ms);
    // The answer's clock reading lies half a round trip back.
    const std::int64_t start_ns = monotonic_now_ns();
    const SimulatedClock clock(first.simulated_time, asked_ns + (start_ns - asked_ns) / 2);
    std::vector<double> round_trips_ms;
    std::uint64_t accepted = 0, refused = 0;
    const auto count = static_cast<std::uint64_t>(o.duration_s * o.rate_hz);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::int64_t due_ns =
            start_ns + static_cast<std::int64_t>(static_cast<double>(i) / o.rate_hz * 1e9);
        sleep_until_monotonic_ns(due_ns);
        const std::int64_t now_ns = monotonic_now_ns();
        PoseCommand pose;
        pose.object = static_cast<std::uint16_t>(o.object);
        pose.motion = flight.at(static_cast<double>(now_ns - start_ns) * 1e-9, clock.at(now_ns));
        const Acknowledgement answer = sender.send(pose, o.timeout_ms);
        round_trips_ms.push_back(static_cast<double>(monotonic_now_ns() - now_ns) * 1e-6);
        ++(answer.status == CommandStatus::kAccepted ? accepted : refused);
    }
    std::sort(round_trips_ms.begin(), round_trips_ms.end());
    const auto quantile = [&](double q) {
        return round_trips_ms.empty() ? 0.0
                                      : round_trips_ms[static_cast<std::size_t>(
                                            q * static_cast<double>(round_trips_ms.size() - 1))];
    };
    fmt::print("{} poses sent, {} accepted, {} refused; round trip p50 {:.3f} ms, p99 {:.3f} ms\n", count,
               accepted, refused, quantile(0.5), quantile(0.99));
    return refused == 0 ? 0 : 1;
}

}  // namespace

void add_send_command(CLI::App& app, std::function<int()>& action) {
    auto options = std::make_shared<SendOptions>();
    CLI::App* send = app.add_subcommand("send", "send commands to a running emulator");
    send->require_subcommand(1);
    send->add_option("--to", options->to, "ADDRESS:PORT of the emulator")->capture_default_str();
    send->add_option("--timeout-ms", options->timeout_ms, "wait for an acknowledgement")
        ->check(CLI::Range(1, 600000));

    CLI::App* ping = send->add_subcommand("ping", "ask for the simulated time");
    ping->callback([&action, options] { action = [options] { return send_one(*options, PingCommand{1}); }; });
    CLI::App* start = send->add_subcommand("start", "let the camera take frames");
    start->callback(
        [&action, options] { action = [options] { return send_one(*options, StartCommand{}); }; });
    CLI::App* stop = send->add_subcommand("stop", "let the camera pause");
    stop->callback([&action, options] { action = [options] { return send_one(*options, StopCommand{}); }; });

    CLI::App* settings = send->add_subcommand("settings", "change exposure, gain, frame rate");
    CLI::Option* exposure = settings->add_option("--exposure-ms", options->exposure_ms);
    CLI::Option* gain = settings->add_option("--gain-db", options->gain_db);
    CLI::Option* rate = settings->add_option("--frame-rate-hz", options->frame_rate_hz);
    settings->callback([&action, options, exposure, gain, rate] {
        SettingsCommand command;
        if (exposure->count()) command.exposure_s = options->exposure_ms * 1e-3;
        if (gain->count()) command.gain_db = options->gain_db;
        if (rate->count()) command.frame_rate_hz = options->frame_rate_hz;
        action = [options, command] { return send_one(*options, command); };
    });

    CLI::App* pose = send->add_subcommand("pose", "one pose, true on arrival");
    pose->add_option("--object", options->object, "0: the camera; 1, 2, ...: the scenario's objects")
        ->check(CLI::Range(0, 65535));
    pose->add_option("--position-m", options->position_m, "x y z in the world")->required();
    CLI::Option* attitude = pose->add_option("--attitude", options->attitude, "w x y z, body to world");
    CLI::Option* look = pose->add_option("--look-at-m", options->look_at_m, "x y z, instead of an attitude")
                            ->excludes(attitude);
    pose->add_option("--up", options->up, "x y z, for --look-at-m");
    pose->add_option("--velocity-m-s", options->velocity_m_s, "x y z in the world");
    pose->add_option("--rate-deg-s", options->rate_deg_s, "x y z about the body axes");
    pose->callback([&action, options, look] {
        options->looks = look->count() > 0;
        action = [options] { return send_one(*options, pose_of(*options)); };
    });

    CLI::App* joint = send->add_subcommand("joint", "turn a part of an object, true on arrival");
    joint->add_option("--object", options->object, "1, 2, ...: the scenario's objects")
        ->required()
        ->check(CLI::Range(1, 65535));
    joint->add_option("--joint", options->joint, "1, 2, ...: its joints")->check(CLI::Range(1, 65535));
    joint->add_option("--angle-deg", options->angle_deg, "from the file's own state")->required();
    joint->add_option("--rate-deg-s", options->joint_rate_deg_s, "from then on");
    joint->callback([&action, options] {
        action = [options] {
            return send_one(*options, JointCommand{static_cast<std::uint16_t>(options->object),
                                                   static_cast<std::uint16_t>(options->joint),
                                                   {},
                                                   options->angle_deg * kDegree_rad,
                                                   options->joint_rate_deg_s * kDegree_rad});
        };
    });

    CLI::App* circle = send->add_subcommand("fly", "fly on a circle around a point, looking at it");
    circle->add_option("--object", options->object, "which thing flies; 0: the camera")
        ->check(CLI::Range(0, 65535));
    circle->add_option("--around-m", options->around_m, "x y z of the centre");
    circle->add_option("--from-m", options->from_m, "x y z of the start");
    circle->add_option("--axis", options->axis, "x y z of the circle's axis");
    circle->add_option("--up", options->up, "x y z that shall be up in the picture");
    circle->add_option("--period-s", options->period_s, "time of one round");
    circle->add_option("--rate-hz", options->rate_hz, "poses a second")->check(CLI::Range(0.1, 10000.0));
    circle->add_option("--duration-s", options->duration_s, "how long")->check(CLI::Range(0.0, 1e7));
    circle->callback([&action, options] { action = [options] { return fly(*options); }; });
}

}  // namespace hilcam
