#include "io/config/config_yaml.h"
#include "io/config/config_manual.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <fstream>
#include <iostream>

#include "render/vocabulary/check.h"
#include "tests/support/limits.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

struct Inner {
    double exposure_s = 0.001;
    Curve curve = Curve::constant(1);
};
Fields fields(Inner& c) {
    return {number("exposure_ms", c.exposure_s, 1e-3, {0.01, 1000}, "exposure time"),
            curve("qe", c.curve, {0, 1}, "efficiency")};
}
void validate(const Inner& c) {
    if (c.exposure_s > 0.5) throw InputError("exposure_ms is above what the well takes");
}
struct Outer {
    std::string name;
    std::int64_t count = 1;
    bool on = false;
    enum class Mode { kA, kB } mode = Mode::kA;
    Vec3d position;
    Quat attitude;
    Inner inner;
    std::vector<Inner> list;
    std::vector<std::string> words;
};
Fields fields(Outer& c) {
    return {required(text("name", c.name, "name")),
            integer("count", c.count, {1, 10}, "how many"),
            flag("on", c.on, "switch"),
            choice("mode", c.mode, {"a", "b"}, "mode"),
            vector3("position_m", c.position, 1, {-10, 10}, "where"),
            quaternion("attitude_wxyz", c.attitude, "how"),
            section("inner", c.inner, "nested"),
            sections("list", c.list, "many"),
            texts("words", c.words, "some words")};
}

Outer read(const std::string& text, std::vector<std::string> overrides = {}) {
    Outer out;
    read_config_text(text, "test.yaml", ".", section_of(out), overrides);
    return out;
}
std::string error_of(const std::string& text, std::vector<std::string> overrides = {}) {
    try {
        read(text, overrides);
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "no error";
}

// What scripts write that read a file by YAML 1.1 and write it again: PyYAML has True for `on`, also as a key, and a decimal for a
// number that was computed.
TEST(ConfigYaml, WordsAndNumbersOfScriptsAreRead) {
    for (const char* word : {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})
        EXPECT_TRUE(read("name: x\non: " + std::string(word)).on) << word;
    for (const char* word : {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})
        EXPECT_FALSE(read("name: x\non: " + std::string(word)).on) << word;
    EXPECT_TRUE(read("name: x\ntrue: true\n").on);
    EXPECT_TRUE(read("name: x\nTrue: true\n").on);
    EXPECT_THAT(error_of("name: x\nfalse: true\n"), HasSubstr("unknown key"));
    EXPECT_THAT(error_of("name: x\non: true\ntrue: true\n"), HasSubstr("the key is given twice"));
    for (const char* number : {"7", "7.0", "7.", "0.7e1", "+7", "+7.0", "'7'"})
        EXPECT_EQ(read("name: x\ncount: " + std::string(number)).count, 7) << number;
    for (const char* number : {"7.5", "7.0000001", "0x7", "7 ", "", "1e99", ".nan", ".inf"})
        EXPECT_THAT(error_of("name: x\ncount: \"" + std::string(number) + "\""),
                    HasSubstr("accepted: a whole number"))
            << number;
}

// Editors of Windows begin a file with a mark, or write it in letters of 16 bits.
TEST(ConfigYaml, EveryKindOfLettersIsRead) {
    const auto wide = [](const std::string& text, bool big) {
        std::string out = big ? "\xFE\xFF" : "\xFF\xFE";
        for (const char c : text) out.append(big ? std::string{'\0', c} : std::string{c, '\0'});
        return out;
    };
    const std::string text = "# a comment\n---\nname: x\ncount: 7\n";
    for (const std::string& bytes : {text, "\xEF\xBB\xBF" + text, wide(text, false), wide(text, true)})
        EXPECT_EQ(read(bytes).count, 7);
    for (const std::string& bytes : {text, "\xEF\xBB\xBF" + text, wide(text + "---\nname: y\n", false),
                                     wide(text + "---\nname: y\n", true)})
        EXPECT_EQ(error_of(bytes.size() > 100 ? bytes : bytes + "---\nname: y\n"),
                  "test.yaml:5:1: a second document ('---') begins here; accepted: one a file");
}

enum class Word { kOff, kOn, kFast };
struct Words {
    Word motion = Word::kFast;
};
Fields fields(Words& w) { return {choice("motion", w.motion, {"off", "on", "fast"}, "motion")}; }

TEST(ConfigYaml, AChoiceOfOffIsWhatAScriptMakesOfIt) {
    const auto motion = [](const std::string& text) {
        Words words;
        read_config_text("motion: " + text, "test.yaml", ".", section_of(words));
        return words.motion;
    };
    EXPECT_EQ(motion("off"), Word::kOff);
    EXPECT_EQ(motion("false"), Word::kOff);
    EXPECT_EQ(motion("True"), Word::kOn);
    EXPECT_EQ(motion("fast"), Word::kFast);
    EXPECT_THROW(motion("slow"), InputError);
}

// A check that several sections share may name its key from the top.
struct Door {
    std::string address = "here";
};
Fields fields(Door& c) { return {text("address", c.address, "address")}; }
void validate(const Door& c) {
    if (c.address == "outside") throw refused("outputs.door.address", "'outside'", "here");
    if (c.address == "nowhere") throw refused_key("outputs.door.address", "'nowhere'", "here");
    if (c.address == "bad") throw InputError("the door is shut");
}
struct Doors {
    Door door;
};
Fields fields(Doors& c) { return {section("door", c.door, "door")}; }
struct CameraWithDoor {
    Doors outputs;
};
Fields fields(CameraWithDoor& c) { return {section("outputs", c.outputs, "outputs")}; }
struct TwoDoors {
    Doors outputs;
    std::vector<CameraWithDoor> cameras;
};
Fields fields(TwoDoors& c) {
    return {section("outputs", c.outputs, "outputs"), sections("cameras", c.cameras, "more")};
}
std::string error_of_doors(const std::string& text, std::vector<std::string> overrides = {}) {
    TwoDoors out;
    try {
        read_config_text(text, "test.yaml", ".", section_of(out), overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(ConfigYaml, AKeyThatIsNamedFromTheTopIsSaidOnce) {
    for (const char* word : {"outside", "nowhere"}) {
        const std::string reason = ": found '" + std::string(word) + "'; accepted: here";
        EXPECT_EQ(error_of_doors("outputs:\n  door: {address: " + std::string(word) + "}\n"),
                  "test.yaml:2:19: outputs.door.address" + reason);
        EXPECT_EQ(error_of_doors("cameras:\n- outputs:\n    door: {address: " + std::string(word) + "}\n"),
                  "test.yaml:3:21: cameras.0.outputs.door.address" + reason);
        EXPECT_EQ(error_of_doors("outputs: {}\n", {"outputs.door.address=" + std::string(word)}),
                  "--set outputs.door.address" + reason);
    }
    EXPECT_EQ(error_of_doors("outputs:\n  door: {address: bad}\n"),
              "test.yaml:2:9: outputs.door: the door is shut");
}

TEST(ConfigYaml, NumbersOfListsCountInEachPlaceThatAnAliasGivesThem) {
    std::string text = "name: x\ninner: {qe: &c [";
    for (int i = 0; i < 20000; ++i) text.append("[").append(std::to_string(0.1 + 1e-4 * i)).append(", 0.5],");
    text += "]}\nlist:\n";
    for (int i = 0; i < 1000; ++i) text += "- {qe: *c}\n";
    EXPECT_EXIT(
        {
            limit_this_process(256u << 20, 60);
            std::cerr << error_of(text);
            _exit(0);
        },
        testing::ExitedWithCode(0),
        "list.24.qe: the configuration has more than 1000000 numbers in its lists");
}

// A word in place of a number, and one in place of a list.
struct WordedKeys {
    double budget_s = -1;
    std::vector<Inner> steps;
    bool stays = false;
};
Fields fields(WordedKeys& w) {
    return {or_word(number("budget_ms", w.budget_s, 1e-3, {0, 100}, "time"), "auto", -1.0),
            or_word(sections("steps", w.steps, "steps"), "fixed", w.stays)};
}

TEST(ConfigYaml, AWordMayStandInPlaceOfANumberOrAList) {
    const auto read_worded = [](const std::string& text, std::vector<std::string> overrides = {}) {
        WordedKeys out;
        read_config_text(text, "test.yaml", ".", section_of(out), overrides);
        return out;
    };
    const auto refused_as = [&](const std::string& text) -> std::string {
        try {
            read_worded(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(read_worded("budget_ms: 20\n").budget_s, 0.02);
    EXPECT_EQ(read_worded("budget_ms: 20\n", {"budget_ms=auto"}).budget_s, -1);
    EXPECT_TRUE(read_worded("steps: fixed\n").stays);
    EXPECT_EQ(read_worded("steps: fixed\n", {"steps=[{exposure_ms: 5}, {}]"}).steps.size(), 2u);
    EXPECT_FALSE(read_worded("steps: fixed\n", {"steps=[{exposure_ms: 5}, {}]"}).stays);
    EXPECT_EQ(refused_as("budget_ms: sometimes\n"),
              "test.yaml:1:12: budget_ms: found 'sometimes'; accepted: a number, 0 to 100, or 'auto' (time)");
    EXPECT_THAT(refused_as("budget_ms: 101\n"), HasSubstr("accepted: a number, 0 to 100"));
    EXPECT_EQ(
        refused_as("steps: some\n"),
        "test.yaml:1:8: steps: found 'some'; accepted: a list of mappings, or 'fixed', or the path of a file "
        "that holds it; ./some: no such file");
    // Without a word none is taken.
    EXPECT_THAT(error_of("name: x\nlist: fixed\n"),
                HasSubstr("accepted: a list of mappings, or the path of a file that holds it; "));
    EXPECT_THAT(error_of("name: x\ninner: {exposure_ms: auto}\n"),
                HasSubstr("accepted: a number, 0.01 to 1000 ("));
}

TEST(ConfigYaml, ReadsEveryKindAndConvertsUnits) {
    const Outer o = read(
        "name: x\ncount: 3\non: true\nmode: b\nposition_m: [1, 2, 3]\nattitude_wxyz: [1, 0, 0, 0]\n"
        "inner: {exposure_ms: 2, qe: [[0.4, 0.1], [0.5, 0.2]]}\nlist: [{exposure_ms: 5}, {}]\n");
    EXPECT_EQ(o.name, "x");
    EXPECT_EQ(o.count, 3);
    EXPECT_TRUE(o.on);
    EXPECT_EQ(o.mode, Outer::Mode::kB);
    EXPECT_EQ(o.position.y, 2);
    EXPECT_DOUBLE_EQ(o.inner.exposure_s, 0.002);
    EXPECT_NEAR(o.inner.curve.at(0.45), 0.15, 1e-12);
    ASSERT_EQ(o.list.size(), 2u);
    EXPECT_DOUBLE_EQ(o.list[0].exposure_s, 0.005);
}

TEST(ConfigYaml, UnknownKeyNamesPlaceAndNearest) {
    EXPECT_THAT(error_of("name: x\ncuont: 3\n"),
                HasSubstr("test.yaml:2:1: cuont: unknown key; nearest known key: count"));
    EXPECT_THAT(
        error_of("name: x\ninner: {exposure_us: 3}\n"),
        HasSubstr("test.yaml:2:9: inner.exposure_us: unknown key; its unit here is another: exposure_ms"));
}

TEST(ConfigYaml, WrongValuesNameFoundAndAccepted) {
    EXPECT_THAT(error_of("name: x\ncount: 30\n"),
                HasSubstr("test.yaml:2:8: count: found '30'; accepted: a whole number, 1 to 10"));
    EXPECT_THAT(error_of("name: x\ncount: 3.5\n"), HasSubstr("accepted: a whole number"));
    EXPECT_THAT(error_of("name: x\ninner: {exposure_ms: 5ms}\n"),
                HasSubstr("found '5ms'; accepted: a number, 0.01 to 1000"));
    EXPECT_THAT(error_of("name: x\ninner: {exposure_ms: .nan}\n"), HasSubstr("accepted: a number"));
    EXPECT_THAT(error_of("name: x\nmode: c\n"), HasSubstr("accepted: a | b"));
    EXPECT_THAT(error_of("name: x\non: maybe\n"), HasSubstr("accepted: true or false"));
    EXPECT_THAT(error_of("name: x\non: tRUE\n"), HasSubstr("accepted: true or false"));
    EXPECT_THAT(error_of("name: x\nposition_m: [1, 2]\n"),
                HasSubstr("found a list of 2; accepted: a list of 3 numbers"));
    EXPECT_THAT(error_of("name: x\nattitude_wxyz: [1, 1, 0, 0]\n"), HasSubstr("quaternion of norm 1.414"));
    EXPECT_THAT(error_of("name: x\ninner: {qe: [[0.5, 0.1], [0.4, 0.2]]}\n"),
                HasSubstr("wavelength_um that rises"));
    EXPECT_THAT(error_of("name: x\ninner: {qe: [[0.5, 1.1]]}\n"), HasSubstr("accepted: a number, 0 to 1"));
    EXPECT_THAT(error_of("name: x\nname: y\n"), HasSubstr("given twice"));
    EXPECT_THAT(error_of("count: 3\n"), HasSubstr("name: the key is missing"));
    EXPECT_THAT(error_of("name: [x\n"), HasSubstr("not YAML"));
    EXPECT_THAT(error_of("- a\n"), HasSubstr("accepted: a mapping of keys"));
    EXPECT_THAT(error_of("name: x\ninner: {exposure_ms: 900}\n"),
                HasSubstr("test.yaml:2:8: inner: exposure_ms is above"));
    EXPECT_THAT(error_of("name: x\ninner: missing.yaml\n"), HasSubstr("missing.yaml: no such file"));
}

struct Pointed {
    Inner inner;
    std::vector<Inner> list;
    std::filesystem::path file;
    std::string where;
};
Fields fields(Pointed& c) {
    return {section("inner", c.inner, "nested"), sections("list", c.list, "many"),
            path("file", c.file, c.where, "a file")};
}
void validate(const Pointed& c) {
    if (c.inner.exposure_s > 0.1) throw KeyError("inner.exposure_ms", "is too long");
    for (std::size_t i = 0; i < c.list.size(); ++i)
        if (c.list[i].exposure_s > 0.1)
            throw KeyError("list." + std::to_string(i) + ".exposure_ms", "is too long");
}

TEST(ConfigYaml, WhatIsWrongBetweenKeysStandsAtItsKey) {
    const auto error = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
        Pointed out;
        try {
            read_config_text(text, "test.yaml", "/bench", section_of(out), overrides);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return out.where;
    };
    EXPECT_EQ(error("inner:\n  exposure_ms: 200\n"), "test.yaml:2:16: inner.exposure_ms: is too long");
    EXPECT_EQ(error("list:\n  - {}\n  - exposure_ms: 200\n"),
              "test.yaml:3:18: list.1.exposure_ms: is too long");
    EXPECT_EQ(error("inner: {}\n", {"inner.exposure_ms=200"}), "--set inner.exposure_ms: is too long");
    EXPECT_EQ(error("inner: {}\n", {"inner={exposure_ms: 200}"}), "--set inner.exposure_ms: is too long");
    // And where a file was named, for what is wrong with the file.
    EXPECT_EQ(error("inner: {}\nfile: x.obj\n"), "test.yaml:2:7: file");
    EXPECT_EQ(error("inner: {}\n", {"file=x.obj"}), "--set file");
}

TEST(ConfigYaml, WordsMayHaveAHyphenForAnUnderscore) {
    enum class Mode { kFree, kOther } mode = Mode::kOther;
    const SectionField section{{choice("mode", mode, {"free_run", "other"}, "which")}, {}};
    read_config_text("mode: free-run\n", "test.yaml", "", section);
    EXPECT_EQ(mode, Mode::kFree);
}

TEST(ConfigYaml, OverridesReplaceAndAreChecked) {
    EXPECT_EQ(read("name: x\n", {"count=7", "inner.exposure_ms=4"}).count, 7);
    EXPECT_DOUBLE_EQ(read("name: x\n", {"inner.exposure_ms=4"}).inner.exposure_s, 0.004);
    EXPECT_DOUBLE_EQ(read("name: x\nlist: [{}]\n", {"list.0.exposure_ms=4"}).list[0].exposure_s, 0.004);
    EXPECT_EQ(read("name: x\n", {"count=7", "count=9"}).count, 9);
    EXPECT_EQ(read("name: x\n", {"count=7", "count=9", "count=8"}).count, 8);
    EXPECT_THAT(error_of("name: x\n", {"count=70"}), HasSubstr("--set count: found '70'"));
    EXPECT_THAT(error_of("name: x\n", {"cuont=7"}),
                HasSubstr("--set cuont: unknown key; nearest known key: count"));
    EXPECT_THAT(error_of("name: x\n", {"inner.exposure_us=7"}),
                HasSubstr("--set inner.exposure_us: unknown key; its unit here is another: exposure_ms"));
    EXPECT_THAT(error_of("name: x\nlist: [{}]\n", {"list.1.exposure_ms=7"}),
                HasSubstr("--set list.1.exposure_ms: the list 'list' has no such element"));
    EXPECT_THAT(error_of("name: x\n", {"count.more=7"}), HasSubstr("'count' has no keys below it"));
    EXPECT_THAT(error_of("name: x\n", {"count"}), HasSubstr("accepted: KEY=VALUE"));
}

TEST(ConfigYaml, SectionFromAnotherFileNamesThatFile) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("hilcam_config_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "inner.yaml") << "exposure_ms: 7\n";
    std::ofstream(folder / "bad.yaml") << "\nexposure: 7\n";
    std::ofstream(folder / "outer.yaml") << "name: x\ninner: inner.yaml\n";
    Outer out;
    read_config(folder / "outer.yaml", section_of(out));
    EXPECT_DOUBLE_EQ(out.inner.exposure_s, 0.007);
    try {
        const std::vector<std::string> set = {"inner=" + (folder / "bad.yaml").string()};
        read_config(folder / "outer.yaml", section_of(out), set);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("bad.yaml:2:1: inner.exposure: unknown key"));
    }
    std::filesystem::remove_all(folder);
}

TEST(ConfigYaml, AListMayStandInAFileOfItsOwnUnderItsKey) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_lists_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "list.yaml") << "list:\n  - exposure_ms: 7\n  - exposure_ms: 8\n";
    std::ofstream(folder / "other.yaml") << "list: []\nname: x\n";
    std::ofstream(folder / "empty.yaml") << "{}\n";
    std::ofstream(folder / "self.yaml") << "list: self.yaml\n";
    const auto read_in = [&](const std::string& text, const std::vector<std::string>& overrides = {}) {
        Outer out;
        try {
            read_config_text(text, "test.yaml", folder, section_of(out), overrides);
        } catch (const InputError& error) {
            out.name = error.what();
        }
        return out;
    };
    const Outer read = read_in("name: x\nlist: list.yaml\n", {"list.1.exposure_ms=9"});
    ASSERT_EQ(read.list.size(), 2u) << read.name;
    EXPECT_DOUBLE_EQ(read.list[0].exposure_s, 0.007);
    EXPECT_DOUBLE_EQ(read.list[1].exposure_s, 0.009);
    const std::string by_option = "list=" + (folder / "list.yaml").string();
    EXPECT_EQ(read_in("name: x\n", {by_option}).list.size(), 2u);
    EXPECT_THAT(read_in("name: x\nlist: other.yaml\n").name,
                HasSubstr("other.yaml:2:1: list.name: unknown key"));
    EXPECT_THAT(read_in("name: x\nlist: empty.yaml\n").name,
                HasSubstr("list: the key 'list' is missing; it is many"));
    EXPECT_THAT(read_in("name: x\nlist: self.yaml\n").name, HasSubstr("the file includes itself"));
    EXPECT_THAT(
        read_in("name: x\nlist: none.yaml\n").name,
        HasSubstr(
            "test.yaml:2:7: list: found 'none.yaml'; accepted: a list of mappings, or the path of a file"));
    std::filesystem::remove_all(folder);
}

TEST(ConfigYaml, ManualListsKeysWithDefaults) {
    Outer out;
    EXPECT_THAT(config_manual(section_of(out)),
                HasSubstr("| `inner.exposure_ms` | 0.01 to 1000 | 1 | exposure time |"));
}

// Every prefix of a good file and many damaged ones: an error or a value, never a crash.
TEST(ConfigYaml, DamagedTextNeverCrashes) {
    const std::string good =
        "name: x\ncount: 3\nposition_m: [1, 2, 3]\ninner: {exposure_ms: 2, qe: [[0.4, 0.1]]}\nlist: [{}]\n";
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < 3000; ++i) {
        std::string text = good.substr(0, i < good.size() ? i : good.size());
        for (int k = 0; k < 3 && i >= good.size(); ++k) {
            state = state * 1664525u + 1013904223u;
            text[state / 7 % text.size()] = static_cast<char>(state >> 24);
        }
        try {
            read(text);
        } catch (const InputError&) {
        }
    }
}

TEST(ConfigYaml, ListsOfTextsMayBeOneTextAndNothingElse) {
    EXPECT_EQ(read("name: x\nwords: [127.0.0.1, 10.0.0.0/8]").words,
              (std::vector<std::string>{"127.0.0.1", "10.0.0.0/8"}));
    EXPECT_EQ(read("name: x\nwords: any").words, std::vector<std::string>{"any"});
    EXPECT_EQ(read("name: x", {"words=[a]"}).words, std::vector<std::string>{"a"});
    EXPECT_TRUE(read("name: x\nwords: []").words.empty());
    EXPECT_THAT(error_of("name: x\nwords: {a: 1}"),
                HasSubstr("words: found a mapping; accepted: a list of texts"));
    EXPECT_THAT(error_of("name: x\nwords: [a, [b]]"), HasSubstr("found a list of 1; accepted: a text"));
}

}  // namespace
}  // namespace hilcam
