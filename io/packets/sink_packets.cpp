#include "io/packets/sink_packets.h"

#include <pthread.h>

#include <algorithm>

#include "io/contract/camera_control.h"
#include "io/images/picture_notes.h"
#include "io/packets/pixel_code.h"
#include "io/system/monotonic.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kSlots = 8;
constexpr const char* kThreadName = "packets";  // in `top -H`

bool is_stream(const PacketsConfig& c) { return c.transport != PacketsConfig::Transport::kUdp; }

std::optional<SpaceWireWrapper> spacewire_of(const PacketsConfig& c) {
    if (!c.has_spacewire) return {};
    return SpaceWireWrapper(c.spacewire, is_stream(c));
}

}  // namespace

PacketsSink::PacketsSink(const PacketsConfig& config, int width, int height, PacketCamera camera, bool waits,
                         PacketSurroundings surroundings)
    : config_(config),
      camera_(std::move(camera)),
      waits_(waits),
      surroundings_(surroundings),
      encoder_(make_payload_encoder(config.payload)),
      transport_(make_packet_transport(config)),
      segmenter_(static_cast<std::uint16_t>(config.apid), static_cast<std::size_t>(config.packet_bytes),
                 config.crc),
      spacewire_(spacewire_of(config)),
      pacer_(config.rate_bytes_s),
      mailbox_(width, height, kSlots) {}

void PacketsSink::start() {
    transport_->open();
    mailbox_.open();
    thread_ = std::thread([this] { run(); });
    pthread_setname_np(thread_.native_handle(), kThreadName);
}

void PacketsSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    if (offered_++ % static_cast<std::uint64_t>(config_.every_nth) != 0) return;
    if (surroundings_.fates)
        surroundings_.fates->expect(record.id);  // the thread may finish before put() does
    if (!mailbox_.put(frame, record)) settle(record.id, false);
}

void PacketsSink::stop() noexcept {
    if (!thread_.joinable()) return;
    mailbox_.close();
    thread_.join();
    transport_->close();
}

void PacketsSink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        try {
            count(item->record, deliver(*item));
            settle(item->record.id, true);
        } catch (const std::exception& error) {
            fail(error, item->record.id);
            settle(item->record.id, false);
        }
        mailbox_.done();
    }
}

PacketsSink::Outcome PacketsSink::deliver(const FrameMailbox::Item& item) {
    if (!transport_->begin_frame(item.record.id)) return Outcome::kUnwanted;
    encode(item);
    const std::int64_t begun_ns = monotonic_ns();
    segmenter_.begin(header_of(item), payload_, strips_);
    if (!send_all()) return Outcome::kDropped;
    const Outcome outcome = transport_->end_frame();
    if (surroundings_.listener && outcome == Outcome::kDelivered)
        surroundings_.listener->delivered(item.record, begun_ns, monotonic_ns());
    return outcome;
}

// False when nobody is left who takes the frame.
bool PacketsSink::send_all() {
    for (std::span<const std::uint8_t> packet = segmenter_.next(); !packet.empty();
         packet = segmenter_.next()) {
        const std::span<const std::uint8_t> bytes = spacewire_ ? spacewire_->wrap(packet) : packet;
        if (is_live(config_)) sleep_until_monotonic_ns(pacer_.may_leave(monotonic_ns(), bytes.size()));
        if (!transport_->send(bytes)) {
            segmenter_.skip_rest();
            return false;
        }
        counters_.packets.fetch_add(1, std::memory_order_relaxed);
        counters_.bytes.fetch_add(bytes.size(), std::memory_order_relaxed);
    }
    return true;
}

void PacketsSink::encode(const FrameMailbox::Item& item) {
    const std::int64_t begun_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
    const int height = item.frame.height();
    const int most = config_.strip_rows > 0 ? static_cast<int>(config_.strip_rows) : height;
    payload_.clear();
    strips_.clear();
    for (int first = 0; first < height; first += most) {
        const int rows = std::min(most, height - first);
        const std::size_t begin = payload_.size();
        encoder_->encode(strip_of(item.frame, first, rows, item.record.bits), payload_);
        strips_.push_back({static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(rows), begin,
                           payload_.size() - begin});
    }
    counters_.encoding_ns.fetch_add(clock_ns(CLOCK_THREAD_CPUTIME_ID) - begun_ns, std::memory_order_relaxed);
    counters_.encoded.fetch_add(1, std::memory_order_relaxed);
    counters_.pixel_bits.fetch_add(item.frame.pixels() * static_cast<std::uint64_t>(item.record.bits),
                                   std::memory_order_relaxed);
    counters_.payload_bits.fetch_add(8 * payload_.size(), std::memory_order_relaxed);
}

ImageFrame PacketsSink::header_of(const FrameMailbox::Item& item) const {
    const FrameRecord& r = item.record;
    return {.exposure_mid = r.exposure_mid,
            .payload = config_.payload,
            .bits = static_cast<std::uint8_t>(r.bits),
            .reverse_x = r.reverse_x,
            .reverse_y = r.reverse_y,
            .binning_x = static_cast<std::uint8_t>(r.binning_x),
            .binning_y = static_cast<std::uint8_t>(r.binning_y),
            .width = static_cast<std::uint16_t>(item.frame.width()),
            .height = static_cast<std::uint16_t>(item.frame.height()),
            .offset_x = static_cast<std::uint16_t>(camera_.offset_x),
            .offset_y = static_cast<std::uint16_t>(camera_.offset_y),
            .pixel_code = pixel_code(r.bits, config_.payload == Payload::kPacked, camera_.color_pattern),
            .frame = r.id,
            .exposure_s = r.exposure_s};
}

void PacketsSink::count(const FrameRecord& record, Outcome outcome) {
    switch (outcome) {
        case Outcome::kDelivered:
            counters_.delivered.fetch_add(1);
            break;
        case Outcome::kUnwanted:
            counters_.unwanted.fetch_add(1);
            break;
        case Outcome::kDropped:
            counters_.gone.add(record.id);
            break;
    }
}

void PacketsSink::fail(const std::exception& error, std::uint64_t frame) {
    segmenter_.skip_rest();
    const std::lock_guard lock(mutex_);
    if (failed_++ == 0) first_failure_ = plain_words(error), first_failed_ = frame;
}

void PacketsSink::settle(std::uint64_t frame, bool written) {
    if (surroundings_.fates) surroundings_.fates->settle(frame, written);
}

bool PacketsSink::has_fault() const noexcept {
    if (config_.when_slow != WhenSlow::kDrop && mailbox_.dropped() > 0) return true;
    const std::lock_guard lock(mutex_);
    return failed_ > 0;
}

// Reports frames that could not be written before frames that came too fast.
std::string PacketsSink::report_of_loss() const {
    if (failed_ > 0) return report_of_failures(first_failure_, failed_);
    const std::uint64_t dropped = mailbox_.dropped();
    return dropped == 0 || config_.when_slow == WhenSlow::kDrop
               ? ""
               : report_of_drops("outputs.packets", transport_->name(), dropped, counters_.delivered.load());
}

SinkReport PacketsSink::report() const {
    const std::lock_guard lock(mutex_);
    const auto n = [](auto value) { return static_cast<double>(value); };
    const double encoded = n(std::max<std::uint64_t>(1, counters_.encoded.load()));
    const double payload_bits = n(std::max<std::uint64_t>(1, counters_.payload_bits.load()));
    return {.name = "packets " + transport_->name(),
            .frames = counters_.delivered.load(),
            .dropped = mailbox_.dropped() + counters_.gone.count() + failed_,
            .fault = report_of_loss(),
            .unwanted = counters_.unwanted.load(),
            .figures = {{"packets_sent", n(counters_.packets.load())},
                        {"bytes_sent", n(counters_.bytes.load())},
                        {"payload_bytes_a_frame", payload_bits / 8 / encoded},
                        {"compression_ratio", n(counters_.pixel_bits.load()) / payload_bits},
                        {"encoding_core_ms_a_frame", 1e-6 * n(counters_.encoding_ns.load()) / encoded}},
            .first_dropped = first_of({mailbox_.first_dropped(), counters_.gone.first(), first_failed_}),
            .packets_lost = transport_->packets_lost().count(),
            .first_with_lost_packet = transport_->packets_lost().first()};
}

std::unique_ptr<FrameSink> make_sink(const PacketsConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    PacketCamera camera{context.camera.limits().color_pattern};
    if (shape.run) {
        const PixelRectangle window = window_of(shape.run->model);
        camera.offset_x = window.left, camera.offset_y = window.top;
    }
    PacketSurroundings surroundings;
    if (is_live(config))
        surroundings.listener = context.listener;
    else if (context.fates)
        surroundings.fates = context.fates->claim();
    return std::make_unique<PacketsSink>(config, shape.width, shape.height, std::move(camera),
                                         waits(config.when_slow, shape.has_live_output), surroundings);
}

}  // namespace hilcam
