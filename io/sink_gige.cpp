#include "io/sink_gige.h"

#include <arpa/inet.h>
#include <netinet/ip.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <semaphore>
#include <thread>
#include <vector>

#include "io/fd.h"
#include "io/gige_device.h"
#include "io/gige_packets.h"
#include "io/net_interface.h"
#include "io/receiver_room.h"
#include "render/latest.h"

namespace hilcam {
namespace {

// Slots: those waiting to be sent plus those kept for resends.
constexpr std::size_t kSlots = 12;
constexpr std::size_t kMostWaiting = 3;
// Packets per system call: so many, and no more than take a third of a client's default receive buffer.
constexpr std::size_t kMostBatch = 8;
constexpr std::size_t kBatchBytes = 70'000;
constexpr std::int64_t kResendPatience_ns = 20'000'000;

std::int64_t monotonic_ns() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
void sleep_until_ns(std::int64_t ns) {
    const timespec t{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace

Fields fields(GigeConfig& c) {
    return {
        text("interface", c.interface, "IPv4 address or name of the interface to be a camera on"),
        text("model", c.model, "DeviceModelName; the camera's name when left as hilcam"),
        text("serial", c.serial, "DeviceSerialNumber; unlike any other camera's on the network"),
        text("user_name", c.user_name, "DeviceUserID at the start"),
        integer("packet_bytes", c.packet_bytes, {576, 16384},
                "of a stream packet until a client sets another"),
        number("rate_limit_mb_s", c.rate_bytes_s, 1e6, {1, 100000}, "upper limit of the stream"),
    };
}

struct GigeSink::Implementation {
    GigeConfig config;
    CameraControl& camera;
    FaultBoard& faults;
    DeliveryListener* listener;
    NetInterface net;
    std::unique_ptr<GigeDevice> device;
    Fd control, broadcast, stream, wakeup;
    sockaddr_in stream_address{};
    std::thread control_thread, sender_thread;
    ReceiverRoom control_room, sender_room;  // one a thread

    // Control thread -> loop, control thread -> sender.
    Latest<GigeStreamState> for_loop, for_sender;
    std::atomic<std::uint32_t> finished_epoch{0};

    // A frame on the wire. `block` is 0 while the loop writes the slot; readers check it before and after.
    struct Slot {
        std::atomic<std::uint16_t> block{0};
        std::uint32_t epoch = 0;
        GigeStreamState state;
        FrameRecord record;
        std::vector<std::uint8_t> payload;

        std::uint32_t trailer() const { return trailer_id(state); }
        GigePacket packet(std::uint16_t id_of_block, std::uint32_t id) const {
            return packet_of({state, {}, id_of_block, stamp(), 0, payload}, id, gvsp::kFresh);
        }
        std::uint64_t stamp() const { return static_cast<std::uint64_t>(record.exposure_mid_monotonic_ns); }
    };
    std::array<Slot, kSlots> slots;
    std::vector<std::uint16_t> scratch;
    std::atomic<std::uint64_t> head{0}, sent{0};
    std::counting_semaphore<> ready{0};
    std::atomic<bool> stopping{false};
    std::uint32_t loop_epoch = 0;
    std::uint32_t loop_frames = 0;
    std::uint16_t next_block = 1;

    std::atomic<std::uint64_t> delivered{0}, dropped{0}, resent{0}, unavailable{0};

    Implementation(const GigeConfig& c, const SinkContext& context)
        : config(c),
          camera(context.camera),
          faults(context.faults),
          listener(context.listener),
          net(find_interface(c.interface)) {}

    void open();
    void serve_control();
    void answer_from(const Fd& socket);
    void send_frames();
    void send_frame(Slot& slot);
    void resend(const gvcp::ResendRequest& request);
    void test_packet(const GigeStreamState& state, std::size_t bytes);
};

void GigeSink::Implementation::open() {
    control = open_udp(net.address, gvcp::kPort);
    try {
        broadcast = open_udp(INADDR_BROADCAST, gvcp::kPort, true);
    } catch (const DeviceError&) {
        // Another program holds the broadcast address for itself: clients that know the camera's address
        // still find it.
    }
    stream = open_udp(net.address, 0);
    socklen_t address_size = sizeof stream_address;
    getsockname(stream.get(), reinterpret_cast<sockaddr*>(&stream_address), &address_size);
    wakeup = open_wakeup();
    const CameraLimits limits = camera.limits();
    const std::size_t bytes = most_payload_bytes(limits.width, limits.height, {});
    scratch.resize(3 * static_cast<std::size_t>(limits.width) + 8);
    for (Slot& slot : slots) slot.payload = std::vector<std::uint8_t>(bytes);
    GigeDevice::Effects effects;
    effects.stream_changed = [this](const GigeStreamState& state) {
        for_loop.write(state);
        for_sender.write(state);
    };
    effects.resend = [this](const gvcp::ResendRequest& request, Endpoint) { resend(request); };
    effects.test_packet = [this](const GigeStreamState& state, std::size_t size) {
        test_packet(state, size);
    };
    device = std::make_unique<GigeDevice>(
        GigeIdentity{config.model, config.serial, config.user_name, net.address, net.mask, 0, net.mac,
                     static_cast<std::uint32_t>(config.packet_bytes)},
        camera, faults, std::move(effects));
    device->set_ports(ntohs(stream_address.sin_port), 0);
}

// --- control thread
// ------------------------------------------------------------------------------------------------

void GigeSink::Implementation::serve_control() {
    std::array<pollfd, 3> watched = {
        {{wakeup.get(), POLLIN, 0}, {control.get(), POLLIN, 0}, {broadcast.get(), POLLIN, 0}}};
    std::uint32_t seen_finished = 0;
    while (true) {
        poll(watched.data(), broadcast ? 3 : 2, 50);
        if (watched[0].revents) return;
        if (watched[1].revents) answer_from(control);
        if (broadcast && watched[2].revents) answer_from(broadcast);
        const std::uint32_t finished = finished_epoch.load(std::memory_order_acquire);
        if (finished != seen_finished) device->acquisition_finished(seen_finished = finished);
        device->tick(monotonic_ns());
    }
}

void GigeSink::Implementation::answer_from(const Fd& socket) {
    std::array<std::uint8_t, 2048> in;
    std::array<std::uint8_t, gvcp::kMostDatagramBytes> out;
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t got = recvfrom(socket.get(), in.data(), in.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&sender), &size);
    if (got < 0) return;
    const Endpoint from{ntohl(sender.sin_addr.s_addr), ntohs(sender.sin_port)};
    const std::size_t answer = device->handle({in.data(), static_cast<std::size_t>(got)}, from,
                                              monotonic_ns(), out, &socket == &broadcast);
    if (answer > 0)
        sendto(control.get(), out.data(), answer, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&sender),
               sizeof sender);
}

void GigeSink::Implementation::test_packet(const GigeStreamState& state, std::size_t bytes) {
    std::array<std::uint8_t, 16384> packet{};
    const int discover = state.do_not_fragment ? IP_PMTUDISC_DO : IP_PMTUDISC_WANT;
    setsockopt(stream.get(), IPPROTO_IP, IP_MTU_DISCOVER, &discover, sizeof discover);
    const sockaddr_in to = socket_address(state.destination.ip, state.destination.port);
    sendto(stream.get(), packet.data(), std::min(bytes, packet.size()), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void GigeSink::Implementation::resend(const gvcp::ResendRequest& request) {
    const auto block = static_cast<std::uint16_t>(request.block);
    const GigeStreamState& now = device->stream_state();
    const sockaddr_in to = socket_address(now.destination.ip, now.destination.port);
    std::array<std::uint8_t, 16384> packet;
    const Slot* slot = nullptr;
    for (const Slot& candidate : slots)
        if (candidate.block.load(std::memory_order_acquire) == block && candidate.epoch == now.epoch)
            slot = &candidate;
    std::uint32_t last = request.last_packet;
    // One request may not make more than one frame's worth of answers.
    last = std::min(last, slot ? slot->trailer() : request.first_packet);
    // The control port must not go silent for a client that reads slowly.
    const std::int64_t until_ns = monotonic_ns() + kResendPatience_ns;
    for (std::uint32_t id = request.first_packet; id <= last; ++id) {
        if (monotonic_ns() < until_ns)
            control_room.wait(stream_address, to, ReceiverRoom::bytes_of(now.packet_bytes), stopping);
        GigePacket made = refusal_of(false, block, id, gvsp::kUnavailable);
        bool whole = false;
        if (slot) {
            const GigePacket sent_once = slot->packet(block, id);
            std::copy(sent_once.data.begin(), sent_once.data.end(), packet.begin() + gvsp::kMostHeadBytes);
            // The loop may have reused the slot meanwhile: then what was copied is of two frames.
            std::atomic_thread_fence(std::memory_order_acquire);
            whole = slot->block.load(std::memory_order_relaxed) == block;
            if (whole) made = sent_once;
        }
        std::copy_n(made.head.begin(), made.head_bytes,
                    packet.begin() + static_cast<std::ptrdiff_t>(gvsp::kMostHeadBytes - made.head_bytes));
        (whole ? resent : unavailable).fetch_add(1);
        sendto(stream.get(), packet.data() + (gvsp::kMostHeadBytes - made.head_bytes), made.bytes(),
               MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to), sizeof to);
        if (!whole) return;
    }
}

// --- sender thread
// -------------------------------------------------------------------------------------------------

void GigeSink::Implementation::send_frames() {
    while (true) {
        ready.acquire();
        if (stopping.load()) return;
        const std::uint64_t index = sent.load(std::memory_order_relaxed);
        Slot& slot = slots[index % kSlots];
        const GigeStreamState& now = for_sender.read();
        // The client may have gone, or begun anew, since the frame was packed.
        if (now.open && now.epoch == slot.epoch) send_frame(slot);
        sent.store(index + 1, std::memory_order_release);
    }
}

void GigeSink::Implementation::send_frame(Slot& slot) {
    sockaddr_in to = socket_address(slot.state.destination.ip, slot.state.destination.port);
    const std::uint16_t block = slot.block.load();
    const std::uint32_t last = slot.trailer();
    const double rate_ns = static_cast<double>(slot.state.packet_bytes) / config.rate_bytes_s * 1e9;
    const double interval_ns = std::max(rate_ns, static_cast<double>(slot.state.packet_delay_ns));
    std::array<GigePacket, kMostBatch> packets;
    std::array<std::array<iovec, 2>, kMostBatch> parts;
    std::array<mmsghdr, kMostBatch> messages;
    const std::size_t packet_room = ReceiverRoom::bytes_of(slot.state.packet_bytes);
    // A delay asked for by the client is per packet; without one, batches keep the rate.
    const std::size_t batch = slot.state.packet_delay_ns > 100'000
                                  ? 1
                                  : std::clamp<std::size_t>(kBatchBytes / packet_room, 1, kMostBatch);
    const std::int64_t first_ns = monotonic_ns();
    std::uint32_t id = 0;
    while (id <= last) {
        unsigned count = 0;
        for (; count < batch && id <= last; ++count, ++id) {
            GigePacket& made = packets[count] = slot.packet(block, id);
            const auto payload = made.data;
            parts[count][0] = {made.head.data(), made.head_bytes};
            parts[count][1] = {const_cast<std::uint8_t*>(payload.data()), payload.size()};
            messages[count] = {};
            messages[count].msg_hdr.msg_name = &to;
            messages[count].msg_hdr.msg_namelen = sizeof to;
            messages[count].msg_hdr.msg_iov = parts[count].data();
            messages[count].msg_hdr.msg_iovlen = payload.empty() ? 1 : 2;
        }
        sender_room.wait(stream_address, to, count * packet_room, stopping);
        // What the kernel does not take now is lost like on a wire; the client asks for it again.
        sendmmsg(stream.get(), messages.data(), count, 0);
        if (id <= last) {
            const std::int64_t due_ns = first_ns + static_cast<std::int64_t>(id * interval_ns);
            // Shorter sleeps than this cost more than they pace.
            if (due_ns - monotonic_ns() > 50'000) sleep_until_ns(due_ns);
        }
    }
    delivered.fetch_add(1);
    if (listener) listener->delivered(slot.record, first_ns, monotonic_ns());
}

// --- the sink
// ------------------------------------------------------------------------------------------------------

GigeSink::GigeSink(const GigeConfig& config, const SinkContext& context)
    : implementation_(std::make_unique<Implementation>(config, context)) {}
GigeSink::~GigeSink() { stop(); }

void GigeSink::start() {
    Implementation& my = *implementation_;
    my.open();
    my.control_thread = std::thread([&my] { my.serve_control(); });
    my.sender_thread = std::thread([&my] { my.send_frames(); });
}

void GigeSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    Implementation& my = *implementation_;
    const GigeStreamState& state = my.for_loop.read();
    if (!state.open || !state.acquiring) return;
    if (state.epoch != my.loop_epoch) {
        my.loop_epoch = state.epoch;
        my.loop_frames = 0;
        my.next_block = 1;
    }
    if (state.frames != 0 && my.loop_frames >= state.frames) return;
    const std::uint16_t block = my.next_block;
    my.next_block = block == 65535 ? 1 : static_cast<std::uint16_t>(block + 1);
    const std::uint64_t head = my.head.load(std::memory_order_relaxed);
    if (head - my.sent.load(std::memory_order_acquire) >= kMostWaiting) {
        my.dropped.fetch_add(1);  // the block id stays used: the client sees the gap
        return;
    }
    Implementation::Slot& slot = my.slots[head % kSlots];
    slot.block.store(0, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    slot.state = state;
    slot.epoch = state.epoch;
    slot.record = record;
    write_gige_payload(frame, record, state, {}, slot.stamp(), my.scratch, slot.payload);
    slot.block.store(block, std::memory_order_release);
    my.head.store(head + 1, std::memory_order_release);
    my.ready.release();
    if (state.frames != 0 && ++my.loop_frames == state.frames)
        my.finished_epoch.store(state.epoch, std::memory_order_release);
}

void GigeSink::stop() noexcept {
    Implementation& my = *implementation_;
    if (!my.control_thread.joinable()) return;
    my.stopping.store(true);
    my.ready.release();
    wake(my.wakeup);
    my.sender_thread.join();
    my.control_thread.join();
}

SinkReport GigeSink::report() const {
    const Implementation& my = *implementation_;
    return {"gige " + format_ipv4(my.net.address), my.delivered.load(), my.dropped.load(), ""};
}

}  // namespace hilcam
