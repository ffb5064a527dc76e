#pragma once
// Telemetry: a report of every frame of every camera, and housekeeping once a second. It goes to senders of
// commands that subscribed, to clients of a read-only port, and to fixed UDP addresses. One thread sends
// everything; each camera's loop reaches it through a sink of its own, which takes the frames' records only.

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/commands/commands_tcp.h"
#include "io/contract/command_receiver.h"
#include "io/contract/frame_sink.h"
#include "io/system/fd.h"
#include "io/system/timed_semaphore.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The read-only port and the fixed addresses. Subscriptions need neither.
struct TelemetryConfig {
    TcpCommandConfig port{.port = 5011};  // port 0: none
    std::vector<std::string> udp_to;
};
Fields fields(TelemetryConfig& config);
void validate(const TelemetryConfig& config);

class TelemetrySender {
  public:
    // figures: called once a second on the sender's thread.
    TelemetrySender(const TelemetryConfig& config, std::function<HousekeepingFigures()> figures);
    ~TelemetrySender() { stop(); }

    // Sets the receivers with senders that may subscribe; they must exist from start() to stop(). Owner
    // thread, before start().
    void serve(std::vector<CommandReceiver*> receivers) { receivers_ = std::move(receivers); }
    // Returns the output of a camera that is to be reported. Both objects are used only while the other
    // exists. Owner thread, before start().
    std::unique_ptr<FrameSink> sink(std::uint8_t camera);

    void start();
    void stop() noexcept;
    // Returns the report of the read-only port. Any thread.
    CommandReport port_report() const { return port_ ? port_->report() : CommandReport{}; }

  private:
    class Sink;

    void run();
    void send_reports();
    void send(const Telemetry& telemetry);

    std::vector<Sink*> sinks_;
    TimedSemaphore ready_;  // counts the reports that wait in all sinks

    TelemetryConfig config_;
    std::function<HousekeepingFigures()> figures_;
    std::vector<CommandReceiver*> receivers_;
    std::unique_ptr<CommandReceiver> port_;
    Fd udp_;
    std::vector<sockaddr_in> destinations_;
    std::uint16_t report_count_ = 0, housekeeping_count_ = 0;  // packet counts for the UDP addresses
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
