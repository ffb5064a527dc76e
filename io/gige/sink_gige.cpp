#include "io/gige/sink_gige.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "io/gige/camera_clock.h"
#include "io/gige/device/gige_device.h"
#include "io/gige/gige_sockets.h"
#include "io/gige/stream/gige_chunk_layout.h"
#include "io/gige/stream/gige_frame_writer.h"
#include "io/gige/stream/gige_sender.h"
#include "io/system/monotonic.h"
#include "io/system/urgent_thread.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Clients request packets again that are up to some 100 ms old (Aravis' frame_retention).
constexpr double kKept_s = 0.2;
constexpr double kMaxRingBytes = 512e6;

std::size_t slots_for(double frame_rate_hz, std::size_t bytes_each) {
    const double wanted = std::min(std::ceil(kKept_s * frame_rate_hz) + GigeRing::kMaxWaiting + 1,
                                   kMaxRingBytes / static_cast<double>(bytes_each));
    return std::max(GigeRing::kMinSlots, static_cast<std::size_t>(wanted));
}

// The kernel would fragment packets longer than the link's MTU, and most clients' filters drop fragments.
std::uint32_t first_packet_bytes(const GigeConfig& config, const NetInterface& net) {
    return static_cast<std::uint32_t>(std::min<std::int64_t>(config.packet_bytes, net.mtu_bytes / 4 * 4));
}

}  // namespace

Fields fields(GigeConfig& c) {
    return {
        text("interface", c.interface,
             "IPv4 address or name of the network interface of the camera; messages on other interfaces are "
             "ignored"),
        text("model", c.model, "DeviceModelName; hilcam: the camera's name"),
        text("serial", c.serial, "DeviceSerialNumber, unique on the network"),
        text("user_name", c.user_name, "DeviceUserID at the start"),
        integer("packet_bytes", c.packet_bytes, {576, 16384},
                "size of a stream packet until a client sets another; limited by the interface's MTU"),
        number("rate_limit_mb_s", c.rate_bytes_s, 1e6, {1, 100000},
               "upper limit of the stream's data rate; resent packets may use half as much in addition"),
        flag("multipart", c.multipart, "true: multipart frames are offered, with 64-bit block ids"),
        number("spread", c.spread_fraction, 1, {0, 1},
               "share of the frame period over which a frame's packets are spread; 0: as fast as the rate "
               "limit permits"),
        texts("lines", c.lines,
              "additional names of the trigger input Line0, as [Line1, Line2]: entries of TriggerSource and "
              "LineSelector"),
        section("clock", c.clock, "the device's clock and PTP"),
        path("genicam_file", c.genicam_file,
             "GenICam description of another camera, whose face clients see: XML, zip, or the output of "
             "arv-tool genicam; "
             "needs face_file"),
        path("face_file", c.face_file, "table that hilcam-camera-face bind made of genicam_file"),
        path("registers_file", c.registers_file,
             "registers that hilcam-camera-face record read from that camera; they replace what the table "
             "holds"),
    };
}

void validate(const GigeConfig& c) {
    if (c.face_file.empty() != c.genicam_file.empty())
        throw refused_key(c.face_file.empty() ? "genicam_file" : "face_file", "it without the other",
                          "both, or neither: face_file is made of genicam_file by hilcam-camera-face bind");
    if (!c.registers_file.empty() && c.face_file.empty())
        throw refused_key("registers_file", "it without face_file", "all three");
    constexpr std::size_t kMax = 16, kLongest = 32;
    if (c.lines.size() > kMax)
        throw refused_key("lines", std::to_string(c.lines.size()) + " names",
                          std::to_string(kMax) + " at most");
    std::set<std::string> taken = {"Line0", "Software", "Action1"};
    for (const std::string& name : c.lines) {
        const bool is_word =
            !name.empty() && name.size() <= kLongest &&
            std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
            std::all_of(name.begin(), name.end(), [](unsigned char ch) { return std::isalnum(ch) != 0; });
        if (!is_word) throw refused_key("lines", in_quotes(name), "letters and digits, as Line1");
        if (!taken.insert(name).second)
            throw refused_key("lines", in_quotes(name),
                              "names that differ, and are not Line0, Software or Action1");
    }
}

struct GigeSink::Implementation {
    GigeConfig config;
    CameraControl& camera;
    CameraLines* lines;
    FaultBoard& faults;
    std::shared_ptr<const CameraFaceFiles> face;  // null: hilcam's own
    NetInterface net;
    CameraClock clock;
    GigeRing ring;
    GigeFrameWriter writer;
    GigeSender sender;
    std::unique_ptr<GigeSockets> sockets, next_sockets;  // next: after a change of the address
    std::unique_ptr<GigeDevice> device;
    Fd wakeup = open_wakeup();  // wakes the control thread
    std::thread control_thread;
    std::atomic<bool> stopping{false}, running{false};  // running: the sender takes frames

    Latest<GigeStreamNow> for_loop;
    std::uint64_t era = 1;  // counts resets; the upper half of an acquisition's number
    std::atomic<std::uint64_t> finished{0};
    struct Event {
        CameraEvent event;
        std::uint64_t block = 0;  // block of the event's frame; 0: none, or not known yet
    };
    BoundedQueue<Event, 1024> events;
    std::atomic<std::uint64_t> begun_frame{0};  // id of the frame whose exposure began last
    // The newest acquisition and its first frame; the control thread's.
    std::uint64_t begun_acquisition = 0, first_frame = 0;
    std::optional<CameraEvent> exposure_end;  // the loop's; reported when publish() knows its frame's block
    std::atomic<std::uint64_t> events_dropped{0};
    std::atomic<bool> controlled{false};
    std::atomic<std::uint32_t> address;  // for reports; net belongs to the control thread
    std::atomic<std::uint32_t> acquisitions{0};
    std::atomic<std::uint64_t> strange_datagrams{0};  // arrived on another interface
    std::atomic<std::uint64_t> foreign_resend_requests{0};

    Implementation(const GigeConfig& c, const SinkContext& context, const CameraLimits& limits,
                   std::size_t payload_bytes, std::shared_ptr<const CameraFaceFiles> a_face)
        : config(c),
          camera(context.camera),
          lines(context.lines),
          faults(context.faults),
          face(std::move(a_face)),
          net(find_interface(c.interface)),
          clock(c.clock, net),
          ring(slots_for(camera.settings().frame_rate_hz, payload_bytes), payload_bytes),
          writer(ring, faults, clock.clock(), limits.color_pattern, limits.width),
          sender(ring, faults, context.listener, {c.rate_bytes_s, c.spread_fraction, !limits.lockstep},
                 [this](std::uint64_t acquisition) { finish(acquisition); }),
          address(net.address) {}

    void open();
    GigeDevice::Effects effects();
    void set_stream(const GigeStreamState& state);
    void order_resend(const gvcp::ResendRequest& request, Endpoint requester);
    void order_test_packet(const GigeStreamState& state, std::size_t payload_bytes);
    bool change_address(std::uint32_t ip);
    void move_to_next_sockets();

    std::uint64_t frames_dropped() const {
        return writer.dropped().count() + writer.dropped_by_faults() +
               sender.counts().frames_given_up.count();
    }
    void serve_control();
    void notify_device(std::int64_t now_ns);
    void notify(const CameraEvent& event, std::uint64_t block) {
        if (!events.push({event, block})) events_dropped.fetch_add(1, std::memory_order_relaxed);
        wake(wakeup);
    }
    void finish(std::uint64_t acquisition) {
        finished.store(acquisition, std::memory_order_release);
        wake(wakeup);
    }
};

void GigeSink::Implementation::open() {
    sockets = std::make_unique<GigeSockets>(net);
    sender.open(net.address);
    clock.start(net, [this] { return !faults.would_strike(FaultKind::kLinkDown, 0); });
    GigeIdentity identity{config.model,
                          config.serial,
                          config.user_name,
                          net.address,
                          net.mask,
                          0,
                          net.mac,
                          first_packet_bytes(config, net),
                          0,
                          config.multipart,
                          config.lines,
                          config.clock.source,
                          config.clock.enable_ptp};
    if (face) {
        identity.face = face;
        identity.vendor = face->table.vendor;
        if (!face->table.version.empty()) identity.version = face->table.version;
        if (!face->table.model.empty()) identity.model = face->table.model;
    }
    device = std::make_unique<GigeDevice>(identity, camera, faults, effects(), lines);
    device->set_ports(sender.port(), sockets->message_port());
}

// --- effects of the device

GigeDevice::Effects GigeSink::Implementation::effects() {
    GigeDevice::Effects e;
    e.stream_changed = [this](const GigeStreamState& state) { set_stream(state); };
    e.resend = [this](const gvcp::ResendRequest& request, Endpoint requester) {
        order_resend(request, requester);
    };
    e.test_packet = [this](const GigeStreamState& state, std::size_t bytes) {
        order_test_packet(state, bytes);
    };
    e.send_message = [this](std::span<const std::uint8_t> bytes, Endpoint to) {
        if (!faults.strikes(FaultKind::kLinkDown, 0)) sockets->send_message(bytes, to);
    };
    e.send_answer = [this](std::span<const std::uint8_t> bytes, Endpoint to) {
        if (!faults.strikes(FaultKind::kLinkDown, 0)) sockets->send_answer(bytes, to);
    };
    e.reset = [this] {
        ++era;  // no frame that is kept belongs to later acquisitions
        set_stream(device->stream_state());
    };
    e.change_address = [this](std::uint32_t ip, std::uint32_t, std::uint32_t) { return change_address(ip); };
    clock.add_to(e);
    return e;
}

void GigeSink::Implementation::set_stream(const GigeStreamState& state) {
    const std::uint64_t acquisition = era << 32 | state.epoch;
    if (acquisition != begun_acquisition) {
        begun_acquisition = acquisition;
        first_frame = begun_frame.load(std::memory_order_acquire) + 1;
    }
    const GigeStreamNow now{state, acquisition, first_frame};
    acquisitions.store(state.epoch);
    for_loop.write(now);
    sender.set_stream(now);
}

void GigeSink::Implementation::order_resend(const gvcp::ResendRequest& request, Endpoint requester) {
    const GigeStreamState& s = device->stream_state();
    if (!s.open || request.channel != 0) return;
    sender.order({.kind = GigeOrder::Kind::kResend,
                  .to = s.resend_to_requester ? requester : s.destination,
                  .acquisition = era << 32 | s.epoch,
                  .block = request.block,
                  .next = request.first_packet,
                  .last = request.last_packet,
                  .extended_ids = s.long_ids(),
                  .packet_bytes = s.packet_bytes});
}

void GigeSink::Implementation::order_test_packet(const GigeStreamState& s, std::size_t payload_bytes) {
    GigeOrder order;
    order.kind = GigeOrder::Kind::kTestPacket;
    order.to = s.destination;
    order.packet_bytes = static_cast<std::uint32_t>(payload_bytes + 28);
    order.do_not_fragment = s.do_not_fragment;
    sender.order(order);
}

// Opens new sockets at once, the stream's too, so that the device can report whether that worked. They are
// used after the present message is answered.
bool GigeSink::Implementation::change_address(std::uint32_t ip) {
    if (ip == net.address) return true;
    try {
        const NetInterface next = find_interface(format_ipv4(ip));
        auto fresh = std::make_unique<GigeSockets>(next);
        sender.open(next.address);
        next_sockets = std::move(fresh);
        net = next;
        return true;
    } catch (const std::runtime_error&) {
        return false;
    }
}

void GigeSink::Implementation::move_to_next_sockets() {
    sockets = std::move(next_sockets);
    sender.close();
    sender.start();
    device->set_ports(sender.port(), sockets->message_port());
    address.store(net.address);
    clock.move(net);
}

// --- control thread

void GigeSink::Implementation::serve_control() {
    make_thread_urgent();
    std::array<std::uint8_t, gvcp::kMaxDatagramBytes> out;
    const GigeSockets::Receive answer = [&](std::span<const std::uint8_t> datagram, Endpoint from,
                                            bool broadcast) {
        const std::int64_t now_ns = monotonic_ns();
        const std::size_t size = device->handle(datagram, from, now_ns, out, broadcast);
        if (size > 0) sockets->send_answer({out.data(), size}, from);
        device->tick(now_ns);
    };
    while (!stopping.load()) {
        sockets->wait(wakeup, device->wake_ns() - monotonic_ns());
        strange_datagrams.fetch_add(sockets->take(answer), std::memory_order_relaxed);
        notify_device(monotonic_ns());
        if (next_sockets) move_to_next_sockets();
    }
}

void GigeSink::Implementation::notify_device(std::int64_t now_ns) {
    for (Event event{}; events.pop(event);) device->on_event(event.event, event.block, now_ns);
    if (const std::uint64_t last = finished.exchange(0, std::memory_order_acquire); last >> 32 == era)
        device->acquisition_finished(static_cast<std::uint32_t>(last));
    const GigeSender::Counts& c = sender.counts();
    device->set_statistics({.frames = c.frames,
                            .frames_dropped = frames_dropped(),
                            .packets = c.packets,
                            .packets_dropped = c.packets_dropped,
                            .resend_requests = c.resend_requests,
                            .packets_resent = c.packets_resent,
                            .packets_refused = c.packets_refused,
                            .events_dropped = events_dropped});
    device->tick(now_ns);
    clock.look(device->ptp_data_set());
    sender.set_frame_rate(camera.settings().frame_rate_hz);
    controlled.store(device->controlled());
    foreign_resend_requests.store(device->foreign_resend_requests());
}

// --- the sink

GigeSink::GigeSink(const GigeConfig& config, const SinkContext& context) {
    const CameraLimits limits = context.camera.limits();
    std::size_t bytes =
        max_payload_bytes(limits.width, limits.height, limits.color_pattern, config.multipart);
    std::shared_ptr<const CameraFaceFiles> face;
    if (!config.face_file.empty()) {
        face = read_face(config.genicam_file, config.face_file, config.registers_file);
        check_camera(face->table, limits.width, limits.height);
        bytes += chunk_layout_of(face->table, limits.color_pattern).bytes(~0u);
    }
    implementation_ = std::make_unique<Implementation>(config, context, limits, bytes, std::move(face));
}
GigeSink::~GigeSink() { stop(); }

void GigeSink::start() {
    Implementation& my = *implementation_;
    my.open();
    my.stopping.store(false);
    my.sender.start();
    my.running.store(true);
    my.control_thread = std::thread([&my] { my.serve_control(); });
}

void GigeSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    Implementation& my = *implementation_;
    const GigeStreamNow& now = my.for_loop.read();
    const std::uint64_t block = my.writer.admit(frame, record, now);
    if (my.exposure_end) my.notify(*my.exposure_end, my.exposure_end->frame == record.id ? block : 0);
    my.exposure_end.reset();
    const GigeFrameWriter::Outcome outcome = my.writer.write(frame, record, now, block);
    if (outcome.written) my.sender.frame_ready();
    if (outcome.finished) my.finish(now.acquisition);
}

// A sender never waits long for a client, so there is room soon. With one frame fewer than the ring holds,
// the sender gives up no late frame.
bool GigeSink::has_room() const noexcept {
    Implementation& my = *implementation_;
    const GigeStreamState& s = my.for_loop.read().state;
    const bool taken = s.open && s.acquiring && my.running.load(std::memory_order_relaxed);
    return !taken || my.ring.waiting() <= FrameSpacing::kMaxQueued;
}

void GigeSink::on_event(const CameraEvent& event) noexcept {
    Implementation& my = *implementation_;
    // A frame gets its block id when it is published. Before that it is unknown whether the stream takes it,
    // so the event of an exposure's start has none.
    if (event.kind == CameraEvent::Kind::kExposureEnd) {
        my.exposure_end = event;
        return;
    }
    if (event.kind == CameraEvent::Kind::kExposureStart)
        my.begun_frame.store(event.frame, std::memory_order_release);
    my.notify(event, 0);
}

void GigeSink::stop() noexcept {
    Implementation& my = *implementation_;
    if (!my.control_thread.joinable()) return;
    my.stopping.store(true);
    wake(my.wakeup);
    my.control_thread.join();
    my.running.store(false);
    my.sender.close();
    my.clock.stop();
    my.sockets.reset();
    my.next_sockets.reset();
}

std::vector<SinkNote> GigeSink::take_notes() {
    Implementation& my = *implementation_;
    return my.clock.take_notes("gige " + format_ipv4(my.address.load()));
}

SinkReport GigeSink::report() const {
    const Implementation& my = *implementation_;
    const GigeSender::Counts& c = my.sender.counts();
    const auto n = [](std::uint64_t count) { return static_cast<double>(count); };
    return {.name = "gige " + format_ipv4(my.address.load()),
            .frames = c.frames,
            .dropped = my.frames_dropped() + my.writer.of_other_size().count(),
            .unwanted = my.writer.unwanted(),
            .figures = {{"clients", my.controlled ? 1.0 : 0.0},
                        {"acquisitions", n(my.acquisitions)},
                        {"packets_sent", n(c.packets)},
                        {"bytes_sent", n(c.bytes)},
                        {"packets_dropped_by_faults", n(c.packets_dropped)},
                        {"packets_not_taken_by_kernel", n(c.packets_failed.count())},
                        {"resend_requests", n(c.resend_requests)},
                        {"packets_resent", n(c.packets_resent)},
                        {"packets_refused", n(c.packets_refused)},
                        {"packets_over_resend_limit", n(c.packets_over_limit)},
                        {"resend_requests_unanswered", n(c.requests_unanswered)},
                        {"resend_requests_from_others", n(my.foreign_resend_requests)},
                        {"frames_spaced", n(c.frames_spaced)},
                        {"frames_given_up", n(c.frames_given_up.count())},
                        {"test_packets", n(c.test_packets)},
                        {"test_packets_not_taken_by_kernel", n(c.test_packets_failed)},
                        {"commands_from_other_interfaces", n(my.strange_datagrams)},
                        {"frames_of_other_size", n(my.writer.of_other_size().count())},
                        {"events_dropped", n(my.events_dropped)}},
            .dropped_by_faults = my.writer.dropped_by_faults(),
            .first_dropped = first_of(
                {my.writer.dropped().first(), my.writer.of_other_size().first(), c.frames_given_up.first()}),
            .packets_lost = c.packets_failed.count(),
            .first_with_lost_packet = c.packets_failed.first(),
            .clock = my.clock.report()};
}

std::vector<ListeningPort> listening(const GigeConfig& c) {
    return {{"outputs.gige.interface", c.interface, gvcp::kPort, false}};
}

std::unique_ptr<FrameSink> make_sink(const GigeConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    GigeConfig own = config;
    if (own.model == GigeConfig{}.model && !shape.camera_name.empty()) own.model = shape.camera_name;
    return std::make_unique<GigeSink>(own, context);
}

}  // namespace hilcam
