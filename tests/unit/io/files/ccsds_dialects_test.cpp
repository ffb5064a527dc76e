// Orbit and attitude messages as STK, GMAT, Orekit and NASA write them; what is refused is in motion_files_test.cpp.

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <tuple>

#include "io/files/aem_file.h"
#include "io/files/oem_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class CcsdsDialects : public FilesTest {
  protected:
    std::string refusal_of_oem(const std::string& text) {
        return error_of([&] { read_oem(text, "t.oem"); });
    }
    static void expect_same(const std::vector<OemSegment>& a, const std::vector<OemSegment>& b) {
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].frame, b[i].frame);
            EXPECT_EQ(a[i].interpolation.method, b[i].interpolation.method);
            EXPECT_EQ(a[i].interpolation.degree, b[i].interpolation.degree);
            EXPECT_EQ(a[i].usable_stop, b[i].usable_stop);
            ASSERT_EQ(a[i].states.size(), b[i].states.size());
            for (std::size_t k = 0; k < a[i].states.size(); ++k) {
                EXPECT_EQ(a[i].states[k].time, b[i].states[k].time);
                EXPECT_EQ(length(a[i].states[k].position_m - b[i].states[k].position_m), 0);
                EXPECT_EQ(length(a[i].states[k].velocity_m_s - b[i].states[k].velocity_m_s), 0);
            }
        }
    }
};

// --- orbits ---

const std::string kCircleOem =
    "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-03-01T00:00:00\nORIGINATOR = T\nMETA_START\nOBJECT_NAME = "
    "SAT\n"
    "OBJECT_ID = 2020-001A\nCENTER_NAME = EARTH\nREF_FRAME = EME2000\nTIME_SYSTEM = UTC\n"
    "START_TIME = 2026-03-20T12:00:00\nSTOP_TIME = 2026-03-20T12:03:00\nINTERPOLATION = LAGRANGE\n"
    "INTERPOLATION_DEGREE = 3\nMETA_STOP\n"
    "2026-03-20T12:00:00 7000.5 0 1 -1 7.5 0\n2026-03-20T12:01:00 7001 450 2 -1 7.4 0\n"
    "2026-03-20T12:02:00 7002 900 3 -1 7.3 0\n2026-03-20T12:03:00 7003 1350 4 -1 7.2 0\n";

TEST_F(CcsdsDialects, WordsAreReadInAnyCase) {
    const std::vector<OemSegment> plain = read_oem(kCircleOem, "t.oem");
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
             {"= LAGRANGE", "= Lagrange"},
             {"= LAGRANGE", "= lagrange"},
             {"= EME2000", "= eme2000"},
             {"= EME2000", "= j2000"},
             {"= UTC", "= utc"},
             {"DEGREE = 3", "DEGREE = 3 [n/a]"},
             {"7000.5 0", "7.0005D+03 0.0d0"},
             {"CCSDS_OEM",
              "\xEF\xBB\xBF"
              "CCSDS_OEM"},
             {"ORIGINATOR = T", "ORIGINATOR = T\nMESSAGE_ID = A 1\nCLASSIFICATION = public"},
             {"META_STOP", "TRACKING_ID = 7\nMESSAGE_ID = 8\nMETA_STOP"},
             {"META_STOP", "REF_FRAME_EPOCH = 2000-01-01T12:00:00\nMETA_STOP"}})
        expect_same(read_oem(with(kCircleOem, from, to), "t.oem"), plain);
    std::vector<std::string> notes;
    read_oem(with(kCircleOem, "META_STOP", "TRACKING_ID = 7\nMETA_STOP"), "t.oem", "sat", &notes);
    EXPECT_THAT(notes, testing::ElementsAre("t.oem:14: the keyword 'TRACKING_ID' is not used"));
}

// Elements in the standard's order, with and without an <ndm> around, units, comments and a covariance.
TEST_F(CcsdsDialects, AnOemInXmlIsTheSame) {
    const std::vector<OemSegment> plain = read_oem(kCircleOem, "t.oem");
    std::string xml =
        "<?xml version=\"1.0\"?>\n<oem id=\"CCSDS_OEM_VERS\" "
        "version=\"2.0\"><header><CREATION_DATE>2026</CREATION_DATE>"
        "</header><body>\n<segment><metadata><COMMENT>c</COMMENT><OBJECT_NAME>SAT</"
        "OBJECT_NAME><OBJECT_ID>2020-001A"
        "</OBJECT_ID><CENTER_NAME>Earth</CENTER_NAME><REF_FRAME>EME2000</REF_FRAME><TIME_SYSTEM>UTC</"
        "TIME_SYSTEM>"
        "<START_TIME>2026-03-20T12:00:00</START_TIME><STOP_TIME>2026-03-20T12:03:00</"
        "STOP_TIME><INTERPOLATION>"
        "Lagrange</INTERPOLATION><INTERPOLATION_DEGREE>3</INTERPOLATION_DEGREE></metadata><data><COMMENT/>\n";
    const auto state = [](int minute, const char* x, int y, int z, const char* v) {
        return "<stateVector><EPOCH>2026-03-20T12:0" + std::to_string(minute) +
               ":00</EPOCH><X units=\"km\">" + x + "</X><Y>" + std::to_string(y) + "</Y><Z>\n " +
               std::to_string(z) + "\n</Z><X_DOT>-1</X_DOT>" + "<Y_DOT units=\"km/s\">" + v +
               "</Y_DOT><Z_DOT>0</Z_DOT><X_DDOT>9</X_DDOT></stateVector>\n";
    };
    xml += state(0, "7000.5", 0, 1, "7.5") + state(1, "7001", 450, 2, "7.4") +
           state(2, "7002", 900, 3, "7.3") + state(3, "7003", 1350, 4, "7.2");
    xml +=
        "<covarianceMatrix><EPOCH>2026</EPOCH><CX_X>1</CX_X></covarianceMatrix></data></segment></body></"
        "oem>";
    expect_same(read_oem(xml, "t.xml"), plain);
    const std::string message = xml.substr(xml.find("<oem"));
    expect_same(read_oem("<ndm xmlns:ndm=\"x\">" + message + "</ndm>", "t.xml"), plain);
    expect_same(read_oem(with(with(message, "<oem", "<ndm:oem"), "</oem>", "</ndm:oem>"), "t.xml"), plain);
    // Messages name the file's lines.
    EXPECT_THAT(refusal_of_oem(with(xml, "<X units=\"km\">7002", "<X units=\"m\">7002")),
                HasSubstr("t.oem:10: X: found units 'm'; accepted: km"));
    EXPECT_THAT(refusal_of_oem(with(xml, "7002", "7x02")),
                HasSubstr("t.oem:10: found '7x02'; accepted: a number"));
    EXPECT_THAT(refusal_of_oem(with(xml, "<Y>900</Y>", "")),
                HasSubstr("t.oem:10: the state that begins here has 5 of X"));
    EXPECT_THAT(refusal_of_oem(with(xml, ">EME2000<", ">TNW<")),
                HasSubstr("found 'TNW'; accepted: REF_FRAME of"));
    EXPECT_THAT(refusal_of_oem(with(xml, "</segment>", "")), HasSubstr("is no XML"));
}

TEST_F(CcsdsDialects, ARepeatedEpochPartsItsSegment) {
    const std::string burn = with(kCircleOem, "2026-03-20T12:02:00",
                                  "2026-03-20T12:01:00 7001 450 2 -1 7.9 0\n2026-03-20T12:02:00");
    std::vector<std::string> notes;
    const std::vector<OemSegment> sides = read_oem(burn, "t.oem", "", &notes);
    ASSERT_EQ(sides.size(), 2u);
    EXPECT_EQ(sides[0].states.size(), 2u);
    EXPECT_EQ(sides[1].states.size(), 3u);
    EXPECT_EQ(sides[0].usable_stop, sides[1].usable_start);
    EXPECT_EQ(sides[0].states.back().velocity_m_s.y, 7400);
    EXPECT_EQ(sides[1].states.front().velocity_m_s.y, 7900);
    // Two and three states allow degrees 1 and 2.
    EXPECT_EQ(sides[0].interpolation.degree, 1);
    EXPECT_EQ(sides[1].interpolation.degree, 2);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], HasSubstr("has 2 samples, fewer than INTERPOLATION_DEGREE 3 takes"));
    // At the first and the last epoch, and three times the same one: what has no length is left out.
    const std::string ends = with(
        with(kCircleOem, "2026-03-20T12:00:00 ", "2026-03-20T12:00:00 1 2 3 4 5 6\n2026-03-20T12:00:00 "),
        "2026-03-20T12:03:00 ", "2026-03-20T12:03:00 7003 1350 4 -1 7.2 0\n2026-03-20T12:03:00 ");
    const std::vector<OemSegment> whole = read_oem(ends, "t.oem");
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].states.size(), 4u);
    EXPECT_EQ(whole[0].states.front().position_m.x, 7000500);
    std::string nothing = kCircleOem.substr(0, kCircleOem.find("2026-03-20T12:01:00 "));
    nothing = with(nothing, "DEGREE = 3", "DEGREE = 1") + "2026-03-20T12:00:00 7001 450 2 -1 7.4 0\n";
    EXPECT_THAT(refusal_of_oem(nothing), HasSubstr("has no two epochs that differ"));
}

TEST_F(CcsdsDialects, WhatLooksLikePlainTextAndIsNotIsNamed) {
    EXPECT_THAT(refusal_of_oem("\xFF\xFE" + kCircleOem),
                HasSubstr("t.oem: is UTF-16; accepted: UTF-8 or ASCII"));
    EXPECT_THAT(refusal_of_oem(with(kCircleOem, "7001 450",
                                    "7001\xC2\xA0"
                                    "450")),
                HasSubstr("which has U+00A0, a non-breaking blank; accepted: a number, with plain blanks"));
    // In a name it is a character as any other.
    EXPECT_EQ(read_oem(with(kCircleOem, "= SAT", "= S\xC2\xA0T"), "t.oem").size(), 1u);
}

// Short segments have the degree that their states allow, and say so.
TEST_F(CcsdsDialects, ADegreeOfMoreStatesThanThereAreIsLowered) {
    for (const auto& [method, given, degree] : std::vector<std::tuple<std::string, std::string, int>>{
             {"LAGRANGE", "9", 3}, {"HERMITE", "11", 8}, {"HERMITE", "7", 7}, {"LAGRANGE", "3", 3}}) {
        std::vector<std::string> notes;
        const OemSegment s =
            read_oem(with(with(kCircleOem, "LAGRANGE", method), "DEGREE = 3", "DEGREE = " + given), "t.oem",
                     "", &notes)
                .at(0);
        EXPECT_LE(interpolation_nodes(s.interpolation), 4);
        EXPECT_LE(s.interpolation.degree, degree);
        EXPECT_EQ(notes.size(), given == "9" || given == "11" ? 1u : 0u);
        for (const std::string& note : notes)
            EXPECT_THAT(note, HasSubstr("t.oem:4: the segment that begins here has 4 samples, fewer than "
                                        "INTERPOLATION_DEGREE " +
                                        given + " takes: as many are taken"));
    }
}

TEST_F(CcsdsDialects, EvenDegreesOfHermiteTakeTheNextOddOnesStates) {
    for (const auto& [degree, nodes] :
         std::vector<std::pair<int, int>>{{1, 2}, {2, 2}, {3, 2}, {4, 3}, {5, 3}, {8, 5}, {30, 16}, {31, 16}})
        EXPECT_EQ(interpolation_nodes({InterpolationMethod::kHermite, degree}), nodes) << degree;
    EXPECT_EQ(
        read_oem(with(with(kCircleOem, "LAGRANGE", "HERMITE"), "DEGREE = 3", "DEGREE = 2"), "t.oem").size(),
        1u);
}

TEST_F(CcsdsDialects, TheFramesEpochIsTakenOrRefused) {
    const auto read = [&](const std::string& frame, const std::string& epoch) {
        return with(kCircleOem, "= EME2000",
                    "= " + frame + (epoch.empty() ? "" : "\nREF_FRAME_EPOCH = " + epoch));
    };
    const TimeTai epoch = parse_utc("2001-02-03T04:05:06Z");
    for (const auto& [name, frame] :
         std::vector<std::pair<std::string, CcsdsFrame>>{{"TEME", CcsdsFrame::kTeme},
                                                         {"TOD", CcsdsFrame::kTod},
                                                         {"mod", CcsdsFrame::kMod},
                                                         {"TEMEOFEPOCH", CcsdsFrame::kTeme},
                                                         {"TOE_EARTH", CcsdsFrame::kTod},
                                                         {"MOE EARTH", CcsdsFrame::kMod}}) {
        const OemSegment s = read_oem(read(name, "2001-02-03T04:05:06"), "t.oem").at(0);
        EXPECT_EQ(s.frame, frame);
        EXPECT_EQ(s.frame_epoch, epoch) << name;
    }
    for (const char* name :
         {"TEME", "TOD", "MOD", "TOD_EARTH", "GTOD", "TDR", "ITRF-97", "ITRF2020", "WGS84"})
        EXPECT_FALSE(read_oem(read(name, ""), "t.oem").at(0).frame_epoch) << name;
    for (const char* name : {"EME2000", "ICRF", "ITRF2000", "GTOD", "TOD_EARTH"})
        EXPECT_THAT(refusal_of_oem(read(name, "2001-02-03T04:05:06")),
                    HasSubstr("t.oem:9: found '2001-02-03T04:05:06'; accepted: no REF_FRAME_EPOCH"))
            << name;
    EXPECT_THAT(refusal_of_oem(read("TOE_EARTH", "")),
                HasSubstr("t.oem:8: REF_FRAME 'TOE_EARTH' without REF_FRAME_EPOCH"));
}

// --- attitudes ---

// A turn about three axes by Euler angles that change evenly; in version 1.
std::string aem_1(const std::string& type, const std::string& meta,
                  const std::function<std::string(double)>& line) {
    std::string out =
        "CCSDS_AEM_VERS = 1.0\nMETA_START\nOBJECT_NAME = T\nOBJECT_ID = T\nREF_FRAME_A = "
        "EME2000\nREF_FRAME_B = SC_BODY_1\n"
        "ATTITUDE_DIR = a2b\nTIME_SYSTEM = UTC\nSTART_TIME = 2026-03-20T12:00:00\nSTOP_TIME = "
        "2026-03-20T12:01:00\n"
        "ATTITUDE_TYPE = " +
        type + "\n" + meta + "META_STOP\nDATA_START\n";
    for (int s = 0; s <= 60; s += 5) {
        const std::string epoch =
            s == 60 ? "2026-03-20T12:01:00"
                    : "2026-03-20T12:00:" + std::string(s < 10 ? "0" : "") + std::to_string(s);
        out += epoch + " " + line(s) + "\n";
    }
    return out + "DATA_STOP\n";
}
Quat euler_312(double t) {
    const auto about = [](Vec3d axis, double deg) { return from_rotation_vector(deg * kDegree_rad * axis); };
    return about({0, 0, 1}, 10 + 3 * t) * about({1, 0, 0}, 20 - 0.5 * t) * about({0, 1, 0}, 30 + t);
}
std::string text_of(std::initializer_list<double> numbers) {
    std::string out;
    for (const double x : numbers) {
        char digits[40];
        std::snprintf(digits, sizeof digits, " %.12f", x);
        out += digits;
    }
    return out;
}
// The body's rate, by a difference over 20 ms.
Vec3d rate_312(double t) {
    const Quat q = conjugate(euler_312(t - 0.01)) * euler_312(t + 0.01);
    return 100.0 * Vec3d{q.x, q.y, q.z};
}

// 504.0-B-1 calls the three rates those of the angles, in the sequence's order, and components in RATE_FRAME; both are read.
TEST_F(CcsdsDialects, RatesOfVersion1AreReadAsTheAttitudesSay) {
    const std::string sequence = "EULER_ROT_SEQ = 312\n", frame_b = sequence + "RATE_FRAME = REF_FRAME_B\n";
    const auto quaternion = [](double t) {
        const Quat q = euler_312(t);
        return text_of({q.x, q.y, q.z, q.w});
    };
    const auto angles = [](double t) { return text_of({10 + 3 * t, 20 - 0.5 * t, 30 + t}); };
    const auto in_b = [](double t) {
        const Vec3d w = rate_312(t) / kDegree_rad;
        return text_of({w.x, w.y, w.z});
    };
    const auto in_a = [](double t) {
        const Vec3d w = to_matrix(euler_312(t)) * rate_312(t) / kDegree_rad;
        return text_of({w.x, w.y, w.z});
    };
    const std::string of_angles = text_of({3, -0.5, 1});
    const std::vector<std::string> messages = {
        aem_1("QUATERNION/RATE", "QUATERNION_TYPE = LAST\n" + sequence,
              [&](double t) { return quaternion(t) + of_angles; }),
        aem_1("quaternion/rate", "QUATERNION_TYPE = last\n" + frame_b,
              [&](double t) { return quaternion(t) + in_b(t); }),
        aem_1("QUATERNION/RATE", "RATE_FRAME = EME2000\n", [&](double t) { return quaternion(t) + in_a(t); }),
        aem_1("EULER_ANGLE/RATE", frame_b, [&](double t) { return angles(t) + of_angles; }),
        aem_1("EULER_ANGLE/RATE", sequence + "RATE_FRAME = REF_FRAME_A\n",
              [&](double t) { return angles(t) + in_a(t); })};
    for (const std::string& message : messages) {
        std::vector<std::string> notes;
        const AemSegment s = read_aem(message, "t.aem", "", &notes).at(0);
        EXPECT_TRUE(s.has_rates);
        EXPECT_THAT(notes, testing::IsEmpty());
        ASSERT_EQ(s.attitudes.size(), 13u);
        for (std::size_t i = 0; i < 13; ++i) {
            const Quat step =
                conjugate(euler_312(5.0 * static_cast<double>(i))) * s.attitudes[i].reference_from_body;
            EXPECT_LT(length(Vec3d{step.x, step.y, step.z}), 1e-9) << message;
            // Twelve digits, and the third order of the difference: (0.01 s)^2 of 3 deg/s, cubed.
            EXPECT_LT(length(s.attitudes[i].rate_body_rad_s - rate_312(5.0 * static_cast<double>(i))), 1e-7)
                << message;
        }
    }
    // Rates that neither reading explains are left out, and said.
    std::vector<std::string> notes;
    const AemSegment s = read_aem(aem_1("QUATERNION/RATE", frame_b,
                                        [&](double t) {
                                            return quaternion(t) + text_of({-9, 9, 9});
                                        }),
                                  "t.aem", "", &notes)
                             .at(0);
    EXPECT_FALSE(s.has_rates);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], HasSubstr("t.aem:2: the rates of QUATERNION/RATE do not go with the attitudes"));
}

TEST_F(CcsdsDialects, APartOfTheBodyStandsForIt) {
    const std::string plain = aem_1("QUATERNION", "", [](double) { return "0 0 0 1"; });
    for (const char* name :
         {"STARTRACKER_1", "INSTRUMENT_A", "IMU_FRAME_1", "sc_body", "ACTUATOR_2", "Instrument_1"}) {
        std::vector<std::string> notes;
        EXPECT_EQ(read_aem(with(plain, "SC_BODY_1", name), "t.aem", "", &notes).size(), 1u) << name;
        EXPECT_EQ(notes.size(), std::string(name) == "sc_body" ? 0u : 1u) << name;
    }
    for (const char* name : {"TOD", "MOD", "GTOD", "teme", "LVLH_rotating"})
        EXPECT_EQ(read_aem(with(plain, "EME2000", name), "t.aem").size(), 1u) << name;
}

// 505.0-B: elements of both versions' schemas, the scalar first or last as the metadata say.
TEST_F(CcsdsDialects, AnAemInXmlIsTheSame) {
    const auto message = [](const std::string& type, const std::string& meta, const std::string& state) {
        std::string out =
            "<aem id=\"CCSDS_AEM_VERS\" "
            "version=\"2.0\"><header/><body><segment><metadata><OBJECT_NAME>T</OBJECT_NAME>"
            "<OBJECT_ID>T</OBJECT_ID><REF_FRAME_A>ICRF</REF_FRAME_A><REF_FRAME_B>SC_BODY_1</"
            "REF_FRAME_B><TIME_SYSTEM>UTC"
            "</TIME_SYSTEM><START_TIME>2026-03-20T12:00:00</START_TIME><STOP_TIME>2026-03-20T12:01:00</"
            "STOP_TIME>"
            "<ATTITUDE_TYPE>" +
            type + "</ATTITUDE_TYPE>" + meta + "</metadata><data>";
        for (const char* epoch : {"2026-03-20T12:00:00", "2026-03-20T12:01:00"}) {
            std::string s = state;
            out += "<attitudeState>" +
                   s.replace(s.find("<EPOCH/>"), 8, std::string("<EPOCH>") + epoch + "</EPOCH>") +
                   "</attitudeState>";
        }
        return out + "</data></segment></body></aem>";
    };
    const auto first = [&](const std::string& type, const std::string& meta, const std::string& state) {
        return read_aem(message(type, meta, state), "t.xml").at(0).attitudes.at(0);
    };
    const std::string q = "<quaternion><Q1>0</Q1><Q2>0</Q2><Q3>0.6</Q3><QC>0.8</QC></quaternion>";
    for (const char* meta :
         {"", "<QUATERNION_TYPE>FIRST</QUATERNION_TYPE>", "<QUATERNION_TYPE>LAST</QUATERNION_TYPE>"}) {
        const AttitudeSample a =
            first("QUATERNION", meta, "<quaternionState><EPOCH/>" + q + "</quaternionState>");
        EXPECT_EQ(a.reference_from_body.w, 0.8);
        EXPECT_EQ(a.reference_from_body.z, 0.6);
    }
    const AttitudeSample w =
        first("QUATERNION/ANGVEL", "<ANGVEL_FRAME>SC_BODY_1</ANGVEL_FRAME>",
              "<quaternionAngVel><EPOCH/>" + q +
                  "<angVel><ANGVEL_X>1</ANGVEL_X><ANGVEL_Y>2</ANGVEL_Y><ANGVEL_Z units=\"deg/s\">3"
                  "</ANGVEL_Z></angVel></quaternionAngVel>");
    EXPECT_DOUBLE_EQ(w.rate_body_rad_s.z, 3 * kDegree_rad);
    const AttitudeSample e =
        first("EULER_ANGLE/RATE", "<EULER_ROT_SEQ>321</EULER_ROT_SEQ>",
              "<eulerAngleRate><EPOCH/><rotationAngles><rotation1 angle=\"Z_ANGLE\" units=\"deg\">90"
              "</rotation1><rotation2 angle=\"Y_ANGLE\">0</rotation2><rotation3 angle=\"X_ANGLE\">0"
              "</rotation3></rotationAngles><rotationRates><rotation1 rate=\"Z_RATE\">0</rotation1>"
              "<rotation2 rate=\"Y_RATE\">0</rotation2><rotation3 rate=\"X_RATE\">0</rotation3>"
              "</rotationRates></eulerAngleRate>");
    EXPECT_NEAR(e.reference_from_body.z, std::sqrt(0.5), 1e-15);
    EXPECT_THAT(
        error_of([&] {
            read_aem(
                message("QUATERNION", "",
                        "<quaternionState><EPOCH/><quaternion><Q5>0</Q5></quaternion></quaternionState>"),
                "t.xml");
        }),
        HasSubstr("t.xml:1: found the element 'Q5'"));
}

}  // namespace
}  // namespace hilcam
