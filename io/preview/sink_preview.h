#pragma once
// A web page with the live picture, the run's figures, the camera's settings and fault buttons
// (docs/preview.md; the page itself is io/preview/).
//
// The loop copies a frame only when somebody is looking, and at most kMaxPictures_hz times a second: while
// nobody looks, publish() is one atomic load. The server's threads cut and reduce the copy, at a lower
// priority than the loop's.
//
// What a client can do is bounded: kWorkers connections are served at a time and as many wait, one request
// each; connection_limiter.h ends those that last or send too long. Requests that name another host than this
// machine are refused (DNS rebinding), and those that change something unless they come from the page
// itself. There are no passwords: beyond loopback a list says who may come.

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
    // `run`: what saved frames say of themselves. `status` gives the run's figures as JSON; called from the
    // server's threads, several at a time, between start() and stop().
    PreviewSink(const PreviewConfig& config, const SinkContext& context, PictureRun run,
                std::function<std::string()> status);
    ~PreviewSink() override;

    // Throws InputError when the address is none, DeviceError when the port cannot be had.
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
