#pragma once
// Takes the states of 42 over TCP, as its client or server, and acknowledges each of its steps.
//
// 42 stands still from the end of its message to the acknowledgement. In lockstep that comes when the frame
// for the message's instant is done, in other modes at once, and `hold_ms` after the message at the latest: a
// frame that is not done by then still comes, while a step that arrives in the meantime and cannot begin
// within its own `hold_ms` is dropped and counted. docs/42.md.
//
// Nothing is authenticated. One simulator at a time; a server answers the next one when the first has gone.

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "io/contract/command_receiver.h"
#include "io/ip42/ip42_sink.h"
#include "io/ip42/ip42_world.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// kClient: hilcam connects to 42, which has SERVER in its Inp_IPC.txt; kServer: the other way round.
enum class Ip42Role { kClient, kServer };

struct Ip42Config {
    Ip42Role role = Ip42Role::kClient;
    std::string address = "127.0.0.1";
    std::int64_t port = 10001;
    std::vector<std::string> allow{};
    double hold_s = 10;
    std::int64_t steps_per_frame = 1;
    std::vector<double> pole_rad{};  // right ascension and declination; empty: ICRF axes
    double tolerance_rad = kDegree_rad;
    bool stay = true;
    std::vector<Ip42BodyConfig> bodies{};
};
Fields fields(Ip42Config& config);
void validate(const Ip42Config& config);
// Returns the rotation from 42's frame N to ICRF axes for a world's pole.
Mat3d icrf_from_n(const std::vector<double>& pole_rad);

// Counters for the report. Any thread.
struct Ip42Counts {
    std::atomic<std::uint64_t> steps{0};          // messages, good or bad
    std::atomic<std::uint64_t> late_frames{0};    // acknowledged before they were done
    std::atomic<std::uint64_t> dropped_steps{0};  // without a frame, as an earlier one was not done
    std::atomic<std::uint64_t> skipped_lines{0};
};

struct Ip42Setup {
    Ip42Config config;
    Ip42Bench bench;
    bool lockstep = false;
    std::vector<Ip42Sink*> sinks;  // one for each camera; outlive the receiver
    std::shared_ptr<Ip42Counts> counts = std::make_shared<Ip42Counts>();
    std::function<void(std::int64_t ns)> held;       // takes the time for which 42 stood still
    std::function<void(const std::string&)> note;    // something that belongs into the log
    std::function<void(const std::string&)> remark;  // something that is wrong; on the receiver's threads
};

// handler: outlives the receiver.
std::unique_ptr<CommandReceiver> make_ip42_receiver(Ip42Setup setup, CommandHandler& handler);

}  // namespace hilcam
