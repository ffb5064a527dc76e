// The fault, the live setting and the quality key that docs/extending.md adds: named where they are defined,
// they are there for those who visit the lists.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "io/contract/fault.h"
#include "io/files/sink_means.h"
#include "io/preview/preview_request.h"
#include "render/frame/render_quality.h"
#include "tests/support/files.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

class Extending : public FilesTest {};

TEST_F(Extending, TheFaultIsOrderedByItsNameAndStrikesTheOutput) {
    const FaultRequest request = parse_fault_request("kind=means_gap&from_frame=2&frames=1");
    FaultBoard faults;
    faults.order(request.order);
    QuietCamera camera;
    const auto sink = make_sink(MeansConfig{folder_ / "means.csv"}, SinkContext{camera, faults},
                                OutputShape{.width = 2, .height = 1});
    sink->start();
    const DnImage frame(2, 1);
    for (std::uint64_t id = 1; id <= 3; ++id) {
        FrameRecord record;
        record.id = id;
        sink->publish(frame, record);
    }
    sink->stop();
    std::ifstream in(folder_ / "means.csv");
    const std::string lines{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(lines, "1,0\n3,0\n");
    EXPECT_EQ(faults.strikes_of(request.order.kind), 1u);
    // No other kind has lost its bit to it.
    EXPECT_EQ(bit_of(FaultKind::kImageTear) << 1, bit_of(request.order.kind));
}

TEST(ExtendingSetting, ThePreviewTakesItAndAChangeApplies) {
    CameraSettings settings;
    apply(parse_settings_change("shutter_closed=1&gain_db=3"), settings);
    EXPECT_TRUE(settings.shutter_closed);
    EXPECT_EQ(settings.gain_db, 3);
}

TEST(ExtendingQuality, TheKeyIsMarked) {
    RenderQuality quality;
    const Fields keys = fields(quality);
    const auto key = std::find_if(keys.begin(), keys.end(),
                                  [](const Field& field) { return field.key == "facets_behind_diffuse"; });
    ASSERT_NE(key, keys.end());
    EXPECT_TRUE(key->per_frame);
}

}  // namespace
}  // namespace hilcam
