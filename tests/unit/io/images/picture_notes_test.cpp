#include "io/images/picture_notes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/contract/frame_flags.h"
#include "io/images/image_file.h"
#include "io/system/input_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A camera of 8 x 6 px whose boresight is 1 px to the right of the middle; a frame of 10 ms, noon in 2026.
PictureRun run_of_camera() {
    PictureRun run{"hilcam 1.2.3", "a scenario", 2, 77, {}, SpectralGrid({0.5, 0.7})};
    run.model.name = "\xC3\x84ther";
    run.model.width_px = 8, run.model.height_px = 6;
    run.model.pitch_m = 1.0 / 65536, run.model.focal_length_m = 1.0 / 64;  // 1024 px, without rounding
    run.model.principal_point_px = {5, 3};
    return run;
}
FrameRecord record_of_frame() {
    FrameRecord record;
    record.id = 12;
    record.exposure_mid = parse_utc("2026-03-20T12:00:00Z");
    record.exposure_s = 0.01;
    record.gain_db = 6;
    record.black_level_dn = 64.5;
    record.bits = 12;
    record.camera = Pose{{1, -2, 3e9}, {-0.5, 0.5, 0.5, 0.5}};
    return record;
}
PictureNotes notes() {
    const FrameRecord record = record_of_frame();
    return notes_of(run_of_camera(), record, layout_of(record), "DN");
}
// As other programs would read them.
json values() { return json::parse(json_of(notes())); }

TEST(PictureNotes, SayWhenHowAndFromWhereItWasTaken) {
    const json v = values();
    EXPECT_EQ(v["software"], "hilcam 1.2.3");
    EXPECT_EQ(v["scenario"], "a scenario");
    EXPECT_EQ(v["camera"], 2);
    EXPECT_EQ(v["camera_name"], "\xC3\x84ther");
    EXPECT_EQ(v["seed"], 77);
    EXPECT_EQ(v["frame"], 12);
    EXPECT_EQ(v["unit"], "DN");
    EXPECT_EQ(v["bits"], 12);
    EXPECT_EQ(v["time_utc"], "2026-03-20T12:00:00.000Z");
    EXPECT_EQ(v["time_tai_ns"], record_of_frame().exposure_mid.ns);
    EXPECT_EQ(v["exposure_s"], 0.01);
    EXPECT_EQ(v["gain_db"], 6);
    EXPECT_EQ(v["black_level_dn"], 64.5);
    EXPECT_EQ(v["position_m"], json({1, -2, 3e9}));
    EXPECT_EQ(v["attitude_wxyz"], json({0.5, -0.5, -0.5, -0.5}));  // the same attitude, scalar positive
    EXPECT_EQ(v["focal_length_px"], json({1024, 1024}));
    EXPECT_EQ(v["principal_point_px"], json({5, 3}));
    EXPECT_EQ(v["projection"], "rectilinear");
    EXPECT_FALSE(v.contains("distortion"));
    EXPECT_FALSE(v.contains("faults"));
}

TEST(PictureNotes, SayTheNumberOfAPixelWithoutLight) {
    PictureRun run = run_of_camera();
    run.model.bits = 12;
    FrameRecord record = record_of_frame();
    record.black_level_dn = 60, record.binning_x = 2, record.binning_y = 3;
    const auto black = [&] {
        return json::parse(json_of(notes_of(run, record, layout_of(record), "DN")))["black_level_dn"];
    };
    EXPECT_EQ(black(), 60) << "charge meets before it is read";
    run.model.binning = BinningKind::kMean;
    EXPECT_EQ(black(), 60);
    run.model.binning = BinningKind::kSum;
    EXPECT_EQ(black(), 360);
    run.model.converter.companding = Companding::kSquareRoot;
    EXPECT_EQ(black(), std::round(255 * std::sqrt(360 / 4095.0)));
}

// Terms are those of places in units of the focal length, here of 1/64 m.
TEST(PictureNotes, SayALensThatIsAPolynomial) {
    PictureRun run = run_of_camera();
    run.model.distortion_x_mm = {0, 0, 0, 0.5}, run.model.distortion_y_mm = {0.25};
    const FrameRecord record = record_of_frame();
    const json v = json::parse(json_of(notes_of(run, record, layout_of(record), "DN")));
    EXPECT_EQ(v["distortion_x"], json({0, 0, 0, 0.5 * 1000 / 64, 0, 0}));
    EXPECT_EQ(v["distortion_y"], json({0.25 * 64 / 1000, 0, 0, 0, 0, 0}));
    EXPECT_FALSE(values().contains("distortion_x"));
}

TEST(PictureNotes, ABinnedMirroredFrameHasItsOwnLens) {
    FrameRecord record = record_of_frame();
    record.binning_x = record.binning_y = 2;
    record.reverse_x = true;
    record.faults = kPosesStaleBit;
    record.camera.reset();
    const json v = json::parse(json_of(notes_of(run_of_camera(), record, layout_of(record), "DN")));
    EXPECT_EQ(v["focal_length_px"], json({-512, 512}));
    EXPECT_EQ(v["principal_point_px"], json({1.5, 1.5}));  // of 4 px, 5 / 2 from the other side
    EXPECT_EQ(v["binning"], json({2, 2}));
    EXPECT_EQ(v["reverse"], json({1, 0}));
    EXPECT_EQ(v["faults"], "poses_stale");
    EXPECT_FALSE(v.contains("position_m"));
}

class PictureNotesInFiles : public FilesTest {
  protected:
    std::string written(const std::string& name, const DnImage& frame) {
        PictureWriter(run_of_camera()).write_frame(folder_ / name, frame, record_of_frame());
        return read_input_file(folder_ / name, {1 << 20, "a picture"});
    }
};

TEST_F(PictureNotesInFiles, EachFormatHasThemAndTheSamePictureIsTheSameBytes) {
    DnImage frame(8, 6);
    frame.row(2)[3] = 4095;
    const std::string png = written("a.png", frame), tiff = written("a.tiff", frame),
                      fits = written("a.fits", frame);
    EXPECT_THAT(png, HasSubstr(std::string("tEXtseed\0"
                                           "77",
                                           11)));
    EXPECT_THAT(png, HasSubstr(std::string("tEXtSoftware\0hilcam 1.2.3", 25)));
    EXPECT_THAT(png, HasSubstr(std::string("iTXtcamera_name\0\0\0\0\0\xC3\x84ther", 26)));
    EXPECT_THAT(png, HasSubstr("[0.5,-0.5,-0.5,-0.5]"));
    EXPECT_THAT(tiff, HasSubstr(json_of(notes())));
    EXPECT_THAT(tiff, HasSubstr("2026:03:20 12:00:00"));
    EXPECT_THAT(fits, HasSubstr("SEED    =                   77 / of the run's random numbers"));
    EXPECT_EQ(png, written("b.png", frame));
    EXPECT_EQ(tiff, written("b.tiff", frame));
    EXPECT_EQ(fits, written("b.fits", frame));
}

TEST_F(PictureNotesInFiles, ARawFileIsTheCamerasMemoryAlone) {
    EXPECT_EQ(written("a.raw", DnImage(8, 6)).size(), 96u);
}

TEST(DarkPictureWarning, IsForNumbersOfMoreThanEightBitsInPngAndTiff) {
    EXPECT_EQ(dark_picture_warning("a.png", 12, "--view"),
              "a.png: 12-bit DN right-aligned in 16 bits, dark in a viewer; --view");
    EXPECT_NE(dark_picture_warning("a.tiff", 10, "--view"), "");
    EXPECT_EQ(dark_picture_warning("a.png", 8, "--view"), "");
    EXPECT_EQ(dark_picture_warning("a.fits", 12, "--view"), "");
    EXPECT_EQ(dark_picture_warning("a.raw", 12, "--view"), "");
}

}  // namespace
}  // namespace hilcam
