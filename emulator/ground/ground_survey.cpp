#include "emulator/ground/ground_survey.h"

#include <spdlog/fmt/fmt.h>

#include "emulator/ground/ground_heights.h"
#include "emulator/ground/ground_things.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

std::string things(GroundThings kind, const GlobeConfig& globe, const MappedBody& body,
                   const GroundSurvey& s) {
    const LocalPlane at(s.middle, body.figure);
    std::string out = std::string(kPlaceColumns) + things_columns(kind) + "\n";
    for (const GroundThing& thing : find_things(kind, globe, body, at.up, s.within_m, s.smallest_m))
        out += fmt::format("{},{:.4f},{:.4f}\n", at.text_of(thing.place), thing.diameter_m, thing.figure);
    return out;
}

std::string heights(const GlobeConfig& globe, const MappedBody& body, const GroundSurvey& s, bool hazards) {
    const LocalPlane at(s.middle, body.figure);
    const HeightSquare square = GroundHeights(globe, body).square(at, s.within_m, s.spacing_m);
    std::string out =
        std::string(kPlaceColumns) + "height_m,slope_deg,step_m" + (hazards ? ",hazard\n" : "\n");
    for (int y = -square.half; y <= square.half; ++y)
        for (int x = -square.half; x <= square.half; ++x) {
            const GroundSlope slope = square.slope(x, y);
            out +=
                fmt::format("{},{:.4f},{:.3f},{:.4f}", at.text_of(at.place(x * s.spacing_m, y * s.spacing_m)),
                            square.height_m(x, y), slope.slope_rad / kDegree_rad, slope.step_m);
            out += hazards ? fmt::format(",{:d}\n", s.limits.is_hazard(slope)) : "\n";
        }
    return out;
}

}  // namespace

const char* things_columns(GroundThings kind) {
    return kind == GroundThings::kCraters ? "diameter_m,worn" : "diameter_m,height_m";
}

std::string survey_ground(const GlobeConfig& globe, const MappedBody& body, const GroundSurvey& survey) {
    switch (survey.what) {
        case GroundSurvey::What::kCraters:
            return things(GroundThings::kCraters, globe, body, survey);
        case GroundSurvey::What::kBoulders:
            return things(GroundThings::kBoulders, globe, body, survey);
        case GroundSurvey::What::kHeights:
        case GroundSurvey::What::kHazards:
            break;
    }
    return heights(globe, body, survey, survey.what == GroundSurvey::What::kHazards);
}

}  // namespace hilcam
