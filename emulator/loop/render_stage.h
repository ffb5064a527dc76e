#pragma once
// The loop's first stage: waits for a frame's begin, samples the world and renders the exposure.
//
// In a replay, the script supplies what a frame depends on, and clock, live settings, governor and faults are
// ignored (frame_script.h). Otherwise the planner decides (frame_planner.h).
//
// Tables of light that are made during the run (Renderer::give_tables) are taken over when a frame begins.
// Earlier frames carry a flag.

#include <atomic>
#include <cstdint>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/frame_planner.h"
#include "emulator/loop/frame_slot.h"
#include "emulator/loop/light_part_orders.h"
#include "emulator/loop/loop_figures.h"
#include "emulator/loop/loop_parts.h"

namespace hilcam {

class RenderStage {
  public:
    // figures: must outlive the stage. Owner thread.
    RenderStage(const LoopParts& parts, LoopFigures& figures);

    // Allocates a slot's memory. Owner thread, before the start.
    void prepare(FrameSlot& slot) const;

    // Waits for the next frame's begin and renders it into the slot; false when there are no more frames.
    // Loop, one thread.
    bool run(FrameSlot& slot, const std::atomic<bool>& stopping);
    // No more frames will come: answers everything that waits for one. Loop.
    void close();

    // Takes the oldest change that has not been taken; false when there is none. One thread.
    bool take_level_change(LevelChange& change) noexcept { return planner_.take_level_change(change); }
    // Returns figures of the last rendered frame. For benchmarks, when the loop is stopped.
    const RenderStats& stats() const { return stats_; }

  private:
    bool begin(FrameSlot& slot, const std::atomic<bool>& stopping);
    void use_level(std::uint32_t level);
    void take_light(FrameUse& use);
    void latch(FrameSlot& slot);
    void render(FrameSlot& slot);
    void render_light(FrameSlot& slot, const LightPartOrders::Order* order);
    void report_pose_tags(FrameSlot& slot);
    void report_impossible(FrameSlot& slot);
    void report_commands(const ShownCommand& shown, FrameSlot& slot);

    ExposureRenderer& exposures_;
    WorldState& world_;
    LiveSettings& settings_;
    const CameraModel& camera_;
    const PoseWatch* poses_;  // null in a replay, too
    std::vector<FrameSink*> sinks_;
    std::uint64_t seed_;
    FrameScript* script_;
    LoopObservers observers_;
    LoopCounters& counters_;
    StageMeters& meters_;
    MissedExposures& missed_;
    FramePlanner planner_;
    RenderStats stats_;
    std::uint32_t level_ = 0;
    bool has_begun_ = false;
    bool ends_order_ = false;  // true: the frame is the last of its order
    std::int64_t shown_arrival_ns_ = 0;
    std::uint64_t flagged_ = 0;     // backward steps of time tags that frames have reported
    std::uint64_t impossible_ = 0;  // WorldState::impossible() at the last flagged frame
};

}  // namespace hilcam
