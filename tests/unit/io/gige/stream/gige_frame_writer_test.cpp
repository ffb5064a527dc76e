#include "io/gige/stream/gige_frame_writer.h"

#include <gmock/gmock.h>

#include <vector>

namespace hilcam {
namespace {

class FrameWriter : public testing::Test {
  protected:
    GigeRing ring_{GigeRing::kMinSlots, max_payload_bytes(16, 8, "", false)};
    FaultBoard faults_;
    DeviceClock clock_;
    GigeFrameWriter writer_{ring_, faults_, clock_, "", 16};
    DnImage image_{16, 8};
    FrameRecord record_;
    GigeStreamNow now_;

    void SetUp() override {
        GigeStreamState& s = now_.state;
        s.open = s.acquiring = true;
        s.packet_bytes = 576;
        s.format = WireFormat::kMono12;
        s.width = 16, s.height = 8;
        now_.acquisition = 1;
        record_.bits = 12;
    }
    GigeFrameWriter::Outcome write() {
        ++record_.id;
        record_.exposure_mid_monotonic_ns += 1000;
        for (std::uint16_t& dn : image_.all()) dn = static_cast<std::uint16_t>(record_.id);
        return writer_.write(image_, record_, now_, writer_.admit(image_, record_, now_));
    }
    // The blocks and first pixels of the frames that wait.
    std::vector<std::pair<std::uint64_t, int>> sent() {
        std::vector<std::pair<std::uint64_t, int>> out;
        while (GigeSlot* slot = ring_.next()) {
            out.emplace_back(slot->frame.block, slot->frame.payload[0]);
            last_ = {slot->frame.timestamp_ns, slot->frame.size_y_error, slot->record.faults, slot->last};
            ring_.done(*slot);
        }
        return out;
    }
    struct Last {
        std::uint64_t timestamp_ns;
        int size_y_error;
        std::uint64_t faults;
        bool last;
    } last_{};
    using Sent = std::vector<std::pair<std::uint64_t, int>>;
};

TEST_F(FrameWriter, OnlyWhileAClientAcquires) {
    now_.state.open = false;
    EXPECT_FALSE(write().written);
    now_.state.open = true;
    now_.state.acquiring = false;
    EXPECT_FALSE(write().written);
    now_.state.acquiring = true;
    EXPECT_TRUE(write().written);
    EXPECT_EQ(sent(), (Sent{{1, 3}}));
    ++now_.acquisition;  // begun anew: ids too
    write();
    EXPECT_EQ(sent(), (Sent{{1, 4}}));
}

// A camera does not send what it was exposing, or had not sent yet, when it was told to start.
TEST_F(FrameWriter, FramesFromBeforeTheAcquisitionAreNotSent) {
    now_.first_frame = 3;
    EXPECT_FALSE(write().written);
    EXPECT_FALSE(write().written);
    EXPECT_TRUE(write().written);
    EXPECT_EQ(sent(), (Sent{{1, 3}}));
    EXPECT_EQ(writer_.unwanted(), 2u);
}

TEST_F(FrameWriter, ACountedAcquisitionEnds) {
    now_.state.frames = 2;
    write();
    sent();
    EXPECT_FALSE(last_.last);
    write();
    sent();
    EXPECT_TRUE(last_.last);
    EXPECT_FALSE(write().written);
    // The last frame is lost on purpose: it is said at once.
    ++now_.acquisition;
    now_.state.frames = 1;
    faults_.order({.kind = FaultKind::kFrameDrop, .rate = 1});
    const auto outcome = write();
    EXPECT_FALSE(outcome.written);
    EXPECT_TRUE(outcome.finished);
}

TEST_F(FrameWriter, FramesOfAnotherSizeAreNotSent) {
    record_.binning_x = record_.binning_y = 2;
    EXPECT_FALSE(write().written);
    record_.binning_x = record_.binning_y = 1;
    now_.state.width = 17;
    EXPECT_FALSE(write().written);
    now_.state.width = 15, now_.state.offset_x = 2;
    EXPECT_FALSE(write().written);
    EXPECT_EQ(writer_.of_other_size().count(), 3u);
    now_.state.offset_x = 1;
    EXPECT_TRUE(write().written);
    EXPECT_EQ(sent(), (Sent{{1, 4}}));  // they took no block ids
}

TEST_F(FrameWriter, LostFramesLeaveAGapInTheBlockIds) {
    write();
    faults_.order({.kind = FaultKind::kFrameDrop, .rate = 1, .from_frame = 2, .frames = 1});
    write(), write();
    EXPECT_EQ(sent(), (Sent{{1, 1}, {3, 3}}));
    for (int i = 0; i < 5; ++i) write();  // three fit
    EXPECT_EQ(sent(), (Sent{{4, 4}, {5, 5}, {6, 6}}));
    write();
    EXPECT_EQ(sent(), (Sent{{9, 9}}));
    EXPECT_EQ(writer_.dropped().count(), 2u);
    EXPECT_EQ(writer_.dropped().first(), 7u);
    EXPECT_EQ(writer_.dropped_by_faults(), 1u);
}

TEST_F(FrameWriter, FaultsOfWholeFrames) {
    write();
    sent();
    const std::uint64_t first = last_.timestamp_ns;
    EXPECT_EQ(first, 1000u);
    faults_.order({.kind = FaultKind::kFrameRepeat, .rate = 1});
    write();
    EXPECT_EQ(sent(), (Sent{{2, 1}}));
    EXPECT_EQ(last_.timestamp_ns, first);
    faults_.clear_all();
    faults_.order({.kind = FaultKind::kWrongSizeY, .rate = 1, .value = -3});
    write();
    EXPECT_EQ(sent(), (Sent{{3, 3}}));
    EXPECT_EQ(last_.size_y_error, -3);
    EXPECT_EQ(last_.faults, bit_of(FaultKind::kWrongSizeY));
    faults_.clear_all();
    faults_.order({.kind = FaultKind::kBlockIdWrap, .rate = 1});
    write(), write();
    EXPECT_EQ(sent(), (Sent{{65530, 4}, {65531, 5}}));
    EXPECT_EQ(last_.size_y_error, 0);
}

}  // namespace
}  // namespace hilcam
