#include "io/files/aem_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/system/input_file.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxAemBytes = 256u << 20;

enum class AttitudeType {
    kQuaternion,
    kQuaternionDerivative,
    kQuaternionAngvel,
    kEuler,
    kEulerDerivative,
    kEulerAngvel,
    kSpin
};
struct TypeName {
    std::string_view name;
    AttitudeType type;
    std::size_t numbers;  // in a data line
    bool rates;
};
constexpr std::array<TypeName, 7> kTypes = {
    {{"QUATERNION", AttitudeType::kQuaternion, 4, false},
     {"QUATERNION/DERIVATIVE", AttitudeType::kQuaternionDerivative, 8, true},
     {"QUATERNION/ANGVEL", AttitudeType::kQuaternionAngvel, 7, true},
     {"EULER_ANGLE", AttitudeType::kEuler, 3, false},
     {"EULER_ANGLE/DERIVATIVE", AttitudeType::kEulerDerivative, 6, true},
     {"EULER_ANGLE/ANGVEL", AttitudeType::kEulerAngvel, 6, true},
     {"SPIN", AttitudeType::kSpin, 4, true}}};

// Metadata say how the numbers of a data line are meant.
struct Metadata {
    AemSegment segment;
    TimeSystem system = TimeSystem::kUtc;
    SegmentSpan span;
    TypeName type = kTypes[0];
    std::array<int, 3> euler_axes{};  // 0, 1, 2: x, y, z
    bool scalar_first = false;
    bool angvel_in_a = false;  // components of angular velocities
    // The message's rotation takes A's axes to B's; the body may be either.
    bool b_to_a = false, body_is_a = false;
};

TypeName type_of(const KvnLines& lines, const KvnEntry& entry) {
    std::string names;
    for (const TypeName& t : kTypes) {
        if (t.name == entry.value) return t;
        names += (names.empty() ? "" : ", ") + std::string(t.name);
    }
    lines.refuse(entry.value, "ATTITUDE_TYPE of " + names, entry.line);
}

std::array<int, 3> axes_of(const KvnLines& lines, const KvnEntry& entry) {
    std::array<int, 3> axes{};
    const std::string& letters = entry.value;
    for (std::size_t i = 0; letters.size() == 3 && i < 3; ++i) {
        // Version 1 has digits.
        const std::size_t at = std::string_view("XYZ123").find(letters[i]);
        if (at == std::string_view::npos || (i > 0 && static_cast<int>(at % 3) == axes[i - 1])) break;
        axes[i] = static_cast<int>(at % 3);
        if (i == 2) return axes;
    }
    lines.refuse(letters, "EULER_ROT_SEQ of three letters X, Y, Z, no two neighbours the same", entry.line);
}

void read_frames(const KvnLines& lines, const KvnSection& meta, Metadata& m) {
    const std::vector<CcsdsFrame> all = {CcsdsFrame::kIcrf, CcsdsFrame::kEme2000, CcsdsFrame::kEarthFixed,
                                         CcsdsFrame::kTeme, CcsdsFrame::kLvlh,    CcsdsFrame::kRtn,
                                         CcsdsFrame::kBody};
    const KvnEntry& entry_a = meta.require(lines, "REF_FRAME_A");
    const KvnEntry& entry_b = meta.require(lines, "REF_FRAME_B");
    const CcsdsFrame a = ccsds_frame(lines, entry_a, all), b = ccsds_frame(lines, entry_b, all);
    m.body_is_a = a == CcsdsFrame::kBody;
    if (m.body_is_a == (b == CcsdsFrame::kBody))
        lines.refuse(entry_a.value + " and " + entry_b.value,
                     "one frame of the body (SC_BODY...), one that is not", entry_b.line);
    m.segment.reference = m.body_is_a ? b : a;
    if (const KvnEntry* direction = meta.find("ATTITUDE_DIR")) {
        if (direction->value != "A2B" && direction->value != "B2A")
            lines.refuse(direction->value, "ATTITUDE_DIR of A2B, B2A", direction->line);
        m.b_to_a = direction->value == "B2A";
    }
    if (m.type.type != AttitudeType::kQuaternionAngvel && m.type.type != AttitudeType::kEulerAngvel) return;
    const KvnEntry& angvel = meta.require(lines, "ANGVEL_FRAME");
    m.angvel_in_a = angvel.value == entry_a.value || angvel.value == "REF_FRAME_A";
    if (!m.angvel_in_a && angvel.value != entry_b.value && angvel.value != "REF_FRAME_B")
        lines.refuse(angvel.value, "ANGVEL_FRAME of " + entry_a.value + ", " + entry_b.value, angvel.line);
}

Metadata read_metadata(KvnLines& lines) {
    Metadata m;
    m.segment.line = lines.number();
    KvnSection meta;
    meta.read(
        lines, "META_STOP",
        {"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME_A", "REF_FRAME_B", "ATTITUDE_DIR",
         "TIME_SYSTEM", "START_TIME", "USEABLE_START_TIME", "USEABLE_STOP_TIME", "STOP_TIME", "ATTITUDE_TYPE",
         "QUATERNION_TYPE", "EULER_ROT_SEQ", "ANGVEL_FRAME", "INTERPOLATION_METHOD", "INTERPOLATION_DEGREE"});
    m.segment.object_name = meta.require(lines, "OBJECT_NAME").value;
    m.segment.object_id = meta.require(lines, "OBJECT_ID").value;
    m.system = ccsds_time_system(lines, meta.require(lines, "TIME_SYSTEM"));
    m.span = meta.span(lines, m.system);
    m.segment.usable_start = m.span.usable_start, m.segment.usable_stop = m.span.usable_stop;
    m.type = type_of(lines, meta.require(lines, "ATTITUDE_TYPE"));
    m.segment.has_rates = m.type.rates;
    read_frames(lines, meta, m);
    const bool euler = m.type.name.starts_with("EULER");
    if (euler) m.euler_axes = axes_of(lines, meta.require(lines, "EULER_ROT_SEQ"));
    if (const KvnEntry* scalar = meta.find("QUATERNION_TYPE")) {
        if (scalar->value != "FIRST" && scalar->value != "LAST")
            lines.refuse(scalar->value, "QUATERNION_TYPE of FIRST, LAST", scalar->line);
        m.scalar_first = scalar->value == "FIRST";
    }
    m.segment.interpolation = meta.interpolation(lines, "INTERPOLATION_METHOD");
    return m;
}

Quat about_axis(int axis, double angle_rad) {
    return from_rotation_vector(angle_rad *
                                Vec3d{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0});
}

Quat quaternion_at(const Metadata& m, const double* v) {
    return m.scalar_first ? Quat{v[0], v[1], v[2], v[3]} : Quat{v[3], v[0], v[1], v[2]};
}

// Frame B's axes by turning A's, and B's angular velocity against A, in B's axes.
struct Turn {
    Quat a_from_b;
    Vec3d rate_b_rad_s;
};

// Annex F3: successive turns about the turned axes; the rate is the sum of theirs.
Turn euler_turn(const Metadata& m, const double* v) {
    const Quat q1 = about_axis(m.euler_axes[0], v[0] * kDegree_rad),
               q2 = about_axis(m.euler_axes[1], v[1] * kDegree_rad),
               q3 = about_axis(m.euler_axes[2], v[2] * kDegree_rad);
    Turn turn{q1 * q2 * q3, {}};
    if (m.type.type != AttitudeType::kEulerDerivative) return turn;
    const auto axis = [&](std::size_t i, Quat later) {
        const int a = m.euler_axes[i];
        return to_matrix(conjugate(later)) *
               Vec3d{a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0};
    };
    turn.rate_b_rad_s = (v[3] * kDegree_rad) * axis(0, q2 * q3) + (v[4] * kDegree_rad) * axis(1, q3) +
                        (v[5] * kDegree_rad) * axis(2, {});
    return turn;
}

Turn quaternion_turn(const KvnLines& lines, const Metadata& m, const double* v) {
    const Quat q = quaternion_at(m, v);
    if (!(std::abs(norm(q) - 1) < 1e-3))
        lines.fail("found a quaternion of norm " + plain(norm(q)) + "; accepted: norm 1 within 0.001");
    Turn turn{normalized(q), {}};
    if (m.type.type == AttitudeType::kQuaternionDerivative) {
        // omega = 2 q* dq/dt, in B's axes.
        const Quat w = conjugate(turn.a_from_b) * quaternion_at(m, v + 4);
        turn.rate_b_rad_s = 2.0 * Vec3d{w.x, w.y, w.z};
    }
    return turn;
}

Turn turn_of(const KvnLines& lines, const Metadata& m, const double* v) {
    Turn turn;
    if (m.type.type == AttitudeType::kSpin) {
        // Annex F5.2: about z, x, z.
        turn.a_from_b = about_axis(2, (v[0] + 90) * kDegree_rad) * about_axis(0, (90 - v[1]) * kDegree_rad) *
                        about_axis(2, v[2] * kDegree_rad);
        turn.rate_b_rad_s = {0, 0, v[3] * kDegree_rad};
        return turn;
    }
    const bool euler = m.type.name.starts_with("EULER");
    turn = euler ? euler_turn(m, v) : quaternion_turn(lines, m, v);
    // Written as a turn of B's axes to A's, it is the inverse; its rate is A's against B, in A's axes.
    if (m.b_to_a) turn = {conjugate(turn.a_from_b), -(to_matrix(turn.a_from_b) * turn.rate_b_rad_s)};
    if (m.type.type == AttitudeType::kQuaternionAngvel || m.type.type == AttitudeType::kEulerAngvel) {
        const double* w = v + (euler ? 3 : 4);
        turn.rate_b_rad_s = kDegree_rad * Vec3d{w[0], w[1], w[2]};
        if (m.angvel_in_a) turn.rate_b_rad_s = to_matrix(conjugate(turn.a_from_b)) * turn.rate_b_rad_s;
    }
    return turn;
}

void read_attitude(const KvnLines& lines, const KvnLine& line, Metadata& m) {
    std::string_view epoch;
    const std::vector<double> v = data_numbers(lines, line.text, epoch);
    if (v.size() != m.type.numbers)
        lines.refuse(line.text, "an epoch with " + std::to_string(m.type.numbers) + " numbers, as " +
                                    std::string(m.type.name) + " has");
    for (const double x : v)
        if (!(std::abs(x) < 1e9)) lines.refuse(line.text, "numbers below 1e9");
    const TimeTai time = ccsds_epoch(lines, epoch, m.system);
    if (time < m.span.start || m.span.stop < time) lines.refuse(epoch, "epochs from START_TIME to STOP_TIME");
    std::vector<AttitudeSample>& samples = m.segment.attitudes;
    if (!samples.empty() && time <= samples.back().time)
        lines.refuse(epoch, "epochs that rise from line to line");
    Turn turn = turn_of(lines, m, v.data());
    if (m.body_is_a) turn = {conjugate(turn.a_from_b), -(to_matrix(turn.a_from_b) * turn.rate_b_rad_s)};
    if (!is_within(turn.rate_b_rad_s, kFastestTurn_rad_s)) lines.refuse(line.text, "rates up to 6300 rad/s");
    Quat q = turn.a_from_b;
    if (!samples.empty()) {
        const Quat& p = samples.back().reference_from_body;
        if (p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0) q = {-q.w, -q.x, -q.y, -q.z};
    }
    samples.push_back({time, q, turn.rate_b_rad_s});
}

// Data between DATA_START and DATA_STOP, and what follows: another segment (true) or the file's end.
bool read_data(KvnLines& lines, Metadata& m) {
    KvnLine line;
    if (!lines.next(line) || line.text != "DATA_START") lines.refuse(line.text, "DATA_START after META_STOP");
    for (;;) {
        if (!lines.next(line)) lines.fail("the file ends; accepted: DATA_STOP");
        if (line.text == "DATA_STOP") break;
        read_attitude(lines, line, m);
    }
    if (!lines.next(line)) return false;
    if (line.text != "META_START") lines.refuse(line.text, "META_START, or the file's end, after DATA_STOP");
    return true;
}

void check_attitudes(const KvnLines& lines, const AemSegment& s) {
    const auto fewest = static_cast<std::size_t>(std::max(2, interpolation_nodes(s)));
    if (s.attitudes.size() < fewest)
        lines.fail("the segment that begins here has " + std::to_string(s.attitudes.size()) +
                       " attitudes; accepted: at least " + std::to_string(fewest) + " for its interpolation",
                   s.line);
    check_steps(lines, s.attitudes, s.line);
    if (s.attitudes.front().time > s.usable_start || s.attitudes.back().time < s.usable_stop)
        lines.fail("the attitudes of the segment that begins here do not reach over its usable span, " +
                       format_utc(s.usable_start) + " to " + format_utc(s.usable_stop),
                   s.line);
}

void keep(const KvnLines& lines, std::vector<AemSegment>& kept, AemSegment&& segment,
          const std::string& object) {
    if (!object.empty() && segment.object_name != object && segment.object_id != object) return;
    if (!kept.empty() && object.empty() && kept.back().object_id != segment.object_id)
        lines.fail("has objects " + in_quotes(kept.back().object_id) + " and " +
                       in_quotes(segment.object_id) + "; accepted: one of them by 'object'",
                   segment.line);
    if (!kept.empty() && segment.usable_start < kept.back().usable_stop)
        lines.fail("the segment that begins here is usable from " + format_utc(segment.usable_start) +
                       ", before the one of line " + std::to_string(kept.back().line) + " ends",
                   segment.line);
    kept.push_back(std::move(segment));
}

void read_header(KvnLines& lines) {
    KvnLine line;
    if (!lines.next(line) || line.key != "CCSDS_AEM_VERS" || (line.value != "1.0" && line.value != "2.0"))
        lines.refuse(line.text, "CCSDS_AEM_VERS = 1.0 or 2.0 first");
    while (lines.next(line)) {
        if (line.text == "META_START") return;
        if (line.key.empty()) lines.refuse(line.text, "META_START before data");
    }
    lines.fail("the file ends; accepted: META_START");
}

}  // namespace

int interpolation_nodes(const AemSegment& s) {
    if (s.interpolation.method == InterpolationMethod::kHermite && !s.has_rates)
        return s.interpolation.degree + 1;
    return interpolation_nodes(s.interpolation);
}

std::vector<AemSegment> read_aem(std::string_view text, const std::string& name, const std::string& object) {
    KvnLines lines(text, name);
    read_header(lines);
    std::vector<AemSegment> segments;
    for (bool more = true; more;) {
        Metadata m = read_metadata(lines);
        more = read_data(lines, m);
        check_attitudes(lines, m.segment);
        keep(lines, segments, std::move(m.segment), object);
    }
    if (segments.empty())
        throw InputError(name + ": has no object " + in_quotes(object) +
                         "; accepted: an OBJECT_NAME or OBJECT_ID");
    return segments;
}

std::vector<AemSegment> load_aem(const std::filesystem::path& file, const std::string& object) {
    return read_aem(read_input_file(file, {kMaxAemBytes, "an attitude ephemeris message (CCSDS AEM)"}),
                    file.string(), object);
}

}  // namespace hilcam
