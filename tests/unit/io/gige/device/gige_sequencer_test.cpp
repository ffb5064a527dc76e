// The sequencer as a client configures and starts it.

#include "io/gige/device/gige_sequencer.h"

#include <gmock/gmock.h>

#include "gige_bench.h"
#include "io/gige/device/gige_features.h"

namespace hilcam {
namespace {

namespace reg = feature_register;

struct SequencerClient : GigeBench {
    SequencerClient() { take_control(); }
    Sequencer& sequencer() { return *camera.sequencer(); }
    // Saves set i with that exposure and its way to the next one.
    void save(std::uint32_t set, double exposure_us, std::uint32_t next) {
        EXPECT_EQ(write(reg::kSequencerSetSelector, set), gvcp::kSuccess);
        EXPECT_EQ(write_real(reg::kExposureTime_us, exposure_us), gvcp::kSuccess);
        EXPECT_EQ(write(reg::kSequencerSetNext, next), gvcp::kSuccess);
        EXPECT_EQ(write(reg::kSequencerTriggerSource, static_cast<std::uint32_t>(LineEvent::kFrameStart)),
                  gvcp::kSuccess);
        EXPECT_EQ(write(reg::kSequencerSetSave, 1), gvcp::kSuccess);
    }
    void configure() {
        EXPECT_EQ(write(reg::kSequencerConfigurationMode, 1), gvcp::kSuccess);
        save(0, 100, 1);
        save(1, 200, 0);
        EXPECT_EQ(write(reg::kSequencerConfigurationMode, 0), gvcp::kSuccess);
    }
    // The exposure of the next frame.
    double frame_us() {
        CameraSettings s = camera.s;
        sequencer().begin(now_ns += 1'000'000, s);
        sequencer().begun(now_ns, now_ns);
        return s.exposure_s * 1e6;
    }
};

TEST(GigeSequencer, ASavedSetIsTheCamerasSettings) {
    SequencerClient b;
    b.configure();
    EXPECT_EQ(b.write(reg::kSequencerMode, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kSequencerMode), 1u);
    EXPECT_DOUBLE_EQ(b.frame_us(), 100);
    EXPECT_DOUBLE_EQ(b.frame_us(), 200);
    EXPECT_EQ(b.read(reg::kSequencerSetActive), 1u);
    EXPECT_DOUBLE_EQ(b.frame_us(), 100);
    EXPECT_EQ(b.write(reg::kSequencerMode, 0), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.frame_us(), 200);  // the camera's own, as the client wrote it last
}

TEST(GigeSequencer, AStreamBeginsWithTheStartSet) {
    SequencerClient b;
    b.configure();
    b.write(reg::kSequencerMode, 1);
    b.frame_us();
    b.open_stream();
    EXPECT_EQ(b.write(reg::kAcquisitionStart, 1), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.frame_us(), 100);
}

TEST(GigeSequencer, SetsAreWrittenInConfigurationModeOnlyAndNeverWhileItRuns) {
    SequencerClient b;
    for (const std::uint32_t address :
         {reg::kSequencerSetStart, reg::kSequencerSetSave, reg::kSequencerSetLoad, reg::kSequencerSetNext,
          reg::kSequencerTriggerSource, reg::kSequencerTriggerActivation, reg::kSequencerFeatureEnable})
        EXPECT_EQ(b.write(address, 1), gvcp::kWriteProtect) << address;
    b.write(reg::kSequencerConfigurationMode, 1);
    EXPECT_EQ(b.write(reg::kSequencerMode, 1), gvcp::kWriteProtect);
    b.write(reg::kSequencerConfigurationMode, 0);
    EXPECT_EQ(b.write(reg::kSequencerMode, 1), gvcp::kSuccess);
    EXPECT_EQ(b.write(reg::kSequencerConfigurationMode, 1), gvcp::kWriteProtect);
}

TEST(GigeSequencer, ValuesOutsideTheirLimitsChangeNothing) {
    SequencerClient b;
    b.write(reg::kSequencerConfigurationMode, 1);
    for (const std::uint32_t address :
         {reg::kSequencerSetSelector, reg::kSequencerSetStart, reg::kSequencerSetNext})
        EXPECT_EQ(b.write(address, kSequencerSets), gvcp::kInvalidParameter) << address;
    EXPECT_EQ(b.write(reg::kSequencerPathSelector, kSequencerPaths), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kSequencerFeatureSelector, kSequencerFeatures), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kSequencerTriggerActivation, 3), gvcp::kInvalidParameter);
    for (const std::uint32_t source : {static_cast<std::uint32_t>(LineEvent::kFrameEnd),
                                       static_cast<std::uint32_t>(event_of_line(2)), 99u})
        EXPECT_EQ(b.write(reg::kSequencerTriggerSource, source), gvcp::kInvalidParameter) << source;
    EXPECT_EQ(b.write(reg::kSequencerTriggerSource, static_cast<std::uint32_t>(event_of_line(0))),
              gvcp::kSuccess);
}

TEST(GigeSequencer, ASetCanBeLoaded) {
    SequencerClient b;
    b.configure();
    b.write(reg::kSequencerConfigurationMode, 1);
    b.write(reg::kSequencerSetSelector, 0);
    EXPECT_EQ(b.write(reg::kSequencerSetLoad, 1), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 100e-6);
}

TEST(GigeSequencer, AutomaticExposureExcludesIt) {
    SequencerClient b;
    b.camera.s.automatic_exposure = true;
    EXPECT_EQ(b.write(reg::kSequencerMode, 1), gvcp::kWriteProtect);
    EXPECT_FALSE(b.sequencer().on());
}

TEST(GigeSequencer, UserSetsKeepSetsAndSwitchItOff) {
    SequencerClient b;
    b.configure();
    b.write(reg::kUserSetSelector, 1);
    EXPECT_EQ(b.write(reg::kUserSetSave, 1), gvcp::kSuccess);
    b.write(reg::kSequencerMode, 1);
    b.write(reg::kUserSetSelector, 0);
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kSequencerMode), 0u);
    b.write(reg::kSequencerMode, 1);
    EXPECT_DOUBLE_EQ(b.frame_us(), 1000);  // the set as at power-up
    b.write(reg::kUserSetSelector, 1);
    b.write(reg::kUserSetLoad, 1);
    b.write(reg::kSequencerMode, 1);
    EXPECT_DOUBLE_EQ(b.frame_us(), 100);
}

TEST(GigeSequencer, ACameraWithItsOwnSequenceHasNone) {
    CameraLimits limits = PlainCamera().l;
    const auto has_any = [&] {
        const FeatureTable table = gige_features(limits, false);
        return std::any_of(table.features.begin(), table.features.end(),
                           [](const Feature& f) { return f.category == "SequencerControl"; });
    };
    EXPECT_TRUE(has_any());
    limits.has_sequencer = false;
    EXPECT_FALSE(has_any());
    GigeBench b(&limits);
    b.take_control();
    EXPECT_EQ(b.write(reg::kSequencerMode, 1), gvcp::kInvalidAddress);
}

}  // namespace
}  // namespace hilcam
