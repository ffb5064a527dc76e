#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "emulator/events/event_sequence.h"
#include "emulator/recording/recording_reader.h"
#include "emulator/run/emulator.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr TimeTai kStart{1'000'000'000'000'000};
TimeTai at_s(double seconds) { return kStart + std::llround(seconds * 1e9); }

EventConfig event(const std::string& name = "") {
    EventConfig e;
    e.name = name;
    e.actions = {"stop"};
    return e;
}
EventConfig timed(double seconds, const std::string& name = "") {
    EventConfig e = event(name);
    e.has_at_s = true, e.at_s = seconds;
    return e;
}
EventConfig on_condition(const EventConditionConfig& condition) {
    EventConfig e = event();
    e.has_when = true, e.when = condition;
    return e;
}

const EventWorld kWorld{{"plate"}, {}};

// A camera at the origin that looks along +z, the plate somewhere, the Sun far away along +x, the Earth out
// of the way.
WorldSnapshot world_with(Vec3d plate_m) {
    WorldSnapshot world;
    world.objects = {{plate_m, {}}};
    world.bodies.sun_world_m = {kAstronomicalUnit_m, 0, 0};
    for (BodyState& body : world.bodies.body) {
        body.world_m = {0, -1e11, 0};
        body.fixed_from_world = to_matrix(Quat{});
    }
    return world;
}

// Shows the sequence frames of the world, a second apart, and tells after which ones something was due.
class Watched {
  public:
    explicit Watched(const EventConfig& config) : sequence_(std::span(&config, 1), kWorld, kStart) {}
    bool happens(const WorldSnapshot& world) {
        ++id_;
        sequence_.saw({id_, 0, at_s(static_cast<double>(id_)), 0.01}, world);
        const auto due = sequence_.take(kStart);
        if (due) {
            EXPECT_EQ(due->time, at_s(static_cast<double>(id_)));
            EXPECT_FALSE(due->by_clock);
        }
        return due.has_value();
    }

  private:
    EventSequence sequence_;
    std::uint64_t id_ = 0;
};

std::vector<bool> at_distances(EventConfig config, const std::vector<double>& distances_m) {
    Watched watched(config);
    std::vector<bool> out;
    for (const double d : distances_m) out.push_back(watched.happens(world_with({0, 0, d})));
    return out;
}

// --- the sequence

TEST(EventSequence, WhatIsTimedComesInOrderAndNotBefore) {
    const EventConfig events[] = {timed(2), timed(1), timed(1)};
    EventSequence sequence(events, kWorld, kStart);
    EXPECT_FALSE(sequence.take(at_s(0.999)));
    EXPECT_EQ(sequence.next_time(), at_s(1));
    for (const std::size_t expected : {1u, 2u}) {
        const auto due = sequence.take(at_s(1.5));
        ASSERT_TRUE(due);
        EXPECT_EQ(due->event, expected);
        EXPECT_EQ(due->time, at_s(1));
        EXPECT_TRUE(due->by_clock);
    }
    EXPECT_FALSE(sequence.take(at_s(1.5)));
    ASSERT_TRUE(sequence.take(at_s(2)));
    EXPECT_FALSE(sequence.take(at_s(1e6)));
    EXPECT_FALSE(sequence.next_time());
}

TEST(EventSequence, WhatRepeatsLeavesOutWhatItPassedOver) {
    EventConfig config = timed(1);
    config.every_s = 2, config.times = 3;
    EventSequence sequence(std::span(&config, 1), kWorld, kStart);
    EXPECT_EQ(sequence.take(at_s(1))->time, at_s(1));
    EXPECT_FALSE(sequence.take(at_s(2.9)));
    EXPECT_EQ(sequence.take(at_s(8))->time, at_s(3));  // 5 and 7 are passed over
    EXPECT_EQ(sequence.next_time(), at_s(9));
    EXPECT_EQ(sequence.take(at_s(9))->time, at_s(9));
    EXPECT_FALSE(sequence.take(at_s(1e6)));
}

TEST(EventSequence, OneFollowsAnotherEachTime) {
    EventConfig events[] = {timed(1, "first"), event("second")};
    events[0].every_s = 10, events[0].times = 2;
    events[1].has_after = true, events[1].after = "first", events[1].delay_s = 0.5, events[1].times = 0;
    EventSequence sequence(events, kWorld, kStart);
    EXPECT_EQ(sequence.take(at_s(1.4))->event, 0u);
    EXPECT_FALSE(sequence.take(at_s(1.4)));
    EXPECT_EQ(sequence.take(at_s(1.5))->time, at_s(1.5));
    EXPECT_EQ(sequence.take(at_s(11))->event, 0u);
    EXPECT_EQ(sequence.take(at_s(12))->time, at_s(11.5));
    EXPECT_FALSE(sequence.take(at_s(100)));
}

// The next time of the other one comes while the first is still waited for.
TEST(EventSequence, ADelayLongerThanTheOthersPeriodLosesNone) {
    EventConfig events[] = {timed(1, "first"), event("each"), event("twice")};
    events[0].every_s = 1, events[0].times = 4;
    for (EventConfig* e : {&events[1], &events[2]}) e->has_after = true, e->after = "first";
    events[1].delay_s = 2.5, events[1].times = 0;
    events[2].delay_s = 10, events[2].times = 2;
    EventSequence sequence(events, kWorld, kStart);
    std::vector<std::pair<std::size_t, double>> found;
    for (int half_s = 0; half_s < 60; ++half_s)
        while (const auto due = sequence.take(at_s(0.5 * half_s)))
            found.emplace_back(due->event, static_cast<double>(due->time - kStart) * 1e-9);
    const std::vector<std::pair<std::size_t, double>> expected = {
        {0, 1}, {0, 2}, {0, 3}, {1, 3.5}, {0, 4}, {1, 4.5}, {1, 5.5}, {1, 6.5}, {2, 11}, {2, 12}};
    EXPECT_EQ(found, expected);
}

TEST(EventSequence, WhatRepeatsForEverComesToNothingByItself) {
    EventConfig events[] = {timed(1), timed(5)};
    events[0].every_s = 1, events[0].times = 0;
    EventSequence sequence(events, kWorld, kStart);
    EXPECT_TRUE(sequence.comes_to_something());
    while (sequence.take(at_s(4))) {
    }
    EXPECT_TRUE(sequence.comes_to_something());  // the one of 5 s
    while (sequence.take(at_s(5))) {
    }
    EXPECT_FALSE(sequence.comes_to_something());
    EXPECT_TRUE(sequence.next_time());
    events[0].actions = {"expose"};
    EventSequence pictures(events, kWorld, kStart);
    while (pictures.take(at_s(5))) {
    }
    EXPECT_TRUE(pictures.comes_to_something());
}

TEST(EventSequence, AFrameNumberIsMetByTheFirstFrameThatReachesIt) {
    EventConfig events[] = {event(), event()};
    events[0].has_at_frame = true, events[0].at_frame = 1;
    events[1].has_at_frame = true, events[1].at_frame = 10;
    EventSequence sequence(events, kWorld, kStart);
    EXPECT_EQ(sequence.take(kStart)->event, 0u);  // before any frame
    const WorldSnapshot world = world_with({});
    sequence.saw({8, 0, at_s(8), 0}, world);
    EXPECT_FALSE(sequence.take(at_s(9)));
    sequence.saw({11, 0, at_s(11), 0}, world);  // 9 and 10 were skipped
    EXPECT_EQ(sequence.take(at_s(9))->event, 1u);
    EXPECT_FALSE(sequence.take(at_s(99)));
}

// --- conditions

TEST(EventCondition, ADistanceIsMetOnceAndAgainOnlyPastItsMargin) {
    EventConditionConfig close;
    close.object = "plate";
    close.distance_m.has_below = true, close.distance_m.below = 100;
    EventConfig once = on_condition(close);
    EXPECT_EQ(at_distances(once, {150, 100, 99, 150, 99}), (std::vector{false, false, true, false, false}));
    EventConfig often = once;
    often.times = 0;
    EXPECT_EQ(at_distances(often, {99, 98, 101, 99}), (std::vector{true, false, false, true}));
    often.when.margin_m = 20;
    EXPECT_EQ(at_distances(often, {150, 90, 105, 95, 125, 110, 80}),
              (std::vector{false, true, false, false, false, false, true}));
    // A second from frame to frame: what comes within 3 s is passed over, not put off.
    often.when.margin_m = 0, often.again_after_s = 3;
    EXPECT_EQ(at_distances(often, {99, 101, 99, 101, 99}), (std::vector{true, false, false, false, true}));
}

TEST(EventCondition, AllLimitsMustHold) {
    EventConditionConfig between;
    between.object = "plate";
    between.distance_m = {200, 100, true, true};
    EventConfig config = on_condition(between);
    config.times = 0;
    EXPECT_EQ(at_distances(config, {250, 150, 50, 150}), (std::vector{false, true, false, true}));
}

// By hand: the plate at 45 degrees to the boresight in the x-z plane, the Sun along +x.
TEST(EventCondition, AnglesAreThoseOfBoresightSunAndPhase) {
    const WorldSnapshot world = world_with({10, 0, 10});
    const auto holds = [&](auto member, double below_deg) {
        EventConditionConfig c;
        c.object = "plate";
        (c.*member).has_below = true, (c.*member).below = below_deg * kDegree_rad;
        return EventCondition(c, kWorld).holds(world);
    };
    for (const auto& [member, angle_deg] :
         {std::pair{&EventConditionConfig::off_boresight_rad, 45.0},
          std::pair{&EventConditionConfig::sun_off_boresight_rad, 90.0},
          // The camera is seen from the plate along (-1, 0, -1), the Sun along +x.
          std::pair{&EventConditionConfig::phase_rad, 135.0}}) {
        EXPECT_FALSE(holds(member, angle_deg - 1e-6)) << angle_deg;
        EXPECT_TRUE(holds(member, angle_deg + 1e-6)) << angle_deg;
    }
}

// A Moon between the plate and the Sun hides it when the way to the Sun passes within its radius.
TEST(EventCondition, ABodyEclipsesWhatIsBehindIt) {
    EventConditionConfig c;
    c.object = "plate";
    c.light = EventLight::kEclipsed;
    EventWorld shown = kWorld;
    shown.visible[index_of(BodyId::kMoon)] = true;
    const auto eclipsed = [&](const EventWorld& bodies, Vec3d moon_m) {
        WorldSnapshot world = world_with({0, 0, 10});
        world.bodies[BodyId::kMoon].world_m = moon_m;
        return EventCondition(c, bodies).holds(world);
    };
    const double radius_m = kFigures[index_of(BodyId::kMoon)].equatorial_radius_m;
    EXPECT_TRUE(eclipsed(shown, {1e7, 0.99 * radius_m, 0}));
    EXPECT_FALSE(eclipsed(shown, {1e7, 1.01 * radius_m, 0}));
    EXPECT_FALSE(eclipsed(shown, {-1e7, 0, 0}));                     // on the other side
    EXPECT_FALSE(eclipsed(shown, {2 * kAstronomicalUnit_m, 0, 0}));  // behind the Sun
    EXPECT_FALSE(eclipsed(kWorld, {1e7, 0, 0}));                     // not part of the scene
}

// --- in a scenario

class EventsTest : public PlateTest {
  protected:
    std::string refusal(const std::string& events) {
        const auto file = scenario("", "events: [" + events + "]\n");
        return error_of([&] { load_scenario(file, {}); });
    }
    // The frames of a run, from its recording, in the order of their times: two cameras' are kept as each is done.
    std::vector<FrameUse> frames_of(const std::filesystem::path& file) {
        const ScenarioConfig config = load_scenario(file, {});
        RunLimits limits;
        limits.seconds = 60;
        limits.record = folder_ / "run.rec";
        Emulator emulator(config, limits);
        emulator.run([] {});
        EXPECT_LT(emulator.seconds(), 60);  // an event has ended it
        RecordingReader reader(limits.record);
        header_ = reader.header();
        std::vector<FrameUse> frames;
        for (Record record; reader.next(record);)
            if (const auto* frame = std::get_if<RecordedFrame>(&record)) frames.push_back(frame->use);
        EXPECT_EQ(reader.end(), RecordingEnd::kClean) << reader.end_text();
        std::stable_sort(frames.begin(), frames.end(), [](const FrameUse& a, const FrameUse& b) {
            return a.exposure_mid.ns < b.exposure_mid.ns;
        });
        return frames;
    }
    RecordingHeader header_;
};

TEST_F(EventsTest, MistakesAreNamedWithTheirPlace) {
    EXPECT_THAT(refusal("{do: stop}"), HasSubstr("one of 'at_s', 'at_utc', 'at_frame', 'after' and 'when'"));
    EXPECT_THAT(refusal("{at_s: 1, at_frame: 2, do: stop}"), HasSubstr("found 2"));
    EXPECT_THAT(refusal("{at_s: 1}"), HasSubstr("events.0.do: the key is missing"));
    EXPECT_THAT(refusal("{at_s: 1, do: fly}"), HasSubstr("do: found 'fly': "));
    EXPECT_THAT(refusal("{at_s: 1, do: settings}"), HasSubstr("names no setting"));
    EXPECT_THAT(refusal("{at_s: 1, do: ping}"), HasSubstr("does nothing to a camera"));
    EXPECT_THAT(refusal("{after: x, do: stop}"), HasSubstr("there is no event 'x'"));
    EXPECT_THAT(refusal("{when: {object: plate}, do: stop}"), HasSubstr("names no quantity"));
    EXPECT_THAT(refusal("{when: {distance_below_m: 3}, do: stop}"), HasSubstr("needs 'object'"));
    EXPECT_THAT(refusal("{when: {object: plat, distance_below_m: 3}, do: stop}"),
                HasSubstr("found 'plat'; accepted: 'plate', sun, earth"));
    EXPECT_THAT(refusal("{at_s: 1, do: stop, camera: 2}"), HasSubstr("accepted: 0 to 1"));
    EXPECT_THAT(refusal("{at_frame: 1, every_s: 1, do: stop}"), HasSubstr("'every_s' goes with"));
    EXPECT_EQ(refusal("{at_s: 1, do: [settings --gain-db 3, 'fault packet_drop --rate 0.1', end]}"),
              "no error");
}

// Nothing but events: they take the pictures and change what these show, at the frames that they name.
TEST_F(EventsTest, InLockstepTheyMakeARunOfTheirOwn) {
    const auto file = scenario("",
                               "mode: lockstep\n"
                               "camera_pose: {velocity_m_s: [0, 0, 0.9]}\n"
                               "events:\n"
                               "  - {at_s: 1, every_s: 1, times: 5, do: expose}\n"
                               "  - {at_s: 2.5, do: settings --exposure-ms 5}\n"
                               "  - {at_frame: 5, do: settings --gain-db 6}\n"
                               // 4 m at the start: 1.3 m in the frame of 3 s
                               "  - {name: near, when: {object: plate, distance_below_m: 1.5},\n"
                               "     do: fault image_black}\n"
                               "  - {after: near, delay_s: 1.5, do: fault clear}\n"
                               "  - {at_s: 6, do: end}\n");
    const std::vector<FrameUse> frames = frames_of(file);
    ASSERT_EQ(frames.size(), 5u);
    const double exposure_s[] = {0.02, 0.02, 0.005, 0.005, 0.005};
    const double gain_db[] = {0, 0, 0, 0, 6};
    const bool black[] = {false, false, false, true, false};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(frames[i].id, i + 1);
        EXPECT_EQ(frames[i].exposure_mid, header_.start + static_cast<std::int64_t>(i + 1) * 1'000'000'000);
        EXPECT_DOUBLE_EQ(frames[i].exposure_s, exposure_s[i]) << i;
        EXPECT_EQ(frames[i].gain_db, gain_db[i]) << i;
        EXPECT_EQ(frames[i].image.black, black[i]) << i;
    }
}

// The picture of an event comes between two frames that a sender orders, also of one burst.
TEST_F(EventsTest, InLockstepTheyTakePicturesBetweenASendersFrames) {
    EventRig bench(scenario(", frame_rate_hz: 1",
                            "events:\n"
                            "  - {at_s: 1.5, do: expose}\n"
                            "  - {at_s: 3.5, do: [expose, settings --gain-db 6]}\n"));
    LoopRig& rig = bench.rig;
    EXPECT_EQ(rig.send(ExposeCommand{rig.start + kSecond_ns, 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{rig.start + 2 * kSecond_ns, 3}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(6));
    bench.stop();
    const auto& frames = rig.collector.frames;
    ASSERT_EQ(frames.size(), 6u);
    // The burst goes on a period after the event's picture.
    const double middle_s[] = {1, 1.5, 2, 3, 3.5, 4.5};
    const double gain_db[] = {0, 0, 0, 0, 0, 6};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(frames[i].record.exposure_mid, rig.start + to_ns(middle_s[i])) << i;
        EXPECT_EQ(frames[i].record.gain_db, gain_db[i]) << i;
    }
}

// Of a burst, too, no frame is taken after the end: that of frame 10 comes before it.
TEST_F(EventsTest, InLockstepTheEndIsExact) {
    const auto file = scenario("",
                               "mode: lockstep\n"
                               "events:\n"
                               "  - {at_s: 1, do: expose --frames 1000}\n"
                               "  - {at_frame: 10, do: end}\n");
    EXPECT_EQ(frames_of(file).size(), 9u);
}

// Nothing is left that could take a picture: neither the end of the list nor what goes on for ever.
TEST_F(EventsTest, InLockstepARunOfEventsEndsWithThem) {
    const auto file = scenario("",
                               "mode: lockstep\n"
                               "events:\n"
                               "  - {at_s: 1, every_s: 1, times: 3, do: expose}\n"
                               "  - {at_s: 0.5, every_s: 0.5, times: 0, do: settings --gain-db 3}\n");
    const std::vector<FrameUse> frames = frames_of(file);
    ASSERT_EQ(frames.size(), 3u);
    for (const FrameUse& f : frames) EXPECT_EQ(f.gain_db, 3) << f.id;
}

// Cameras count their own frames: the second takes the first of its own.
TEST_F(EventsTest, AFaultIsForTheNextFrameOfItsCamera) {
    const auto file =
        scenario("",
                 "mode: lockstep\n"
                 "more_cameras:\n"
                 "  - {camera: {name: second, width_px: 16, height_px: 16, pitch_um: 5, "
                 "focal_length_mm: 50, f_number: 8, quantum_efficiency: 0.5, full_well_e: 10000, "
                 "read_noise_e: 5, gain_dn_e: 0.3, bits: 12, exposure_ms: 1}}\n"
                 "events:\n"
                 "  - {at_s: 1, every_s: 1, times: 20, camera: 1, do: expose}\n"
                 "  - {at_s: 20.5, do: fault image_black --frames 1}\n"
                 "  - {at_s: 21, camera: 2, do: expose --frames 2}\n"
                 "  - {at_s: 30, camera: 1, do: expose --frames 2}\n"
                 "  - {at_s: 40, do: end}\n");
    std::vector<std::uint64_t> black;
    const std::vector<FrameUse> frames = frames_of(file);
    ASSERT_EQ(frames.size(), 24u);
    for (const FrameUse& f : frames)
        if (f.image.black) black.push_back(f.id);
    EXPECT_EQ(black, (std::vector<std::uint64_t>{1, 21}));
}

// Never before its time; how late it may be is the machine's business.
TEST_F(EventsTest, InFreeRunTheyTakeEffectFromTheirTimeOn) {
    const auto file = scenario(", frame_rate_hz: 50",
                               "events:\n"
                               "  - {at_s: 0, do: settings --gain-db 3}\n"
                               "  - {at_s: 0.5, do: settings --gain-db 6}\n"
                               "  - {at_s: 1.5, do: end}\n");
    const std::vector<FrameUse> frames = frames_of(file);
    int before = 0, after = 0;
    for (const FrameUse& f : frames) {
        const std::int64_t begin_ns = f.begin_ns - header_.monotonic_start_ns;
        if (f.gain_db == 6) {
            ++after;
            EXPECT_GE(begin_ns, 500'000'000) << f.id;
        } else {
            ++before;
            EXPECT_EQ(f.gain_db, 3) << f.id;
        }
    }
    EXPECT_GT(before, 0);
    EXPECT_GT(after, 0);
}

TEST_F(EventsTest, ATriggeredCameraTakesItsPicturesAtTheirTimes) {
    const auto file = scenario(", frame_rate_hz: 50",
                               "mode: triggered\n"
                               "events:\n"
                               "  - {at_s: 0.3, do: expose}\n"
                               "  - {at_s: 0.5, do: expose --frames 3}\n"
                               "  - {at_s: 1.2, do: end}\n");
    const std::vector<FrameUse> frames = frames_of(file);
    ASSERT_EQ(frames.size(), 4u);
    const std::int64_t begin_ms[] = {300, 500, 520, 540};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(frames[i].begin_ns - header_.monotonic_start_ns, begin_ms[i] * 1'000'000) << i;
}

}  // namespace
}  // namespace hilcam
