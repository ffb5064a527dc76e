#pragma once
// Telemetry: a report of every frame and housekeeping once a second, to the senders of commands that
// subscribed, to clients of a read-only port, and to fixed UDP addresses.

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "io/command_receiver.h"
#include "io/commands_tcp.h"
#include "io/fd.h"
#include "io/frame_sink.h"
#include "render/config_field.h"

namespace hilcam {

// The read-only port and the fixed addresses. Senders of commands subscribe without it.
struct TelemetryConfig {
    TcpCommandConfig port{.port = 5011};  // port 0: none
    std::vector<std::string> udp_to;
};
Fields fields(TelemetryConfig& config);
void validate(const TelemetryConfig& config);

// A sink that takes the frames' records alone.
class TelemetrySink : public FrameSink {
  public:
    // `figures` is asked once a second, by the sink's thread.
    TelemetrySink(const TelemetryConfig& config, std::function<HousekeepingFigures()> figures);
    ~TelemetrySink() override { TelemetrySink::stop(); }

    // Receivers whose senders may subscribe; they outlive the sink's start() to stop(). Owner thread, before
    // start().
    void serve(std::vector<CommandReceiver*> receivers) { receivers_ = std::move(receivers); }

    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;
    // Of the read-only port. Any thread.
    CommandReport port_report() const { return port_ ? port_->report() : CommandReport{}; }

  private:
    void run();
    void send(const Telemetry& telemetry);

    // Reports on their way from the loop to the thread.
    static constexpr std::size_t kRing = 256;
    std::array<FrameReport, kRing> ring_;
    std::atomic<std::size_t> head_{0}, tail_{0};
    std::counting_semaphore<> ready_{0};
    std::atomic<std::uint64_t> sent_{0}, dropped_{0};

    TelemetryConfig config_;
    std::function<HousekeepingFigures()> figures_;
    std::vector<CommandReceiver*> receivers_;
    std::unique_ptr<CommandReceiver> port_;
    Fd udp_;
    std::vector<sockaddr_in> destinations_;
    std::uint16_t report_count_ = 0, housekeeping_count_ = 0;  // packet counts of the UDP addresses
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
