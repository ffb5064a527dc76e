// The output that docs/extending.md adds, found in the list by its key.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "emulator/scenario/outputs.h"
#include "io/contract/fault.h"
#include "tests/support/files.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

class ExtendingOutput : public FilesTest {};

TEST_F(ExtendingOutput, ItIsFoundByItsKeyAndWritesALineForEachFrame) {
    OutputsConfig outputs;
    for (Field& field : fields(outputs))
        if (field.key == "means") {
            *field.present = true;
            Fields& keys = std::get<SectionField>(field.target).fields;
            ASSERT_EQ(keys.size(), 1u);
            *std::get<PathField>(keys[0].target).value = folder_ / "means.csv";
        }
    QuietCamera camera;
    FaultBoard faults;
    const SinkContext context{camera, faults};
    const OutputShape shape{.width = 4, .height = 2};
    std::vector<std::unique_ptr<FrameSink>> sinks;
    outputs.for_each_given([&](const auto& config) {
        if constexpr (requires { make_sink(config, context, shape); })
            sinks.push_back(make_sink(config, context, shape));
    });
    ASSERT_EQ(sinks.size(), 1u);
    sinks[0]->start();
    DnImage frame(4, 2);
    for (std::uint64_t id = 1; id <= 3; ++id) {
        std::fill(frame.all().begin(), frame.all().end(), static_cast<std::uint16_t>(id));
        frame.all()[0] = static_cast<std::uint16_t>(id + 4);
        FrameRecord record;
        record.id = id;
        sinks[0]->publish(frame, record);
    }
    sinks[0]->stop();
    EXPECT_EQ(sinks[0]->report().frames, 3u);
    std::ifstream in(folder_ / "means.csv");
    const std::string lines{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(lines, "1,1.5\n2,2.5\n3,3.5\n");
}

}  // namespace
}  // namespace hilcam
