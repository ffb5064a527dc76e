#include "io/truth/sink_truth.h"

#include <pthread.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// Added to the nice value of the threads that make frames; the preview's threads have a higher one still.
constexpr int kNicer = 10;
// The bytes that an IPv4 datagram holds: 65535 less the headers of IP and UDP.
constexpr std::size_t kMaxTruthBytes = 65507;

LineServerSetup port_of(const TruthConfig& c) {
    return {c.address, static_cast<std::uint16_t>(c.port), c.allow, static_cast<std::size_t>(c.clients),
            "outputs.truth"};
}

}  // namespace

TruthSink::TruthSink(const TruthConfig& config, const TruthSource& source,
                     const std::function<FrameTruth()>& make_slot, const TruthSurroundings& surroundings)
    : config_(config),
      document_(source),
      listener_(surroundings.listener),
      fates_(config.folder.empty() ? nullptr : surroundings.fates),
      waits_(!config.folder.empty() && waits(config.when_slow, surroundings.has_live_output)) {
    if (!config.folder.empty()) require_unused(run_folder(config));
    if (config.port != 0) server_ = std::make_unique<LineServer>(port_of(config));
    for (const std::string& to : config.udp_to) destinations_.push_back(parse_endpoint(to));
    if (fates_) fates_->listen([this] { news_.release(); });
    // A listener may miss a frame, because it wants only a few per second.
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
    nice_.acquire();  // so that a later change of the other threads' priority leaves this one alone
}

FrameTruth* TruthSink::begin(const FrameRecord& record, bool wanted) noexcept {
    if (!open_.load(std::memory_order_relaxed)) return nullptr;
    const bool for_outputs = has_outputs() && offered_++ % static_cast<std::uint64_t>(config_.every_nth) == 0;
    const bool for_listener = listener_ && (wanted || listener_->wants_truth());
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
    // Without truth for this frame, the slot belongs to an earlier frame or to the next one.
    if (slot.frame.load(std::memory_order_relaxed) != record.id) return;
    slot.record = record;
    ready_.store(ready + 1, std::memory_order_release);
    news_.release();
}

// Lockstep asks before it publishes. With this many free slots, neither stage finds all of them taken.
bool TruthSink::has_room() const noexcept {
    if (!open_.load(std::memory_order_relaxed)) return true;
    const std::size_t waiting =
        ready_.load(std::memory_order_relaxed) - done_.load(std::memory_order_acquire);
    return waiting + kInLoop < slots_.size();
}

// A signal means a frame's truth, the fate of a frame's file, or the end.
void TruthSink::run() {
    while (true) {
        news_.acquire();
        if (done_.load(std::memory_order_relaxed) != ready_.load(std::memory_order_acquire))
            take_next();
        else if (!open_.load(std::memory_order_acquire))
            break;
        write_settled_lines(false);
    }
    write_settled_lines(true);
}

// Counts what the action delivers, or a loss when it throws.
template <class Action>
void TruthSink::count(const Action& action) {
    try {
        if (action()) written_.fetch_add(1, std::memory_order_relaxed);
    } catch (const std::exception& error) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        const std::lock_guard lock(mutex_);
        fault_ = plain_words(error);
    }
}

void TruthSink::take_next() {
    const std::size_t done = done_.load(std::memory_order_relaxed);
    const Slot& slot = *slots_[done % slots_.size()];
    count([&] {
        deliver(slot);
        return !(files_ && slot.for_outputs);  // that is counted with its line
    });
    took_ms_.store(took_ms_.load(std::memory_order_relaxed) + slot.truth.took_ms, std::memory_order_relaxed);
    ++told_;
    done_.store(done + 1, std::memory_order_release);
}

// The stream comes first, because files take longer.
void TruthSink::deliver(const Slot& slot) {
    std::string line = document_.line(slot.truth, slot.record);
    if (slot.for_listener) listener_->take_truth(slot.record.id, line);
    if (!slot.for_outputs) return;
    if (server_) server_->notify(line + "\n");
    if (!destinations_.empty()) send_datagrams(slot.truth, slot.record, line);
    if (!files_) return;
    files_->write_layers(slot.truth, slot.record.id, document_.legend(slot.truth));
    held_lines_.push_back({slot.record.id, std::move(line)});
}

// Writes lines in the order of frames, up to the first with an undecided file. all: no more files will come.
void TruthSink::write_settled_lines(bool all) {
    while (!held_lines_.empty()) {
        const auto fate = fates_ ? fates_->of(held_lines_.front().frame) : FrameFates::Fate::kNoFile;
        if (fate == FrameFates::Fate::kPending && !all && held_lines_.size() < kMaxHeld) return;
        std::string line = std::move(held_lines_.front().text);
        held_lines_.pop_front();
        if (fate == FrameFates::Fate::kLost) line.replace(line.size() - 1, 1, ",\"file\":false}");
        count([&] {
            files_->add_line(line);
            return true;
        });
    }
}

void TruthSink::send_datagrams(const FrameTruth& truth, const FrameRecord& record, const std::string& line) {
    const bool fits = line.size() <= kMaxTruthBytes;
    const std::string shorter = fits ? std::string() : document_.line(truth, record, false);
    const std::string& text = fits ? line : shorter;
    for (const sockaddr_in& to : destinations_)
        if (sendto(udp_.get(), text.data(), text.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to) < 0)
            not_sent_.fetch_add(1, std::memory_order_relaxed);
}

// Stops the thread after it has delivered what was handed over.
void TruthSink::stop() noexcept {
    if (!thread_.joinable()) return;
    open_.store(false);
    news_.release();
    thread_.join();
    if (server_) server_->stop();
    udp_.reset();
}

bool TruthSink::has_fault() const noexcept {
    if (loss_is_fault() && dropped_.load() > 0) return true;
    const std::lock_guard lock(mutex_);
    return !fault_.empty();
}

SinkReport TruthSink::report() const {
    SinkReport out;
    out.name = has_outputs() ? "truth" : "truth for the preview";
    out.frames = written_.load();
    out.dropped = dropped_.load();
    const std::uint64_t told = told_.load();
    out.figures = {{"truth_ms", told > 0 ? took_ms_.load() / static_cast<double>(told) : 0.0}};
    if (server_) {
        out.figures.emplace_back("clients", static_cast<double>(server_->clients()));
        out.figures.emplace_back("cut_off", static_cast<double>(server_->cut_off()));
    }
    if (!destinations_.empty())
        out.figures.emplace_back("datagrams_not_sent", static_cast<double>(not_sent_.load()));
    const std::lock_guard lock(mutex_);
    out.fault = fault_;
    if (out.fault.empty() && loss_is_fault() && out.dropped > 0)
        out.fault = report_of_drops("outputs.truth", config_.folder, out.dropped, out.frames);
    return out;
}

}  // namespace hilcam
