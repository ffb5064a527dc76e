#include "io/files/oem_file.h"

#include <algorithm>

#include "io/files/message_segments.h"
#include "io/files/repeated_epochs.h"
#include "io/system/input_file.h"
#include "render/sky/motion_bounds.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxOemBytes = 256u << 20;
constexpr double kKilometre_m = 1000;

void read_header(KvnLines& lines, KvnLine& line) {
    if (!lines.next(line) || line.key != "CCSDS_OEM_VERS")
        lines.refuse(line.text, "CCSDS_OEM_VERS = 1.0, 2.0 or 3.0 first");
    if (line.value != "1.0" && line.value != "2.0" && line.value != "3.0")
        lines.refuse(line.value, "CCSDS_OEM_VERS 1.0, 2.0 or 3.0");
    while (lines.next(line)) {
        if (line.text == "META_START") return;
        if (line.key.empty()) lines.refuse(line.text, "META_START before data");
    }
    lines.fail("the file ends; accepted: META_START");
}

struct OemMetadata {
    OemSegment segment;
    TimeSystem system = TimeSystem::kUtc;
    SegmentSpan span;
};

OemMetadata read_oem_metadata(KvnLines& lines) {
    OemMetadata m;
    m.segment.line = lines.number();
    KvnSection meta;
    meta.read(lines, "META_STOP",
              {"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "REF_FRAME_EPOCH", "TIME_SYSTEM",
               "START_TIME", "USEABLE_START_TIME", "USEABLE_STOP_TIME", "STOP_TIME", "INTERPOLATION",
               "INTERPOLATION_DEGREE"});
    m.segment.object_name = meta.require(lines, "OBJECT_NAME").value;
    m.segment.object_id = meta.require(lines, "OBJECT_ID").value;
    m.segment.center_name = meta.require(lines, "CENTER_NAME").value;
    m.segment.frame = ccsds_frame(lines, meta.require(lines, "REF_FRAME"),
                                  {CcsdsFrame::kIcrf, CcsdsFrame::kEme2000, CcsdsFrame::kEarthFixed,
                                   CcsdsFrame::kTeme, CcsdsFrame::kTod, CcsdsFrame::kMod, CcsdsFrame::kGtod});
    m.system = ccsds_time_system(lines, meta.require(lines, "TIME_SYSTEM"));
    m.segment.frame_epoch = frame_epoch(lines, meta, m.segment.frame, m.system);
    m.span = meta.span(lines, m.system);
    m.segment.usable_start = m.span.usable_start, m.segment.usable_stop = m.span.usable_stop;
    m.segment.interpolation = meta.interpolation(lines, "INTERPOLATION");
    return m;
}

void read_state(const KvnLines& lines, const KvnLine& line, OemMetadata& m) {
    std::string_view epoch;
    const std::vector<double> v = data_numbers(lines, line.text, epoch);
    if (v.size() != 6 && v.size() != 9)
        lines.refuse(line.text, "an epoch with 6 or 9 numbers: position, velocity, perhaps acceleration");
    const TimeTai time = ccsds_epoch(lines, epoch, m.system);
    if (time < m.span.start || m.span.stop < time) lines.refuse(epoch, "epochs from START_TIME to STOP_TIME");
    std::vector<StateSample>& states = m.segment.states;
    // An epoch that occurs twice marks a manoeuvre.
    if (!states.empty() && time < states.back().time)
        lines.refuse(epoch, "epochs that rise from line to line");
    const StateSample state{time, kKilometre_m * Vec3d{v[0], v[1], v[2]},
                            kKilometre_m * Vec3d{v[3], v[4], v[5]}};
    if (!is_within(state.position_m, kFarthestPlace_m) || !is_within(state.velocity_m_s, kFastestMotion_m_s))
        lines.refuse(line.text, "positions up to 1.5e12 km and velocities up to 3e5 km/s");
    states.push_back(state);
}

// Checks that the states cover the usable span.
void check_states(const KvnLines& lines, const OemSegment& s) {
    if (s.states.size() < 2)
        lines.fail("the segment that begins here has " + std::to_string(s.states.size()) +
                       " states; accepted: at least 2",
                   s.line);
    check_steps(lines, s.states, s.line);
    if (s.states.front().time > s.usable_start || s.states.back().time < s.usable_stop)
        lines.fail("the states of the segment that begins here, " + format_utc(s.states.front().time) +
                       " to " + format_utc(s.states.back().time) + ", do not reach over its usable span, " +
                       format_utc(s.usable_start) + " to " + format_utc(s.usable_stop),
                   s.line);
}

void skip_covariance(KvnLines& lines, KvnLine& line) {
    while (lines.next(line))
        if (line.text == "COVARIANCE_STOP") return;
    lines.fail("the file ends; accepted: COVARIANCE_STOP");
}

// Reads data. Returns true at the next META_START, false at the end of the file.
bool read_data(KvnLines& lines, KvnLine& line, OemMetadata& m) {
    while (lines.next(line)) {
        if (line.text == "META_START") return true;
        if (line.text == "COVARIANCE_START")
            skip_covariance(lines, line);
        else
            read_state(lines, line, m);
    }
    return false;
}

int nodes_of(const OemSegment& s) { return interpolation_nodes(s.interpolation); }

}  // namespace

std::vector<OemSegment> read_oem(std::string_view text, const std::string& name, const std::string& object,
                                 std::vector<std::string>* notes) {
    KvnLines lines(text, name, NdmKind::kOem);
    KvnLine line;
    read_header(lines, line);
    std::vector<OemSegment> segments;
    for (bool more = true; more;) {
        OemMetadata m = read_oem_metadata(lines);
        more = read_data(lines, line, m);
        check_states(lines, m.segment);
        for (OemSegment& piece :
             cut_at_repeated_epochs(lines, std::move(m.segment), &OemSegment::states, &nodes_of))
            keep_segment(lines, segments, std::move(piece), object);
    }
    return kept_segments(lines, std::move(segments), name, object, notes);
}

std::vector<OemSegment> load_oem(const std::filesystem::path& file, const std::string& object,
                                 std::vector<std::string>* notes) {
    return read_oem(read_input_file(file, {kMaxOemBytes, "an orbit ephemeris message (CCSDS OEM)"}),
                    file.string(), object, notes);
}

}  // namespace hilcam
