#pragma once
// Reads Orbit Ephemeris Messages (OEM) as KVN or XML: CCSDS 502.0-B-3 section 5, versions 1.0 to 3.0, as STK,
// GMAT, Orekit and NASA write them.
//
// Frames: ICRF, GCRF, EME2000, ITRF and its realisations, TEME, TOD and MOD (of date or of REF_FRAME_EPOCH),
// GTOD. Time systems: UTC, TAI, TT, GPS, TDB. Covariances and accelerations are skipped. An epoch that occurs
// twice splits its segment (repeated_epochs.h).

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/ccsds_message.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct StateSample {
    TimeTai time;
    Vec3d position_m, velocity_m_s;
};

// States that may be interpolated with each other.
struct OemSegment {
    std::string object_name, object_id, center_name;
    CcsdsFrame frame = CcsdsFrame::kIcrf;
    std::optional<TimeTai> frame_epoch;  // epoch at which the frame's axes are frozen, if they are
    TimeTai usable_start, usable_stop;
    Interpolation interpolation;
    std::vector<StateSample> states;  // rising times; at least two, and enough for the interpolation
    int line = 0;                     // line of META_START
};

// Loads the segments of one object in time order, from at most 256 MiB (XML: 128); usable spans do not
// overlap. object: its name or id; may be empty when the message has only one. notes: gets one line for each
// thing in the message that is not used. Throws InputError with file:line.
std::vector<OemSegment> load_oem(const std::filesystem::path& file, const std::string& object = "",
                                 std::vector<std::string>* notes = nullptr);
// Reads the same from memory; name stands for the file in messages.
std::vector<OemSegment> read_oem(std::string_view text, const std::string& name,
                                 const std::string& object = "", std::vector<std::string>* notes = nullptr);

}  // namespace hilcam
