#include "emulator/run/output_summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "emulator/recording/recorder.h"
#include "emulator/run/report.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

TEST(OutputSummary, OneLineSaysWhatHasBecomeOfTheFrames) {
    const std::vector<SinkReport> outputs = {
        {.name = "files out", .frames = 16, .dropped = 14},
        {.name = "gige 127.0.0.1", .frames = 1, .dropped = 2, .unwanted = 27},
        {.name = "preview"},
        output_report({.file = "run.rec", .frames = 30, .lost = 3, .fault = "lost"})};
    EXPECT_EQ(line_of(outputs),
              "files out 16 frames, 14 lost; gige 127.0.0.1 1 frame, 2 lost, 27 that nobody took; "
              "recording run.rec 30 frames, 3 lost");
    EXPECT_TRUE(any_lost(outputs));
    EXPECT_EQ(counts_of(outputs[1]).dump(),
              R"({"dropped":2,"frames":1,"name":"gige 127.0.0.1","unwanted":27})");
    EXPECT_FALSE(any_lost({{.name = "files out", .frames = 30}, {.name = "gige", .unwanted = 3}}));
    EXPECT_EQ(line_of({{.name = "preview"}}), "");
}

// The second camera's outputs count as the first one's do.
class OutputsOfARun : public PlateTest {};

TEST_F(OutputsOfARun, NoFileIsLostInAFreeRunAndTheReportHasEveryOutputsCounts) {
    const auto file =
        scenario(", frame_rate_hz: 500, frame_rate_range_hz: [1, 1000], exposure_range_ms: [0.01, 1]", "");
    RunLimits limits;
    limits.frames = 40;
    Emulator emulator(load_scenario(file, {{"camera.exposure_ms=0.1",
                                            "outputs.files.folder=" + (folder_ / "frames").string(),
                                            "outputs.truth.folder=" + (folder_ / "frames").string()}}),
                      limits);
    emulator.run([] {});
    EXPECT_TRUE(run_outcome(emulator).faults.empty());
    const nlohmann::json report = run_report(emulator);
    ASSERT_EQ(report["outputs"].size(), 2u);
    for (const auto& output : report["outputs"]) {
        EXPECT_EQ(output["frames"].get<int>(), 40) << output;
        EXPECT_EQ(output["dropped"].get<int>(), 0) << output;
        EXPECT_EQ(output["unwanted"].get<int>(), 0) << output;
    }
    EXPECT_GE(report["waited_for_outputs_s"].get<double>(), 0.0);
}

TEST_F(OutputsOfARun, AFaultOfAnyCameraIsTheRuns) {
    const std::string second =
        "{width_px: 8, height_px: 8, pitch_um: 10, focal_length_mm: 4, f_number: 8, quantum_efficiency: 0.5,"
        " full_well_e: 20000, gain_dn_e: 0.2, bits: 12}";
    const auto frames = folder_ / "second";
    const auto file = scenario("", "more_cameras: [{camera: " + second + ", outputs: {files: {folder: '" +
                                       frames.string() + "'}}}]\n");
    RunLimits limits;
    limits.frames = 2;
    Emulator emulator(load_scenario(file, {}), limits);
    std::filesystem::create_directories(frames);
    emulator.run([&] {
        for (int i = 1; i < 9; ++i)
            std::filesystem::create_symlink("/dev/full",
                                            frames / ("frame_0000000" + std::to_string(i) + ".png"));
    });
    ASSERT_EQ(run_outcome(emulator).faults.size(), 1u);
    EXPECT_NE(run_outcome(emulator).faults[0].find("cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace hilcam
