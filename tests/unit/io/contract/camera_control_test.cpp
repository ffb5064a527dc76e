#include "io/contract/camera_control.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace hilcam {
namespace {

struct Anything {
    template <class T>
    operator T() const;
};
// How many members an aggregate has.
template <class T, class... Members>
constexpr std::size_t members() {
    if constexpr (requires { T{Members{}..., Anything{}}; })
        return members<T, Members..., Anything>();
    else
        return sizeof...(Members);
}

TEST(CameraControl, EverySettingIsVisitedOnceByAName) {
    struct Three {
        double a;
        bool b, c;
    };
    static_assert(members<Three>() == 3);
    std::set<std::string_view> names;
    visit_settings(
        [&](std::string_view name, auto, auto) { EXPECT_TRUE(names.insert(name).second) << name; });
    EXPECT_EQ(names.size(), members<CameraSettings>());
}

TEST(CameraControl, AChangeLeadsFromSomeSettingsToOthersAndLeavesTheRest) {
    CameraSettings from, to;
    to.gain_db = 3, to.test_pattern = TestPattern::kWhite, to.running = false, to.binning_y = 4;
    const SettingsChange change = difference(from, to);
    EXPECT_FALSE(change.exposure_s);
    EXPECT_FALSE(change.binning_x);
    EXPECT_EQ(change.gain_db, 3);
    EXPECT_EQ(change.running, false);
    from.reverse_x = true;
    apply(change, from);
    EXPECT_TRUE(from.reverse_x);
    EXPECT_EQ(from.gain_db, 3);
    EXPECT_EQ(from.test_pattern, TestPattern::kWhite);
    EXPECT_EQ(from.binning_y, 4);
}

}  // namespace
}  // namespace hilcam
