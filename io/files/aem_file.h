#pragma once
// Reads Attitude Ephemeris Messages (AEM) as KVN or XML: CCSDS 504.0-B-2 section 4 (version 2.0), and version
// 1.0 of 504.0-B-1.
//
// - Types: QUATERNION, QUATERNION/DERIVATIVE, QUATERNION/ANGVEL, EULER_ANGLE, EULER_ANGLE/DERIVATIVE,
//   EULER_ANGLE/ANGVEL, SPIN, and version 1's QUATERNION/RATE and EULER_ANGLE/RATE. The rates of the latter
//   two are interpreted in the way that agrees with the attitudes.
// - Frames: one is the body's (SC_BODY...); a part's frame (STARTRACKER_1, INSTRUMENT_A...) counts as the
//   body's. The other is ICRF, GCRF, EME2000, ITRF, TEME, TOD, MOD, GTOD, LVLH or RTN.
// - Quaternions follow annex F: the rotation that takes frame A's axes to frame B's.
// - An epoch that occurs twice splits its segment (repeated_epochs.h).

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/ccsds_message.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct AttitudeSample {
    TimeTai time;
    Quat reference_from_body;  // neighbours have the same sign
    Vec3d rate_body_rad_s;     // rate of the body relative to the reference; only when has_rates
};

struct AemSegment {
    std::string object_name, object_id;
    CcsdsFrame reference = CcsdsFrame::kIcrf;
    TimeTai usable_start, usable_stop;
    Interpolation interpolation;
    bool has_rates = false;
    std::vector<AttitudeSample> attitudes;  // rising times; at least two, and enough for the interpolation
    int line = 0;                           // line of META_START
};

// Loads the segments of one object in time order, from a file of at most 256 MiB; `object` as in load_oem().
// HERMITE without rates in the message, as in the standard's own example, uses as many attitudes as LAGRANGE
// of its degree. Throws InputError with file:line.
std::vector<AemSegment> load_aem(const std::filesystem::path& file, const std::string& object = "",
                                 std::vector<std::string>* notes = nullptr);
std::vector<AemSegment> read_aem(std::string_view text, const std::string& name,
                                 const std::string& object = "", std::vector<std::string>* notes = nullptr);
// Returns how many attitudes an interpolation of the segment needs.
int interpolation_nodes(const AemSegment& segment);

}  // namespace hilcam
