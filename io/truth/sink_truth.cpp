#include "io/truth/sink_truth.h"

#include <pthread.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// Niceness above the threads that make frames; the preview's threads are nicer still.
constexpr int kNicer = 10;
// The bytes that an IPv4 datagram holds: 65535 less the headers of IP and UDP.
constexpr std::size_t kMaxDatagramBytes = 65507;

LineServerSetup port_of(const TruthConfig& c) {
    return {c.address, static_cast<std::uint16_t>(c.port), c.allow, static_cast<std::size_t>(c.clients),
            "outputs.truth"};
}

}  // namespace

TruthSink::TruthSink(const TruthConfig& config, const TruthSource& source,
                     const std::function<FrameTruth()>& make_slot, TruthListener* listener)
    : config_(config), document_(source), listener_(listener) {
    if (!config.folder.empty()) require_unused(run_folder(config));
    if (config.port != 0) server_ = std::make_unique<LineServer>(port_of(config));
    for (const std::string& to : config.udp_to) destinations_.push_back(parse_endpoint(to));
    // A listener can miss one: it wants a few frames a second.
    const std::size_t count = config.layers.empty() && has_outputs() ? kSlots : kFewerSlots;
    for (std::size_t i = 0; i < count; ++i) {
        slots_.push_back(std::make_unique<Slot>());
        slots_.back()->truth = make_slot();
    }
}

bool TruthSink::has_outputs() const { return server_ || !destinations_.empty() || !config_.folder.empty(); }

void TruthSink::start() {
    if (!config_.folder.empty()) {
        claim(run_folder(config_));
        files_.emplace(config_.folder, document_.header());
    }
    if (!destinations_.empty()) udp_ = open_udp(INADDR_ANY, 0);
    if (server_) server_->start();
    open_.store(true);
    thread_ = std::thread([this] {
        pthread_setname_np(pthread_self(), kTruthThreadName);
        // Linux: of this thread alone.
        setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kNicer);
        nice_.release();
        run();
    });
    nice_.acquire();  // whoever raises threads later leaves this one as it is
}

FrameTruth* TruthSink::begin(const FrameRecord& record) noexcept {
    if (!open_.load(std::memory_order_relaxed)) return nullptr;
    const bool for_outputs = has_outputs() && offered_++ % static_cast<std::uint64_t>(config_.every_nth) == 0;
    const bool for_listener = listener_ && listener_->wants_truth();
    if (!for_outputs && !for_listener) return nullptr;
    const std::size_t taken = taken_.load(std::memory_order_relaxed);
    if (taken - done_.load(std::memory_order_acquire) == slots_.size()) {
        if (for_outputs) dropped_.fetch_add(1, std::memory_order_relaxed);
        return nullptr;
    }
    Slot& slot = *slots_[taken % slots_.size()];
    const TruthSource& source = document_.source();
    slot.truth.raster = raster_of(source.model, source.oversampling,
                                  {record.binning_x, record.binning_y, record.reverse_x, record.reverse_y});
    slot.for_outputs = for_outputs, slot.for_listener = for_listener;
    slot.frame.store(record.id, std::memory_order_relaxed);
    taken_.store(taken + 1, std::memory_order_relaxed);
    return &slot.truth;
}

// Frames come in the order in which they were begun, one by one.
void TruthSink::publish(const DnImage&, const FrameRecord& record) noexcept {
    const std::size_t ready = ready_.load(std::memory_order_relaxed);
    Slot& slot = *slots_[ready % slots_.size()];
    // The slot of a frame without truth holds another's: an earlier one's, or that of the frame after it.
    if (slot.frame.load(std::memory_order_relaxed) != record.id) return;
    slot.record = record;
    ready_.store(ready + 1, std::memory_order_release);
    news_.release();
}

// Lockstep asks before it publishes: with this much room neither stage will find the slots taken.
bool TruthSink::has_room() const noexcept {
    if (!open_.load(std::memory_order_relaxed)) return true;
    const std::size_t waiting =
        ready_.load(std::memory_order_relaxed) - done_.load(std::memory_order_acquire);
    return waiting + kInLoop < slots_.size();
}

void TruthSink::run() {
    while (true) {
        news_.acquire();
        const std::size_t done = done_.load(std::memory_order_relaxed);
        if (done == ready_.load(std::memory_order_acquire)) return;  // stop() has called
        const Slot& slot = *slots_[done % slots_.size()];
        try {
            deliver(slot);
            written_.fetch_add(1, std::memory_order_relaxed);
            took_ms_.store(took_ms_.load(std::memory_order_relaxed) + slot.truth.took_ms,
                           std::memory_order_relaxed);
        } catch (const std::exception& error) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            const std::lock_guard lock(mutex_);
            fault_ = plain_words(error);
        }
        done_.store(done + 1, std::memory_order_release);
    }
}

// The stream first: files take longer.
void TruthSink::deliver(const Slot& slot) {
    const std::string line = document_.line(slot.truth, slot.record);
    if (slot.for_listener) listener_->take_truth(slot.record.id, line);
    if (!slot.for_outputs) return;
    if (server_) server_->notify(line + "\n");
    if (!destinations_.empty()) send_datagrams(slot.truth, slot.record, line);
    if (files_) files_->write(slot.truth, slot.record.id, line, document_.legend(slot.truth));
}

void TruthSink::send_datagrams(const FrameTruth& truth, const FrameRecord& record, const std::string& line) {
    const bool fits = line.size() <= kMaxDatagramBytes;
    const std::string shorter = fits ? std::string() : document_.line(truth, record, false);
    const std::string& text = fits ? line : shorter;
    for (const sockaddr_in& to : destinations_)
        if (sendto(udp_.get(), text.data(), text.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to) < 0)
            not_sent_.fetch_add(1, std::memory_order_relaxed);
}

// Stops the thread; what was handed over is still delivered.
void TruthSink::stop() noexcept {
    if (!thread_.joinable()) return;
    open_.store(false);
    news_.release();
    thread_.join();
    if (server_) server_->stop();
    udp_.reset();
}

bool TruthSink::has_fault() const noexcept {
    const std::lock_guard lock(mutex_);
    return !fault_.empty();
}

SinkReport TruthSink::report() const {
    SinkReport out;
    out.name = has_outputs() ? "truth" : "truth for the preview";
    out.frames = written_.load();
    out.dropped = dropped_.load();
    out.figures = {{"truth_ms", out.frames > 0 ? took_ms_.load() / static_cast<double>(out.frames) : 0.0}};
    if (server_) {
        out.figures.emplace_back("clients", static_cast<double>(server_->clients()));
        out.figures.emplace_back("cut_off", static_cast<double>(server_->cut_off()));
    }
    if (!destinations_.empty())
        out.figures.emplace_back("datagrams_not_sent", static_cast<double>(not_sent_.load()));
    const std::lock_guard lock(mutex_);
    out.fault = fault_;
    return out;
}

}  // namespace hilcam
