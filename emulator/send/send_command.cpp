#include "emulator/send/send_command.h"

#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <memory>

#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/send/command_words.h"
#include "emulator/send/send_clock.h"
#include "emulator/send/send_fly.h"
#include "emulator/send/send_watch.h"
#include "io/commands/command_sender.h"
#include "io/system/input_file.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct SendOptions {
    SendTarget target;
    Command command;
    FlyOptions fly;
    WatchOptions watch;
    std::filesystem::path script;
};

// Returns a sequence number from the clock's nanoseconds, never 0. Reports name the command in a frame by its
// sequence number, and 0 means none. A program that sends a single command and ends thereby uses a number far
// from that of the program before it, so that no number in between counts as lost (sequence_window.h). The 14
// bits of cFS are too few for that.
std::uint32_t sequence_by_clock(Dialect dialect) {
    if (dialect == Dialect::kCfs) return 0;
    return static_cast<std::uint32_t>(std::chrono::system_clock::now().time_since_epoch().count() | 1);
}

int print(const Acknowledgement& a) {
    const bool good = a.status == CommandStatus::kAccepted;
    fmt::print("{} simulated time {}\n", text_of(a), format_utc(a.simulated_time));
    return good ? 0 : 1;
}

int send_one(const SendOptions& o) {
    if (const auto* clock = std::get_if<ClockCommand>(&o.command)) return send_clock(o.target, *clock);
    CommandSender sender(o.target.endpoint, o.target.dialect);
    sender.address(o.target.camera);
    sender.begin_at(sequence_by_clock(o.target.dialect.dialect));
    return print(sender.send(o.command, o.target.timeout_ms));
}

int list_faults() {
    for (const FaultKind kind : kAllFaults) fmt::print("{:<20} {}\n", name_of(kind), meaning_of(kind));
    return 0;
}

// Sends each line at its time; a late line is sent at once.
int play_script(const SendOptions& o) {
    const std::string text = read_input_file(o.script, {64u << 20, "a text file of commands"});
    const std::vector<ScriptLine> lines = parse_script(text, o.script.string());
    CommandSender sender(o.target.endpoint, o.target.dialect);
    sender.address(o.target.camera);
    const std::int64_t start_ns = monotonic_ns();
    std::size_t refused = 0;
    for (const ScriptLine& line : lines) {
        sleep_until_monotonic_ns(start_ns + static_cast<std::int64_t>(line.at_s * 1e9));
        const Acknowledgement a = sender.send(line.command, o.target.timeout_ms);
        if (a.status == CommandStatus::kAccepted) continue;
        ++refused;
        fmt::print("{}:{}: {}\n", harmless(o.script.string()), line.number, text_of(a));
    }
    fmt::print("{} commands sent, {} refused\n", lines.size(), refused);
    return refused == 0 ? 0 : 1;
}

void add_target(CLI::App& send, SendTarget& target) {
    send.add_option("--to", target.endpoint,
                    "address where the emulator listens: ADDRESS:PORT (UDP), tcp:ADDRESS:PORT, unix:PATH, "
                    "usb:VENDOR:PRODUCT[:SERIAL]")
        ->capture_default_str();
    add_choice<Dialect>(send, "--dialect", target.dialect.dialect,
                        {{"hilcam", Dialect::kHilcam}, {"cfs", Dialect::kCfs}}, "as the emulator's");
    send.add_option("--camera", target.camera,
                    "number of the camera for settings, triggers and faults, from 1; 0: every one");
    send.add_option("--timeout-ms", target.timeout_ms, "time to wait for an acknowledgement")
        ->check(CLI::Range(1, 600000));
}

}  // namespace

void add_send_command(CLI::App& app, std::function<int()>& action) {
    auto o = std::make_shared<SendOptions>();
    CLI::App* send = app.add_subcommand("send", "send commands to a running emulator");
    send->require_subcommand(1);
    add_target(*send, o->target);
    set_examples(send, {"hilcam send ping", "hilcam send settings --exposure-ms 5",
                        "hilcam send --to tcp:127.0.0.1:5010 watch", "hilcam send pose --help"});
    add_command_words(
        *send,
        [&action, o](const Command& command) {
            o->command = command;
            action = [o] { return send_one(*o); };
        },
        [&action] { action = list_faults; });
    CLI::App* fly = send->add_subcommand("fly", "fly on a circle around a point, looking at it");
    add_fly_options(*fly, o->fly);
    set_examples(fly, {"hilcam send fly --around-m 0 0 0 --from-m 40 0 0 --period-s 120"});
    fly->callback([&action, o] { action = [o] { return send_flight(o->target, o->fly); }; });
    CLI::App* watch = send->add_subcommand("watch", "print frame reports and housekeeping as they come");
    add_watch_options(*watch, o->watch);
    set_examples(watch, {"hilcam send watch"});
    watch->callback([&action, o] { action = [o] { return watch_telemetry(o->target, o->watch); }; });
    CLI::App* script = send->add_subcommand("script", "send the commands of a file, each at its time");
    script->add_option("file", o->script, "lines: [@SECONDS or +SECONDS] and a command as here")->required();
    set_examples(script, {"hilcam send script approach.txt"});
    script->callback([&action, o] { action = [o] { return play_script(*o); }; });
}

}  // namespace hilcam
