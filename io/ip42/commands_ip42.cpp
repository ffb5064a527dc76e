#include "io/ip42/commands_ip42.h"

#include <poll.h>
#include <sys/socket.h>
#include <array>
#include <cerrno>
#include <mutex>
#include <thread>

#include "io/ip42/bounded_worker.h"
#include "io/ip42/ip42_peer.h"
#include "io/ip42/ip42_stream.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

constexpr std::array<char, 4> kAcknowledgement = {'A', 'c', 'k', '\0'};
// Longest time from the accepted `expose` to the published frame.
constexpr std::int64_t kPatience_ns = 60 * kSecond_ns;
constexpr std::int64_t kStopStep_ns = kSecond_ns / 20;
constexpr std::uint64_t kMostFarewells = 10;  // the largest number that is named

const char* reason_of(CommandStatus status) {
    switch (status) {
        case CommandStatus::kBusy:
            return "the camera is busy, or took too long";
        case CommandStatus::kNotNow:
            return "the camera is stopped, or has taken all its frames";
        case CommandStatus::kTimeBackwards:
            return "its time is before that of the last one (commands.poses.backwards)";
        default:
            return "its values are out of bounds";
    }
}

class Ip42Receiver : public CommandReceiver {
  public:
    Ip42Receiver(Ip42Setup setup, CommandHandler& handler)
        : setup_(std::move(setup)),
          handler_(handler),
          peer_({setup_.config.role == Ip42Role::kServer, setup_.config.address,
                 static_cast<std::uint16_t>(setup_.config.port), setup_.config.allow}),
          remarks_(setup_.remark),
          world_({setup_.config.bodies, icrf_from_n(setup_.config.pole_rad), setup_.config.tolerance_rad,
                  setup_.lockstep},
                 setup_.bench, remarks_) {}
    ~Ip42Receiver() override { stop(); }

    void start() override;
    void stop() noexcept override;
    std::string name() const override {
        return "ip42 " + setup_.config.address + ":" + std::to_string(setup_.config.port);
    }
    CommandReport report() const override;
    std::vector<SenderReport> senders() const override { return {}; }
    std::string trouble() const override { return peer_.trouble(); }
    void notify(const Telemetry&) noexcept override {}
    bool asks_to_end() const override { return over_.load(); }

  private:
    using Work = std::function<void()>;

    void run();
    void serve(const Fd& socket);
    bool take(const Ip42Stream::Found& found, const Fd& socket, std::int64_t arrival_ns);
    void step(const Ip42Message& message, std::int64_t arrival_ns);
    void remark(const std::string& topic, const std::string& text);
    void refuse(const std::string& topic, const std::string& text);
    void carry_out(const std::vector<Command>& commands);
    bool command(const Command& command);
    void photograph(TimeTai time);

    Ip42Setup setup_;
    CommandHandler& handler_;
    Ip42Peer peer_;
    std::mutex saying_;  // guards the remarks, which the worker makes as well
    FirstRemarks remarks_;
    Ip42World world_;
    Ip42Stream stream_;
    Fd wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false}, over_{false};
    std::thread thread_;
    std::unique_ptr<BoundedWorker> worker_;
    std::uint64_t steps_here_ = 0;  // steps of the present connection
    std::uint64_t times_gone_ = 0;
    std::uint32_t sequence_ = 0;  // worker's
    std::atomic<std::uint64_t> refused_{0};
};

void Ip42Receiver::start() {
    peer_.open();
    stopping_ = false;
    worker_ = std::make_unique<BoundedWorker>();
    thread_ = std::thread([this] { run(); });
}

void Ip42Receiver::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    worker_.reset();
    peer_.close();
}

void Ip42Receiver::run() {
    while (!stopping_) {
        const Fd socket = peer_.meet(wakeup_);
        if (!socket) {
            if (const std::string why = peer_.trouble(); !why.empty())
                remark("call", why + "; it is tried again");
            continue;
        }
        setup_.note("42 is connected, " + peer_.name());
        stream_.clear();
        world_.restart();
        steps_here_ = 0;
        serve(socket);
        peer_.leave();
        if (stopping_) return;
        if (++times_gone_ <= kMostFarewells)
            remark("gone " + std::to_string(times_gone_),
                   "42 went away after " + std::to_string(steps_here_) + " steps" +
                       (setup_.config.stay ? "; it is waited for" : "; the run ends"));
        if (!setup_.config.stay) over_ = true;
    }
}

// Returns when the peer has gone, sends too much, or does not read.
void Ip42Receiver::serve(const Fd& socket) {
    std::array<char, 16384> bytes{};
    std::array<pollfd, 2> watched{{{wakeup_.get(), POLLIN, 0}, {socket.get(), POLLIN, 0}}};
    while (!stopping_) {
        if (poll(watched.data(), watched.size(), -1) < 0 || watched[1].revents == 0) continue;
        const ssize_t got = recv(socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (got <= 0) return;
        const std::int64_t arrival_ns = monotonic_ns();
        stream_.put({bytes.data(), static_cast<std::size_t>(got)});
        while (const auto found = stream_.take())
            if (!take(*found, socket, arrival_ns)) return;
    }
}

// Returns false when the acknowledgement cannot be sent.
bool Ip42Receiver::take(const Ip42Stream::Found& found, const Fd& socket, std::int64_t arrival_ns) {
    setup_.counts->steps.fetch_add(1, std::memory_order_relaxed);
    const DecodedIp42 decoded = decode_ip42(found.text);
    setup_.counts->skipped_lines.fetch_add(decoded.message.skipped_lines, std::memory_order_relaxed);
    const auto acknowledge = [&] {
        const ssize_t sent =
            send(socket.get(), kAcknowledgement.data(), kAcknowledgement.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        setup_.held(monotonic_ns() - arrival_ns);
        return sent == static_cast<ssize_t>(kAcknowledgement.size());
    };
    const bool is_first = steps_here_++ == 0;
    if (found.too_long) {
        refuse("too long", "a message of more than " + std::to_string(Ip42Stream::kMaxMessage_bytes) +
                               " bytes is not used");
        return acknowledge();
    }
    if (!decoded.refusal.empty()) {
        refuse("refused", "a message is not used: " + decoded.refusal);
        return acknowledge();
    }
    if (is_first && decoded.message.skipped_lines > 0)
        setup_.note(std::to_string(decoded.message.skipped_lines) + " lines of each step are not used");
    if (setup_.lockstep) {
        if ((steps_here_ - 1) % static_cast<std::uint64_t>(setup_.config.steps_per_frame) == 0)
            step(decoded.message, arrival_ns);
        return acknowledge();
    }
    if (!acknowledge()) return false;
    step(decoded.message, arrival_ns);
    return true;
}

// Carries out what a step means; in lockstep until its frame is done, or until 42 has waited long enough.
void Ip42Receiver::step(const Ip42Message& message, std::int64_t arrival_ns) {
    std::unique_lock saying(saying_);
    std::vector<Command> commands = world_.commands_of(message);
    saying.unlock();
    if (setup_.lockstep) commands.push_back(ExposeCommand{message.time, 1, true});
    const std::int64_t until_ns = arrival_ns + to_ns(setup_.config.hold_s);
    const auto outcome =
        worker_->run_until([this, commands = std::move(commands)] { carry_out(commands); }, until_ns);
    const std::string bound = plain(setup_.config.hold_s * 1e3) + " ms (commands.ip42.hold_ms)";
    if (outcome == BoundedWorker::Outcome::kLate) {
        setup_.counts->late_frames.fetch_add(1, std::memory_order_relaxed);
        remark("late", "a frame was not done within " + bound + ": 42 went on before it was");
    }
    if (outcome == BoundedWorker::Outcome::kBusy) {
        setup_.counts->dropped_steps.fetch_add(1, std::memory_order_relaxed);
        refuse("dropped", "a step has no frame, as the last one was not done within " + bound);
    }
}

// Any of the receiver's threads, as refuse().
void Ip42Receiver::remark(const std::string& topic, const std::string& text) {
    const std::lock_guard lock(saying_);
    remarks_.remark(topic, text);
}

void Ip42Receiver::refuse(const std::string& topic, const std::string& text) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    remark(topic, text);
}

// Worker, as the next two.
void Ip42Receiver::carry_out(const std::vector<Command>& commands) {
    for (const Command& c : commands) {
        if (const auto* expose = std::get_if<ExposeCommand>(&c))
            photograph(expose->time);
        else
            command(c);
    }
}

bool Ip42Receiver::command(const Command& command) {
    const CommandStatus status = handler_.handle(command, {++sequence_, monotonic_ns()});
    if (status == CommandStatus::kAccepted) return true;
    const bool is_frame = std::holds_alternative<ExposeCommand>(command);
    refuse(std::string(is_frame ? "frame" : "pose") + reason_of(status),
           std::string(is_frame ? "a frame" : "a pose") + " was refused: " + reason_of(status));
    return false;
}

void Ip42Receiver::photograph(TimeTai time) {
    for (Ip42Sink* const sink : setup_.sinks) sink->expect(sequence_ + 1, time);
    if (!command(ExposeCommand{time, 1, true})) return;
    const std::int64_t end_ns = monotonic_ns() + kPatience_ns;
    for (Ip42Sink* const sink : setup_.sinks)
        while (!sink->wait_until(monotonic_ns() + kStopStep_ns)) {
            if (stopping_) return;
            if (monotonic_ns() > end_ns) return remark("no frame", "a frame did not come");
        }
}

CommandReport Ip42Receiver::report() const {
    CommandReport report;
    report.received = setup_.counts->steps.load();
    report.refused = refused_.load();
    report.strangers = peer_.strangers();
    report.clients = peer_.is_met() ? 1 : 0;
    return report;
}

}  // namespace

std::unique_ptr<CommandReceiver> make_ip42_receiver(Ip42Setup setup, CommandHandler& handler) {
    return std::make_unique<Ip42Receiver>(std::move(setup), handler);
}

}  // namespace hilcam
