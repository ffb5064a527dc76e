#include "emulator/run/camera_station.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "emulator/loop/shutter_timing.h"
#include "emulator/recording/recorder.h"
#include "emulator/run/picture_fault.h"
#include "emulator/run/picture_run.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/apart_refusal.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "io/contract/refused_settings.h"
#include "sensor/ideal_sensor.h"

namespace hilcam {
namespace {

LiveSettings::Mode mode_of(const ScenarioConfig& scenario) {
    return {.lockstep = scenario.mode == CameraMode::kLockstep,
            .triggered = scenario.mode == CameraMode::kTriggered,
            .fixed_size = have_fixed_size(scenario.outputs)};
}

// Frames in lockstep, and recorded or replayed ones, depend on their commands alone, so they wait for light.
bool begins_without_light(const ScenarioConfig& scenario, const RunLimits& limits) {
    return limits.light_beside && !scenario.loop.wait_for_light && scenario.mode != CameraMode::kLockstep &&
           limits.record.empty() && limits.replay.empty();
}

// Computes the frame's numbers for one part of its light.
DnImage numbers_of(const RadianceImage& light, const FrameRecord& record, const IdealSensor& sensor) {
    const Exposure exposure{
        .exposure_s = record.exposure_s, .gain_db = record.gain_db, .black_level_dn = record.black_level_dn};
    return sensor.take(light, exposure,
                       {record.binning_x, record.binning_y, record.reverse_x, record.reverse_y});
}

// Returns all qualities that frames may have, including those that the governor may choose.
std::vector<RenderQuality> all_levels(const ScenarioConfig& scenario) {
    std::vector<RenderQuality> levels = lower_levels(scenario);
    levels.insert(levels.begin(), render_quality_of(scenario));
    return levels;
}

}  // namespace

CameraStation::CameraStation(const ScenarioConfig& scenario, std::size_t number, const RunLimits& limits)
    : scenario_(scenario),
      number_(number),
      limits_(limits),
      settings_(scenario_.camera, mode_of(scenario_)),
      lines_(settings_, plan_of(scenario_.lines, number)),
      faults_(seed_of_camera(scenario_, number - 1)),
      light_parts_(apart_refusal(scenario_)),
      timed_faults_(scenario_.faults) {
    connect_lines();
    std::stable_sort(timed_faults_.begin(), timed_faults_.end(),
                     [](const FaultConfig& a, const FaultConfig& b) { return a.at_s < b.at_s; });
    if (limits.outputs) make_sinks();
}

CameraStation::~CameraStation() = default;

void CameraStation::connect_lines() {
    settings_.on_missed_trigger([this](std::int64_t monotonic_ns) {
        for (const auto& sink : sinks_) sink->on_event({CameraEvent::Kind::kTriggerMissed, 0, monotonic_ns});
        line_watch_.on_event({CameraEvent::Kind::kTriggerMissed, 0, monotonic_ns});
    });
    settings_.on_exposure([this](std::int64_t begin_ns, std::int64_t end_ns) {
        if (begin_ns == 0)
            lines_.drop_exposures();
        else
            lines_.post({LineEvent::kExposureStart, begin_ns, end_ns});
    });
    lines_.on_edge([this](const LineEdge& edge) {
        using Kind = CameraEvent::Kind;
        if (edge.line != 0) return;
        for (const auto& sink : sinks_)
            sink->on_event({edge.level ? Kind::kLine0Rises : Kind::kLine0Falls, 0, edge.monotonic_ns});
    });
    if (!scenario_.lines.trigger) return;
    const SettingsChange change = change_of(*scenario_.lines.trigger);
    if (!settings_.change(change))
        throw InputError("lines.trigger: " + refusal_of(change, settings_.settings(), settings_.limits()));
}

void CameraStation::make_sinks() {
    const auto [width, height] = array_size(scenario_.camera);  // largest size of a frame
    const auto [fixed_width, fixed_height] = frame_size(scenario_.camera);
    const PictureRun run = picture_run_of(scenario_, number_);
    const OutputShape shape{width,
                            height,
                            fixed_width,
                            fixed_height,
                            settings_.settings().frame_rate_hz,
                            scenario_.camera.name,
                            &run,
                            have_live(scenario_.outputs),
                            [this] { return status(); }};
    scenario_.outputs.for_each_given([&](const auto& config) {
        // The sink of truth is made when there is a renderer.
        if constexpr (requires(SinkContext context) { make_sink(config, context, shape); })
            sinks_.push_back(make_sink(config, sink_context(), shape));
    });
    for (const auto& sink : sinks_)
        if (TruthListener* const listener = sink->truth_listener()) truth_listener_ = listener;
}

SinkContext CameraStation::sink_context() {
    const bool clocked = scenario_.mode != CameraMode::kLockstep && !limits_.replay_fast;
    OutputMeter& meter = output_meters_.emplace_back(delivery_, scenario_.loop.fail_on, clocked);
    return {settings_, faults_, &meter, &fates_, &light_parts_, &lines_};
}

std::string CameraStation::status() const {
    return run_status({scenario_, number_, links_->pages, *loop_, delivery_, links_->receivers, sinks(),
                       settings_, faults_, links_->light_maker});
}

void CameraStation::load(const SpectralGrid& grid) {
    const ImageGeometry geometry = geometry_of(scenario_.camera, static_cast<int>(scenario_.quality.guard_px),
                                               static_cast<int>(scenario_.quality.oversampling));
    light_.later = begins_without_light(scenario_, limits_);
    renderer_ = load_renderer(scenario_, grid, geometry, &objects_, &light_);
    chain_ = std::make_unique<SensorChain>(scenario_.camera, grid, sampling_of(scenario_),
                                           load_detector_pictures(scenario_.camera));
    const TimeTai start = parse_utc(scenario_.time_utc);
    world_ = std::make_unique<WorldState>(initial_motions(scenario_, start), scenario_.origin,
                                          joints_of(scenario_), scenario_.mount,
                                          load_motion_sources(scenario_), lamp_mounts(scenario_));
    const WorldSnapshot first = snapshot_at(scenario_, start, start);
    renderer_->require_air(first);
    // In lockstep the first frame may be ordered for another place, and waiting for it does no harm.
    if (scenario_.mode != CameraMode::kLockstep) renderer_->make_ground_ahead(first);
    ExposureConfig exposures = exposure_config_of(scenario_);
    exposures.for_detector = true;
    exposures_ = std::make_unique<ExposureRenderer>(*renderer_, exposures, scenario_.camera, grid,
                                                    world_->placed_objects());
    if (limits_.outputs && (scenario_.outputs.find<TruthConfig>() || truth_listener_)) {
        auto truth = make_truth_sink(scenario_, grid, number_, *renderer_, limits_.run_id,
                                     {truth_listener_, &fates_, have_live(scenario_.outputs)});
        truth_ = truth.get();
        sinks_.push_back(std::move(truth));
    }
    serve_light_parts();
    find_level_costs();
}

void CameraStation::serve_light_parts() {
    const auto sensor = std::make_shared<const IdealSensor>(scenario_.camera, sampling_of(scenario_));
    LightPartOrders::Maker maker;
    maker.make_buffer = [this](LightPart part) {
        return std::make_unique<PartsBuffer>(exposures_->make_parts_buffer(part));
    };
    maker.numbers_of = [sensor](const RadianceImage& light, const FrameRecord& record) {
        return numbers_of(light, record, *sensor);
    };
    light_parts_.serve(std::move(maker));
}

void CameraStation::prepare(const StationLinks& links) {
    links_.emplace(links);
    serve_faults(0);
    tell_of_changes(links.recorder);
    std::vector<FrameSink*> watching = sinks();
    if (scenario_.mode != CameraMode::kLockstep && !links.script) watching.push_back(&line_watch_);
    loop_ = std::make_unique<FrameLoop>(LoopParts{
        .exposures = *exposures_,
        .chain = *chain_,
        .camera = scenario_.camera,
        .world = *world_,
        .settings = settings_,
        .faults = faults_,
        .clock = links.clock,
        .poses = &links.poses,
        .sinks = std::move(watching),
        .seed = seed_of_camera(scenario_, number_ - 1),
        .limits = {limits_.frames, limits_.warm_up, limits_.paced, governor(), scenario_.loop.prefer,
                   static_cast<std::uint64_t>(scenario_.loop.fail_on.from_frame)},
        .script = links.script,
        .observers = {.watcher = links.watcher,
                      .truth = truth_,
                      .light_parts = &light_parts_,
                      .recorder = links.recorder,
                      .recorded_camera = static_cast<std::uint16_t>(number_)},
    });
}

double CameraStation::period_s() const {
    const CameraSettings settings = settings_.settings();
    return ShutterTiming(scenario_.camera).period_s(settings.frame_rate_hz, settings.exposure_s) /
           scenario_.clock.scale;
}

GovernorSettings CameraStation::governor() const {
    const LoopConfig& loop = scenario_.loop;
    GovernorSettings out;
    out.budget_ms = loop.budget_is_of_rate() ? GovernorSettings::kToldBudget_ms : 1e3 * loop.frame_budget_s;
    out.levels = 1 + lower_levels(scenario_).size();
    for (const LevelCost& cost : level_costs_) out.costs_ms.push_back(cost.frame_ms);
    return out;
}

// A replay takes its frames' levels from the recording.
void CameraStation::find_level_costs() {
    const std::vector<RenderQuality> levels = all_levels(scenario_);
    if (levels.size() == 1 || !limits_.paced || !limits_.replay.empty()) return;
    std::vector<double> rays;
    for (const RenderQuality& level : levels) rays.push_back(primary_rays(scenario_, level));
    const LoopConfig& loop = scenario_.loop;
    const double budget_s = loop.budget_is_of_rate() ? period_s() : loop.frame_budget_s;
    const FrameMachine machine{tbb::this_task_arena::max_concurrency(), 1 + scenario_.more_cameras.size(),
                               loop.prefer};
    TrialFrames frames({*exposures_, *chain_, *world_, scenario_, seed_of_camera(scenario_, number_ - 1)});
    exposures_->take_light();
    level_costs_ = measure_levels(rays, 1e3 * Governor::kRoom * budget_s, machine, [&](std::size_t level) {
        exposures_->use_level(level);
        return frames.take();
    });
    exposures_->use_level(0);
}

// recorder: null: nothing is recorded.
void CameraStation::tell_of_changes(Recorder* recorder) {
    const auto camera = static_cast<std::uint16_t>(number_);
    if (recorder)
        settings_.on_change([recorder, camera](const SettingsChange& change) {
            recorder->put(RecordedChange{camera, monotonic_ns(), change});
        });
    settings_.on_trigger([this, recorder, camera](const TriggerOrder& order, TriggerResult result) {
        if (result == TriggerResult::kTaken) lines_.post({LineEvent::kFrameTrigger, monotonic_ns(), 0});
        if (recorder) recorder->put(RecordedTrigger{camera, monotonic_ns(), order, result});
    });
}

void CameraStation::start_outputs() {
    for (const auto& sink : sinks_) sink->start();
}

void CameraStation::stop_outputs() noexcept {
    for (const auto& sink : sinks_) sink->stop();
}

std::vector<FrameSink*> CameraStation::sinks() const {
    std::vector<FrameSink*> out;
    for (const auto& sink : sinks_) out.push_back(sink.get());
    return out;
}

std::vector<std::string> CameraStation::new_faults() {
    std::vector<std::string> out;
    for (const auto& sink : sinks_)
        if (sink->has_fault() && reported_faults_.insert(sink.get()).second)
            out.push_back(sink->report().fault);
    if (!reported_render_fault_)
        if (const std::string fault = picture_fault(renderer()); !fault.empty()) {
            out.push_back(fault);
            reported_render_fault_ = true;
        }
    return out;
}

std::vector<SinkNote> CameraStation::new_notes() {
    std::vector<SinkNote> out;
    for (const auto& sink : sinks_)
        for (SinkNote& note : sink->take_notes()) out.push_back(std::move(note));
    return out;
}

void CameraStation::serve_faults(double seconds) {
    for (; next_fault_ < timed_faults_.size() && timed_faults_[next_fault_].at_s <= seconds; ++next_fault_)
        faults_.order(order_of(timed_faults_[next_fault_]));
    FaultBoard::Entry entry;
    while (faults_.take_entry(entry)) {
        fault_log_.push_back(entry);
        if (fault_log_.size() > kMaxLogged) fault_log_.pop_front();
    }
}

}  // namespace hilcam
