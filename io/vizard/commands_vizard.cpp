#include "io/vizard/commands_vizard.h"

#include <unistd.h>
#include <atomic>
#include <chrono>
#include <thread>

#include "io/images/picture_codecs.h"
#include "io/system/fd.h"
#include "io/system/monotonic.h"
#include "io/system/wire_format.h"
#include "io/vizard/reply_socket.h"
#include "io/vizard/vizard_conversation.h"
#include "io/vizard/zmq_frontend.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Twice the limit of a SIM_UPDATE (vizard_message.h), so that one above the limit still gets an answer.
constexpr std::int64_t kMaxMessageBytes = 16 << 20;
constexpr std::size_t kMaxMessageParts = 1000;
// A process of Basilisk leaves 145 connections behind before it runs out of its own 1024 descriptors. Each
// takes three descriptors (the frontend's two, ZeroMQ's one), which fit into 1024 here as well.
constexpr std::size_t kMaxPeers = 200;
constexpr std::uint64_t kMaxHeldBytes = 8 * kMaxMessageBytes;
constexpr std::size_t kMaxParts = 16;  // most parts of a request; further ones are ignored
// Longest time from the rendered frame (the command's answer) to the published frame: the sensor's part.
constexpr std::chrono::seconds kPatience{60};
constexpr std::chrono::milliseconds kStopStep{50};

const char* reason_of(CommandStatus status) {
    switch (status) {
        case CommandStatus::kAccepted:
            return "";
        case CommandStatus::kBusy:
            return "the camera is busy, or took too long";
        case CommandStatus::kNotNow:
            return "the camera is stopped, or has taken all its frames";
        default:
            return "the command for it was refused";
    }
}

class VizardReceiver : public CommandReceiver {
  public:
    VizardReceiver(const VizardConfig& config, VizardBench bench, std::vector<VizardCameraPart> cameras,
                   CommandHandler& handler, VizardWorld::Remark remark)
        : config_(config),
          cameras_(std::move(cameras)),
          handler_(handler),
          remark_(remark),
          world_({config.time, config.tolerance_rad, config.cameras}, std::move(bench), std::move(remark)),
          conversation_(world_, [this](const VizardShot& shot) { return photograph(shot); }) {}
    ~VizardReceiver() override { stop(); }

    void start() override;
    void stop() noexcept override;
    std::string name() const override { return "vizard " + config_.address; }
    CommandReport report() const override;
    std::vector<SenderReport> senders() const override { return {}; }
    void notify(const Telemetry&) noexcept override {}
    bool asks_to_end() const override { return over_.load(); }

  private:
    using Picture = VizardConversation::Picture;

    void listen_behind_guard();
    void run();
    void serve(ReplySocket& socket);
    Picture photograph(const VizardShot& shot);
    CommandStatus command(const Command& command, std::uint16_t camera);
    bool wait_for(VizardSink& sink) const;
    Picture encoded(const VizardCameraPart& camera) const;

    VizardConfig config_;
    std::vector<VizardCameraPart> cameras_;
    CommandHandler& handler_;
    VizardWorld::Remark remark_;
    VizardWorld world_;
    VizardConversation conversation_;
    std::unique_ptr<ReplySocket> socket_;
    std::unique_ptr<ZmqFrontend> frontend_;  // protects TCP connections
    Fd wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false}, over_{false};
    std::thread thread_;
    std::uint32_t sequence_ = 0;
    std::atomic<std::uint64_t> received_{0}, refused_{0}, ended_{0};
};

void VizardReceiver::start() {
    socket_ = std::make_unique<ReplySocket>(kMaxMessageBytes);
    try {
        config_.address.starts_with("tcp://") ? listen_behind_guard() : socket_->listen(config_.address);
    } catch (const DeviceError& error) {
        throw DeviceError("commands.vizard.address: " + config_.address +
                          " cannot be listened at: " + error.what());
    } catch (const InputError& error) {
        throw InputError(std::string("commands.vizard.address: ") + error.what());
    }
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

// Listens behind a frontend. The file system decides which programs may connect to a Unix socket's file; over
// TCP, anyone who reaches the port may.
void VizardReceiver::listen_behind_guard() {
    const pid_t own = getpid();
    ZmqFrontendSetup setup{config_.address,
                           "hilcam-vizard-" + std::to_string(own) + "-" + std::to_string(monotonic_ns()),
                           kMaxPeers,
                           {kMaxMessageBytes, kMaxMessageParts},
                           kMaxHeldBytes,
                           [this](const std::string& why) {
                               // Only once, because the peer may do it again and again.
                               if (ended_.fetch_add(1) == 0) remark_("a connection was ended: " + why);
                           }};
    socket_->admit_only(own);  // others would bypass the frontend
    socket_->listen("ipc://@" + setup.inner);
    frontend_ = std::make_unique<ZmqFrontend>(std::move(setup));
    frontend_->start();
}

void VizardReceiver::stop() noexcept {
    frontend_.reset();
    if (thread_.joinable()) {
        stopping_ = true;
        wake(wakeup_);
        thread_.join();
    }
    socket_.reset();
}

void VizardReceiver::run() {
    while (!stopping_) {
        try {
            if (!socket_->wait(wakeup_.get()) || stopping_) continue;
        } catch (const DeviceError& error) {
            return world_.remark(std::string("ends, as its socket cannot be waited for: ") + error.what());
        }
        try {
            serve(*socket_);
        } catch (const DeviceError& error) {
            world_.remark(std::string("a request was lost: ") + error.what());
        }
    }
}

void VizardReceiver::serve(ReplySocket& socket) {
    const VizardParts asked = socket.receive(kMaxParts);
    received_.fetch_add(1, std::memory_order_relaxed);
    const VizardConversation::Answer answer = conversation_.answer(asked);
    if (answer.refused) refused_.fetch_add(1, std::memory_order_relaxed);
    socket.send(answer.parts);
    if (conversation_.is_over() && !config_.stay) over_ = true;
}

CommandStatus VizardReceiver::command(const Command& command, std::uint16_t camera) {
    return handler_.handle(command, {++sequence_, monotonic_ns(), camera});
}

VizardConversation::Picture VizardReceiver::photograph(const VizardShot& shot) {
    const VizardCameraPart& camera = cameras_[shot.camera - std::size_t{1}];
    for (const PoseCommand& pose : shot.poses)
        if (const CommandStatus status = command(pose, 0); status != CommandStatus::kAccepted)
            return {{}, reason_of(status)};
    camera.sink->expect(sequence_ + 1, shot.time);
    const CommandStatus status = command(ExposeCommand{shot.time, 1, true}, shot.camera);
    const bool there = status == CommandStatus::kAccepted && wait_for(*camera.sink);
    if (!there) {
        camera.sink->forget();
        return {{}, status == CommandStatus::kAccepted ? "its frame did not come" : reason_of(status)};
    }
    return encoded(camera);
}

bool VizardReceiver::wait_for(VizardSink& sink) const {
    for (std::chrono::nanoseconds waited{0}; waited < kPatience && !stopping_; waited += kStopStep)
        if (sink.wait_for(kStopStep)) return true;
    return false;
}

VizardConversation::Picture VizardReceiver::encoded(const VizardCameraPart& camera) const {
    const DnImage& frame = camera.sink->frame();
    const bool color = !camera.color_pattern.empty();
    const WireFormat format = color                                  ? WireFormat::kRgb8
                              : config_.depth == VizardDepth::kBytes ? WireFormat::kMono8
                                                                     : WireFormat::kMono16;
    const Crop all{0, 0, frame.width(), frame.height()};
    std::vector<std::uint16_t> row(3 * static_cast<std::size_t>(frame.width()) + 8);
    std::vector<std::uint8_t> samples(wire_bytes(frame.pixels(), format));
    write_wire(frame, all, camera.sink->record().bits, format, camera.color_pattern, row, samples);
    const SampleKind kind = color                          ? SampleKind::kRgb8
                            : format == WireFormat::kMono8 ? SampleKind::kGray8
                                                           : SampleKind::kGray16;
    std::string png = encode_png({samples, frame.width(), frame.height(), kind});
    return {std::move(png), "it cannot be encoded as PNG"};
}

CommandReport VizardReceiver::report() const {
    CommandReport report;
    report.received = received_.load();
    report.refused = refused_.load();
    report.strangers = ended_.load();
    return report;
}

}  // namespace

std::unique_ptr<CommandReceiver> make_vizard_receiver(const VizardConfig& config, VizardBench bench,
                                                      std::vector<VizardCameraPart> cameras,
                                                      CommandHandler& handler, VizardWorld::Remark remark) {
    return std::make_unique<VizardReceiver>(config, std::move(bench), std::move(cameras), handler,
                                            std::move(remark));
}

}  // namespace hilcam
