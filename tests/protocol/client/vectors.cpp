// What hilcam's own codec makes of numbers, for client_test.py. Lines as vectors.c has them:
//
//     encode DIALECT CAMERA SEQUENCE FUNCTION NUMBERS...   a command's bytes
//     answer DIALECT APID COUNT NUMBERS...                 the bytes of an acknowledgement (the last word is
//     its
//                                                          reason's bytes) or of telemetry
//     judge BYTES                                          a command's status and, where it is accepted, what
//                                                          was understood, encoded again
//     faults                                               each kind's name and number
//     filter AT EXCHANGES...                               as vectors.c has it

#include <bit>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/commands/clock_filter.h"
#include "io/commands/command_dialect.h"

namespace {

using namespace hilcam;

struct Line {
    std::vector<std::uint64_t> numbers;
    std::string last;
    std::size_t at = 0;

    std::uint64_t u64() { return numbers.at(at++); }
    std::int64_t i64() { return static_cast<std::int64_t>(u64()); }
    double f64() { return std::bit_cast<double>(u64()); }
    template <class T>
    T as() {
        return static_cast<T>(u64());
    }
    Vec3d vec3() {
        const double x = f64(), y = f64(), z = f64();
        return {x, y, z};
    }
};

// The functions that are written out here are all that there are.
static_assert(std::variant_size_v<Command> == 12);
Command command_of(Line& in) {
    switch (in.u64()) {
        case 1: {
            PoseCommand pose;
            pose.object = in.as<std::uint16_t>();
            pose.motion.time.ns = in.i64();
            pose.motion.pose.position_world_m = in.vec3();
            pose.motion.velocity_world_m_s = in.vec3();
            Quat& q = pose.motion.pose.world_from_body;
            q.w = in.f64(), q.x = in.f64(), q.y = in.f64(), q.z = in.f64();
            pose.motion.rate_body_rad_s = in.vec3();
            return pose;
        }
        case 2: {
            SettingsCommand settings;
            const std::uint64_t mask = in.u64();
            const double exposure_s = in.f64(), gain_db = in.f64(), frame_rate_hz = in.f64();
            if (mask & 1) settings.exposure_s = exposure_s;
            if (mask & 2) settings.gain_db = gain_db;
            if (mask & 4) settings.frame_rate_hz = frame_rate_hz;
            return settings;
        }
        case 3:
            return StartCommand{};
        case 4:
            return StopCommand{};
        case 5:
            return PingCommand{in.u64()};
        case 6: {
            JointCommand joint;
            joint.object = in.as<std::uint16_t>();
            joint.joint = in.as<std::uint16_t>();
            joint.time.ns = in.i64();
            joint.angle_rad = in.f64();
            joint.rate_rad_s = in.f64();
            return joint;
        }
        case 7: {
            FaultCommand fault;
            fault.order.kind = in.as<FaultKind>();
            fault.clear_all = fault.order.kind == FaultKind{0};
            fault.order.rate = in.f64();
            fault.order.value = in.f64();
            fault.order.from_frame = in.u64();
            fault.order.frames = in.u64();
            fault.order.duration_s = in.f64();
            return fault;
        }
        case 8: {
            ExposeCommand expose;
            expose.frames = in.as<std::uint16_t>();
            expose.time.ns = in.i64();
            return expose;
        }
        case 9: {
            TriggerModeCommand mode;
            mode.triggered = in.u64() != 0;
            mode.burst_frames = in.as<std::uint16_t>();
            return mode;
        }
        case 11: {
            ClockCommand clock;
            clock.action = in.as<ClockCommand::Action>();
            clock.sender_ns = in.i64();
            clock.scale = in.f64();
            clock.step_ns = in.i64();
            return clock;
        }
        case 12: {
            LampCommand lamp;
            lamp.lamp = in.as<std::uint16_t>();
            lamp.time.ns = in.i64();
            lamp.level = in.f64();
            return lamp;
        }
        case 10: {
            const std::uint64_t mask = in.u64();
            return SubscribeCommand{(mask & 1) != 0, (mask & 2) != 0};
        }
        default:
            throw std::invalid_argument("no such function");
    }
}

DialectConfig dialect_of(std::uint64_t number) { return {number == 0 ? Dialect::kHilcam : Dialect::kCfs}; }

Acknowledgement acknowledgement_of(Line& in) {
    Acknowledgement a;
    a.function = in.as<std::uint8_t>();
    a.status = in.as<CommandStatus>();
    a.sequence = in.as<std::uint32_t>();
    a.token = in.u64();
    a.simulated_time.ns = in.i64();
    if (in.at < in.numbers.size()) {
        ClockReading& r = a.clock.emplace();
        r.arrival.ns = in.i64(), r.arrival_monotonic_ns = in.i64(), r.departure_monotonic_ns = in.i64();
        r.scale = in.f64();
        r.stands_at.ns = in.i64();
    }
    for (std::size_t i = 0; i + 1 < in.last.size(); i += 2)
        a.reason += static_cast<char>(std::stoul(in.last.substr(i, 2), nullptr, 16));
    return a;
}

FrameReport frame_report_of(Line& in) {
    FrameReport r;
    r.camera = in.as<std::uint8_t>();
    r.frame = in.u64();
    r.exposure_mid.ns = in.i64();
    r.exposure_mid_monotonic_ns = in.i64();
    r.exposure_s = in.f64(), r.gain_db = in.f64();
    r.pose_sequence = in.as<std::uint32_t>(), r.trigger_sequence = in.as<std::uint32_t>();
    r.pose_time.ns = in.i64();
    r.latency_ns = in.i64();
    r.faults = in.u64();
    r.quality_level = in.as<std::uint32_t>();
    return r;
}

HousekeepingFigures housekeeping_of(Line& in) {
    HousekeepingFigures h;
    h.mode = in.as<OperatingMode>();
    h.running = in.u64() != 0;
    h.simulated_time.ns = in.i64();
    h.monotonic_ns = in.i64();
    h.uptime_s = in.f64();
    h.frames = in.u64();
    h.frame_rate_hz = in.f64();
    h.deadline_misses = in.u64();
    h.commands_received = in.u64(), h.commands_refused = in.u64(), h.commands_lost = in.u64();
    h.latency_p50_s = in.f64(), h.latency_p99_s = in.f64();
    h.temperature_c = in.f64();
    h.active_faults = in.as<std::uint32_t>(), h.clients = in.as<std::uint32_t>();
    return h;
}

std::size_t encode(Line& in, std::span<std::uint8_t> bytes) {
    const DialectConfig dialect = dialect_of(in.u64());
    const auto camera = in.as<std::uint16_t>();
    const auto sequence = in.as<std::uint32_t>();
    return encode_command(command_of(in), sequence, dialect, bytes, camera);
}

std::size_t answer(Line& in, std::span<std::uint8_t> bytes) {
    const DialectConfig dialect = dialect_of(in.u64());
    const std::uint64_t apid = in.u64();
    const auto count = in.as<std::uint16_t>();
    if (apid == kAcknowledgeApid)
        return encode_acknowledgement(acknowledgement_of(in), count, dialect, bytes);
    const Telemetry telemetry =
        apid == kFrameReportApid ? Telemetry{frame_report_of(in)} : Telemetry{housekeeping_of(in)};
    return encode_telemetry(telemetry, count, dialect, bytes);
}

void print_judged(const std::string& digits) {
    std::vector<std::uint8_t> packet;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        packet.push_back(static_cast<std::uint8_t>(std::stoul(digits.substr(i, 2), nullptr, 16)));
    const DecodedCommand d = decode_command(packet, DialectConfig{});
    std::printf("%u ", static_cast<unsigned>(d.status));
    if (d.status == CommandStatus::kAccepted) {
        std::vector<std::uint8_t> bytes(kMaxPacketBytes);
        bytes.resize(encode_command(d.command, d.sequence, DialectConfig{}, bytes, d.camera));
        for (const std::uint8_t byte : bytes) std::printf("%02x", byte);
    }
    std::printf("\n");
}

void print_filtered(Line& in) {
    ClockFilter filter;
    const std::int64_t at_ns = in.i64();
    while (in.at < in.numbers.size()) {
        ClockExchange x;
        x.sent_ns = in.i64(), x.received_ns = in.i64();
        x.reading.arrival.ns = in.i64(), x.reading.arrival_monotonic_ns = in.i64();
        x.reading.departure.ns = in.i64(), x.reading.departure_monotonic_ns = in.i64();
        x.reading.scale = in.f64(), x.reading.stands_at.ns = in.i64();
        filter.take(x);
    }
    const auto estimate = filter.estimate(at_ns).value_or(ClockFilter::Estimate{});
    const TimeTai simulated = filter.simulated_at(at_ns).value_or(TimeTai{});
    for (const std::int64_t value : {estimate.offset_ns, estimate.delay_ns, simulated.ns})
        std::printf(" %llx", static_cast<unsigned long long>(value));
    std::printf("\n");
}

}  // namespace

int main() {
    std::string text;
    while (std::getline(std::cin, text)) {
        std::istringstream words(text);
        std::string verb, word;
        words >> verb;
        if (verb == "faults") {
            for (const FaultKind kind : kAllFaults)
                std::printf("%s:%u ", std::string(name_of(kind)).c_str(), static_cast<unsigned>(kind));
            std::printf("\n");
            continue;
        }
        if (verb == "judge") {
            words >> word;
            print_judged(word);
            continue;
        }
        Line line;
        const bool has_reason = text.find(" reason ") != std::string::npos;
        while (words >> word && word != "reason") line.numbers.push_back(std::stoull(word, nullptr, 16));
        if (has_reason) words >> line.last;
        if (verb == "filter") {
            print_filtered(line);
            continue;
        }
        std::vector<std::uint8_t> bytes(kMaxPacketBytes);
        bytes.resize(verb == "encode" ? encode(line, bytes) : answer(line, bytes));
        for (const std::uint8_t byte : bytes) std::printf("%02x", byte);
        std::printf("\n");
    }
}
