#include "io/commands/telemetry.h"

#include <sys/socket.h>

#include <chrono>

#include "io/commands/command_dialect.h"
#include "io/system/allow_list.h"
#include "io/system/monotonic.h"

namespace hilcam {

Fields fields(TelemetryConfig& c) {
    Fields list = fields(c.port);
    for (Field& field : list)
        if (field.key == "port")
            field =
                integer("port", c.port.port, {0, 65535},
                        "TCP port for clients that receive all telemetry; their input is ignored; 0: none");
    list.push_back(texts("udp_to", c.udp_to, "receivers of all telemetry as datagrams, each ADDRESS:PORT"));
    return list;
}

void validate(const TelemetryConfig& c) {
    validate(c.port.dialect);
    if (c.port.port != 0) AllowList(c.port.allow, c.port.address, "telemetry");
    for (const std::string& to : c.udp_to) parse_endpoint(to);
}

// Passes a camera's reports from its loop to the sender's thread.
class TelemetrySender::Sink : public FrameSink {
  public:
    Sink(TelemetrySender& sender, std::uint8_t camera) : sender_(sender), camera_(camera) {}

    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override {}
    SinkReport report() const override;

    // Takes a report; false when there is none. Sender's thread.
    bool take(FrameReport& report) noexcept;

  private:
    static constexpr std::size_t kRing = 256;
    TelemetrySender& sender_;
    std::uint8_t camera_;
    std::array<FrameReport, kRing> ring_;
    std::atomic<std::size_t> head_{0}, tail_{0};
    std::atomic<std::uint64_t> dropped_{0};
};

TelemetrySender::TelemetrySender(const TelemetryConfig& config, std::function<HousekeepingFigures()> figures)
    : config_(config), figures_(std::move(figures)) {
    if (config.port.port != 0) port_ = make_telemetry_port(config.port, "telemetry");
    for (const std::string& to : config.udp_to) destinations_.push_back(parse_endpoint(to));
}

std::unique_ptr<FrameSink> TelemetrySender::sink(std::uint8_t camera) {
    auto sink = std::make_unique<Sink>(*this, camera);
    sinks_.push_back(sink.get());
    return sink;
}

void TelemetrySender::start() {
    if (port_) port_->start();
    if (!destinations_.empty()) udp_ = open_udp(INADDR_ANY, 0);
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void TelemetrySender::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    ready_.release();
    thread_.join();
    if (port_) port_->stop();
    udp_.reset();
}

void TelemetrySender::Sink::publish(const DnImage&, const FrameRecord& record) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == kRing) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    FrameReport& r = ring_[head % kRing];
    r.camera = camera_;
    r.frame = record.id;
    r.exposure_mid = record.exposure_mid;
    r.exposure_mid_monotonic_ns = record.exposure_mid_monotonic_ns;
    r.exposure_s = record.exposure_s;
    r.gain_db = record.gain_db;
    r.pose_sequence = record.pose_sequence;
    r.pose_time = record.pose_time;
    r.trigger_sequence = record.trigger_sequence;
    r.latency_ns =
        record.command_arrival_monotonic_ns == 0 ? -1 : monotonic_ns() - record.command_arrival_monotonic_ns;
    r.faults = record.faults;
    r.quality_level = record.quality_level;
    head_.store(head + 1, std::memory_order_release);
    sender_.ready_.release();
}

bool TelemetrySender::Sink::take(FrameReport& report) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    report = ring_[tail % kRing];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
}

SinkReport TelemetrySender::Sink::report() const {
    SinkReport out;
    out.name = "telemetry";
    out.frames = tail_.load();
    out.dropped = dropped_.load();
    out.figures = {{"clients", static_cast<double>(sender_.port_report().clients)},
                   {"udp_destinations", static_cast<double>(sender_.destinations_.size())}};
    return out;
}

void TelemetrySender::run() {
    constexpr std::int64_t kPeriod_ns = 1'000'000'000;
    std::int64_t next_housekeeping_ns = monotonic_ns() + kPeriod_ns;
    while (true) {
        const bool asked = ready_.try_acquire_until(next_housekeeping_ns);
        if (stopping_) return;
        if (asked) send_reports();
        if (monotonic_ns() < next_housekeeping_ns) continue;
        send(figures_());
        // When late, the missed ones are left out.
        while (next_housekeeping_ns <= monotonic_ns()) next_housekeeping_ns += kPeriod_ns;
    }
}

// Sends one report per camera in turn, so that no camera waits for another.
void TelemetrySender::send_reports() {
    FrameReport report;
    for (Sink* sink : sinks_)
        if (sink->take(report)) send(report);
}

void TelemetrySender::send(const Telemetry& telemetry) {
    for (CommandReceiver* receiver : receivers_) receiver->notify(telemetry);
    if (port_) port_->notify(telemetry);
    if (destinations_.empty()) return;
    std::uint16_t& count =
        std::holds_alternative<FrameReport>(telemetry) ? report_count_ : housekeeping_count_;
    std::array<std::uint8_t, kMaxPacketBytes> bytes;
    const std::size_t size = encode_telemetry(telemetry, count++, config_.port.dialect, bytes);
    for (const sockaddr_in& to : destinations_)
        sendto(udp_.get(), bytes.data(), size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
}

}  // namespace hilcam
