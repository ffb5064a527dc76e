// The manual's table with its folded sections, its list, and the schema, of a small configuration.

#include "io/config/config_manual.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "io/config/config_schema.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

struct Ball {
    double radius_m = 1;
    bool visible = true;
    std::string name = "a";
    std::int64_t rings = 0;
};
Fields fields(Ball& b) {
    return {number("radius_km", b.radius_m, 1e3, {0, 100}, "how large"), flag("visible", b.visible, "seen"),
            text("name", b.name, "called"), integer("rings", b.rings, {0, 9}, "around it")};
}
struct Sky {
    Ball earth{6378e3}, moon{1737e3, false};
    std::vector<Ball> more;
    enum class Mode { kDay, kNight } mode = Mode::kNight;
    Curve tint = Curve::constant(1);
};
Fields fields(Sky& s) {
    return {required(section("earth", s.earth, "the first")), section("moon", s.moon, "the second"),
            sections("more", s.more, "others"), choice("mode", s.mode, {"day", "night"}, "light"),
            curve("tint", s.tint, {0, 2}, "colour")};
}

std::string manual(std::string_view prefix = {}) {
    Sky sky;
    return config_manual(section_of(sky), prefix);
}
json schema(std::string_view prefix = {}) {
    Sky sky;
    return json::parse(config_schema(section_of(sky), prefix, "sky"));
}

struct Worded {
    double budget_s = -1;
    std::vector<Ball> steps;
    bool stays = false;
};
Fields fields(Worded& w) {
    return {or_word(number("budget_ms", w.budget_s, 1e-3, {0, 100}, "time"), "auto", -1.0),
            or_word(sections("steps", w.steps, "steps"), "fixed", w.stays)};
}

TEST(ConfigManual, AWordThatStandsInAValuesPlaceIsAccepted) {
    Worded worded;
    const std::string table = config_manual(section_of(worded), "");
    EXPECT_THAT(table, HasSubstr("| `budget_ms` | auto, or 0 to 100 | auto | time |\n"));
    EXPECT_THAT(table, HasSubstr("| `steps` | fixed, or list of mappings, or file |"));
    worded.budget_s = 0.02;
    EXPECT_THAT(config_manual(section_of(worded), ""), HasSubstr("| `budget_ms` | auto, or 0 to 100 | 20 |"));
    worded.budget_s = -1;
    const json keys = json::parse(config_schema(section_of(worded), "", "worded"))["properties"];
    EXPECT_EQ(keys["budget_ms"]["default"], "auto");
    EXPECT_EQ(keys["budget_ms"]["anyOf"][0], json({{"enum", {"auto"}}}));
    EXPECT_EQ(keys["budget_ms"]["anyOf"][1], json({{"type", "number"}, {"minimum", 0}, {"maximum", 100}}));
    EXPECT_EQ(keys["steps"]["anyOf"][0], json({{"enum", {"fixed"}}}));
    EXPECT_EQ(keys["steps"]["anyOf"][1]["anyOf"][0]["type"], "string");  // a file
    EXPECT_EQ(keys["steps"]["anyOf"][1]["anyOf"][1]["type"], "array");
}

TEST(ConfigManual, ASectionLikeAnEarlierOneIsFoldedWithItsOtherDefaults) {
    EXPECT_THAT(manual(), HasSubstr("| `earth.radius_km` | 0 to 100 | 6378 | how large |\n"));
    EXPECT_THAT(manual(),
                HasSubstr("| `moon` | mapping or file |  | the second |\n"
                          "| `moon.*` | as `earth.*` | radius_km 1737, visible false | the same keys |\n"));
    EXPECT_THAT(manual(), HasSubstr("| `more.N.*` | as `earth.*` | radius_km 0.001 | the same keys |\n"));
    EXPECT_THAT(manual(), Not(HasSubstr("moon.radius_km")));
}

TEST(ConfigManual, APrefixGivesOneKeyWithAllBelowItUnfolded) {
    EXPECT_EQ(manual("moon"),
              "| key | accepted | default | meaning |\n|---|---|---|---|\n"
              "| `moon` | mapping or file |  | the second |\n"
              "| `moon.radius_km` | 0 to 100 | 1737 | how large |\n"
              "| `moon.visible` | true, false | false | seen |\n"
              "| `moon.name` | text | a | called |\n"
              "| `moon.rings` | whole, 0 to 9 | 0 | around it |\n");
    EXPECT_THAT(manual("more.N.visible"), HasSubstr("| `more.N.visible` | true, false | true | seen |\n"));
    EXPECT_EQ(manual("more.N"), manual("more"));
    EXPECT_THROW(manual("sun"), InputError);
}

TEST(ConfigManual, TheListHasEachKeyOnce) {
    Sky sky;
    const json keys = json::parse(config_manual_json(section_of(sky)));
    ASSERT_EQ(keys.size(), 5u + 3u * 4u);
    EXPECT_EQ(keys[0], (json{{"key", "earth"},
                             {"kind", "section"},
                             {"accepted", "mapping or file"},
                             {"default", ""},
                             {"required", true},
                             {"meaning", "the first"}}));
    EXPECT_EQ(keys[6]["key"], "moon.radius_km");
    EXPECT_EQ(keys[6]["default"], "1737");
    EXPECT_EQ(keys[11]["key"], "more.N.radius_km");
}

TEST(ConfigSchema, SaysTypesRangesWordsAndWhatIsRequired) {
    const json s = schema();
    EXPECT_EQ(s["$schema"], "https://json-schema.org/draft/2020-12/schema");
    EXPECT_EQ(s["additionalProperties"], false);
    EXPECT_EQ(s["required"], json{"earth"});
    EXPECT_EQ(s["properties"]["mode"],
              (json{{"enum", {"day", "night"}}, {"description", "light"}, {"default", "night"}}));
    const json moon = s["properties"]["moon"]["anyOf"][1];
    EXPECT_EQ(moon["properties"]["radius_km"], (json{{"type", "number"},
                                                     {"minimum", 0},
                                                     {"maximum", 100},
                                                     {"description", "how large"},
                                                     {"default", 1737}}));
    EXPECT_EQ(moon["properties"]["rings"]["type"], "integer");
    EXPECT_EQ(moon["properties"]["visible"]["default"], false);
    const json more = s.at("properties").at("more").at("anyOf");
    EXPECT_EQ(more.at(0).at("type"), "string");  // a file
    EXPECT_EQ(more.at(1).at("items").at("anyOf").at(0).at("type"), "string");
    const json pairs = s["properties"]["tint"]["anyOf"][1];
    EXPECT_EQ(pairs["items"]["prefixItems"][1], (json{{"type", "number"}, {"minimum", 0}, {"maximum", 2}}));
}

TEST(ConfigSchema, OfOneSectionIsThatOfItsFile) {
    EXPECT_EQ(schema("moon")["properties"].size(), 4u);
    EXPECT_EQ(schema("more.N")["properties"]["radius_km"]["default"], 0.001);
    for (const char* none : {"sun", "moon.radius_km", "moon.x"})
        EXPECT_THROW(schema(none), InputError) << none;
}

}  // namespace
}  // namespace hilcam
