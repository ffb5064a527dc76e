#pragma once
// The loop's first stage: waits for a frame's begin, samples the world and renders what the exposure lets in.
//
// What a frame depends on comes from the script, where there is one, and then clock, live settings, governor
// and faults do not matter (frame_script.h); otherwise from the planner (frame_planner.h).
//
// Light: what is made beside the run (Renderer::give_tables) is taken as a frame begins; frames before that
// say so.

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
    // figures: outlive the stage. Owner thread.
    RenderStage(const LoopParts& parts, LoopFigures& figures);

    // Gives a slot the memory that it needs. Owner thread, before the start.
    void prepare(FrameSlot& slot) const;

    // Waits for the next frame's begin and renders it into the slot; false when there is none. Loop, one
    // thread.
    bool run(FrameSlot& slot, const std::atomic<bool>& stopping);
    // No frame comes any more: what waits for one is answered. Loop.
    void close();

    // False: there is none that was not taken yet. One thread.
    bool take_level_change(LevelChange& change) noexcept { return planner_.take_level_change(change); }
    // Those of the frame rendered last; for benchmarks, when the loop is stopped.
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
    const PoseWatch* poses_;  // null in a replay, as well
    std::vector<FrameSink*> sinks_;
    std::uint64_t seed_;
    FrameScript* script_;
    LoopObservers observers_;
    LoopCounters& counters_;
    StageMeters& meters_;
    FramePlanner planner_;
    RenderStats stats_;
    std::uint32_t level_ = 0;
    bool has_begun_ = false;
    bool ends_order_ = false;  // the frame is its order's last
    std::int64_t shown_arrival_ns_ = 0;
    std::uint64_t flagged_ = 0;     // time tags that went back, as frames have told of them
    std::uint64_t impossible_ = 0;  // WorldState::impossible() at the last frame that was flagged
};

}  // namespace hilcam
