#include "emulator/motion/reference_axes.h"

#include "render/sky/earth_frames.h"

namespace hilcam {

bool is_of_the_earth(CcsdsFrame frame) {
    switch (frame) {
        case CcsdsFrame::kEarthFixed:
        case CcsdsFrame::kTeme:
        case CcsdsFrame::kTod:
        case CcsdsFrame::kMod:
        case CcsdsFrame::kGtod:
            return true;
        case CcsdsFrame::kIcrf:
        case CcsdsFrame::kEme2000:
        case CcsdsFrame::kLvlh:
        case CcsdsFrame::kRtn:
        case CcsdsFrame::kBody:
            break;
    }
    return false;
}

std::optional<Mat3d> resting_axes(CcsdsFrame frame, const std::optional<TimeTai>& epoch) {
    if (frame == CcsdsFrame::kEme2000) return icrf_from_eme2000();
    if (!epoch) return {};
    // UT1 cancels in TEME.
    if (frame == CcsdsFrame::kTeme) return icrf_from_teme(*epoch, {});
    if (frame == CcsdsFrame::kTod) return icrf_from_true_of_date(*epoch);
    if (frame == CcsdsFrame::kMod) return icrf_from_mean_of_date(*epoch);
    return {};
}

TurningAxes axes_of_date(CcsdsFrame frame, const WorldFrame& world) {
    switch (frame) {
        case CcsdsFrame::kTeme:
            return {world.icrf_from_teme(), {}};
        case CcsdsFrame::kTod:
            return {icrf_from_true_of_date(world.time()), {}};
        case CcsdsFrame::kMod:
            return {icrf_from_mean_of_date(world.time()), {}};
        case CcsdsFrame::kGtod:
            return world.earth_rotated();
        case CcsdsFrame::kEarthFixed:
            return world.body_fixed(BodyId::kEarth);
        case CcsdsFrame::kIcrf:
        case CcsdsFrame::kEme2000:
        case CcsdsFrame::kLvlh:
        case CcsdsFrame::kRtn:
        case CcsdsFrame::kBody:
            break;
    }
    return {};
}

}  // namespace hilcam
