#include "io/lines/line_bench.h"

#include <poll.h>
#include <pthread.h>
#include <sys/prctl.h>

#include <algorithm>
#include <array>

#include "io/lines/gpio_pin.h"
#include "io/lines/pps_source.h"
#include "io/system/clock_difference.h"
#include "io/system/datagram_arrival.h"
#include "io/system/monotonic.h"
#include "io/system/urgent_thread.h"

namespace hilcam {
namespace {

constexpr int kAtOnce = 64;  // datagrams taken before outputs get their turn

AllowList allow_list(const LinesConfig& config) {
    const LineUdpConfig udp = config.udp.value_or(LineUdpConfig{});
    return {udp.allow, udp.address, "lines.udp"};
}

}  // namespace

LineBench::LineBench(const LinesConfig& config, std::vector<CameraLines*> cameras)
    : config_(config), cameras_(std::move(cameras)), allow_(allow_list(config)) {
    if (config_.udp)
        for (const std::string& receiver : config_.udp->send_to)
            receivers_.push_back(parse_endpoint(receiver));
    for (CameraLines* const lines : cameras_) lines->on_wake([this] { wake(wakeup_); });
}

LineBench::~LineBench() { stop(); }

void LineBench::start() {
    if (config_.udp) {
        socket_ = open_udp(parse_ipv4(config_.udp->address, "lines.udp.address"),
                           static_cast<std::uint16_t>(config_.udp->port));
        ask_for_arrivals(socket_.get());
    }
    for (const LineInputConfig& c : config_.inputs) {
        const auto line = static_cast<std::uint8_t>(c.line);
        const auto camera = static_cast<std::uint16_t>(c.camera);
        if (!c.pin.gpio.empty()) {
            inputs_.push_back({line, camera, open_input_pin(c.pin)});
            // The wire's level before its first edge.
            if (read_pin(inputs_.back().fd)) take({line, true, monotonic_ns(), 0}, camera);
        }
        if (c.pps.empty()) continue;
        pulses_.push_back(std::make_unique<PpsSource>(c.pps));
        pulses_.back()->start([this, line, camera](const PpsSource::Edge& edge) {
            take({line, edge.level, edge.monotonic_ns, edge.sequence}, camera);
        });
    }
    for (const LineOutputConfig& c : config_.outputs) {
        if (c.pin.gpio.empty()) continue;
        const CameraLines& lines = *cameras_[static_cast<std::size_t>(c.camera - 1)];
        outputs_.push_back({static_cast<std::uint8_t>(c.line), static_cast<std::uint16_t>(c.camera),
                            open_output_pin(c.pin, lines.levels() >> c.line & 1u)});
    }
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void LineBench::stop() noexcept {
    for (const auto& pulse : pulses_) pulse->stop();
    if (thread_.joinable()) {
        stopping_ = true;
        wake(wakeup_);
        thread_.join();
    }
    socket_.reset();
    inputs_.clear(), outputs_.clear(), pulses_.clear();
}

void LineBench::run() {
    pthread_setname_np(pthread_self(), "lines");
    make_thread_urgent();
    // The kernel may wake an ordinary thread 50 us late, to spare power.
    prctl(PR_SET_TIMERSLACK, 1'000, 0, 0, 0);
    std::vector<pollfd> watched = {{wakeup_.get(), POLLIN, 0}, {socket_.get(), POLLIN, 0}};
    for (const InputPin& pin : inputs_) watched.push_back({pin.fd.get(), POLLIN, 0});
    while (!stopping_) {
        const std::int64_t wait_ns = wake_ns() - monotonic_ns();
        const timespec patience = timespec_of(std::clamp<std::int64_t>(wait_ns, 0, 1'000'000'000));
        if (ppoll(watched.data(), watched.size(), &patience, nullptr) > 0) {
            if (watched[0].revents) drain(wakeup_);
            if (watched[1].revents) receive();
            for (std::size_t i = 0; i < inputs_.size(); ++i)
                if (watched[i + 2].revents) read_pin_edges(inputs_[i]);
        }
        for (std::size_t i = 0; i < cameras_.size(); ++i) {
            cameras_[i]->tick(monotonic_ns());
            for (LineEdge edge; cameras_[i]->take_output(edge);)
                put_out(static_cast<std::uint16_t>(i + 1), edge);
        }
    }
}

std::int64_t LineBench::wake_ns() const {
    std::int64_t next_ns = CameraLines::kNever_ns;
    for (const CameraLines* const lines : cameras_) next_ns = std::min(next_ns, lines->wake_ns());
    // Far from the largest number, so that a difference to it can be taken.
    return std::min(next_ns, monotonic_ns() + 3'600'000'000'000);
}

// --- in

void LineBench::receive() {
    for (int i = 0; i < kAtOnce; ++i) {
        sockaddr_in from{};
        std::array<std::uint8_t, kEdgeBytes + 1> bytes;  // a longer one is no edge
        iovec io{bytes.data(), bytes.size()};
        alignas(cmsghdr) std::array<char, 128> control;
        msghdr message{&from, sizeof from, &io, 1, control.data(), control.size(), 0};
        const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
        if (size < 0) return;
        if (!allow_.allows(ntohl(from.sin_addr.s_addr))) {
            strangers_.fetch_add(1, std::memory_order_relaxed);
            continue;
        }
        const auto edge = decode_edge(std::span(bytes).first(static_cast<std::size_t>(size)));
        if (!edge) {
            edges_refused_.fetch_add(1, std::memory_order_relaxed);
            continue;
        }
        std::int64_t at_ns = arrival_of(message);
        if (edge->clock == EdgeClock::kMonotonic) at_ns = edge->time_ns;
        if (edge->clock == EdgeClock::kTai)
            // Compared first, so that a hostile time cannot overflow.
            at_ns = edge->time_ns < 0 ? 0 : edge->time_ns - ahead_of_monotonic_ns(CLOCK_TAI);
        take({edge->line, edge->level, at_ns, edge->sequence}, edge->camera);
    }
}

void LineBench::read_pin_edges(const InputPin& pin) {
    std::array<PinEdge, 16> edges;
    const std::size_t count = read_edges(pin.fd, edges);
    for (std::size_t i = 0; i < count; ++i)
        take({pin.line, edges[i].level, edges[i].monotonic_ns, edges[i].sequence}, pin.camera);
}

void LineBench::take(const LineEdge& edge, std::uint16_t camera) {
    const std::int64_t now_ns = monotonic_ns();
    bool taken = camera <= cameras_.size() && edge.monotonic_ns <= now_ns + kHorizon_ns &&
                 edge.monotonic_ns >= now_ns - kHorizon_ns;
    if (taken) {
        bool any = false;
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            if (camera == 0 || camera == i + 1) any = cameras_[i]->edge(edge, now_ns) || any;
        taken = any;
    }
    (taken ? edges_in_ : edges_refused_).fetch_add(1, std::memory_order_relaxed);
}

// --- out

void LineBench::put_out(std::uint16_t camera, const LineEdge& edge) {
    bool lost = false;
    for (const OutputPin& pin : outputs_)
        if (pin.camera == camera && pin.line == edge.line) lost = !write_pin(pin.fd, edge.level) || lost;
    if (!receivers_.empty()) {
        EdgeDatagram datagram{edge.line, edge.level, EdgeClock::kMonotonic,
                              camera,    ++sent_,    edge.monotonic_ns};
        if (config_.udp->clock == LineUdpConfig::Clock::kTai) {
            datagram.clock = EdgeClock::kTai;
            datagram.time_ns += ahead_of_monotonic_ns(CLOCK_TAI);
        }
        const auto bytes = encode_edge(datagram);
        for (const sockaddr_in& to : receivers_)
            lost = sendto(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                          reinterpret_cast<const sockaddr*>(&to), sizeof to) < 0 ||
                   lost;
    }
    edges_out_.fetch_add(1, std::memory_order_relaxed);
    if (lost) edges_lost_.fetch_add(1, std::memory_order_relaxed);
    worst_late_ns_ = std::max(worst_late_ns_.load(), monotonic_ns() - edge.monotonic_ns);
}

LineReport LineBench::report() const {
    return {edges_in_,  edges_refused_, strangers_,
            edges_out_, edges_lost_,    static_cast<double>(worst_late_ns_.load()) * 1e-3};
}

}  // namespace hilcam
