#include "io/config/renamed_keys.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/config/config_advice.h"
#include "io/config/config_yaml.h"

namespace hilcam {
namespace {

struct Quality {
    std::int64_t probes = 1, samples_per_axis = 1;
    std::string path_model;
};

SectionField section_of(Quality& q) {
    return {{integer("probes", q.probes, {0, 10}, "number of probes"),
             integer("samples_per_axis", q.samples_per_axis, {1, 16}, "number of rays"),
             text("path_model", q.path_model, "path model")},
            {}};
}

std::string answer_to(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
    Quality q;
    try {
        read_config_text(yaml, "old.yaml", ".", section_of(q), overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(RenamedKeys, AnEarlierKeyIsAnsweredByItsNewName) {
    EXPECT_EQ(answer_to("probes: 3\nkept_nodes: 4\n"),
              "old.yaml:2:1: kept_nodes: unknown key; it was renamed to probes");
    EXPECT_EQ(answer_to("probes: 3\n", {"kept_nodes=4"}),
              "--set kept_nodes: unknown key; it was renamed to probes");
    Quality q;
    EXPECT_EQ(key_advice("kept_nodes", section_of(q).fields), "; it was renamed to probes");
}

TEST(RenamedKeys, AKeyThatNeverWasIsNot) {
    EXPECT_EQ(answer_to("kept_lodes: 4\n").find("renamed"), std::string::npos);
    // Its new name is none of this section.
    EXPECT_EQ(answer_to("most_hz: 4\n").find("renamed"), std::string::npos);
}

TEST(RenamedKeys, ARemovedKeyIsAnsweredByWhatReplacesIt) {
    const std::string instead =
        "; it was removed: each pixel is sampled alike: samples_per_axis says how often, and sun_disk: true "
        "scatters its rays";
    EXPECT_EQ(answer_to("probes: 3\nnoise_budget: 0.3\n"),
              "old.yaml:2:1: noise_budget: unknown key" + instead);
    EXPECT_EQ(answer_to("probes: 3\n", {"max_passes=4"}), "--set max_passes: unknown key" + instead);
    Quality q;
    EXPECT_EQ(key_advice("most_passes", section_of(q).fields), instead);
    // A section of something else never had it.
    Fields other = {integer("width_px", q.probes, {0, 10}, "width")};
    EXPECT_EQ(key_advice("noise_budget", other).find("removed"), std::string::npos);
    EXPECT_EQ(advice_for("noise_budget", other, other).find("removed"), std::string::npos);
}

TEST(RenamedKeys, AnEarlierWordIsAnsweredByItsNewOne) {
    EXPECT_EQ(answer_to("path_model: kept\n"),
              "old.yaml:1:13: path_model: found 'kept'; accepted: cached, as it was renamed (path model)");
    EXPECT_EQ(answer_to("path_model: cached\n"), "");
}

}  // namespace
}  // namespace hilcam
