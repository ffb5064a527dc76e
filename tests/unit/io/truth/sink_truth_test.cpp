// Truth on its way out: lines over TCP and UDP, files, and what happens when they are too slow.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <semaphore>
#include <thread>

#include "io/contract/fault.h"
#include "io/images/picture_file.h"
#include "io/truth/sink_truth.h"
#include "tests/support/files.h"
#include "tests/support/gvsp_receiver.h"

namespace hilcam {
namespace {

using nlohmann::json;

constexpr std::uint32_t kHere = 0x7F530901;  // 127.83.9.1

CameraModel camera_8x4() {
    CameraModel c;
    c.name = "small";
    c.width_px = 8, c.height_px = 4;
    return c;
}

TruthSource source() {
    TruthSource s;
    s.run = {"0123", "bench", 7, "hilcam 9"};
    s.model = camera_8x4();
    s.things = {"target"};
    s.parts = {"target", "target/wing"};
    return s;
}

// What the renderer would make and fill; here by hand.
FrameTruth slot(const TruthConfig& config) {
    FrameTruth truth;
    truth.request = request_of(config);
    truth.geometry = geometry_of(camera_8x4(), 0);
    if (truth.request.rays()) truth.layers.object = IdImage(8, 4);
    if (truth.request.depth) truth.layers.depth_m = LengthImage(8, 4);
    if (truth.request.normal) truth.layers.normal = DirectionImage(8, 4, 3);
    return truth;
}

struct TruthOut : FilesTest {
    TruthConfig config;
    TruthSurroundings surroundings{};
    std::unique_ptr<TruthSink> sink;

    void make() {
        sink = std::make_unique<TruthSink>(
            config, source(), [this] { return slot(config); }, surroundings);
    }
    // As the loop does it; false: dropped.
    bool frame(std::uint64_t id, std::size_t stars = 0) {
        FrameRecord record;
        record.id = id;
        record.exposure_s = 0.25;
        record.exposure_mid = parse_utc("2026-12-21T00:00:01Z") + 5;
        record.faults = bit_of(FaultKind::kImageBlack);
        FrameTruth* const truth = sink->begin(record);
        if (truth) {
            truth->time = parse_utc("2026-12-21T00:00:00Z");  // the world is held
            SeenThing thing;
            thing.id = 1;
            thing.camera_from_thing = {-1, 0, 0, 0};
            thing.center_px = {1.5, 2.25}, thing.has_center = true;
            thing.visible_px = 3, thing.visible_box_px = {1, 2, 4, 3};
            truth->things = {thing};
            truth->parts = {{1, 1, {1, 2, 3}, {}}};
            truth->stars.assign(stars, SeenStar{7, 32349, 48915, {1.25, 2}, {1.25, 2}, -1.46f, {}});
        }
        sink->publish(DnImage(), record);
        return truth != nullptr;
    }
    // Returns a figure of the report; -1: there is none of that name.
    double figure(const std::string& wanted) const {
        for (const auto& [name, value] : sink->report().figures)
            if (name == wanted) return value;
        return -1;
    }
    void wait_for_clients(double clients) const {
        for (int i = 0; i < kPatience_ms && figure("clients") != clients; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_EQ(figure("clients"), clients);
    }
    void wait_for(std::uint64_t frames) const {
        for (int i = 0; i < kPatience_ms && sink->report().frames < frames; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_EQ(sink->report().frames, frames);
    }
};

// A client of the port.
class Reader {
  public:
    explicit Reader(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        const sockaddr_in to = socket_address(kHere, port);
        EXPECT_EQ(connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    }
    void send(std::string_view text) const {
        EXPECT_EQ(::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(text.size()));
    }
    void end_its_side() const { EXPECT_EQ(shutdown(socket_.get(), SHUT_WR), 0); }
    // Empty: none came, or the connection has ended.
    std::string line() {
        while (text_.find('\n') == std::string::npos) {
            const auto bytes = receive(socket_, kPatience_ms);
            if (bytes.empty()) return {};
            text_.append(bytes.begin(), bytes.end());
        }
        const std::size_t end = text_.find('\n');
        const std::string out = text_.substr(0, end);
        text_.erase(0, end + 1);
        return out;
    }

  private:
    Fd socket_;
    std::string text_;
};

std::uint16_t free_port() {
    const Fd probe = listen_tcp(kHere, 0);
    return endpoint_of(probe).port;
}

TEST_F(TruthOut, EveryClientGetsEachFramesLine) {
    config.address = "127.83.9.1";
    config.port = free_port();
    make();
    sink->start();
    Reader first(static_cast<std::uint16_t>(config.port)), second(static_cast<std::uint16_t>(config.port));
    wait_for_clients(2);
    EXPECT_TRUE(frame(1, 1));
    EXPECT_TRUE(frame(2));
    for (Reader* reader : {&first, &second}) {
        const json one = json::parse(reader->line());
        EXPECT_EQ(one["frame"].get<int>(), 1);
        EXPECT_EQ(one["camera_name"].get<std::string>(), "small");
        EXPECT_EQ(one["time_utc"].get<std::string>(), "2026-12-21T00:00:01.000Z");
        const auto mid_ns = one["time_tai_ns"].get<std::int64_t>();
        EXPECT_EQ(mid_ns % 1'000'000'000, 5);
        EXPECT_EQ(mid_ns - one["shown_tai_ns"].get<std::int64_t>(), 1'000'000'005);
        EXPECT_EQ(one["faults"].dump(), "[\"image_black\"]");
        const json& object = one["objects"][0];
        EXPECT_EQ(object["name"].get<std::string>(), "target");
        EXPECT_EQ(object["center_px"].dump(), "[1.5,2.25]");
        EXPECT_EQ(object["visible_box_px"].dump(), "[1,2,3,1]");
        EXPECT_TRUE(object["silhouette_box_px"].is_null());
        EXPECT_TRUE(object["visible_fraction"].is_null());
        // Of q and -q the one whose scalar is not negative.
        EXPECT_EQ(object["camera_from_body_wxyz"][0].get<double>(), 1);
        EXPECT_EQ(one["parts"][0]["name"].get<std::string>(), "target/wing");
        EXPECT_EQ(one["stars"][0]["hd"].get<int>(), 48915);
        EXPECT_EQ(one["stars"][0]["hip"].get<int>(), 32349);
        EXPECT_EQ(one["stars"][0]["magnitude_v"].get<double>(), -1.46);
        EXPECT_EQ(json::parse(reader->line())["frame"].get<int>(), 2);
    }
    sink->stop();
    EXPECT_EQ(first.line(), "");
}

TEST_F(TruthOut, DatagramsAreLinesAndLeaveOutStarsThatDoNotFit) {
    const Fd client = open_udp(kHere, 0);
    config.udp_to = {"127.83.9.1:" + std::to_string(endpoint_of(client).port)};
    make();
    sink->start();
    EXPECT_TRUE(frame(1, 2));
    EXPECT_TRUE(frame(2, 5000));
    const auto next = [&] {
        const auto bytes = receive(client, kPatience_ms);
        return json::parse(std::string(bytes.begin(), bytes.end()));
    };
    const json one = next(), two = next();
    EXPECT_EQ(one["stars"].size(), 2u);
    EXPECT_EQ(one["stars_left_out"].get<int>(), 0);
    EXPECT_EQ(two["frame"].get<int>(), 2);
    EXPECT_EQ(two["stars"].size(), 0u);
    EXPECT_EQ(two["stars_left_out"].get<int>(), 5000);
}

TEST_F(TruthOut, WhoDoesNotReadIsCutOffAndTheOthersGoOn) {
    config.address = "127.83.9.1";
    config.port = free_port();
    make();
    sink->start();
    Reader slow(static_cast<std::uint16_t>(config.port)), quick(static_cast<std::uint16_t>(config.port));
    wait_for_clients(2);
    // Lines of half a megabyte: 8 MiB wait, and sockets hold some more.
    std::uint64_t id = 0;
    for (; id < 200 && figure("cut_off") < 1; ++id) {
        EXPECT_TRUE(frame(id + 1, 5000));
        EXPECT_NE(quick.line(), "");
    }
    EXPECT_EQ(figure("cut_off"), 1);
    wait_for_clients(1);
    EXPECT_TRUE(frame(id + 1));
    EXPECT_EQ(json::parse(quick.line())["frame"].get<std::uint64_t>(), id + 1);
}

TEST_F(TruthOut, WhatAClientSendsIsIgnoredAndWhoEndsItsSideIsDisconnected) {
    config.address = "127.83.9.1";
    config.port = free_port();
    make();
    sink->start();
    Reader talks(static_cast<std::uint16_t>(config.port)), leaves(static_cast<std::uint16_t>(config.port));
    wait_for_clients(2);
    talks.send("GET / HTTP/1.1\r\n\r\n");
    leaves.end_its_side();  // as `nc -N` does
    wait_for_clients(1);
    EXPECT_EQ(leaves.line(), "");
    EXPECT_TRUE(frame(1));
    EXPECT_EQ(json::parse(talks.line())["frame"].get<int>(), 1);
    EXPECT_EQ(figure("cut_off"), 0) << "it was not too slow";
}

TEST_F(TruthOut, TruthIsDroppedAndCountedWhenNobodyWritesIt) {
    config.folder = folder_ / "truth";
    make();
    EXPECT_TRUE(sink->has_room());
    EXPECT_FALSE(frame(1));  // not started: nobody wants it
    EXPECT_EQ(sink->report().dropped, 0u);
    sink->start();
    FrameRecord record;
    // The loop renders nine frames and publishes none of them.
    for (record.id = 1; record.id <= 8; ++record.id) EXPECT_NE(sink->begin(record), nullptr);
    record.id = 9;
    EXPECT_EQ(sink->begin(record), nullptr);
    EXPECT_EQ(sink->report().dropped, 1u);
    for (record.id = 1; record.id <= 9; ++record.id) sink->publish(DnImage(), record);
    wait_for(8);
    EXPECT_TRUE(frame(10));
    wait_for(9);
}

// A line of the folder waits until it is known whether the frame's file was written.
TEST_F(TruthOut, ALineSaysWhenTheFramesFileWasLost) {
    FrameFates fates;
    surroundings.fates = &fates;
    config.folder = folder_ / "truth";
    make();
    sink->start();
    for (const std::uint64_t id : {1u, 2u, 3u, 5u}) fates.expect(id);  // frame 4 has none
    fates.settle(2, false);
    for (std::uint64_t id = 1; id <= 5; ++id) {
        while (!sink->has_room()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_TRUE(frame(id));
    }
    EXPECT_EQ(sink->report().frames, 0u);  // the first one's file may come yet
    fates.settle(1, true);
    wait_for(2);
    fates.settle(3, false);
    wait_for(4);
    sink->stop();  // outputs of frames have ended before
    EXPECT_EQ(sink->report().frames, 5u);
    EXPECT_EQ(sink->report().fault, "");
    std::ifstream in(config.folder / "truth.jsonl");
    std::string line;
    std::getline(in, line);
    for (int id = 1; id <= 5; ++id) {
        ASSERT_TRUE(std::getline(in, line));
        const json told = json::parse(line);
        EXPECT_EQ(told["frame"].get<int>(), id);
        EXPECT_EQ(told.contains("file"), id == 2 || id == 3) << line;
        EXPECT_FALSE(told.value("file", false)) << line;
    }
}

TEST_F(TruthOut, LostTruthOfAFolderIsAFaultUnlessItMayBeDropped) {
    for (const WhenSlow when_slow : {WhenSlow::kAuto, WhenSlow::kDrop}) {
        config.folder = folder_ / "truth";
        config.overwrite = true;
        config.when_slow = when_slow;
        make();
        EXPECT_EQ(sink->must_be_waited_for(), when_slow != WhenSlow::kDrop);
        sink->start();
        FrameRecord record;
        for (record.id = 1; record.id <= 9; ++record.id) sink->begin(record);  // eight slots
        EXPECT_EQ(sink->has_fault(), when_slow != WhenSlow::kDrop);
        EXPECT_EQ(sink->report().fault.find("outputs.truth: 1 of 1 frames came too fast for ") == 0,
                  when_slow != WhenSlow::kDrop)
            << sink->report().fault;
        sink->stop();
    }
}

TEST_F(TruthOut, LayersAreChannelsOfOnePicture) {
    config.folder = folder_ / "truth";
    config.layers = {"object", "depth", "normal"};
    make();
    sink->start();
    FrameRecord record;
    record.id = 12;
    FrameTruth* const truth = sink->begin(record);
    ASSERT_NE(truth, nullptr);
    SeenThing thing;
    thing.id = 1;
    truth->things = {thing};
    for (float& value : truth->layers.depth_m.all()) value = std::numeric_limits<float>::infinity();
    truth->layers.object.row(2)[5] = 1;
    truth->layers.depth_m.row(2)[5] = 3.5f;
    truth->layers.normal.row(2, 2)[5] = -1;
    sink->publish(DnImage(), record);
    sink->stop();
    EXPECT_EQ(sink->report().fault, "");

    Imf::InputFile in((folder_ / "truth" / "truth_00000012.exr").c_str());
    const Imf::Header& header = in.header();
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("depth.unit").value(), "m along the boresight");
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("object.names").value(), "1 target\n");
    EXPECT_EQ(header.channels().findChannel("range.D"), nullptr);
    std::vector<std::uint32_t> ids(32, 99);
    std::vector<float> depth(32, 99), normal_z(32, 99);
    Imf::FrameBuffer buffer;
    const auto add = [&](const char* name, Imf::PixelType type, void* values) {
        buffer.insert(name, Imf::Slice(type, static_cast<char*>(values), 4, 4 * 8));
    };
    add("object.ID", Imf::UINT, ids.data());
    add("depth.Z", Imf::FLOAT, depth.data());
    add("normal.Z", Imf::FLOAT, normal_z.data());
    in.setFrameBuffer(buffer);
    in.readPixels(0, 3);
    EXPECT_EQ(ids[2 * 8 + 5], 1u);
    EXPECT_EQ(ids[2 * 8 + 4], 0u);
    EXPECT_EQ(depth[2 * 8 + 5], 3.5f);
    EXPECT_TRUE(std::isinf(depth[0]));
    EXPECT_EQ(normal_z[2 * 8 + 5], -1);

    const std::filesystem::path file = folder_ / "truth" / "truth_00000012.object.png";
    const PixelMap mask = read_pixel_map(file, false);
    EXPECT_EQ(mask.width(), 8);
    EXPECT_EQ(mask.row(2)[5], 1);
    EXPECT_EQ(mask.row(2)[4], 0);
    EXPECT_NE(read_input_file(file, picture_kind())
                  .find(std::string("object.names\0"
                                    "1 target",
                                    21)),
              std::string::npos);
}

TEST(ObjectMask, BodiesHaveNumbersOfSixteenBits) {
    EXPECT_EQ(mask_number(kSkyId), 0);
    EXPECT_EQ(mask_number(59'999), 59'999);
    EXPECT_EQ(mask_number(60'000), 65'535);
    EXPECT_EQ(mask_number(kSunId), 60'010);
    EXPECT_EQ(mask_number(truth_id(BodyId::kEarth)), 60'399);
    EXPECT_EQ(mask_number(kFirstBodyId + 7'000), 65'535);
}

TEST_F(TruthOut, AFolderThatCannotBeMadeIsToldAtTheStart) {
    config.folder = write("file", "no folder") / "truth";
    make();
    EXPECT_THROW(sink->start(), DeviceError);
}

// A file that may not grow, and /dev/full, which takes nothing: as a full disk, what is begun does not stay.
TEST_F(TruthOut, WhatTheDiskHasNoRoomForIsLeftOutWholeAndCounted) {
    config.folder = folder_ / "truth";
    make();
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto old = std::signal(SIGXFSZ, SIG_IGN);
    sink->start();
    const rlimit full{std::filesystem::file_size(config.folder / "truth.jsonl"), before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
    EXPECT_TRUE(frame(1));
    for (int i = 0; i < kPatience_ms && sink->report().dropped < 1; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, old);
    EXPECT_EQ(sink->report().dropped, 1u);
    EXPECT_EQ(sink->report().frames, 0u);
    EXPECT_EQ(std::filesystem::file_size(config.folder / "truth.jsonl"), full.rlim_cur);
    EXPECT_NE(sink->report().fault.find("truth.jsonl cannot be written; is the disk full?"),
              std::string::npos);

    const std::filesystem::path picture = folder_ / "picture.exr";
    std::filesystem::create_symlink("/dev/full", picture);
    EXPECT_THROW(write_truth_exr(picture, slot(config), {}), DeviceError);
    EXPECT_FALSE(std::filesystem::is_symlink(picture));
}

TEST_F(TruthOut, AnotherRunsTruthIsRefusedOrReplacedAsAWhole) {
    config.folder = folder_ / "truth";
    make();
    sink->start();
    EXPECT_TRUE(frame(1));
    sink->stop();
    write("truth/truth_00000007.exr", "a layer");
    write("truth/view.truth.jsonl", "of a picture");
    EXPECT_EQ(
        error_of([&] { make(); }),
        "outputs.truth.folder: found '" + config.folder.string() +
            "', which holds 2 files of another run ('truth.jsonl' is the first); accepted: an empty folder, "
            "another folder, or outputs.truth.overwrite: true, which replaces all of them");
    config.overwrite = true;
    make();
    sink->start();
    sink->stop();
    EXPECT_FALSE(std::filesystem::exists(config.folder / "truth_00000007.exr"));
    EXPECT_TRUE(std::filesystem::exists(config.folder / "view.truth.jsonl"));
    std::ifstream in(config.folder / "truth.jsonl");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(
        text,
        "{\"version\":1,\"run\":{\"id\":\"0123\",\"scenario\":\"bench\",\"seed\":7,\"program\":\"hilcam "
        "9\"},\"camera\":1,\"camera_name\":\"small\"}\n");
}

// A file grows to a limit, then may grow again.
TEST_F(TruthOut, LinesStayWholeWhenTheDiskIsFullForAWhile) {
    std::filesystem::create_directories(folder_ / "truth");
    TruthFiles files(folder_ / "truth", "header");
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto old = std::signal(SIGXFSZ, SIG_IGN);
    files.add_line("first");
    const rlimit little{16, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
    EXPECT_THROW(files.add_line("second"), DeviceError);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, old);
    files.add_line("third");
    std::ifstream in(folder_ / "truth" / "truth.jsonl");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "header\nfirst\nthird\n");
}

TEST_F(TruthOut, DatagramsThatTheSystemDoesNotTakeAreCounted) {
    config.udp_to = {"127.83.9.1:17299"};
    make();
    sink->start();
    FrameRecord record;
    record.id = 1;
    FrameTruth* const truth = sink->begin(record);
    ASSERT_NE(truth, nullptr);
    // A thing is some hundred bytes of text.
    truth->things.assign(1000, SeenThing{});
    sink->publish(DnImage(), record);
    sink->stop();
    EXPECT_EQ(figure("datagrams_not_sent"), 1);
}

// The loop's two threads and the writer's: also under TSan.
TEST_F(TruthOut, BothStagesOfTheLoopMayWorkAtOnce) {
    config.folder = folder_ / "truth";
    make();
    sink->start();
    constexpr std::uint64_t kFrames = 500;
    std::counting_semaphore<> free{2}, rendered{0};
    std::atomic<std::uint64_t> told{0};
    std::thread render([&] {
        FrameRecord record;
        for (record.id = 1; record.id <= kFrames; ++record.id) {
            free.acquire();
            if (FrameTruth* truth = sink->begin(record)) truth->took_ms = 1, ++told;
            rendered.release();
        }
    });
    std::thread sense([&] {
        FrameRecord record;
        for (record.id = 1; record.id <= kFrames; ++record.id) {
            rendered.acquire();
            sink->publish(DnImage(), record);
            free.release();
        }
    });
    render.join(), sense.join();
    wait_for(told);
    EXPECT_EQ(told + sink->report().dropped, kFrames);
    EXPECT_NEAR(sink->report().figures.at(0).second, 1, 1e-12);
}

}  // namespace
}  // namespace hilcam
