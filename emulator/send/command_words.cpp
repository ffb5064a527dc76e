#include "emulator/send/command_words.h"

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <sstream>

#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/send/number_options.h"
#include "io/contract/fault.h"
#include "render/vocabulary/attitude.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Take = std::function<void(const Command&)>;

// Latest time of a script's lines: 30 years, which 64 bits hold in nanoseconds.
constexpr double kLatest_s = 1e9;

// Reports words that cannot become a command as the user's error.
template <class Make>
void hand_over(const CLI::App* app, const Take& take, const Make& make) {
    Command command;
    try {
        command = make();
    } catch (const InputError& error) {
        throw CLI::ValidationError(app->get_name(), error.what());
    }
    take(command);
}
template <class Make>
void on(CLI::App* app, const Take& take, Make make) {
    app->callback([app, take, make] { hand_over(app, take, make); });
}

Vec3d vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

void add_simple(CLI::App& app, const Take& take) {
    const auto add = [&](const char* name, const char* meaning, std::string_view example,
                         const Command& command) {
        CLI::App* sub = app.add_subcommand(name, meaning);
        sub->callback([take, command] { take(command); });
        set_examples(sub, {example});
    };
    add("ping", "ask for the simulated time", "hilcam send --to 127.0.0.1:5010 ping", PingCommand{1});
    add("start", "let the camera take frames", "hilcam send start", StartCommand{});
    add("stop", "let the camera pause", "hilcam send stop", StopCommand{});
}

void add_settings(CLI::App& app, const Take& take) {
    struct Options {
        double exposure_ms = 0, gain_db = 0, frame_rate_hz = 0;
    };
    CLI::App* settings = app.add_subcommand("settings", "change exposure, gain, frame rate");
    const auto o = std::make_shared<Options>();
    CLI::Option* exposure = settings->add_option("--exposure-ms", o->exposure_ms);
    CLI::Option* gain = settings->add_option("--gain-db", o->gain_db);
    CLI::Option* rate = settings->add_option("--frame-rate-hz", o->frame_rate_hz);
    set_examples(settings, {"hilcam send settings --exposure-ms 5 --gain-db 6"});
    on(settings, take, [=] {
        SettingsCommand command;
        if (exposure->count()) command.exposure_s = o->exposure_ms * 1e-3;
        if (gain->count()) command.gain_db = o->gain_db;
        if (rate->count()) command.frame_rate_hz = o->frame_rate_hz;
        return command;
    });
}

// An attitude in one of the forms that a scenario accepts as well (docs/conventions.md).
struct AttitudeOptions {
    std::array<double, 4> wxyz{1, 0, 0, 0};
    std::array<double, 3> mrp{}, euler_deg{}, radec_deg{};
    std::array<double, 9> dcm{};
    std::size_t sequence = 0;
};

// Adds options in the order of AttitudeOptions' forms: wxyz, mrp, dcm, euler, radec.
std::vector<CLI::Option*> add_attitudes(CLI::App& pose, AttitudeOptions& o) {
    std::vector<CLI::Option*> forms = {
        pose.add_option("--attitude", o.wxyz, "w x y z, body to world"),
        pose.add_option("--mrp", o.mrp, "x y z, instead: Basilisk's sigma_BN"),
        pose.add_option("--dcm", o.dcm, "nine numbers, instead: [BN] row by row"),
        pose.add_option("--euler-deg", o.euler_deg, "three angles, instead, with --sequence"),
        pose.add_option("--radec-deg", o.radec_deg,
                        "right ascension, declination, roll of a camera, instead"),
    };
    for (std::size_t i = 0; i < forms.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) forms[i]->excludes(forms[k]);
    std::vector<std::pair<std::string, std::size_t>> sequences;
    for (std::size_t i = 0; i < kEulerSequences.size(); ++i) sequences.emplace_back(kEulerSequences[i], i);
    CLI::Option* sequence = add_choice(pose, "--sequence", o.sequence, sequences, "the axes of --euler-deg");
    forms[3]->needs(sequence);
    sequence->needs(forms[3]);
    return forms;
}

Quat world_from_body(const AttitudeOptions& o, std::span<CLI::Option* const> forms) {
    if (forms[1]->count()) return from_mrp(vec(o.mrp));
    if (forms[2]->count()) {
        const std::array<double, 9>& m = o.dcm;
        const Mat3d dcm{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
        if (const double error = rotation_error(dcm); !(error <= kDcmTolerance))
            throw refused("--dcm", "a matrix that is off a rotation by " + std::to_string(error),
                          std::to_string(kDcmTolerance) + " or less");
        return from_dcm(dcm);
    }
    if (forms[3]->count()) return from_euler(euler_axes(o.sequence), kDegree_rad * vec(o.euler_deg));
    if (forms[4]->count()) {
        const Vec3d p = kDegree_rad * vec(o.radec_deg);
        if (!(std::abs(p.y) <= 0.5 * kPi))
            throw refused("--radec-deg", "a declination of " + std::to_string(o.radec_deg[1]), "-90 to 90");
        return from_radec({p.x, p.y, p.z});
    }
    return {o.wxyz[0], o.wxyz[1], o.wxyz[2], o.wxyz[3]};
}

void add_pose(CLI::App& app, const Take& take) {
    struct Options {
        unsigned object = 0;
        std::string utc;
        std::array<double, 3> position_m{}, velocity_m_s{}, rate_deg_s{}, look_at_m{}, up{0, 0, 1};
        AttitudeOptions attitude;
    };
    CLI::App* pose = app.add_subcommand("pose", "set one pose");
    const auto o = std::make_shared<Options>();
    pose->add_option("--object", o->object, "0: the camera; 1, 2, ...: the scenario's objects")
        ->check(CLI::Range(0, 65535));
    pose->add_option("--position-m", o->position_m, "x y z in the world")->required();
    const std::vector<CLI::Option*> attitudes = add_attitudes(*pose, o->attitude);
    CLI::Option* look = pose->add_option("--look-at-m", o->look_at_m, "x y z, instead of an attitude");
    for (CLI::Option* attitude : attitudes) look->excludes(attitude);
    pose->add_option("--up", o->up, "x y z, for --look-at-m")->needs(look);
    pose->add_option("--velocity-m-s", o->velocity_m_s, "x y z in the world");
    pose->add_option("--at-utc", o->utc, "simulated time at which it is true; left out: on arrival");
    pose->add_option("--rate-deg-s", o->rate_deg_s, "x y z about the body axes");
    set_examples(pose, {"hilcam send pose --position-m 40 27 13 --look-at-m 0 0 0",
                        "hilcam send pose --object 1 --position-m 0 0 0 --attitude 1 0 0 0"});
    on(pose, take, [=] {
        PoseCommand command;
        command.object = static_cast<std::uint16_t>(o->object);
        Motion& m = command.motion;
        if (!o->utc.empty()) m.time = parse_utc(o->utc);
        m.pose.position_world_m = vec(o->position_m);
        m.pose.world_from_body = world_from_body(o->attitude, attitudes);
        if (look->count())
            m.pose.world_from_body = look_along(vec(o->look_at_m) - vec(o->position_m), vec(o->up));
        m.velocity_world_m_s = vec(o->velocity_m_s);
        m.rate_body_rad_s = kDegree_rad * vec(o->rate_deg_s);
        return command;
    });
}

void add_joint(CLI::App& app, const Take& take) {
    struct Options {
        unsigned object = 1, joint = 1;
        double angle_deg = 0, rate_deg_s = 0;
        std::string utc;
    };
    CLI::App* joint = app.add_subcommand("joint", "turn a part of an object");
    const auto o = std::make_shared<Options>();
    joint->add_option("--object", o->object, "1, 2, ...: the scenario's objects")
        ->required()
        ->check(CLI::Range(1, 65535));
    joint->add_option("--joint", o->joint, "1, 2, ...: its joints")->check(CLI::Range(1, 65535));
    joint->add_option("--angle-deg", o->angle_deg, "angle from the file's own state")->required();
    joint->add_option("--rate-deg-s", o->rate_deg_s, "rate of turn from then on");
    joint->add_option("--at-utc", o->utc, "simulated time at which it is true; left out: on arrival");
    set_examples(joint, {"hilcam send joint --object 1 --joint 1 --angle-deg 30 --rate-deg-s 0.5"});
    on(joint, take, [=] {
        return JointCommand{static_cast<std::uint16_t>(o->object), static_cast<std::uint16_t>(o->joint),
                            o->utc.empty() ? TimeTai{} : parse_utc(o->utc), o->angle_deg * kDegree_rad,
                            o->rate_deg_s * kDegree_rad};
    });
}

void add_lamp(CLI::App& app, const Take& take) {
    struct Options {
        std::string what, utc;
        unsigned lamp = 1;
        double level = 1;
    };
    CLI::App* lamp = app.add_subcommand("lamp", "switch a lamp");
    const auto o = std::make_shared<Options>();
    lamp->add_option("what", o->what, "on or off")->required()->check(CLI::IsMember({"on", "off"}));
    lamp->add_option("--lamp", o->lamp, "1, 2, ...: the scenario's lamps")->check(CLI::Range(1, 65535));
    CLI::Option* level = lamp->add_option("--level", o->level, "on: share of its intensity, 0 to 1");
    lamp->add_option("--at-utc", o->utc, "simulated time of the switch; left out: on arrival");
    set_examples(lamp, {"hilcam send lamp on --lamp 1 --level 0.5", "hilcam send lamp off --lamp 1"});
    on(lamp, take, [=] {
        const bool off = o->what == "off";
        if (off && level->count()) throw InputError("'off' and --level do not go together");
        if (!(o->level >= 0 && o->level <= 1)) throw refused("--level", std::to_string(o->level), "0 to 1");
        return LampCommand{static_cast<std::uint16_t>(o->lamp),
                           o->utc.empty() ? TimeTai{} : parse_utc(o->utc), off ? 0 : o->level};
    });
}

void add_expose(CLI::App& app, const Take& take) {
    struct Options {
        unsigned frames = 0;
        std::string utc;
    };
    CLI::App* expose = app.add_subcommand("expose", "trigger a frame or a burst (triggered, lockstep)");
    const auto o = std::make_shared<Options>();
    expose->add_option("--frames", o->frames, "frames of the burst; 0: as the settings have it")
        ->check(CLI::Range(0, 65535));
    expose->add_option(
        "--at-utc", o->utc,
        "simulated time of the trigger, in lockstep of the exposure's middle; left out: now, in "
        "lockstep a frame period on");
    set_examples(expose, {"hilcam send expose --frames 3"});
    on(expose, take, [=] {
        return ExposeCommand{o->utc.empty() ? TimeTai{} : parse_utc(o->utc),
                             static_cast<std::uint16_t>(o->frames)};
    });
}

void add_clock(CLI::App& app, const Take& take) {
    struct Options {
        std::string what;
        double scale = 1, seconds = 0;
    };
    CLI::App* clock = app.add_subcommand("clock", "query or change simulated time");
    const auto o = std::make_shared<Options>();
    CLI::Option* what = clock->add_option("what", o->what, "pause, resume or step")
                            ->check(CLI::IsMember({"pause", "resume", "step"}));
    CLI::Option* scale =
        clock->add_option("--scale", o->scale, "simulated seconds in one of the machine's")->excludes(what);
    CLI::Option* seconds = clock->add_option("--seconds", o->seconds,
                                             "step: simulated time that goes by before it stands again");
    set_examples(
        clock, {"hilcam send clock", "hilcam send clock --scale 10", "hilcam send clock step --seconds 60"});
    on(clock, take, [=] {
        using Action = ClockCommand::Action;
        ClockCommand command;
        if (scale->count()) {
            command.action = Action::kScale;
            command.scale = o->scale;
            if (!(o->scale >= kMinClockScale && o->scale <= kMaxClockScale))
                throw refused("--scale", std::to_string(o->scale), "0.001 to 1000");
        }
        if (o->what == "pause") command.action = Action::kPause;
        if (o->what == "resume") command.action = Action::kResume;
        if (o->what == "step") command.action = Action::kStep;
        if ((command.action == Action::kStep) != (seconds->count() > 0))
            throw InputError("'step' and --seconds go together");
        if (command.action != Action::kStep) return command;
        if (!(o->seconds >= 1e-9 && o->seconds <= 1e7))
            throw refused("--seconds", std::to_string(o->seconds), "1e-9 to 1e7");
        command.step_ns = to_ns(o->seconds);
        return command;
    });
}

void add_mode(CLI::App& app, const Take& take) {
    struct Options {
        std::string mode;
        unsigned burst_frames = 0;
    };
    CLI::App* mode = app.add_subcommand("mode", "choose what starts a frame: the frame rate, or triggers");
    const auto o = std::make_shared<Options>();
    mode->add_option("mode", o->mode, "free_run or triggered")
        ->required()
        ->check(CLI::IsMember({"free_run", "free-run", "triggered"}));
    mode->add_option("--burst-frames", o->burst_frames, "frames of each trigger; left out: as it is")
        ->check(CLI::Range(1, 65535));
    set_examples(mode, {"hilcam send mode triggered --burst-frames 3", "hilcam send mode free_run"});
    on(mode, take, [=] {
        return TriggerModeCommand{o->mode == "triggered", static_cast<std::uint16_t>(o->burst_frames)};
    });
}

void add_fault(CLI::App& app, const Take& take, const std::function<void()>& list_faults) {
    struct Options {
        std::string name;
        FaultOrder order;
    };
    CLI::App* fault = app.add_subcommand("fault", "inject a fault");
    const auto o = std::make_shared<Options>();
    fault->add_option("name", o->name, "name of the fault; 'clear' ends all, 'list' prints their names")
        ->required();
    fault->add_option("--rate", o->order.rate,
                      "share of frames, packets or pixels that is struck, 0 to 1; 0 ends the fault");
    fault->add_option("--value", o->order.value,
                      "value of the fault; its meaning depends on the kind, see 'list'");
    fault->add_option("--from-frame", o->order.from_frame, "first frame that can be struck; 0: at once");
    fault->add_option("--frames", o->order.frames, "number of frames; 0: no end");
    fault->add_option("--duration-s", o->order.duration_s, "duration; 0: no end");
    const auto make = [o] {
        FaultCommand command{o->order, o->name == "clear"};
        if (command.clear_all) return command;
        const std::optional<FaultKind> kind = fault_named(o->name);
        if (!kind)
            throw InputError("found " + in_quotes(o->name) +
                             "; accepted: clear, or a fault's name ('hilcam send fault list')");
        command.order.kind = *kind;
        const std::string_view refusal = refusal_of(command.order);
        if (!refusal.empty()) throw InputError(o->name + ": " + std::string(refusal));
        return command;
    };
    set_examples(fault,
                 {"hilcam send fault list", "hilcam send fault packet_drop --rate 0.01 --duration-s 10",
                  "hilcam send fault clear"});
    fault->callback([=] {
        if (list_faults && o->name == "list") return list_faults();
        hand_over(fault, take, make);
    });
}

// Reads "@2.5" or "+0.1" before a line's words; false when there is none.
bool read_time(const std::string& word, double before_s, double& at_s) {
    if (word.empty() || (word[0] != '@' && word[0] != '+')) return false;
    std::size_t end = 0;
    double value = 0;
    try {
        value = std::stod(word.substr(1), &end);
    } catch (const std::exception&) {
        end = 0;
    }
    at_s = word[0] == '@' ? value : before_s + value;
    if (end + 1 != word.size() || !(value >= 0) || !(at_s <= kLatest_s))
        throw InputError("found " + in_quotes(word) +
                         "; accepted: @SECONDS since the start or +SECONDS since the line before, up to 1e9");
    if (at_s < before_s) throw InputError("its time " + word + " is before the time of the previous line");
    return true;
}

}  // namespace

void add_command_words(CLI::App& app, const Take& take, const std::function<void()>& list_faults) {
    add_simple(app, take);
    add_settings(app, take);
    add_pose(app, take);
    add_joint(app, take);
    add_lamp(app, take);
    add_expose(app, take);
    add_mode(app, take);
    add_clock(app, take);
    add_fault(app, take, list_faults);
}

Command command_of_words(const std::string& words) {
    CLI::App app;
    app.require_subcommand(1);
    app.set_help_flag();
    Command command;
    add_command_words(app, [&](const Command& c) { command = c; });
    read_numbers_strictly(app);
    try {
        app.parse(words, false);
    } catch (const CLI::ParseError&) {
        if (const std::string what = unknown_subcommand(app); !what.empty()) throw InputError(what);
        throw;
    }
    return command;
}

std::vector<ScriptLine> parse_script(const std::string& text, const std::string& name) {
    std::vector<ScriptLine> out;
    std::istringstream in(text);
    std::string line;
    double before_s = 0;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        line.erase(std::min(line.find('#'), line.size()));
        std::istringstream words(line);
        std::string first;
        if (!(words >> first)) continue;
        ScriptLine entry{before_s, {}, number};
        try {
            std::string rest = line;
            if (read_time(first, before_s, entry.at_s)) std::getline(words, rest);
            entry.command = command_of_words(rest);
        } catch (const std::exception& error) {
            throw InputError(name + ":" + std::to_string(number) + ": " + error.what());
        }
        before_s = entry.at_s;
        out.push_back(entry);
    }
    return out;
}

}  // namespace hilcam
