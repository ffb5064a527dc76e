#include "io/lines/sequencer.h"

#include <algorithm>

namespace hilcam {
namespace {

constexpr std::uint32_t event_bit(LineEvent event) { return 1u << static_cast<unsigned>(event); }
static_assert(kLineEvents <= 32, "events are bits of a word");

constexpr bool is_of_frame(LineEvent event) {
    return event == LineEvent::kFrameStart || event == LineEvent::kExposureStart ||
           event == LineEvent::kExposureEnd;
}
constexpr bool is_counter(LineEvent event) {
    return event == LineEvent::kCounter0End || event == LineEvent::kCounter1End;
}
constexpr std::size_t counter_of(LineEvent end) {
    return static_cast<std::size_t>(end) - static_cast<std::size_t>(LineEvent::kCounter0End);
}

// Returns the sets that paths lead to from the start set; bits.
std::uint32_t reachable(const SequencerProgram& program) {
    std::uint32_t found = 1u << program.start, before = 0;
    while (found != before) {
        before = found;
        for (std::size_t i = 0; i < kSequencerSets; ++i)
            for (const SequencerPath& path : program.sets[i].paths)
                if (found >> i & 1u && path.source != LineEvent::kOff) found |= 1u << path.next;
    }
    return found;
}

}  // namespace

void keep_in(SequencerSet& set, const CameraSettings& s) {
    set.exposure_s = s.exposure_s, set.gain_db = s.gain_db, set.black_level_dn = s.black_level_dn;
    set.test_pattern = s.test_pattern;
    set.reverse_x = s.reverse_x, set.reverse_y = s.reverse_y;
}

void take_from(const SequencerSet& set, std::uint32_t features, CameraSettings& s) {
    const auto has = [features](SequencerFeature f) { return (features & bit_of(f)) != 0; };
    if (has(SequencerFeature::kExposureTime)) s.exposure_s = set.exposure_s;
    if (has(SequencerFeature::kGain)) s.gain_db = set.gain_db;
    if (has(SequencerFeature::kBlackLevel)) s.black_level_dn = set.black_level_dn;
    if (has(SequencerFeature::kTestPattern)) s.test_pattern = set.test_pattern;
    if (has(SequencerFeature::kReverseX)) s.reverse_x = set.reverse_x;
    if (has(SequencerFeature::kReverseY)) s.reverse_y = set.reverse_y;
}

bool is_sequencer_source(LineEvent event, bool lockstep) {
    if (event == LineEvent::kOff || is_of_frame(event) || is_counter(event)) return true;
    const bool of_bench = event >= LineEvent::kTimer0End && static_cast<std::size_t>(event) < kLineEvents;
    return of_bench && !lockstep;
}

// --- orders

void Sequencer::start(const SequencerProgram& program, const Counters& counters) {
    const std::lock_guard lock(mutex_);
    order_.program = program, order_.counters = counters, order_.on = true;
    const std::uint32_t sets = reachable(program);
    std::uint32_t wanted = 0;
    double longest_s = 0;
    for (std::size_t i = 0; i < kSequencerSets; ++i) {
        if (!(sets >> i & 1u)) continue;
        longest_s = std::max(longest_s, program.sets[i].exposure_s);
        for (const SequencerPath& path : program.sets[i].paths)
            if (!is_of_frame(path.source) &&
                !(is_counter(path.source) &&
                  counts_frames(counters[counter_of(path.source)], counter_of(path.source))))
                wanted |= event_bit(path.source);
    }
    const bool of_exposure = (program.features & bit_of(SequencerFeature::kExposureTime)) != 0;
    longest_s_.store(of_exposure ? longest_s : 0, std::memory_order_relaxed);
    wanted_.store(wanted, std::memory_order_relaxed);
    write();
}

void Sequencer::restart() {
    const std::lock_guard lock(mutex_);
    if (order_.on) write();
}

void Sequencer::stop() {
    const std::lock_guard lock(mutex_);
    if (!order_.on) return;
    order_.on = false;
    longest_s_.store(0, std::memory_order_relaxed);
    wanted_.store(0, std::memory_order_relaxed);
    write();
}

// Called under the lock.
void Sequencer::write() {
    ++order_.number;
    latest_.write(order_);
    on_.store(order_.on, std::memory_order_relaxed);
}

// Events that no path waits for would only fill the queue.
bool Sequencer::post(LineEvent event, bool rises, std::int64_t at_ns) noexcept {
    if (!(wanted_.load(std::memory_order_relaxed) & event_bit(event))) return true;
    return posts_.push({event, rises, at_ns});
}

// True for a counter that counts and is reset by what the loop knows itself.
bool Sequencer::counts_frames(const LineCounter::Settings& counter, std::size_t i) {
    return is_of_frame(counter.event) && (counter.reset == LineEvent::kOff || is_of_frame(counter.reset) ||
                                          counter.reset == end_of_counter(i));
}

// --- the loop

const Sequencer::Order& Sequencer::follow() noexcept {
    const Order& order = latest_.read();
    if (order.number == number_) return order;
    number_ = order.number;
    active_ = order.program.start;
    counters_ = {};
    waiting_count_ = 0;
    for (Event event; posts_.pop(event);) {
    }
    return order;
}

std::optional<double> Sequencer::exposure_s() noexcept {
    const Order& order = follow();
    const bool own = order.program.features & bit_of(SequencerFeature::kExposureTime);
    if (!order.on || !own) return {};
    return order.program.sets[active_].exposure_s;
}

void Sequencer::wait_for(const Event& event) noexcept {
    if (waiting_count_ == kMaxWaiting) return;
    const auto begin = waiting_.begin(), end = begin + static_cast<std::ptrdiff_t>(waiting_count_);
    const auto place =
        std::upper_bound(begin, end, event, [](const Event& a, const Event& b) { return a.at_ns < b.at_ns; });
    std::move_backward(place, end, end + 1);
    *place = event;
    ++waiting_count_;
}

std::int64_t Sequencer::begin(std::int64_t begin_ns, CameraSettings& settings) noexcept {
    const Order& order = follow();
    if (!order.on) return kNone;
    for (Event event; posts_.pop(event);) wait_for(event);
    std::size_t past = 0;
    for (; past < waiting_count_ && waiting_[past].at_ns < begin_ns; ++past)
        fire(order, waiting_[past].event, waiting_[past].rises);
    std::move(waiting_.begin() + static_cast<std::ptrdiff_t>(past),
              waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_), waiting_.begin());
    waiting_count_ -= past;
    take_from(order.program.sets[active_], order.program.features, settings);
    shown_.store(active_, std::memory_order_relaxed);
    return active_;
}

void Sequencer::begun(std::int64_t begin_ns, std::int64_t end_ns) noexcept {
    const Order& order = latest_.read();
    // A new order begins with the next frame, whatever this one does.
    if (!order.on || order.number != number_) return;
    fire(order, LineEvent::kFrameStart, true);
    fire(order, LineEvent::kExposureStart, true);
    if (end_ns <= begin_ns)
        fire(order, LineEvent::kExposureEnd, true);
    else
        wait_for({LineEvent::kExposureEnd, true, end_ns - 1});
}

// A counter counts one event, so that ends of counters cannot follow each other in a circle.
void Sequencer::fire(const Order& order, LineEvent event, bool rises) noexcept {
    for (std::size_t i = 0; i < kCounters; ++i)
        if (counts_frames(order.counters[i], i) && counters_[i].take(order.counters[i], event, rises))
            fire(order, end_of_counter(i), true);
    for (const SequencerPath& path : order.program.sets[active_].paths) {
        if (path.source != event || event == LineEvent::kOff) continue;
        if (event >= LineEvent::kLine0 && !is_active_edge(path.activation, rises)) continue;
        active_ = path.next;
        return;
    }
}

}  // namespace hilcam
