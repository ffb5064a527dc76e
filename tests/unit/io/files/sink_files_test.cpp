#include "io/files/sink_files.h"

#include <gmock/gmock.h>

#include <chrono>
#include <set>
#include <thread>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class FilesSinkTest : public FilesTest {
  protected:
    // A file of the folder that has no room for anything: as on a full disk.
    void fill_up(const std::string& name) { std::filesystem::create_symlink("/dev/full", folder_ / name); }
    // Publishes frames 1 to `last` and waits until each is done with.
    static void publish(FilesSink& sink, std::uint64_t last) {
        for (std::uint64_t id = 1; id <= last; ++id) {
            while (!sink.has_room()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            FrameRecord record;
            record.id = id;
            sink.publish(DnImage(8, 4), record);
        }
    }
};

TEST_F(FilesSinkTest, AFullDiskIsToldByTheFirstFrameThatIsLostAndLeavesNoBeginnings) {
    const std::array<const char*, 4> endings = {"png", "tiff", "raw", "fits"};
    for (std::size_t i = 0; i < endings.size(); ++i) {
        const std::string ending = std::string(".") + endings[i];
        FilesConfig config;
        config.folder = folder_;
        config.format = static_cast<FilesConfig::Format>(i);
        config.overwrite = i > 0;
        testing::internal::CaptureStderr();
        FrameFates fates;
        FilesSink sink(config, 8, 4, PictureRun{}, true, &fates);
        sink.start();
        fill_up("frame_00000002" + ending);
        fill_up("frame_00000003" + ending);
        publish(sink, 4);
        sink.stop();
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        const SinkReport report = sink.report();
        EXPECT_THAT(report.fault, HasSubstr("frame_00000002" + ending +
                                            ": cannot be written: No space left on device (the first of 2 "
                                            "frames lost)"));
        EXPECT_EQ(report.frames, 2u);
        EXPECT_EQ(report.dropped, 2u);
        for (const std::uint64_t id : {2u, 3u}) EXPECT_EQ(fates.of(id), FrameFates::Fate::kLost);
        EXPECT_EQ(fates.of(4), FrameFates::Fate::kWritten);
        for (const char* id : {"1", "4"})
            EXPECT_GT(std::filesystem::file_size(folder_ / ("frame_0000000" + (id + ending))), 0u);
        for (const char* id : {"2", "3"})
            EXPECT_FALSE(std::filesystem::is_symlink(folder_ / ("frame_0000000" + (id + ending))));
    }
}

// Before start() nothing takes frames out: eight wait, the others find no room.
void publish_at_once(FilesSink& sink, std::uint64_t last) {
    for (std::uint64_t id = 1; id <= last; ++id) {
        FrameRecord record;
        record.id = id;
        sink.publish(DnImage(8, 4), record);
    }
}

TEST_F(FilesSinkTest, FramesThatComeTooFastAreAFaultUnlessTheyMayBeDropped) {
    for (const WhenSlow when_slow : {WhenSlow::kAuto, WhenSlow::kWait, WhenSlow::kDrop}) {
        FilesConfig config{.folder = folder_ / "out", .overwrite = true, .when_slow = when_slow};
        FilesSink sink(config, 8, 4, PictureRun{});
        publish_at_once(sink, 8);
        EXPECT_FALSE(sink.has_fault());
        publish_at_once(sink, 2);
        EXPECT_EQ(sink.has_fault(), when_slow != WhenSlow::kDrop);
        sink.start();
        sink.stop();
        const SinkReport report = sink.report();
        EXPECT_EQ(report.frames, 8u);
        EXPECT_EQ(report.dropped, 2u);
        if (when_slow == WhenSlow::kDrop)
            EXPECT_EQ(report.fault, "");
        else
            EXPECT_THAT(report.fault, HasSubstr("outputs.files: 2 of 10 frames came too fast for '" +
                                                config.folder.string() +
                                                "' and were lost; accepted: outputs.files.when_slow: wait"));
    }
}

TEST(FilesConfig, TheCameraWaitsUnlessClientsTakeFramesBesideTheFiles) {
    EXPECT_TRUE(waits(WhenSlow::kAuto, false));
    EXPECT_FALSE(waits(WhenSlow::kAuto, true));
    for (const bool live : {false, true}) {
        EXPECT_TRUE(waits(WhenSlow::kWait, live));
        EXPECT_FALSE(waits(WhenSlow::kDrop, live));
    }
}

TEST_F(FilesSinkTest, ItIsKnownWhatHasBecomeOfEachFramesFile) {
    using Fate = FrameFates::Fate;
    FilesConfig config{.folder = folder_ / "out", .every_nth = 2};
    FrameFates fates;
    FilesSink sink(config, 8, 4, PictureRun{}, true, &fates);
    publish_at_once(sink, 20);  // 1, 3, ... 15 wait
    EXPECT_EQ(fates.of(15), Fate::kPending);
    sink.start();
    sink.stop();
    EXPECT_EQ(fates.of(1), Fate::kWritten);
    EXPECT_EQ(fates.of(15), Fate::kWritten);
    EXPECT_EQ(fates.of(2), Fate::kNoFile);
    EXPECT_EQ(fates.of(17), Fate::kLost);
    EXPECT_EQ(fates.of(19), Fate::kLost);
    EXPECT_EQ(fates.of(21), Fate::kNoFile);
}

TEST(FrameFates, TheNewestFramesAreKnown) {
    using Fate = FrameFates::Fate;
    FrameFates fates;
    int news = 0;
    fates.listen([&] { ++news; });
    for (std::uint64_t id = 10; id <= 20480; id += 10) fates.expect(id);
    EXPECT_EQ(fates.of(10240), Fate::kNoFile);
    EXPECT_EQ(fates.of(10250), Fate::kPending);
    fates.settle(10250, true), fates.settle(20480, false), fates.settle(7, true);
    EXPECT_EQ(fates.of(10250), Fate::kWritten);
    EXPECT_EQ(fates.of(20480), Fate::kLost);
    EXPECT_EQ(news, 3);
}

TEST_F(FilesSinkTest, FilesAreNamedByThePatternAndAViewLiesBesideEach) {
    FilesConfig config;
    config.folder = folder_;
    config.name = "cam{camera}_%03d.png";
    config.view = true;
    FilesSink sink(config, 8, 4, PictureRun{});
    sink.start();
    publish(sink, 2);
    sink.stop();
    EXPECT_EQ(sink.report().fault, "");
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"cam1_001.png", "cam1_001.view.png", "cam1_002.png",
                                            "cam1_002.view.png"}));
}

TEST(FilesConfig, ANameThatOverwritesItselfIsRefused) {
    FilesConfig config;
    config.name = "frame.png";
    EXPECT_THROW(validate(config), InputError);
    config.name = "frame_%d.png";
    EXPECT_NO_THROW(validate(config));
    config.format = FilesConfig::Format::kFits;
    EXPECT_THROW(validate(config), InputError);
}

TEST_F(FilesSinkTest, AnotherRunsFramesAreRefusedOrReplacedAsAWhole) {
    FilesConfig config;
    config.folder = folder_ / "frames";
    const auto run = [&](std::uint64_t last) {
        FilesSink sink(config, 8, 4, PictureRun{});
        sink.start();
        publish(sink, last);
        sink.stop();
    };
    run(5);
    write("frames/notes.txt", "mine");
    write("frames/frame_1.png", "mine, too");
    EXPECT_EQ(
        error_of([&] { run(2); }),
        "outputs.files.folder: found '" + config.folder.string() +
            "', which holds 5 files of another run ('frame_00000001.png' is the first); accepted: an empty "
            "folder, another folder, or outputs.files.overwrite: true, which replaces all of them");
    config.format = FilesConfig::Format::kTiff;
    EXPECT_THAT(error_of([&] { run(2); }), HasSubstr("holds 5 files of another run"));
    config.overwrite = true;
    run(2);
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(config.folder))
        names.insert(entry.path().filename());
    EXPECT_THAT(names, testing::ElementsAre("frame_00000001.tiff", "frame_00000002.tiff", "frame_1.png",
                                            "notes.txt"));
}

TEST_F(FilesSinkTest, AnotherRunsFramesAreFoundByTheirPattern) {
    FilesConfig config;
    config.folder = folder_ / "frames";
    config.name = "left({camera})_%04d";
    std::filesystem::create_directory(config.folder);
    write("frames/left(1)_0007.view.png", "a run's");
    EXPECT_THAT(error_of([&] { FilesSink(config, 8, 4, PictureRun{}); }), HasSubstr("left(1)_0007.view.png"));
    config.name = "right({camera})_%04d";
    EXPECT_NO_THROW(FilesSink(config, 8, 4, PictureRun{}));
    config.name = "left({camera})_%05d";
    EXPECT_NO_THROW(FilesSink(config, 8, 4, PictureRun{}));
}

TEST_F(FilesSinkTest, OfTwoRunsThatAreMadeBeforeEitherBeginsTheSecondIsRefused) {
    FilesConfig config;
    config.folder = folder_ / "frames";
    FilesSink first(config, 8, 4, PictureRun{}), second(config, 8, 4, PictureRun{});
    first.start();
    publish(first, 1);
    first.stop();
    EXPECT_THAT(error_of([&] { second.start(); }),
                HasSubstr("holds a file of another run ('frame_00000001.png')"));
}

}  // namespace
}  // namespace hilcam
