#pragma once
// The camera's live settings and its trigger input, as commands and camera interfaces (GenICam) see them.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "render/vocabulary/time.h"
#include "sensor/test_pattern.h"

namespace hilcam {

// The source that starts a frame in triggered mode. Line0 to Line7 are inputs (io/lines); Line0 is the wire
// on which the command `expose` gives a pulse.
enum class TriggerSource : std::uint8_t {
    kSoftware,
    kLine0,
    kAction1,
    kLine1,
    kLine2,
    kLine3,
    kLine4,
    kLine5,
    kLine6,
    kLine7
};
// The edge of a line that is a trigger (SFNC TriggerActivation), or the level while which frames follow one
// another.
enum class TriggerActivation : std::uint8_t { kRisingEdge, kFallingEdge, kAnyEdge, kLevelHigh, kLevelLow };
constexpr bool is_level(TriggerActivation activation) { return activation >= TriggerActivation::kLevelHigh; }
// SFNC TriggerOverlap: a trigger may begin an exposure while the frame before is read out, or not.
enum class TriggerOverlap : std::uint8_t { kOff, kReadOut };
// SFNC ExposureMode: an exposure is ended by its time, or by the inactive edge of the trigger's line.
enum class ExposureMode : std::uint8_t { kTimed, kTriggerWidth };

struct CameraSettings {
    double exposure_s = 0;
    double gain_db = 0;         // added to the gain of the camera file
    double black_level_dn = 0;  // unbinned
    double frame_rate_hz = 0;   // free-run
    bool running = true;        // false between stop and start
    bool automatic_exposure = false;
    // When set, each trigger takes burst_frames frames at the frame rate. The first begins trigger_delay_s
    // after the trigger.
    bool triggered = false;
    TriggerSource trigger_source = TriggerSource::kSoftware;
    double trigger_delay_s = 0;
    std::int64_t burst_frames = 1;
    TestPattern test_pattern = TestPattern::kOff;
    bool reverse_x = false, reverse_y = false;
    std::int64_t binning_x = 1, binning_y = 1;
    TriggerActivation trigger_activation = TriggerActivation::kRisingEdge;
    std::int64_t trigger_divider = 1;  // each n-th active edge of a line is a trigger
    TriggerOverlap trigger_overlap = TriggerOverlap::kReadOut;
    // kTriggerWidth holds for single frames that a line triggers; all others last exposure_s.
    ExposureMode exposure_mode = ExposureMode::kTimed;
};

// A change of settings: members that hold a value change, the others keep theirs.
struct SettingsChange {
    std::optional<double> exposure_s{}, gain_db{}, black_level_dn{}, frame_rate_hz{};
    std::optional<bool> running{}, automatic_exposure{}, triggered{};
    std::optional<TriggerSource> trigger_source{};
    std::optional<double> trigger_delay_s{};
    std::optional<std::int64_t> burst_frames{};
    std::optional<TestPattern> test_pattern{};
    std::optional<bool> reverse_x{}, reverse_y{};
    std::optional<std::int64_t> binning_x{}, binning_y{};
    std::optional<TriggerActivation> trigger_activation{};
    std::optional<std::int64_t> trigger_divider{};
    std::optional<TriggerOverlap> trigger_overlap{};
    std::optional<ExposureMode> exposure_mode{};
};

// Calls visit(std::string_view name, &CameraSettings::..., &SettingsChange::...) for every setting.
// Recordings rely on this order: append a new setting at the end.
template <class Visit>
constexpr void visit_settings(const Visit& visit) {
    using S = CameraSettings;
    using C = SettingsChange;
    visit("exposure_s", &S::exposure_s, &C::exposure_s);
    visit("gain_db", &S::gain_db, &C::gain_db);
    visit("black_level_dn", &S::black_level_dn, &C::black_level_dn);
    visit("frame_rate_hz", &S::frame_rate_hz, &C::frame_rate_hz);
    visit("running", &S::running, &C::running);
    visit("automatic_exposure", &S::automatic_exposure, &C::automatic_exposure);
    visit("triggered", &S::triggered, &C::triggered);
    visit("trigger_source", &S::trigger_source, &C::trigger_source);
    visit("trigger_delay_s", &S::trigger_delay_s, &C::trigger_delay_s);
    visit("burst_frames", &S::burst_frames, &C::burst_frames);
    visit("test_pattern", &S::test_pattern, &C::test_pattern);
    visit("reverse_x", &S::reverse_x, &C::reverse_x);
    visit("reverse_y", &S::reverse_y, &C::reverse_y);
    visit("binning_x", &S::binning_x, &C::binning_x);
    visit("binning_y", &S::binning_y, &C::binning_y);
    visit("trigger_activation", &S::trigger_activation, &C::trigger_activation);
    visit("trigger_divider", &S::trigger_divider, &C::trigger_divider);
    visit("trigger_overlap", &S::trigger_overlap, &C::trigger_overlap);
    visit("exposure_mode", &S::exposure_mode, &C::exposure_mode);
}

// Sets every setting that the change holds.
inline void apply(const SettingsChange& change, CameraSettings& settings) {
    visit_settings([&](std::string_view, auto value, auto wish) {
        if (change.*wish) settings.*value = *(change.*wish);
    });
}

// Returns the change that turns `from` into `to`; settings that are equal in both are left out.
inline SettingsChange difference(const CameraSettings& from, const CameraSettings& to) {
    SettingsChange change;
    visit_settings([&](std::string_view, auto value, auto wish) {
        if (from.*value != to.*value) change.*wish = to.*value;
    });
    return change;
}

struct CameraLimits {
    int width = 0;  // width of a frame without binning
    int height = 0;
    int bits = 0;                 // significant bits of a published DN
    std::string color_pattern{};  // first two rows of the colour filter array, "RGGB"; empty: monochrome
    double min_exposure_s = 0, max_exposure_s = 0;
    double min_gain_db = 0, max_gain_db = 0;
    double max_black_level_dn = 0;
    double min_frame_rate_hz = 0, max_frame_rate_hz = 0;
    double max_trigger_delay_s = 10;
    std::int64_t max_burst_frames = 65535;
    std::int64_t max_trigger_divider = 65535;
    std::int64_t max_binning = 1;  // largest binning along each axis, a power of 2; 1: no binning
    double temperature_c = 0;      // detector temperature
    // True for what the camera sets itself (by a sequence or a line-scan shutter): it refuses any change of
    // it. While automatic exposure is on, the exposure is refused as well.
    bool exposure_is_own = false, gain_is_own = false, frame_rate_is_own = false;
    bool has_automatic_exposure = false;
    bool reversible = false;     // ReverseX, ReverseY
    bool lockstep = false;       // one frame per `expose`, in simulated time; `triggered` cannot change
    bool has_sequencer = false;  // CameraControl::sequencer()

    // ExposureMode TriggerWidth: the exposure is the client's, and the machine's clock counts.
    bool has_trigger_width() const { return !exposure_is_own && !lockstep; }
    // TriggerOverlap Off; the frames of a line scanner join without a gap.
    bool can_wait_for_readout() const { return !frame_rate_is_own; }
    // TriggerActivation LevelHigh and LevelLow, which the machine's clock times.
    bool has_trigger_levels() const { return !lockstep; }
};

// True when the width of a line's pulse is the exposure. Frames of bursts last exposure_s.
inline bool exposes_by_width(const CameraSettings& s) {
    return s.exposure_mode == ExposureMode::kTriggerWidth && s.triggered && s.burst_frames == 1 &&
           s.trigger_source != TriggerSource::kSoftware && s.trigger_source != TriggerSource::kAction1;
}

enum class TriggerResult : std::uint8_t {
    kTaken,
    kMissed,    // the camera is busy with the previous frame: no frame, but an event
    kNotArmed,  // the camera does not listen to this source at present
    kTooEarly,  // lockstep: the time is not later than the previous frame's
};

// A request for a frame or a burst.
struct TriggerOrder {
    TriggerSource source = TriggerSource::kSoftware;
    std::int64_t at_monotonic_ns = 0;  // 0: now
    // ExposureMode TriggerWidth: when the line became inactive again. The exposure is as long as the pulse,
    // within the camera's limits. 0: the exposure is that of the settings.
    std::int64_t until_monotonic_ns = 0;
    // Lockstep: the middle of the exposure; ns = 0: one frame period after the previous frame. Otherwise the
    // earliest simulated time of the trigger; ns = 0: no such limit.
    TimeTai at_simulated;
    std::int64_t frames = 0;     // 0: burst_frames of the settings
    std::uint32_t sequence = 0;  // sequence number of the command that asked
    bool at_any_time = false;    // lockstep: a time that is not later than the previous frame's is allowed
};

class Sequencer;  // io/lines/sequencer.h

// Reads and changes the camera's settings, and triggers frames. A change takes effect with the next frame
// that has not begun its exposure. All functions: any thread but the loop, because they may take a lock.
class CameraControl {
  public:
    virtual ~CameraControl() = default;
    virtual CameraSettings settings() const = 0;
    // Returns the free-running frame rate that the exposure time permits [Hz]. This default is for a shutter
    // that is ready again when the exposure ends.
    virtual double resulting_frame_rate_hz() const {
        const CameraSettings now = settings();
        return now.exposure_s * now.frame_rate_hz > 1 ? 1 / now.exposure_s : now.frame_rate_hz;
    }
    virtual CameraLimits limits() const = 0;
    // Makes the whole change, or none of it: false when a value is outside its limits.
    virtual bool change(const SettingsChange& change) = 0;
    virtual TriggerResult trigger(const TriggerOrder& order) = 0;
    // Returns from when on a trigger begins a frame and is not missed [CLOCK_MONOTONIC ns]; kNeverReady_ns:
    // the camera does not listen to triggers.
    static constexpr std::int64_t kNeverReady_ns = std::numeric_limits<std::int64_t>::max();
    virtual std::int64_t trigger_ready_ns() const {
        const CameraSettings now = settings();
        return now.running && now.triggered ? 0 : kNeverReady_ns;
    }
    // Returns the sequencer of a camera that has one (CameraLimits::has_sequencer), or null.
    virtual Sequencer* sequencer() { return nullptr; }
    // Returns the machine's time when the camera's clock has counted that long from an instant on.
    virtual std::int64_t monotonic_after(std::int64_t from_monotonic_ns, double camera_s) const {
        return from_monotonic_ns + static_cast<std::int64_t>(camera_s * 1e9);
    }
};

}  // namespace hilcam
