#pragma once
// A web page with the live picture, the run's figures, the camera's settings and fault buttons
// (docs/preview.md; the page's files are in io/preview/).
//
// The loop copies a frame only on request, at most once per PreviewViewers::kInterval; without viewers,
// publish() is one atomic load. The server's threads clip and reduce the copy with a lower priority than the
// loop's.
//
// Clients are limited. kWorkers connections are served at a time and kMaxConnectionsWaiting wait, with one
// request each; connection_limiter.h ends those that last or send too long. A request that names a host other
// than this machine is refused (DNS rebinding), and so is a request that changes something and does not come
// from the page itself. There are no passwords: on addresses other than loopback, a list says which clients
// may connect.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/contract/frame_sink.h"
#include "io/contract/output_shape.h"
#include "io/contract/truth_listener.h"
#include "io/images/picture_notes.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct PreviewConfig {
    static constexpr const char* kKey = "preview";
    static constexpr const char* kMeaning = "web page with the live picture";

    std::string address = "127.0.0.1";
    std::int64_t port = 8080;
    std::vector<std::string> allow;
};
Fields fields(PreviewConfig& config);
void validate(const PreviewConfig& config);
std::vector<ListeningPort> listening(const PreviewConfig& config);
std::unique_ptr<FrameSink> make_sink(const PreviewConfig& config, const SinkContext& context,
                                     const OutputShape& shape);

class PreviewSink : public FrameSink, public TruthListener {
  public:
    // run: for the notes in saved frames. status: returns the run's figures as JSON; the server's threads
    // call it between start() and stop(), several at a time.
    PreviewSink(const PreviewConfig& config, const SinkContext& context, PictureRun run,
                std::function<std::string()> status);
    ~PreviewSink() override;

    // Throws InputError when the address is invalid, DeviceError when the port cannot be opened.
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;
    TruthListener* truth_listener() noexcept override { return this; }
    bool wants_truth() const noexcept override;
    void take_truth(std::uint64_t frame, std::string line) override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
