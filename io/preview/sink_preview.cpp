#include "io/preview/sink_preview.h"

#include <httplib.h>

#include <utility>

#include "io/contract/light_part_source.h"
#include "io/contract/refused_settings.h"
#include "io/images/image_file.h"
#include "io/preview/connection_limiter.h"
#include "io/preview/preview_assets.h"
#include "io/preview/preview_picture.h"
#include "io/preview/preview_pool.h"
#include "io/preview/preview_request.h"
#include "io/preview/preview_shelf.h"
#include "io/preview/preview_slot.h"
#include "io/preview/preview_viewers.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongestPoll = 2s;
// A frame's truth follows soon after the frame.
constexpr auto kTruthPoll = 1s;
// A viewer has one open request for pictures, one for figures, and now and then an order.
constexpr std::size_t kWorkers = 24;
// Slow clients are ended together, however many there are, so they do not keep others out.
constexpr std::size_t kMaxConnectionsWaiting = 232;
constexpr int kBacklog = 128;  // in the kernel, behind those
constexpr std::size_t kMaxBody_bytes = 4096;

// Browsers send less than 2 KB, at once; a picture on a slow line takes time.
ConnectionLimiter::Limits connection_limits(const AllowList& allow) {
    return {.age = 30s,
            .received_bytes = 128 * 1024,
            .request_age = 3s,
            .request_age_in_crowd = 500ms,
            .crowd = kWorkers,
            .allows = [&allow](std::uint32_t address) { return allow.allows(address); }};
}

// The library's own pool accepts any number of connections.
class Workers : public httplib::TaskQueue {
  public:
    // bool in newer versions of the library.
    using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

    Enqueued enqueue(std::function<void()> job) override {
        pool_.add(std::move(job));
        return static_cast<Enqueued>(true);
    }
    void shutdown() override { pool_.stop(); }

  private:
    BoundedPool pool_{kWorkers, kMaxConnectionsWaiting};
};

std::string machine_name() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return name;
}

// Returns the announced length of the body; a text that is not a number counts as too long.
std::uint64_t body_bytes(const httplib::Request& request) {
    const std::string text = request.get_header_value("Content-Length");
    return text.empty() ? 0 : parsed_as<std::uint64_t>(text).value_or(~std::uint64_t{0});
}

void refuse(httplib::Response& response, int status, const std::string& why) {
    response.status = status;
    response.set_content(why + "\n", "text/plain; charset=utf-8");
}

void refuse_crowd(httplib::Response& response) {
    refuse(response, 429,
           "accepted: " + std::to_string(PreviewViewers::kMax) + " viewers, 15 requests/s each");
}

std::string_view query_of(const httplib::Request& request) {
    const std::size_t question = request.target.find('?');
    return question == std::string::npos ? std::string_view()
                                         : std::string_view(request.target).substr(question + 1);
}

std::size_t max_samples(const CameraLimits& limits) {
    return static_cast<std::size_t>(limits.width) * static_cast<std::size_t>(limits.height);
}

}  // namespace

Fields fields(PreviewConfig& c) {
    return {
        text("address", c.address,
             "IPv4 address of this machine to serve the page on; there are no passwords"),
        integer("port", c.port, {1, 65535}, "TCP port of the page: http://ADDRESS:PORT/ in a browser"),
        allow_field(c.allow),
    };
}

void validate(const PreviewConfig& c) { AllowList(c.allow, c.address, "outputs.preview"); }

struct PreviewSink::Implementation {
    Implementation(const PreviewConfig& c, const SinkContext& sink_context, PictureRun r,
                   std::function<std::string()> s)
        : config(c),
          allow(c.allow, c.address, "outputs.preview"),
          context(sink_context),
          run(std::move(r)),
          status(std::move(s)),
          color_pattern(sink_context.camera.limits().color_pattern),
          slot(max_samples(sink_context.camera.limits()), PreviewViewers::kInterval) {}

    PreviewConfig config;
    AllowList allow;
    SinkContext context;
    PictureRun run;
    std::function<std::string()> status;
    std::string color_pattern;
    std::string machine = machine_name();
    PreviewSlot slot;
    PreviewShelf shelf;
    std::mutex encoding;  // one file at a time, because encoding takes memory and time
    PreviewViewers viewers;
    ConnectionLimiter guard;
    httplib::Server server;
    std::thread thread;
    std::atomic<std::uint64_t> pictures{0}, requests{0}, refused{0}, bytes{0};

    void add_routes();
    bool refuse_stranger(const httplib::Request& request, httplib::Response& response);
    void send_picture(const httplib::Request& request, httplib::Response& response);
    void send_light(const PictureRequest& wanted, httplib::Response& response);
    void answer(std::string picture, httplib::Response& response);
    void send_numbers(const httplib::Request& request, httplib::Response& response);
    void send_truth(const httplib::Request& request, httplib::Response& response);
    void change_settings(const httplib::Request& request, httplib::Response& response);
    void trigger(const httplib::Request& request, httplib::Response& response);
    void order_fault(const httplib::Request& request, httplib::Response& response);
};

// Refuses clients that are not allowed before the body is read. True: answered.
bool PreviewSink::Implementation::refuse_stranger(const httplib::Request& request,
                                                  httplib::Response& response) {
    const std::string host = request.get_header_value("Host");
    in_addr peer{};
    if (inet_pton(AF_INET, request.remote_addr.c_str(), &peer) != 1 || !allow.allows(ntohl(peer.s_addr))) {
        refuse(response, 403, request.remote_addr + " is not among outputs.preview.allow");
    } else if (request.get_header_value_count("Host") != 1 || request.get_header_value_count("Origin") > 1) {
        refuse(response, 400, "accepted: one header Host, and at most one Origin");
    } else if (!is_own_host(host, machine)) {
        refuse(response, 403, "this host name is not known here; use the numeric address");
    } else if (request.method != "GET" && request.method != "POST") {
        refuse(response, 405, "accepted: GET, POST");
    } else if (request.method == "POST" && !is_own_origin(request.get_header_value("Origin"), host)) {
        refuse(response, 403, "the header Origin is not http://" + host);
    } else if (request.has_header("Transfer-Encoding")) {
        refuse(response, 411, "accepted: requests with Content-Length");
    } else if (body_bytes(request) > kMaxBody_bytes) {
        refuse(response, 413, "accepted: up to " + std::to_string(kMaxBody_bytes) + " bytes");
    } else {
        return false;
    }
    return true;
}

void PreviewSink::Implementation::send_picture(const httplib::Request& request, httplib::Response& response) {
    const PictureRequest wanted = parse_picture_request(query_of(request));
    if (!viewers.admit(wanted.viewer)) return refuse_crowd(response);
    if (wanted.light) return send_light(wanted, response);
    std::string picture;
    const auto read = [&](const PreviewSlot::Frame& f) {
        const PictureSource source{f.samples, f.width, f.height, f.record};
        picture = encode_picture(source, fit_to_frame(wanted, f.width, f.height), color_pattern);
        if (wanted.hold) shelf.keep(f);
    };
    slot.wait_for(wanted.after, kLongestPoll, wanted.truth, read);
    answer(std::move(picture), response);
}

// Sends one part of a frame's light in the picture's form; the frame is not kept.
void PreviewSink::Implementation::send_light(const PictureRequest& wanted, httplib::Response& response) {
    if (!context.light_parts) return refuse(response, 409, "light: nobody takes this camera's frames apart");
    if (const std::string why = context.light_parts->refusal(); !why.empty())
        return refuse(response, 409, why);
    const auto shown =
        context.light_parts->wait_for({*wanted.light, wanted.after, wanted.truth}, kLongestPoll);
    if (!shown) return answer({}, response);
    const int width = shown->numbers.width(), height = shown->numbers.height();
    const PictureSource source{shown->numbers.all(), width, height, shown->record};
    answer(encode_picture(source, fit_to_frame(wanted, width, height), color_pattern), response);
}

void PreviewSink::Implementation::answer(std::string picture, httplib::Response& response) {
    if (picture.empty()) {
        response.status = 204;  // no frame in time: ask again
        return;
    }
    pictures.fetch_add(1);
    bytes.fetch_add(picture.size());
    response.headers.emplace("Content-Type", "application/octet-stream");
    response.body = std::move(picture);
}

// Sends a kept frame, or the newest.
void PreviewSink::Implementation::send_numbers(const httplib::Request& request, httplib::Response& response) {
    const NumbersRequest wanted = parse_numbers_request(query_of(request));
    if (!viewers.admit(wanted.viewer)) return refuse_crowd(response);
    PreviewShelf::Frame frame = shelf.find(wanted.frame);
    if (!frame)
        slot.wait_for(0, kLongestPoll, false, [&](const PreviewSlot::Frame& f) {
            if (wanted.frame == 0 || wanted.frame == f.record.id)
                frame = std::make_shared<const PreviewSlot::Frame>(f);
        });
    if (!frame)
        return refuse(response, 404,
                      wanted.frame == 0
                          ? "no frame yet"
                          : "frame " + std::to_string(wanted.frame) +
                                " is no longer here; freeze the picture, and it is kept for you");
    const std::lock_guard lock(encoding);
    DnImage image(frame->width, frame->height);
    std::copy_n(frame->samples.begin(), image.pixels(), image.data());
    const std::string kind = wanted.tiff ? ".tiff" : ".png";
    response.body = encode_frame(kind, image, run, frame->record);
    response.headers.emplace("Content-Type", wanted.tiff ? "image/tiff" : "image/png");
    response.headers.emplace("Content-Disposition", "attachment; filename=\"camera" +
                                                        std::to_string(run.camera) + "_frame" +
                                                        std::to_string(frame->record.id) + kind + "\"");
    bytes.fetch_add(response.body.size());
}

void PreviewSink::Implementation::send_truth(const httplib::Request& request, httplib::Response& response) {
    const std::uint64_t frame = parse_truth_request(query_of(request));
    std::string line = shelf.line_of(frame, kTruthPoll);
    if (line.empty()) return refuse(response, 404, "the truth of this frame is not, or no longer, here");
    bytes.fetch_add(line.size());
    response.headers.emplace("Content-Type", "application/json");
    response.body = std::move(line);
}

void PreviewSink::Implementation::change_settings(const httplib::Request& request,
                                                  httplib::Response& response) {
    const SettingsChange change = parse_settings_change(request.body);
    if (!context.camera.change(change))
        return refuse(response, 409, refusal_of(change, context.camera.settings(), context.camera.limits()));
    response.status = 204;
}

void PreviewSink::Implementation::trigger(const httplib::Request& request, httplib::Response& response) {
    switch (context.camera.trigger(parse_trigger_order(request.body))) {
        case TriggerResult::kTaken:
            response.status = 204;
            return;
        case TriggerResult::kMissed:
            return refuse(response, 409, "missed: the camera is busy with the frame before");
        case TriggerResult::kTooEarly:
            return refuse(response, 409, "too early: the instant is not after that of the frame before");
        case TriggerResult::kNotArmed:
            return refuse(response, 409, "the camera does not listen to this trigger now");
    }
}

void PreviewSink::Implementation::order_fault(const httplib::Request& request, httplib::Response& response) {
    const FaultRequest wanted = parse_fault_request(request.body);
    if (wanted.clear_all)
        context.faults.clear_all();
    else
        context.faults.order(wanted.order);
    response.status = 204;
}

void PreviewSink::Implementation::add_routes() {
    using httplib::Request, httplib::Response;
    for (const PreviewAsset& asset : preview_assets())
        server.Get(asset.path, [&asset](const Request&, Response& response) {
            response.set_content(asset.text.data(), asset.text.size(), asset.type);
        });
    server.Get("/frame", [this](const Request& q, Response& a) { send_picture(q, a); });
    server.Get("/numbers", [this](const Request& q, Response& a) { send_numbers(q, a); });
    server.Get("/truth", [this](const Request& q, Response& a) { send_truth(q, a); });
    server.Get("/status",
               [this](const Request&, Response& a) { a.set_content(status(), "application/json"); });
    server.Post("/settings", [this](const Request& q, Response& a) { change_settings(q, a); });
    server.Post("/trigger", [this](const Request& q, Response& a) { trigger(q, a); });
    server.Post("/fault", [this](const Request& q, Response& a) { order_fault(q, a); });

    server.set_pre_routing_handler([this](const Request& q, Response& a) {
        // A POST's body, which takes no time here, is still to come.
        if (q.method == "GET") guard.heard(q.remote_addr, q.remote_port);
        return refuse_stranger(q, a) ? httplib::Server::HandlerResponse::Handled
                                     : httplib::Server::HandlerResponse::Unhandled;
    });
    server.set_expect_100_continue_handler(
        [this](const Request& q, Response& a) { return refuse_stranger(q, a) ? a.status : 100; });
    server.set_exception_handler([](const Request&, Response& a, std::exception_ptr error) {
        try {
            std::rethrow_exception(std::move(error));
        } catch (const InputError& e) {
            refuse(a, 400, e.what());
        } catch (const std::exception& e) {
            refuse(a, 500, e.what());
        }
    });
    server.set_error_handler(httplib::Server::Handler([](const Request& q, Response& a) {
        if (a.body.empty()) refuse(a, a.status, a.status == 404 ? "no such page" : "not understood");
        static_cast<void>(q);
    }));
    server.set_logger([this](const Request&, const Response& a) {
        requests.fetch_add(1);
        if (a.status >= 400) refused.fetch_add(1);
    });
    server.set_default_headers(
        {{"Cache-Control", "no-store"},
         {"Content-Security-Policy", "default-src 'self'; img-src data:; frame-ancestors 'none'"},
         {"X-Content-Type-Options", "nosniff"}});
}

PreviewSink::PreviewSink(const PreviewConfig& config, const SinkContext& context, PictureRun run,
                         std::function<std::string()> status)
    : implementation_(std::make_unique<Implementation>(config, context, std::move(run), std::move(status))) {}

PreviewSink::~PreviewSink() { stop(); }

void PreviewSink::start() {
    Implementation& i = *implementation_;
    parse_ipv4(i.config.address, "outputs.preview.address");
    i.add_routes();
    i.server.new_task_queue = [] { return new Workers; };
    // One request per connection, so an idle browser holds no worker.
    i.server.set_keep_alive_max_count(1);
    i.server.set_keep_alive_timeout(2);
    i.server.set_read_timeout(2s);
    i.server.set_write_timeout(5s);
    i.server.set_payload_max_length(kMaxBody_bytes);
    i.server.set_tcp_nodelay(true);
    // The library's own options let two programs share the port.
    int listening = -1;
    i.server.set_socket_options([&listening](int socket) {
        listening = socket;
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    const auto port = static_cast<std::uint16_t>(i.config.port);
    if (!i.server.bind_to_port(i.config.address, port))
        throw DeviceError("outputs.preview: " + i.config.address + ":" + std::to_string(port) +
                          " cannot be had: " + std::strerror(errno) +
                          "; does another program use the port? (ss -ltnp)");
    listen(listening, kBacklog);  // again, because the library's own backlog is 5
    i.slot.start();
    i.guard.start(port, connection_limits(i.allow));
    i.thread = std::thread([&server = i.server] {
        become_preview_thread();
        server.listen_after_bind();
    });
    // stop() has no effect on a server that does not run yet.
    while (!i.server.is_running()) std::this_thread::sleep_for(1ms);
}

void PreviewSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    implementation_->slot.put(frame, record);
}

bool PreviewSink::wants_truth() const noexcept { return implementation_->slot.wants_truth(); }

void PreviewSink::take_truth(std::uint64_t frame, std::string line) {
    implementation_->shelf.put_line(frame, std::move(line));
}

void PreviewSink::stop() noexcept {
    Implementation& i = *implementation_;
    if (!i.thread.joinable()) return;
    i.server.stop();
    i.slot.stop();
    i.guard.end_all();
    i.thread.join();
    i.guard.stop();
}

SinkReport PreviewSink::report() const {
    const Implementation& i = *implementation_;
    SinkReport r;
    r.name = "preview http://" + i.config.address + ":" + std::to_string(i.config.port);
    r.frames = i.pictures.load();
    r.figures = {{"viewers", static_cast<double>(i.viewers.count())},
                 {"copies", static_cast<double>(i.slot.copies())},
                 {"requests", static_cast<double>(i.requests.load())},
                 {"refused", static_cast<double>(i.refused.load())},
                 {"megabytes", static_cast<double>(i.bytes.load()) * 1e-6}};
    return r;
}

std::vector<ListeningPort> listening(const PreviewConfig& c) {
    return {{"outputs.preview.port", c.address, c.port}};
}

std::unique_ptr<FrameSink> make_sink(const PreviewConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    return std::make_unique<PreviewSink>(config, context, *shape.run, shape.status);
}

}  // namespace hilcam
