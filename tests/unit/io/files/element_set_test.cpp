// Element sets in all their forms: two-line sets of today's dialects, and OMM as CelesTrak and Space-Track publish it.

#include "io/files/element_set.h"

#include <gmock/gmock.h>

#include <array>

#include "io/files/omm_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class ElementSets : public FilesTest {
  protected:
    std::string refusal(const std::string& text, const std::string& satellite = "",
                        TleChecksum checksum = TleChecksum::kVerify) {
        return error_of(
            [&] { choose_element_set(read_element_sets(text, "s.txt", checksum), satellite, {}, "s.txt"); });
    }
    static std::string with(std::string text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return at == std::string::npos ? text : text.replace(at, from.size(), to);
    }
};

// The same elements in each form; no real satellite.
const std::string kLine1 = "1 99901U 20001A   26079.50000000  .00000100  00000-0  10000-4 0  9996\n";
const std::string kLine2 = "2 99901  51.6000  10.0000 0001000  20.0000  30.0000 15.50000000123455\n";
const std::string kKvn =
    "CCSDS_OMM_VERS = 2.0\nCREATION_DATE  =\nORIGINATOR     =\nOBJECT_NAME = FUTURE SAT\n"
    "OBJECT_ID = 2026-001A\nCENTER_NAME = EARTH\nREF_FRAME = TEME\nTIME_SYSTEM = UTC\n"
    "MEAN_ELEMENT_THEORY = SGP/SGP4\nEPOCH = 2026-03-20T12:00:00\nMEAN_MOTION = 15.5 [rev/day]\n"
    "ECCENTRICITY = .0001\nINCLINATION = 51.6\nRA_OF_ASC_NODE = 10 [deg]\nARG_OF_PERICENTER = 20\n"
    "MEAN_ANOMALY = 30\nEPHEMERIS_TYPE = 0\nNORAD_CAT_ID = 100001\nBSTAR = .1E-4\n";
const std::string kXml =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ndm><omm id=\"CCSDS_OMM_VERS\" version=\"2.0\">"
    "<header><CREATION_DATE/><ORIGINATOR/></header><body><segment><metadata><OBJECT_NAME>FUTURE SAT"
    "</OBJECT_NAME><OBJECT_ID>2026-001A</OBJECT_ID><CENTER_NAME>EARTH</CENTER_NAME><REF_FRAME>TEME"
    "</REF_FRAME><TIME_SYSTEM>UTC</TIME_SYSTEM><MEAN_ELEMENT_THEORY>SGP4</MEAN_ELEMENT_THEORY></metadata>"
    "<data><meanElements><EPOCH>2026-03-20T12:00:00.000000</EPOCH><MEAN_MOTION units=\"rev/day\">15.5"
    "</MEAN_MOTION><ECCENTRICITY>.0001</ECCENTRICITY><INCLINATION>51.6</INCLINATION><RA_OF_ASC_NODE>10"
    "</RA_OF_ASC_NODE><ARG_OF_PERICENTER>20</ARG_OF_PERICENTER><MEAN_ANOMALY>30</MEAN_ANOMALY>"
    "</meanElements><tleParameters><EPHEMERIS_TYPE>0</EPHEMERIS_TYPE><NORAD_CAT_ID>100001</NORAD_CAT_ID>"
    "<BSTAR>.1E-4</BSTAR></tleParameters></data></segment></body></omm></ndm>\n";
const std::string kCsvHead =
    "OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,ARG_OF_PERICENTER,"
    "MEAN_ANOMALY,EPHEMERIS_TYPE,NORAD_CAT_ID,BSTAR\r\n";
const std::string kCsvLine =
    "FUTURE SAT,2026-001A,2026-03-20T12:00:00.000000,15.5,.0001,51.6,10,20,30,0,100001,.1E-4\r\n";
const std::string kJson =
    "[{\"OBJECT_NAME\":\"FUTURE SAT\",\"OBJECT_ID\":\"2026-001A\",\"EPOCH\":\"2026-03-20T12:00:00.000000\","
    "\"MEAN_MOTION\":15.5,\"ECCENTRICITY\":0.0001,\"INCLINATION\":51.6,\"RA_OF_ASC_NODE\":10,"
    "\"ARG_OF_PERICENTER\":20,\"MEAN_ANOMALY\":30,\"EPHEMERIS_TYPE\":0,\"NORAD_CAT_ID\":100001,"
    "\"BSTAR\":1e-5,\"DECAY_DATE\":null}]";

TEST_F(ElementSets, EveryFormHasTheSameElements) {
    const ElementSet tle = read_element_sets(kLine1 + kLine2, "t.tle").at(0);
    for (const std::string& text :
         {kKvn, kXml, kCsvHead + kCsvLine, kJson, "\xEF\xBB\xBF" + kKvn, with(kJson, "15.5", "\"15.5\""),
          "  \n" + kXml, with(kCsvHead + kCsvLine, "FUTURE SAT", "\"FUTURE SAT\"")}) {
        const std::vector<ElementSet> sets = read_element_sets(text, "o.txt");
        ASSERT_EQ(sets.size(), 1u) << text;
        const ElementSet& omm = sets[0];
        EXPECT_EQ(omm.name, "FUTURE SAT");
        EXPECT_EQ(omm.satellite, "100001");
        EXPECT_EQ(omm.designator, "2026-001A");
        EXPECT_EQ(omm.epoch, tle.epoch);
        EXPECT_EQ(omm.epoch_days_1950, tle.epoch_days_1950);
        // Numbers that are written alike are the same; angles come by one multiplication.
        EXPECT_EQ(omm.inclination_rad, tle.inclination_rad);
        EXPECT_EQ(omm.node_rad, tle.node_rad);
        EXPECT_EQ(omm.eccentricity, tle.eccentricity);
        EXPECT_EQ(omm.perigee_rad, tle.perigee_rad);
        EXPECT_EQ(omm.mean_anomaly_rad, tle.mean_anomaly_rad);
        EXPECT_DOUBLE_EQ(omm.mean_motion_rad_min, tle.mean_motion_rad_min);
        EXPECT_DOUBLE_EQ(omm.bstar_per_er, tle.bstar_per_er);
    }
}

TEST_F(ElementSets, CataloguesOfManyAreRead) {
    const std::string second = with(with(kKvn, "100001", "270001"), "FUTURE SAT", "OTHER");
    EXPECT_EQ(read_element_sets(kKvn + second, "o.kvn").at(1).satellite, "270001");
    const std::string message = kXml.substr(kXml.find("<omm"), kXml.find("</ndm>") - kXml.find("<omm"));
    EXPECT_EQ(read_element_sets("<ndm>" + message + with(message, "100001", "270001") + "</ndm>", "o.xml")
                  .at(1)
                  .satellite,
              "270001");
    EXPECT_EQ(
        read_element_sets(kCsvHead + kCsvLine + with(kCsvLine, "100001", "270001"), "o.csv").at(1).satellite,
        "270001");
    const std::string object = kJson.substr(1, kJson.size() - 2);
    const std::vector<ElementSet> sets =
        read_element_sets("[" + object + ", " + with(object, "100001", "270001") + "]", "o.json");
    EXPECT_EQ(choose_element_set(sets, "270001", {}, "o.json").where, "o.json: set 2");
    EXPECT_EQ(choose_element_set(sets, "2026-001A", {}, "o.json").satellite, "100001");
    EXPECT_THAT(refusal(kKvn + second), HasSubstr("several satellites, '100001' and '270001'"));
}

// Space-Track, "Alpha-5 Satellite Catalog Numbers": A0000 is 100000, Z9999 is 339999, I and O are not used.
TEST_F(ElementSets, SatellitesAreFoundByNumberInAnyForm) {
    EXPECT_EQ(catalogue_number("A0001"), 100001);
    EXPECT_EQ(catalogue_number("H9999"), 179999);
    EXPECT_EQ(catalogue_number("J0000"), 180000);
    EXPECT_EQ(catalogue_number("P0000"), 230000);
    EXPECT_EQ(catalogue_number("Z9999"), 339999);
    EXPECT_EQ(catalogue_number(" 4859"), 4859);
    for (const char* text : {"", "I0000", "O0000", "a0001", "A001", "AA001", "1234567890", "-1", "ISS"})
        EXPECT_FALSE(catalogue_number(text)) << text;
    const auto renamed = [&](std::string number) {
        std::string text = kLine1 + kLine2;
        text.replace(2, 5, number);
        return text.replace(kLine1.size() + 2, 5, number);
    };
    const auto finds = [&](const std::string& text, const std::string& satellite) {
        return choose_element_set(read_element_sets(text, "t.tle", TleChecksum::kIgnore), satellite, {},
                                  "t.tle")
            .satellite;
    };
    EXPECT_EQ(finds(renamed("A0001"), "100001"), "A0001");
    EXPECT_EQ(finds(renamed("A0001"), "A0001"), "A0001");
    EXPECT_EQ(finds(renamed(" 4859"), "04859"), "4859");
    EXPECT_EQ(finds(renamed("04859"), "4859"), "04859");
    EXPECT_EQ(finds(kKvn, "A0001"), "100001");
}

// SGP4-XP's columns 45 to 61 have other quantities (Space-Track's description of ephemeris type 4).
TEST_F(ElementSets, SetsOfAnotherTheoryAreRefusedByNameAndAlone) {
    std::string xp = kLine1 + kLine2;
    xp[62] = '4', xp[53] = '*', xp[68] = '0';
    const std::string expected =
        "t.tle:1: the set of satellite '99901' is of ephemeris type 4 (SGP4-XP), which is "
        "no set for SGP4; accepted: type 0";
    EXPECT_EQ(error_of([&] { choose_element_set(read_element_sets(xp, "t.tle"), "", {}, "t.tle"); }),
              expected)
        << xp;
    // In a catalogue the others are as before, and an SGP4 set of the same satellite is taken.
    std::string other = kLine1 + kLine2;
    other.replace(2, 5, "00005"), other.replace(kLine1.size() + 2, 5, "00005");
    const auto sets = read_element_sets(xp + other, "t.tle", TleChecksum::kIgnore);
    EXPECT_EQ(choose_element_set(sets, "5", {}, "t.tle").satellite, "00005");
    EXPECT_THROW(choose_element_set(sets, "99901", {}, "t.tle"), InputError);
    EXPECT_EQ(
        choose_element_set(read_element_sets(xp + kLine1 + kLine2, "t.tle"), "99901", {}, "t.tle").where,
        "t.tle:3");
    for (const auto& [from, to, what] : std::vector<std::array<std::string, 3>>{
             {"EPHEMERIS_TYPE = 0", "EPHEMERIS_TYPE = 4", "(SGP4-XP)"},
             {"SGP/SGP4", "SGP4-XP", "MEAN_ELEMENT_THEORY 'SGP4-XP'"},
             {"SGP/SGP4", "DSST", "MEAN_ELEMENT_THEORY 'DSST'"},
             {"REF_FRAME = TEME", "REF_FRAME = EME2000", "REF_FRAME 'EME2000'"},
             {"TIME_SYSTEM = UTC", "TIME_SYSTEM = TT", "TIME_SYSTEM 'TT'"},
             {"CENTER_NAME = EARTH", "CENTER_NAME = MARS", "CENTER_NAME 'MARS'"}}) {
        EXPECT_THAT(refusal(with(kKvn, from, to)), HasSubstr(what));
        EXPECT_EQ(refusal(with(kKvn, from, to) + with(kKvn, "100001", "270001"), "270001"), "no error");
    }
}

TEST_F(ElementSets, LinesWithoutChecksumAreTakenWhenItIsIgnored) {
    const std::string text = kLine1.substr(0, 68) + "\n" + kLine2.substr(0, 68) + "\n";
    EXPECT_EQ(refusal(text, "", TleChecksum::kIgnore), "no error");
    EXPECT_THAT(refusal(text), HasSubstr("69 columns; it has 68 (checksum: ignore takes lines without"));
    EXPECT_THAT(refusal(text.substr(0, 67) + "\n" + kLine2, "", TleChecksum::kIgnore),
                HasSubstr("69 columns (or 68, without the checksum); it has 67"));
}

TEST_F(ElementSets, BlanksThatAreNoneAreNamed) {
    for (const char* blank : {"\xC2\xA0", "\xE2\x80\xAF", "\xA0"}) {
        EXPECT_THAT(refusal(with(kLine1, " ", blank) + kLine2), HasSubstr("s.txt:1: the line has "));
        EXPECT_THAT(refusal(kLine1 + with(kLine2, " ", blank)), HasSubstr("s.txt:2: the line has "));
    }
    EXPECT_THAT(refusal(with(kLine1, " ", "\xC2\xA0") + kLine2), HasSubstr("U+00A0, a non-breaking blank"));
    EXPECT_THAT(refusal(with(kKvn, "= 51.6", "= 51\xC2\xA0.6")), HasSubstr("U+00A0, a non-breaking blank"));
    // A name may have them.
    EXPECT_EQ(refusal("STATION\xC2\xA0ONE\n" + kLine1 + kLine2), "no error");
}

// Names that begin as a line of a set does are in the catalogue.
TEST_F(ElementSets, NamesMayBeginWithADigit) {
    for (const char* name : {"1 KUNS-PF", "2 BEOOBSAT", "0 ISS", "1KUNS"})
        EXPECT_THAT(read_element_sets(std::string(name) + "\n" + kLine1 + kLine2, "t.tle").at(0).name,
                    HasSubstr(std::string(name).substr(2)));
    EXPECT_THAT(refusal(kLine1.substr(0, 50) + "\n" + kLine2), HasSubstr("69 columns; it has 50"));
    EXPECT_THAT(refusal(kLine2 + kLine1), HasSubstr("line 1 of an element set before its line 2"));
}

TEST_F(ElementSets, ABadMessageIsNamedByItsPlace) {
    EXPECT_THAT(refusal(with(kKvn, "BSTAR = .1E-4\n", "")),
                HasSubstr("s.txt:1: the message of satellite '100001' has no BSTAR"));
    EXPECT_THAT(refusal(with(kKvn, "= .0001", "= 1.5")),
                HasSubstr("ECCENTRICITY: found '1.5'; accepted: 0 to below 1"));
    EXPECT_THAT(refusal(with(kKvn, "[deg]", "[rad]")),
                HasSubstr("found 'rad'; accepted: RA_OF_ASC_NODE in deg"));
    EXPECT_THAT(refusal(with(kKvn, "T12:00:00", "T25:00:00")),
                HasSubstr("EPOCH: found '2026-03-20T25:00:00'"));
    EXPECT_THAT(refusal(with(kKvn, "OMM_VERS", "OPM_VERS")),
                HasSubstr("s.txt:1: found 'CCSDS_OPM_VERS = 2.0'"));
    EXPECT_THAT(refusal(kKvn + "MEAN_MOTION = 1\n"), HasSubstr("'MEAN_MOTION' is given twice"));
    EXPECT_THAT(refusal(with(kXml, "rev/day", "rad/s")),
                HasSubstr("MEAN_MOTION: found units 'rad/s'; accepted: rev/day"));
    EXPECT_THAT(refusal(with(kXml, "</omm>", "")), HasSubstr("is no XML"));
    EXPECT_THAT(refusal(with(with(kXml, "<omm", "<opm"), "</omm>", "</opm>")),
                HasSubstr("without <omm> in it"));
    EXPECT_THAT(refusal(kCsvHead + "A,B\n"), HasSubstr("s.txt:2: found 2 fields; accepted: 12"));
    EXPECT_THAT(refusal(kCsvHead + with(kCsvLine, "FUTURE", "\"FUTURE")),
                HasSubstr("a double quote has no second one"));
    EXPECT_THAT(refusal("[" + kJson + "]"), HasSubstr("s.txt: set 1: found an array inside"));
    EXPECT_THAT(refusal(with(kJson, "15.5", "[15.5]")), HasSubstr("s.txt: set 1: found an array inside"));
    EXPECT_THAT(refusal(kJson.substr(0, 40)), HasSubstr("is no JSON from its byte"));
    EXPECT_THAT(refusal(kCsvHead), HasSubstr("holds no orbit mean-elements message"));
}

}  // namespace
}  // namespace hilcam
