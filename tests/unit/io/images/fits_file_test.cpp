#include "io/images/fits_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// The value of a card, without its comment.
std::string card(const std::string& fits, const std::string& key) {
    std::string name = key;
    name.resize(8, ' ');
    for (std::size_t at = 0; at + 80 <= fits.size(); at += 80) {
        const std::string line = fits.substr(at, 80);
        if (line.starts_with("END     ")) break;
        if (!line.starts_with(name + "=")) continue;
        const std::string value = line.substr(10, line.find(" / ") - 10);
        const std::size_t first = value.find_first_not_of(' ');
        return first == std::string::npos ? "" : value.substr(first, value.find_last_not_of(' ') + 1 - first);
    }
    return "none";
}
std::size_t header_bytes(const std::string& fits) {
    for (std::size_t at = 0; at + 80 <= fits.size(); at += 80)
        if (fits.compare(at, 8, "END     ") == 0) return (at / 2880 + 1) * 2880;
    return 0;
}

TEST(FitsFile, IsWholeBlocksOfNumbersWithoutSign) {
    DnImage frame(3, 2);
    const std::uint16_t dn[] = {0, 1, 4095, 32768, 65535, 77};
    std::copy(std::begin(dn), std::end(dn), frame.all().begin());
    const std::string fits = encode_fits(frame, {{}, "adu", {}});
    EXPECT_EQ(fits.size() % 2880, 0u);
    EXPECT_EQ(fits.substr(0, 80).substr(0, 30), "SIMPLE  =                    T");
    EXPECT_EQ(card(fits, "BITPIX"), "16");
    EXPECT_EQ(card(fits, "NAXIS1"), "3");
    EXPECT_EQ(card(fits, "NAXIS2"), "2");
    EXPECT_EQ(card(fits, "BZERO"), "32768");
    EXPECT_EQ(card(fits, "BUNIT"), "'adu     '");
    EXPECT_EQ(card(fits, "ROWORDER"), "'TOP-DOWN'");
    EXPECT_EQ(card(fits, "CTYPE1"), "none");
    const std::size_t at = header_bytes(fits);
    for (std::size_t i = 0; i < 6; ++i) {
        const auto high = static_cast<std::uint8_t>(fits[at + 2 * i]),
                   low = static_cast<std::uint8_t>(fits[at + 2 * i + 1]);
        EXPECT_EQ(static_cast<std::int16_t>(high << 8 | low) + 32768, dn[i]);
    }
}

TEST(FitsFile, ElectronsAreFloats) {
    ElectronImage electrons(1, 1);
    electrons.all()[0] = -1.5f;
    const std::string fits = encode_fits(electrons, {{}, "electron", {}});
    EXPECT_EQ(card(fits, "BITPIX"), "-32");
    EXPECT_EQ(card(fits, "BZERO"), "none");
    EXPECT_EQ(fits.substr(header_bytes(fits), 4), std::string("\xBF\xC0\0\0", 4));
}

TEST(FitsFile, CardsHoldTextsNumbersAndTimesAsTheStandardHasThem) {
    const PictureNotes notes = {
        {"a", "A", std::string("it's\n\xC3\x84"), "what it is"},
        {"b", "B", 5.0, ""},
        {"c", "C", -1.25e-7, ""},
        {"d", "D", std::vector{1.0, 2.5}, ""},
        {"e", "E", std::nan(""), ""},
        {"f", "F", std::string(100, 'x'), ""},
        {"time_tai_ns", "TAI_NS", parse_utc("2026-03-20T12:00:00Z").ns, ""},
        {"exposure_s", "EXPTIME", 3.0, ""},
    };
    const std::string fits = encode_fits(DnImage(1, 1), {notes, "adu", {}});
    EXPECT_EQ(card(fits, "A"), "'it''s\?\?\?'");
    EXPECT_EQ(card(fits, "B"), "5.0");
    EXPECT_EQ(card(fits, "C"), "-1.25E-07");
    EXPECT_EQ(card(fits, "D1"), "1.0");
    EXPECT_EQ(card(fits, "D2"), "2.5");
    EXPECT_EQ(card(fits, "E"), "none");
    EXPECT_EQ(card(fits, "F"), "'" + std::string(68, 'x') + "'");
    EXPECT_EQ(card(fits, "DATE-OBS"), "'2026-03-20T11:59:58.500000'");
    EXPECT_EQ(card(fits, "DATE-AVG"), "'2026-03-20T12:00:00.000000'");
    EXPECT_EQ(card(fits, "DATE-END"), "'2026-03-20T12:00:01.500000'");
    EXPECT_EQ(card(fits, "TIMESYS"), "'UTC     '");
    FitsHeader sky{notes, "adu", SkyMap{}};
    EXPECT_THAT(encode_fits(DnImage(1, 1), sky),
                HasSubstr("COMMENT Stars are seen aberrated by the camera's velocity; the WCS is its       "
                          "COMMENT attitude's."));
}

// The direction that a pixel has by the map, after Calabretta & Greisen (2002), sections 2 and 5.
Vec3d direction_by(const SkyMap& map, Vec2d fits_px) {
    const double dx = fits_px.x - map.reference_px.x, dy = fits_px.y - map.reference_px.y;
    const double east = (map.east_deg_px[0] * dx + map.east_deg_px[1] * dy) * kPi / 180;
    const double north = (map.north_deg_px[0] * dx + map.north_deg_px[1] * dy) * kPi / 180;
    const double radius = std::hypot(east, north);
    const double off = map.fisheye ? radius : std::atan(radius);  // from the boresight
    const double ra = map.ra_deg * kPi / 180, dec = map.dec_deg * kPi / 180;
    const Vec3d ahead{std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
    const Vec3d to_east{-std::sin(ra), std::cos(ra), 0};
    const Vec3d to_north{-std::sin(dec) * std::cos(ra), -std::sin(dec) * std::sin(ra), std::cos(dec)};
    const Vec3d side = radius > 0 ? (east / radius) * to_east + (north / radius) * to_north : Vec3d{};
    return std::cos(off) * ahead + std::sin(off) * side;
}

TEST(SkyMap, IsTheLensWithoutItsDistortion) {
    CameraModel model;
    model.width_px = 100, model.height_px = 80;
    model.pitch_m = 1e-5, model.focal_length_m = 0.0005;  // 50 px: wide
    model.principal_point_px = {40, 45};
    model.black_columns = 4;
    for (const Projection projection : {Projection::kRectilinear, Projection::kFisheye})
        for (const Quat& attitude :
             {Quat{1, 0, 0, 0}, normalized({0.3, -0.4, 0.8, 0.1}), normalized({-0.2, 0.9, 0.1, 0.3})})
            for (const bool mirrored : {false, true}) {
                model.projection = projection;
                const PictureLayout layout{{2, 2, mirrored, false}, 1};
                const SkyMap map = sky_map({{}, attitude}, model, layout);
                const ImageGeometry geometry = geometry_of(model, 0);
                const FrameRaster raster = raster_of(model, 1, layout.frame);
                for (const Vec2d frame_px : {Vec2d{0.5, 0.5}, Vec2d{20, 10}, Vec2d{51.5, 39.5}}) {
                    const Vec2d image_px = raster.image_px(frame_px);
                    const Vec3d camera = geometry.direction_camera(image_px.x, image_px.y);
                    const Vec3d expected = to_matrix(attitude) * (1 / length(camera) * camera);
                    const Vec3d found = direction_by(map, {frame_px.x + 0.5, frame_px.y + 0.5});
                    EXPECT_LT(length(found - expected), 1e-12);
                }
            }
}

}  // namespace
}  // namespace hilcam
