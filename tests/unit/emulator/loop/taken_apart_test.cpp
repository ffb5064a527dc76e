// Frames that the loop takes apart for somebody are those that it makes otherwise.

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <optional>
#include <thread>

#include "emulator/loop/light_part_orders.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using Picture = std::shared_ptr<const LightPartSource::Picture>;

// Two frames, each when it is let go.
class TwoFrames : public FrameScript {
  public:
    TwoFrames(TimeTai start, double exposure_s, bool second_is_closed)
        : start_(start), exposure_s_(exposure_s), second_is_closed_(second_is_closed) {}

    void let_go() { ++allowed_; }
    bool next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) override {
        if (begun_ == 2) return false;
        while (allowed_ == begun_ && !stopping) std::this_thread::yield();
        if (stopping) return false;
        use = {};
        use.id = ++begun_;
        use.exposure_s = exposure_s_;
        use.exposure_mid = use.shown_at = start_ + static_cast<std::int64_t>(begun_) * 1'000'000'000;
        use.shutter_closed = begun_ == 2 && second_is_closed_;
        not_before_ns = 0;
        return true;
    }
    void seen() noexcept override {}

  private:
    TimeTai start_;
    double exposure_s_;
    bool second_is_closed_;
    std::atomic<std::uint64_t> allowed_{0};
    std::uint64_t begun_ = 0;
};

class TakenApart : public FrameLoopTest {
  protected:
    struct Seen {
        std::vector<Collector::Frame> frames;
        std::vector<Picture> pictures;
    };
    // part: the one that somebody asks for, of each frame; none: nobody asks.
    Seen look(std::optional<LightPart> part, const std::string& quality, bool second_is_closed = false) {
        LoopRig rig(scenario(), {}, {quality});
        std::atomic<std::uint64_t> made{0};
        LightPartOrders orders("");
        orders.serve({[&](LightPart wanted) {
                          ++made;
                          return std::make_unique<PartsBuffer>(rig.exposures.make_parts_buffer(wanted));
                      },
                      &TakenApart::lit_pixels});
        TwoFrames script(rig.start, rig.scenario.camera.exposure_s, second_is_closed);
        LoopParts parts = rig.parts({});
        parts.script = &script;
        parts.observers.light_parts = &orders;
        FrameLoop loop(parts);
        loop.start();
        Seen seen;
        for (std::uint64_t i = 1; i <= 2; ++i) {
            std::future<Picture> asked;
            if (part) {
                asked = std::async(std::launch::async, [&, i] {
                    return orders.wait_for({*part, i - 1}, std::chrono::minutes(1));
                });
                while (made < i) std::this_thread::yield();
                // Ordered as soon as the memory is there.
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
            }
            script.let_go();
            EXPECT_TRUE(rig.collector.wait_for(i));
            if (part) seen.pictures.push_back(asked.get());
        }
        loop.stop();
        seen.frames = rig.collector.frames;
        return seen;
    }
    static DnImage lit_pixels(const RadianceImage& light, const FrameRecord&) {
        DnImage lit(light.width(), light.height());
        for (int y = 0; y < lit.height(); ++y)
            for (std::size_t x = 0; x < static_cast<std::size_t>(lit.width()); ++x)
                for (int plane = 0; plane < light.planes(); ++plane)
                    if (light.row(y, plane)[x] > 0) lit.row(y)[x] = 1;
        return lit;
    }
    static std::ptrdiff_t count(const DnImage& lit) {
        return std::count(lit.all().begin(), lit.all().end(), 1);
    }
};

TEST_F(TakenApart, FramesAreTheSameToTheLastBit) {
    // With the buffer, what is so small has a picture of its own, and is drawn as points.
    for (const auto& [quality, part] : {std::pair{"quality.visibility=rays", LightPart::kSun},
                                        {"quality.visibility=buffer", LightPart::kPoints}}) {
        SCOPED_TRACE(quality);
        const Seen alone = look(std::nullopt, quality), asked = look(part, quality);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(alone.frames[i].dn, asked.frames[i].dn);
            ASSERT_TRUE(asked.pictures[i]);
            EXPECT_EQ(asked.pictures[i]->record.id, i + 1);
            EXPECT_GE(count(asked.pictures[i]->numbers), 200) << "the plate is 16 x 16 px";
        }
        const Seen lamps = look(LightPart::kLamps, quality);
        ASSERT_TRUE(lamps.pictures[0]);
        EXPECT_EQ(count(lamps.pictures[0]->numbers), 0) << "there is none";
    }
}

TEST_F(TakenApart, WhileTheShutterStaysClosedThereIsNoLight) {
    const Seen seen = look(LightPart::kSun, "quality.visibility=rays", true);
    ASSERT_TRUE(seen.pictures[0] && seen.pictures[1]);
    EXPECT_GT(count(seen.pictures[0]->numbers), 0);
    EXPECT_EQ(seen.pictures[1]->record.id, 2u);
    EXPECT_EQ(count(seen.pictures[1]->numbers), 0);
}

}  // namespace
}  // namespace hilcam
