#pragma once
// Makes triggers from the edges of the line that TriggerSource names.
//
// TriggerActivation says which edges count, and TriggerDivider n that each n-th of these is a trigger; its
// count begins anew when source, activation, divider or mode change. With ExposureMode TriggerWidth, a
// trigger's frame is exposed until the line is inactive again, at most for the longest exposure; a shorter
// pulse than the shortest exposure gives the shortest. The picture needs the exposure's length, so its order
// goes to the camera at the end of the exposure, with both instants.
//
// With LevelHigh and LevelLow frames follow one another at the frame rate while the line has that level, also
// when it had it before the camera began to listen. The first begins with the level, each next one a period
// later, or as soon as the camera is ready. TriggerDivider does not hold for them.
//
// Time and edges are arguments. One thread at a time.

#include <algorithm>
#include <array>
#include <functional>

#include "io/contract/camera_control.h"
#include "io/lines/line_edge.h"
#include "io/lines/line_words.h"

namespace hilcam {

class TriggerInput {
  public:
    // Takes the begin and the end of an exposure by width, each at its time, so that outputs can follow it.
    struct Exposure {
        std::int64_t begin_ns = 0, end_ns = 0;  // end: 0 at the begin
        bool lost = false;  // at the end: no frame comes, as the camera was stopped meanwhile
    };
    TriggerInput(CameraControl& camera, std::function<void(const Exposure&)> exposes)
        : camera_(camera), exposes_(std::move(exposes)) {}

    // Takes an edge; its level is the camera's, behind LineInverter.
    void edge(const LineEdge& edge);
    // Takes the pulse of an `expose`, which has no length. Taken: also for a pulse that the divider or the
    // activation keeps from being a trigger.
    TriggerResult pulse(const TriggerOrder& order);
    // Ends an exposure that has lasted as long as the camera permits, and begins the next frame of a level.
    void tick(std::int64_t now_ns);
    // Takes the camera's settings and the levels of its lines, which may have changed without an edge.
    void follow(const std::array<bool, kLines>& levels, std::int64_t now_ns);
    // True while settings may begin frames without an edge, so that follow() is needed from time to time.
    bool watches_level() const { return watches_level_; }
    // True while an exposure by width lasts.
    bool exposes() const { return open_; }
    std::int64_t wake_ns() const {
        return std::min(open_ ? longest_ns_ : CameraControl::kNeverReady_ns, next_ns_);
    }

  private:
    bool is_trigger(const CameraSettings& s, bool level);
    void begin_exposure(const LineEdge& edge, const CameraSettings& s);
    void end_exposure(std::int64_t at_ns);
    void begin_level(const LineEdge& edge);
    void end_level() { next_ns_ = CameraControl::kNeverReady_ns; }
    bool holds() const { return next_ns_ != CameraControl::kNeverReady_ns; }
    void take_by_level();

    CameraControl& camera_;
    std::function<void(const Exposure&)> exposes_;
    // Settings for which edges have been counted, and their number.
    CameraSettings of_;
    std::int64_t seen_ = 0;
    // An exposure by width that has begun with an edge.
    bool open_ = false, shows_ = false;  // shows_: the camera was ready for it
    LineEdge begin_;
    std::int64_t exposure_ns_ = 0;  // its begin: the edge's instant and the delay
    std::int64_t longest_ns_ = 0;
    // A level that holds: the edge that began it, and when its next frame is due.
    LineEdge level_;
    std::int64_t next_ns_ = CameraControl::kNeverReady_ns;
    bool watches_level_ = false;
};

}  // namespace hilcam
