#pragma once
// The sequencer (SFNC 2.4, SequencerControl): sets of settings that frames use one after another.
//
// A frame uses the set that is active when it begins. Each set has two paths; a path says which event makes
// which set the next one. The first path whose event comes is taken. A frame's own begin (FrameStart,
// ExposureStart) and events at its very instant count for the frames after it. An exposure that ends as the
// next one begins has ended before.
//
// Example, three exposures in turn: sets 0, 1, 2, each with SequencerTriggerSource FrameStart and
// SequencerSetNext 1, 2, 0.
//
// Counters that count the camera's own frames are counted here as well, from the sequencer's start, so that a
// frame's set never depends on how quickly another thread counts. Edges, timers and other counters come from
// io/lines with their instants; one that is reported after a later frame has begun counts from the next frame
// on.
//
// Threads: start(), stop() any thread; post() any thread, without a lock; "Loop" one thread, no allocation.

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "io/contract/camera_control.h"
#include "io/lines/line_counter.h"
#include "io/lines/line_words.h"
#include "io/system/bounded_queue.h"
#include "render/vocabulary/latest.h"
#include "sensor/test_pattern.h"

namespace hilcam {

inline constexpr std::size_t kSequencerSets = 16, kSequencerPaths = 2;

// Settings that sets hold; bits of SequencerProgram::features. None changes the size of frames.
enum class SequencerFeature : std::uint8_t {
    kExposureTime,
    kGain,
    kBlackLevel,
    kTestPattern,
    kReverseX,
    kReverseY
};
inline constexpr std::size_t kSequencerFeatures = 6;
constexpr std::uint32_t bit_of(SequencerFeature feature) { return 1u << static_cast<unsigned>(feature); }

struct SequencerPath {
    std::uint8_t next = 0;
    LineEvent source = LineEvent::kOff;
    TriggerActivation activation = TriggerActivation::kRisingEdge;  // the edge that counts, for a line
};

struct SequencerSet {
    double exposure_s = 0, gain_db = 0, black_level_dn = 0;
    TestPattern test_pattern = TestPattern::kOff;
    bool reverse_x = false, reverse_y = false;
    std::array<SequencerPath, kSequencerPaths> paths{};
};

struct SequencerProgram {
    std::array<SequencerSet, kSequencerSets> sets{};
    std::uint8_t start = 0;
    std::uint32_t features = (1u << kSequencerFeatures) - 1;
};

// Copies the values of a set's features, from or into settings.
void keep_in(SequencerSet& set, const CameraSettings& settings);
void take_from(const SequencerSet& set, std::uint32_t features, CameraSettings& settings);

// True for an event that a path may wait for: in lockstep only the camera's own frames, and counters of them.
bool is_sequencer_source(LineEvent event, bool lockstep);

class Sequencer {
  public:
    static constexpr std::int64_t kNone = -1;
    using Counters = std::array<LineCounter::Settings, kCounters>;

    // The next frame that the loop begins uses the start set.
    void start(const SequencerProgram& program, const Counters& counters = {});
    // Begins anew at the start set, if it is on.
    void restart();
    void stop();
    bool on() const { return on_.load(std::memory_order_relaxed); }
    // Returns the set of the newest frame.
    std::uint32_t active() const { return shown_.load(std::memory_order_relaxed); }
    // Returns the longest exposure of sets that can follow the start set; 0: exposures are not the
    // sequencer's.
    double longest_exposure_s() const { return longest_s_.load(std::memory_order_relaxed); }
    // Takes an event of lines, timers or counters. False when too many wait.
    bool post(LineEvent event, bool rises, std::int64_t at_ns) noexcept;

    // --- Loop.
    // Returns the exposure of the next frame as far as it is known now; nothing while it is that of the
    // settings.
    std::optional<double> exposure_s() noexcept;
    // Puts the values of the set into the settings of a frame that begins then, and returns the set; kNone
    // while the sequencer is off.
    std::int64_t begin(std::int64_t begin_ns, CameraSettings& settings) noexcept;
    // The frame of begin() has begun, and its exposure will end then.
    void begun(std::int64_t begin_ns, std::int64_t end_ns) noexcept;

  private:
    struct Order {
        SequencerProgram program;
        Counters counters{};
        std::uint64_t number = 0;
        bool on = false;
    };
    struct Event {
        LineEvent event = LineEvent::kOff;
        bool rises = false;
        std::int64_t at_ns = 0;
    };
    static constexpr std::size_t kMaxWaiting = 64;

    void write();
    const Order& follow() noexcept;
    void wait_for(const Event& event) noexcept;
    void fire(const Order& order, LineEvent event, bool rises) noexcept;
    static bool counts_frames(const LineCounter::Settings& counter, std::size_t i);

    // The writers'.
    std::mutex mutex_;
    Order order_;
    Latest<Order> latest_;
    std::atomic<bool> on_{false};
    std::atomic<std::uint32_t> wanted_{0};  // events from outside that paths wait for; bits by LineEvent
    std::atomic<double> longest_s_{0};
    BoundedQueue<Event, kMaxWaiting> posts_;
    // The loop's.
    std::atomic<std::uint32_t> shown_{0};
    std::uint64_t number_ = 0;
    std::uint8_t active_ = 0;
    std::array<LineCounter, kCounters> counters_{};
    std::array<Event, kMaxWaiting> waiting_{};  // in order of time
    std::size_t waiting_count_ = 0;
};

}  // namespace hilcam
