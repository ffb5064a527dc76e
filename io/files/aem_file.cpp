#include "io/files/aem_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "io/files/message_segments.h"
#include "io/files/repeated_epochs.h"
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
    kQuaternionRate,
    kEuler,
    kEulerDerivative,
    kEulerAngvel,
    kEulerRate,
    kSpin
};
struct TypeName {
    std::string_view name;
    AttitudeType type;
    std::size_t numbers;  // numbers in a data line
    bool rates;
};
constexpr std::array<TypeName, 9> kTypes = {
    {{"QUATERNION", AttitudeType::kQuaternion, 4, false},
     {"QUATERNION/DERIVATIVE", AttitudeType::kQuaternionDerivative, 8, true},
     {"QUATERNION/ANGVEL", AttitudeType::kQuaternionAngvel, 7, true},
     {"QUATERNION/RATE", AttitudeType::kQuaternionRate, 7, true},
     {"EULER_ANGLE", AttitudeType::kEuler, 3, false},
     {"EULER_ANGLE/DERIVATIVE", AttitudeType::kEulerDerivative, 6, true},
     {"EULER_ANGLE/ANGVEL", AttitudeType::kEulerAngvel, 6, true},
     {"EULER_ANGLE/RATE", AttitudeType::kEulerRate, 6, true},
     {"SPIN", AttitudeType::kSpin, 4, true}}};

// The metadata that give the numbers of a data line their meaning.
struct Metadata {
    AemSegment segment;
    TimeSystem system = TimeSystem::kUtc;
    SegmentSpan span;
    TypeName type = kTypes[0];
    std::optional<std::array<int, 3>> euler_axes;  // 0, 1, 2: x, y, z
    bool scalar_first = false;
    bool angvel_in_a = false;  // components of angular velocities
    // The meaning of version 1's rates, and its data lines, which are interpreted when all have been read.
    bool rates_of_angles = false;
    std::vector<double> version_1;
    // The message's rotation takes A's axes to B's; the body may be either of them.
    bool b_to_a = false, body_is_a = false;
};

TypeName type_of(const KvnLines& lines, const KvnEntry& entry) {
    std::string names;
    for (const TypeName& t : kTypes) {
        if (is_word(entry.value, t.name)) return t;
        names += (names.empty() ? "" : ", ") + std::string(t.name);
    }
    lines.refuse(entry.value, "ATTITUDE_TYPE of " + names, entry.line);
}

std::array<int, 3> axes_of(const KvnLines& lines, const KvnEntry& entry) {
    std::array<int, 3> axes{};
    const std::string letters = ccsds_word(entry.value);
    for (std::size_t i = 0; letters.size() == 3 && i < 3; ++i) {
        // Version 1 uses digits.
        const std::size_t at = std::string_view("XYZ123").find(letters[i]);
        if (at == std::string_view::npos || (i > 0 && static_cast<int>(at % 3) == axes[i - 1])) break;
        axes[i] = static_cast<int>(at % 3);
        if (i == 2) return axes;
    }
    lines.refuse(entry.value, "EULER_ROT_SEQ of three letters X, Y, Z, no two neighbours the same",
                 entry.line);
}

bool is_version_1(AttitudeType type) {
    return type == AttitudeType::kQuaternionRate || type == AttitudeType::kEulerRate;
}

// Determines in which frame a rate's components are given.
void read_rate_frame(const KvnLines& lines, const KvnEntry& frame, const KvnEntry& a, const KvnEntry& b,
                     Metadata& m) {
    m.angvel_in_a = is_word(frame.value, a.value) || is_word(frame.value, "REF_FRAME_A");
    if (!m.angvel_in_a && !is_word(frame.value, b.value) && !is_word(frame.value, "REF_FRAME_B"))
        lines.refuse(frame.value, frame.key + " of " + a.value + ", " + b.value, frame.line);
}

void read_frames(KvnLines& lines, const KvnSection& meta, Metadata& m) {
    const std::vector<CcsdsFrame> all = {CcsdsFrame::kIcrf, CcsdsFrame::kEme2000, CcsdsFrame::kEarthFixed,
                                         CcsdsFrame::kTeme, CcsdsFrame::kTod,     CcsdsFrame::kMod,
                                         CcsdsFrame::kGtod, CcsdsFrame::kLvlh,    CcsdsFrame::kRtn,
                                         CcsdsFrame::kBody};
    const KvnEntry& entry_a = meta.require(lines, "REF_FRAME_A");
    const KvnEntry& entry_b = meta.require(lines, "REF_FRAME_B");
    const CcsdsFrame a = ccsds_frame(lines, entry_a, all), b = ccsds_frame(lines, entry_b, all);
    m.body_is_a = a == CcsdsFrame::kBody;
    if (m.body_is_a == (b == CcsdsFrame::kBody))
        lines.refuse(entry_a.value + " and " + entry_b.value,
                     "one frame of the body (SC_BODY...), one that is not", entry_b.line);
    m.segment.reference = m.body_is_a ? b : a;
    const KvnEntry& body = m.body_is_a ? entry_a : entry_b;
    if (!ccsds_word(body.value).starts_with("SC BODY"))
        lines.note("part", in_quotes(body.value) + " is taken for the axes of the whole body", body.line);
    if (const KvnEntry* direction = meta.find("ATTITUDE_DIR")) {
        m.b_to_a = is_word(direction->value, "B2A");
        if (!m.b_to_a && !is_word(direction->value, "A2B"))
            lines.refuse(direction->value, "ATTITUDE_DIR of A2B, B2A", direction->line);
    }
    if (const KvnEntry* rate = meta.find("RATE_FRAME"); rate && is_version_1(m.type.type))
        read_rate_frame(lines, *rate, entry_a, entry_b, m);
    if (m.type.type != AttitudeType::kQuaternionAngvel && m.type.type != AttitudeType::kEulerAngvel) return;
    read_rate_frame(lines, meta.require(lines, "ANGVEL_FRAME"), entry_a, entry_b, m);
}

Metadata read_metadata(KvnLines& lines) {
    Metadata m;
    m.segment.line = lines.number();
    KvnSection meta;
    meta.read(lines, "META_STOP",
              {"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME_A", "REF_FRAME_B", "ATTITUDE_DIR",
               "TIME_SYSTEM", "START_TIME", "USEABLE_START_TIME", "USEABLE_STOP_TIME", "STOP_TIME",
               "ATTITUDE_TYPE", "QUATERNION_TYPE", "EULER_ROT_SEQ", "ANGVEL_FRAME", "RATE_FRAME",
               "INTERPOLATION_METHOD", "INTERPOLATION_DEGREE"});
    m.segment.object_name = meta.require(lines, "OBJECT_NAME").value;
    m.segment.object_id = meta.require(lines, "OBJECT_ID").value;
    m.system = ccsds_time_system(lines, meta.require(lines, "TIME_SYSTEM"));
    m.span = meta.span(lines, m.system);
    m.segment.usable_start = m.span.usable_start, m.segment.usable_stop = m.span.usable_stop;
    m.type = type_of(lines, meta.require(lines, "ATTITUDE_TYPE"));
    m.segment.has_rates = m.type.rates;
    read_frames(lines, meta, m);
    if (m.type.name.starts_with("EULER"))
        m.euler_axes = axes_of(lines, meta.require(lines, "EULER_ROT_SEQ"));
    else if (const KvnEntry* sequence = meta.find("EULER_ROT_SEQ"))
        m.euler_axes = axes_of(lines, *sequence);
    if (const KvnEntry* scalar = meta.find("QUATERNION_TYPE")) {
        m.scalar_first = is_word(scalar->value, "FIRST");
        if (!m.scalar_first && !is_word(scalar->value, "LAST"))
            lines.refuse(scalar->value, "QUATERNION_TYPE of FIRST, LAST", scalar->line);
    }
    m.segment.interpolation = meta.interpolation(lines, "INTERPOLATION_METHOD");
    return m;
}

Vec3d axis_dir(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }
Quat about_axis(int axis, double angle_rad) { return from_rotation_vector(angle_rad * axis_dir(axis)); }

Quat quaternion_at(const Metadata& m, const double* v) {
    return m.scalar_first ? Quat{v[0], v[1], v[2], v[3]} : Quat{v[3], v[0], v[1], v[2]};
}

// Frame B's axes relative to A, and B's angular velocity relative to A, in B's axes.
struct Turn {
    Quat a_from_b;
    Vec3d rate_b_rad_s;
};

// Annex F3: successive rotations about the rotated axes; the rate is the sum of the three.
Turn euler_turn(const Metadata& m, const double* v) {
    const std::array<int, 3>& axes = m.euler_axes.value();
    const Quat q1 = about_axis(axes[0], v[0] * kDegree_rad), q2 = about_axis(axes[1], v[1] * kDegree_rad),
               q3 = about_axis(axes[2], v[2] * kDegree_rad);
    Turn turn{q1 * q2 * q3, {}};
    if (m.type.type != AttitudeType::kEulerDerivative &&
        !(m.type.type == AttitudeType::kEulerRate && m.rates_of_angles))
        return turn;
    const auto axis = [&](std::size_t i, Quat later) {
        return to_matrix(conjugate(later)) * axis_dir(axes[i]);
    };
    turn.rate_b_rad_s = (v[3] * kDegree_rad) * axis(0, q2 * q3) + (v[4] * kDegree_rad) * axis(1, q3) +
                        (v[5] * kDegree_rad) * axis(2, {});
    return turn;
}

// Computes the rate for an attitude that is given as a quaternion. The first rotation is about an axis of A,
// the third about one of B, and the second about the line of nodes, perpendicular to both. The sign of that
// line is chosen for a second angle of 0 to 180 deg, or of -90 to 90 when the three axes differ. Nothing when
// the two axes are parallel.
std::optional<Vec3d> rate_of_angles(const Metadata& m, const Quat& a_from_b, const double* rates_deg_s) {
    const std::array<int, 3>& axes = m.euler_axes.value();
    const Mat3d a_from_b_axes = to_matrix(a_from_b), b_from_a_axes = transposed(a_from_b_axes);
    const Vec3d nodes = cross(axis_dir(axes[0]), a_from_b_axes * axis_dir(axes[2]));
    if (!(length(nodes) > 1e-6)) return {};
    const bool cyclic = (axes[0] + 1) % 3 == axes[1];
    const double sign = axes[0] == axes[2] || !cyclic ? 1 : -1;
    return kDegree_rad * (rates_deg_s[0] * (b_from_a_axes * axis_dir(axes[0])) +
                          (sign * rates_deg_s[1]) * (b_from_a_axes * normalized(nodes)) +
                          rates_deg_s[2] * axis_dir(axes[2]));
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
    if (m.type.type == AttitudeType::kQuaternionRate && m.rates_of_angles)
        turn.rate_b_rad_s = rate_of_angles(m, turn.a_from_b, v + 4).value_or(Vec3d{});
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
    // A rotation of B's axes to A's is the inverse; its rate is A's relative to B, in A's axes.
    if (m.b_to_a) turn = {conjugate(turn.a_from_b), -(to_matrix(turn.a_from_b) * turn.rate_b_rad_s)};
    if (m.type.type == AttitudeType::kQuaternionAngvel || m.type.type == AttitudeType::kEulerAngvel ||
        (is_version_1(m.type.type) && !m.rates_of_angles)) {
        const double* w = v + (euler ? 3 : 4);
        turn.rate_b_rad_s = kDegree_rad * Vec3d{w[0], w[1], w[2]};
        if (m.angvel_in_a) turn.rate_b_rad_s = to_matrix(conjugate(turn.a_from_b)) * turn.rate_b_rad_s;
    }
    return turn;
}

// Returns the same for the body relative to the reference.
Turn body_turn(const KvnLines& lines, const Metadata& m, const double* v) {
    const Turn turn = turn_of(lines, m, v);
    if (!m.body_is_a) return turn;
    return {conjugate(turn.a_from_b), -(to_matrix(turn.a_from_b) * turn.rate_b_rad_s)};
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
    // An epoch that occurs twice marks a manoeuvre.
    if (!samples.empty() && time < samples.back().time)
        lines.refuse(epoch, "epochs that rise from line to line");
    if (is_version_1(m.type.type)) m.version_1.insert(m.version_1.end(), v.begin(), v.end());
    const Turn turn = body_turn(lines, m, v.data());
    if (!is_within(turn.rate_b_rad_s, kFastestTurn_rad_s)) lines.refuse(line.text, "rates up to 6300 rad/s");
    Quat q = turn.a_from_b;
    if (!samples.empty()) {
        const Quat& p = samples.back().reference_from_body;
        if (p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0) q = {-q.w, -q.x, -q.y, -q.z};
    }
    samples.push_back({time, q, turn.rate_b_rad_s});
}

// Reads data from DATA_START to DATA_STOP. Returns true when another segment follows, false at the end of the
// file.
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

// Sums of the rotations from attitude to attitude, and of the deviations of the rates from them [rad].
struct RateFit {
    double off_rad = 0, turned_rad = 0;
    std::size_t steps = 0;
    bool good() const { return steps > 0 && off_rad <= 0.2 * turned_rad + 1e-3 * static_cast<double>(steps); }
};
RateFit fit_of(const std::vector<AttitudeSample>& samples) {
    RateFit fit;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double step_s = static_cast<double>(samples[i].time - samples[i - 1].time) * kSecondsPerNs;
        const Vec3d by_rates = (0.5 * step_s) * (samples[i - 1].rate_body_rad_s + samples[i].rate_body_rad_s);
        // Beyond half a turn, attitudes do not tell the direction of the rotation.
        if (!(step_s > 0) || !(length(by_rates) < 0.5 * kPi)) continue;
        const Quat step = conjugate(samples[i - 1].reference_from_body) * samples[i].reference_from_body;
        const Vec3d sine = (step.w < 0 ? -1.0 : 1.0) * Vec3d{step.x, step.y, step.z};
        const double size = length(sine), angle = 2 * std::atan2(size, std::abs(step.w));
        const Vec3d turned = (size > 1e-12 ? angle / size : 2.0) * sine;
        fit.off_rad += length(turned - by_rates), fit.turned_rad += length(turned), ++fit.steps;
    }
    return fit;
}

// Version 1 of the standard (504.0-B-1, 4.2.5) calls the rates of its types /RATE both rates of the Euler
// angles, in the sequence's order, and components in RATE_FRAME; programs write either. The attitudes decide
// which it is. Rates that contradict the attitudes both ways are not used.
void settle_version_1(KvnLines& lines, Metadata& m) {
    std::vector<AttitudeSample>& samples = m.segment.attitudes;
    const auto take = [&](bool of_angles) {
        m.rates_of_angles = of_angles;
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i].rate_body_rad_s =
                body_turn(lines, m, m.version_1.data() + i * m.type.numbers).rate_b_rad_s;
        return fit_of(samples);
    };
    const RateFit of_angles = m.euler_axes ? take(true) : RateFit{};
    const RateFit components = take(false);
    const bool better =
        m.euler_axes && of_angles.steps > 0 &&
        (components.steps == 0 || of_angles.off_rad / static_cast<double>(of_angles.steps) <
                                      components.off_rad / static_cast<double>(components.steps));
    if (better) take(true);
    m.segment.has_rates = (better ? of_angles : components).good();
    if (!m.segment.has_rates)
        lines.note("rates",
                   "the rates of " + std::string(m.type.name) +
                       " do not go with the attitudes, neither as rates of Euler angles nor as components: "
                       "they are not used",
                   m.segment.line);
}

void check_attitudes(const KvnLines& lines, const AemSegment& s) {
    if (s.attitudes.size() < 2)
        lines.fail("the segment that begins here has " + std::to_string(s.attitudes.size()) +
                       " attitudes; accepted: at least 2",
                   s.line);
    check_steps(lines, s.attitudes, s.line);
    if (s.attitudes.front().time > s.usable_start || s.attitudes.back().time < s.usable_stop)
        lines.fail("the attitudes of the segment that begins here do not reach over its usable span, " +
                       format_utc(s.usable_start) + " to " + format_utc(s.usable_stop),
                   s.line);
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

std::vector<AemSegment> read_aem(std::string_view text, const std::string& name, const std::string& object,
                                 std::vector<std::string>* notes) {
    KvnLines lines(text, name, NdmKind::kAem);
    read_header(lines);
    std::vector<AemSegment> segments;
    for (bool more = true; more;) {
        Metadata m = read_metadata(lines);
        more = read_data(lines, m);
        if (is_version_1(m.type.type)) settle_version_1(lines, m);
        check_attitudes(lines, m.segment);
        for (AemSegment& piece :
             cut_at_repeated_epochs(lines, std::move(m.segment), &AemSegment::attitudes,
                                    static_cast<int (*)(const AemSegment&)>(&interpolation_nodes)))
            keep_segment(lines, segments, std::move(piece), object);
    }
    return kept_segments(lines, std::move(segments), name, object, notes);
}

std::vector<AemSegment> load_aem(const std::filesystem::path& file, const std::string& object,
                                 std::vector<std::string>* notes) {
    return read_aem(read_input_file(file, {kMaxAemBytes, "an attitude ephemeris message (CCSDS AEM)"}),
                    file.string(), object, notes);
}

}  // namespace hilcam
