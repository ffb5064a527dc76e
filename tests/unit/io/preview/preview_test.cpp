// The preview's requests and pictures as bytes.

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <thread>

#include "io/preview/preview_assets.h"
#include "io/preview/preview_picture.h"
#include "io/preview/preview_request.h"
#include "io/preview/preview_shelf.h"
#include "io/preview/preview_slot.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

template <class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const InputError& e) {
        return e.what();
    }
    return "accepted";
}

TEST(PreviewRequest, PictureTakesItsNumbers) {
    const PictureRequest r = parse_picture_request("viewer=7&after=12&x=3&y=4&width=50&height=60&step=2");
    EXPECT_EQ(r.viewer, 7u);
    EXPECT_EQ(r.after, 12u);
    EXPECT_EQ((std::array{r.x, r.y, r.width, r.height, r.step}), (std::array{3, 4, 50, 60, 2}));
    EXPECT_EQ(parse_picture_request("").step, 1);
    EXPECT_FALSE(parse_picture_request("").hold);
    EXPECT_TRUE(parse_picture_request("hold=1").hold);
    EXPECT_TRUE(parse_picture_request("truth=1").truth);
}

TEST(PreviewRequest, APictureMayBeOfOnePartOfTheLight) {
    EXPECT_FALSE(parse_picture_request("").light.has_value());
    for (std::size_t i = 0; i < kLightParts; ++i)
        EXPECT_EQ(parse_picture_request("light=" + std::string(kLightPartNames[i])).light,
                  static_cast<LightPart>(i));
    for (const char* bad : {"", "picture", "sun", "direct.sun.", "Direct.Sun", "0"})
        EXPECT_THAT(
            message_of([&] { parse_picture_request("light=" + std::string(bad)); }),
            HasSubstr("'light' is '" + std::string(bad) + "'; accepted: emission, direct.sun, direct.lamps"));
}

// In their order, and nothing else but the picture.
TEST(PreviewPage, OffersEachPartOfTheLight) {
    const auto assets = preview_assets();
    const auto page = std::find_if(assets.begin(), assets.end(), [](const PreviewAsset& asset) {
        return asset.text.find("<select id=\"light\">") != std::string_view::npos;
    });
    ASSERT_NE(page, assets.end());
    std::string_view list = page->text.substr(page->text.find("<select id=\"light\">"));
    list = list.substr(0, list.find("</select>"));
    std::vector<std::string> offered, expected{"picture"};
    for (std::size_t at = list.find("<option"); at != std::string_view::npos;
         at = list.find("<option", at + 1)) {
        const std::size_t begin = list.find('>', at) + 1;
        std::string_view word = list.substr(begin, list.find('<', begin) - begin);
        while (!word.empty() && std::isspace(static_cast<unsigned char>(word.back()))) word.remove_suffix(1);
        offered.emplace_back(word);
    }
    expected.insert(expected.end(), kLightPartNames.begin(), kLightPartNames.end());
    EXPECT_EQ(offered, expected);
}

TEST(PreviewRequest, NumbersAndTruthNameTheirFrame) {
    const NumbersRequest r = parse_numbers_request("viewer=3&frame=12&format=tiff");
    EXPECT_EQ(r.viewer, 3u);
    EXPECT_EQ(r.frame, 12u);
    EXPECT_TRUE(r.tiff);
    EXPECT_FALSE(parse_numbers_request("").tiff);
    EXPECT_EQ(message_of([] { parse_numbers_request("format=jpeg"); }),
              "'format' is 'jpeg'; accepted: png, tiff");
    EXPECT_EQ(parse_truth_request("frame=7"), 7u);
    EXPECT_THAT(message_of([] { parse_truth_request(""); }), HasSubstr("missing key 'frame'"));
    EXPECT_THAT(message_of([] { parse_truth_request("frame=0"); }), HasSubstr("from 1"));
    EXPECT_THAT(message_of([] { parse_truth_request("frames=1"); }), HasSubstr("unknown key 'frames'"));
}

TEST(PreviewRequest, RefusalsNameTheKeyAndWhatIsAccepted) {
    EXPECT_EQ(message_of([] { parse_picture_request("step=0"); }),
              "'step' is '0'; accepted: a whole number from 1 to 256");
    EXPECT_THAT(message_of([] { parse_picture_request("step=-1"); }), HasSubstr("'step' is '-1'"));
    EXPECT_THAT(message_of([] { parse_picture_request("x=99999999999999999999"); }), HasSubstr("'x'"));
    EXPECT_THAT(message_of([] { parse_picture_request("z=1"); }), HasSubstr("unknown key 'z'"));
    EXPECT_THAT(message_of([] { parse_picture_request("x"); }), HasSubstr("not KEY=VALUE"));
    EXPECT_THAT(message_of([] { parse_picture_request("x=%31"); }), HasSubstr("character 37"));
    EXPECT_THAT(message_of([] { parse_settings_change("exposure_s=nan"); }), HasSubstr("accepted: a number"));
    EXPECT_THAT(message_of([] { parse_settings_change("gain_db=inf"); }), HasSubstr("accepted: a number"));
    EXPECT_THAT(message_of([] { parse_settings_change("running=yes"); }), HasSubstr("accepted: 0 or 1"));
    EXPECT_THAT(message_of([] { parse_settings_change("test_pattern=plaid"); }), HasSubstr("ramp_vertical"));
    EXPECT_THAT(message_of([] { parse_fault_request("rate=1"); }), HasSubstr("missing key 'kind'"));
    EXPECT_THAT(message_of([] { parse_fault_request("kind=packet_drop&rate=2"); }),
                HasSubstr("rate is not 0 to 1"));
    std::string many;
    for (int i = 0; i < 33; ++i) many += "x=1&";
    EXPECT_THAT(message_of([&] { parse_picture_request(many); }), HasSubstr("more than 32 keys"));
}

TEST(PreviewRequest, SettingsAndFaultsAreWhatWasAsked) {
    const SettingsChange c = parse_settings_change("exposure_s=1e-05&triggered=1&trigger_source=action1");
    EXPECT_EQ(c.exposure_s, 1e-5);
    EXPECT_EQ(c.triggered, true);
    EXPECT_EQ(c.trigger_source, TriggerSource::kAction1);
    EXPECT_FALSE(c.gain_db.has_value());
    const FaultOrder o =
        parse_fault_request("kind=image_tear&rate=0.25&value=0.5&frames=10&duration_s=3").order;
    EXPECT_EQ(o.kind, FaultKind::kImageTear);
    EXPECT_EQ((std::array{o.rate, o.value, o.duration_s}), (std::array{0.25, 0.5, 3.0}));
    EXPECT_EQ(o.frames, 10u);
    EXPECT_TRUE(parse_fault_request("clear_all=1").clear_all);
    for (const TestPattern p : {TestPattern::kOff, TestPattern::kRampHorizontalMoving})
        EXPECT_EQ(parse_settings_change("test_pattern=" + std::string(name_of(p))).test_pattern, p);
    const SettingsChange t = parse_settings_change(
        "trigger_source=line7&trigger_activation=any_edge&trigger_divider=3&trigger_overlap=off&exposure_"
        "mode="
        "trigger_width");
    EXPECT_EQ(t.trigger_source, TriggerSource::kLine7);
    EXPECT_EQ(t.trigger_activation, TriggerActivation::kAnyEdge);
    EXPECT_EQ(t.trigger_divider, 3);
    EXPECT_EQ(t.trigger_overlap, TriggerOverlap::kOff);
    EXPECT_EQ(t.exposure_mode, ExposureMode::kTriggerWidth);
    EXPECT_EQ(name_of(TriggerSource::kLine1), "line1");
}

TEST(PreviewRequest, HostsThatAWebSiteCouldNameAreStrangers) {
    for (const char* own : {"127.0.0.1:8080", "192.168.1.7", "localhost:8080", "[::1]:8080", "bench"})
        EXPECT_TRUE(is_own_host(own, "bench")) << own;
    for (const char* strange :
         {"", "evil.example:8080", "127.0.0.1.evil.example", "localhost.evil.example", "[::1", "[evil]",
          "127.1:80", "127.0.0.1:8080@evil.example", "127.0.0.1:", "127.0.0.1:http", "127.0.0.1:808080",
          "[::1]evil.example", "[::1]@evil", "bench:80,evil"})
        EXPECT_FALSE(is_own_host(strange, "bench")) << strange;
    EXPECT_FALSE(is_own_host("", ""));
    EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
    for (const char* strange :
         {"", "null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1"})
        EXPECT_FALSE(is_own_origin(strange, "127.0.0.1:8080")) << strange;
    EXPECT_FALSE(is_own_origin("http://", ""));
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

TEST(PreviewPicture, PartsAreCutToTheFrame) {
    PictureRequest r;
    r.x = 90, r.width = 50, r.y = 1000, r.step = 4;
    r = fit_to_frame(r, 100, 60);
    EXPECT_EQ((std::array{r.x, r.y, r.width, r.height}), (std::array{88, 56, 12, 4}));
    // 8000 x 8000 samples do not go in one answer: 2^21 do, that is every 6 x 6.
    EXPECT_EQ(fit_to_frame({}, 8000, 8000).step, 6);
    EXPECT_EQ(fit_to_frame({}, 2048, 1024).step, 1);
}

TEST(PreviewPicture, ExactAtStep1AndMeansAtOthers) {
    std::vector<std::uint16_t> samples(5 * 3);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint16_t>(100 * i);
    FrameRecord record;
    record.id = 77, record.bits = 12, record.exposure_s = 0.25, record.pose_sequence = 9, record.faults = 5;
    record.pose_time.ns = -3;
    // The 37th leap second, between 23:59:59 and 00:00:00, and a pose without a tag.
    record.exposure_mid = parse_utc("2016-12-31T23:59:60.25Z"), record.has_truth = true;
    const PictureSource source{samples, 5, 3, record};

    const std::string whole = encode_picture(source, fit_to_frame({}, 5, 3), "RGGB");
    ASSERT_EQ(whole.size(), kPictureHeaderBytes + 30);
    EXPECT_EQ(whole.substr(0, 4), "HCP1");
    EXPECT_EQ(at<std::uint32_t>(whole, 4), kPictureHeaderBytes);
    EXPECT_EQ(at<std::uint64_t>(whole, 8), 77u);
    EXPECT_EQ(at<std::uint32_t>(whole, 44), 12u);
    EXPECT_EQ(at<std::int64_t>(whole, 56), -3);
    EXPECT_EQ(at<double>(whole, 80), 0.25);
    EXPECT_EQ(at<std::uint64_t>(whole, 104), 5u);
    EXPECT_EQ(at<std::uint32_t>(whole, 112), 9u);
    EXPECT_EQ(whole.substr(132, 4), "RGGB");
    EXPECT_EQ(at<std::uint32_t>(whole, 136), 1u);
    EXPECT_STREQ(whole.c_str() + 144, "2016-12-31T23:59:60.250Z");
    EXPECT_STREQ(whole.c_str() + 176, format_utc({-3}).c_str());
    for (std::size_t i = 0; i < 15; ++i)
        EXPECT_EQ(at<std::uint16_t>(whole, kPictureHeaderBytes + 2 * i), 100 * i);

    PictureRequest r;
    r.x = 2, r.step = 2;
    const std::string part = encode_picture(source, fit_to_frame(r, 5, 3), "");
    EXPECT_EQ(at<std::uint32_t>(part, 32), 2u);  // 2 x 2 blocks, the last of each narrower
    EXPECT_EQ(at<std::uint32_t>(part, 36), 2u);
    ASSERT_EQ(part.size(), kPictureHeaderBytes + 8);
    EXPECT_EQ(at<std::uint16_t>(part, kPictureHeaderBytes), (200 + 300 + 700 + 800) / 4);
    EXPECT_EQ(at<std::uint16_t>(part, kPictureHeaderBytes + 2), (400 + 900) / 2);
    EXPECT_EQ(at<std::uint16_t>(part, kPictureHeaderBytes + 4), (1200 + 1300) / 2);
    EXPECT_EQ(at<std::uint16_t>(part, kPictureHeaderBytes + 6), 1400);
}

// Every frame has its id in every pixel: a reader sees whole frames only, and never an older one than before.
TEST(PreviewSlot, ReadersSeeWholeFramesAndTheLoopCopiesForThemOnly) {
    PreviewSlot slot(64 * 64, 1ms);
    slot.start();
    std::atomic<bool> over{false};
    std::uint64_t published = 0;
    std::thread loop([&] {
        DnImage frame(64, 64);
        FrameRecord record;
        while (!over) {
            ++record.id;
            std::fill(frame.all().begin(), frame.all().end(), static_cast<std::uint16_t>(record.id));
            slot.put(frame, record);
            std::this_thread::sleep_for(100us);
        }
        published = record.id;
    });
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(slot.copies(), 0u);
    const auto look = [&] {
        std::uint64_t last = 0;
        for (int i = 0; i < 50; ++i)
            ASSERT_TRUE(slot.wait_for(last, 10s, false, [&](const PreviewSlot::Frame& f) {
                EXPECT_GT(f.record.id, last);
                last = f.record.id;
                for (const std::uint16_t sample : f.samples)
                    ASSERT_EQ(sample, static_cast<std::uint16_t>(f.record.id));
            }));
    };
    std::thread other(look);
    look();
    other.join();
    over = true;
    loop.join();
    EXPECT_LT(slot.copies(), published);
    std::uint64_t last = 0;
    slot.wait_for(0, 1s, false, [&](const PreviewSlot::Frame& f) { last = f.record.id; });
    EXPECT_FALSE(slot.wait_for(last, 5ms, false, [](const PreviewSlot::Frame&) {})) << "no loop, no news";
    slot.stop();
    EXPECT_FALSE(slot.wait_for(0, 10s, false, [](const PreviewSlot::Frame&) {}));
}

TEST(PreviewSlot, AFrameLargerThanItsRoomIsNotCopied) {
    PreviewSlot slot(16, 1ms);
    slot.start();
    std::atomic<bool> over{false};
    std::thread loop([&] {
        const DnImage large(8, 8);
        while (!over) slot.put(large, FrameRecord{});
    });
    EXPECT_FALSE(slot.wait_for(0, 30ms, false, [](const PreviewSlot::Frame&) {}));
    over = true;
    loop.join();
    EXPECT_EQ(slot.copies(), 0u);
}

// While truth is wanted frames without it are passed over, but for who would else get none at all.
TEST(PreviewSlot, WhoWantsTruthGetsAFrameWithIt) {
    PreviewSlot slot(16, 1ms);
    slot.start();
    std::atomic<bool> over{false}, told{false};
    std::thread loop([&] {
        const DnImage frame(4, 4);
        FrameRecord record;
        while (!over) {
            ++record.id;
            // The loop does so: it is asked when the frame begins.
            record.has_truth = told && slot.wants_truth();
            slot.put(frame, record);
            std::this_thread::sleep_for(100us);
        }
    });
    FrameRecord got;
    const auto read = [&](const PreviewSlot::Frame& f) { got = f.record; };
    EXPECT_FALSE(slot.wants_truth());
    ASSERT_TRUE(slot.wait_for(0, 10s, false, read));
    EXPECT_FALSE(got.has_truth);
    told = true;
    ASSERT_TRUE(slot.wait_for(0, 10s, true, read));
    EXPECT_TRUE(got.has_truth);
    told = false;
    // The wish is forgotten, and pictures come as before.
    std::this_thread::sleep_for(20ms);
    over = true;
    loop.join();
    const std::uint64_t last = got.id;
    ASSERT_TRUE(slot.wait_for(0, 20ms, true, read)) << "the newest there is, in the end";
    EXPECT_GE(got.id, last);
}

TEST(PreviewShelf, KeepsWhatWasFrozenLastAndTheNewestLines) {
    PreviewShelf shelf;
    PreviewSlot::Frame frame;
    for (std::uint64_t id = 1; id <= 5; ++id) {
        frame.record.id = id;
        frame.samples.assign(4, static_cast<std::uint16_t>(id));
        shelf.keep(frame);
        shelf.keep(frame);  // twice is once
    }
    EXPECT_EQ(shelf.find(1), nullptr);
    ASSERT_NE(shelf.find(2), nullptr);
    EXPECT_EQ(shelf.find(5)->samples[3], 5);

    for (std::uint64_t id = 1; id <= 9; ++id) shelf.put_line(id, "line " + std::to_string(id));
    EXPECT_EQ(shelf.line_of(1, 1ms), "");
    EXPECT_EQ(shelf.line_of(9, 1ms), "line 9");
    std::thread truth([&] {
        std::this_thread::sleep_for(5ms);
        shelf.put_line(10, "late");
    });
    EXPECT_EQ(shelf.line_of(10, 10s), "late");
    truth.join();
}

}  // namespace
}  // namespace hilcam
