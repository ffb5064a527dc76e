// A station with everything that a spacecraft has, and ground, taken apart (render/vocabulary/light_parts.h) at the shipped qualities:
// the pictures stay the same, and the parts are what they are made of.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "emulator/run/still_camera.h"
#include "render/vocabulary/light_parts.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// The mesh of a station about the geostationary place of 10 degrees east, in the world's axes. +c is the way to the camera, behind which
// the Sun stands, 40 degrees to the left; the Earth is behind the station.
class StationMesh {
  public:
    StationMesh() {
        // Foil, and a white wall on its right edge that lights it.
        add("foil", {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
        add("white", {1, -1, 0}, {0, 0, 1.5}, {0, 2, 0});
        // A mirror below it, out of which the Sun shines on the foil's middle; another that shows the fin at its side.
        const Vec3d normal = normalized(Vec3d{-0.643, 0.8, 0.166}),
                    along = normalized(cross(normal, Vec3d{1, 0, 0}));
        const Vec3d across = cross(along, normal);
        add("mirror", Vec3d{0, -2, 1.5} - 0.4 * along - 0.4 * across, 0.8 * across, 0.8 * along);
        add("mirror", {1.3, -0.8, 0}, {1.3, 0, 0}, {0, 1.6, 0});
        add("white", {2.6, -0.8, 0}, {0, 0, 0.8}, {0, 1.6, 0});
        // A window before a white wall, a polished plate beside a fin, cells, and something hot.
        add("window", {-1, 1.2, 0.5}, {2, 0, 0}, {0, 1.2, 0});
        add("white", {-1, 1.2, 0}, {2, 0, 0}, {0, 1.2, 0});
        add("polished", {-3.2, 1, 0}, {1.8, 0, 0}, {0, 1.4, 0});
        add("white", {-1.4, 1, 0}, {0, 0, 0.5}, {0, 1.4, 0});
        add("cells", {-3.2, -0.8, 0}, {1.8, 0, 0.4}, {0, 1.6, 0});
        add("hot", {1.5, -3, 0}, {1, 0, 0}, {0, 0.4, 0});
    }
    const std::string& text() const { return text_; }

    static Vec3d world(Vec3d at) { return at.x * kRight + at.y * Vec3d{0, 0, 1} + at.z * kToCamera; }
    static constexpr Vec3d kToCamera{0.766, 0.643, 0}, kRight{-0.643, 0.766, 0};

  private:
    std::string text_;
    int vertices_ = 0;

    void add(const std::string& surface, Vec3d corner, Vec3d a, Vec3d b) {
        for (const Vec3d at : {corner, corner + a, corner + a + b, corner + b}) {
            const Vec3d v = world(at);
            text_ +=
                "v " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
        }
        const auto number = [&](int i) { return ' ' + std::to_string(vertices_ + i); };
        text_ += "usemtl " + surface + "\nf" + number(1) + number(2) + number(3) + "\nf" + number(1) +
                 number(3) + number(4) + '\n';
        vertices_ += 4;
    }
};

class PartsOfPictures : public FilesTest {
  protected:
    ScenarioConfig station(const std::string& quality, const std::vector<std::string>& more = {}) {
        write("station.obj", StationMesh().text());
        write("speck.obj", "v 0 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 3 2\n");
        const auto list = [](Vec3d at) {
            const Vec3d v = StationMesh::world(at);
            return '[' + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ']';
        };
        const auto file = write(
            "station.yaml",
            "time_utc: 2026-03-20T14:00:00Z\n"
            "origin: {kind: earth_fixed, longitude_deg: 10, latitude_deg: 0, height_km: 35786}\n"
            "camera: {name: test, width_px: 72, height_px: 72, pitch_um: 10, focal_length_mm: 0.9, f_number: "
            "8, "
            "transmission: 0.1,\n"
            "  quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 0.2}\n"
            "camera_pose: {position_m: " +
                list({0, 0, 10}) +
                ", attitude: look_at, look_at_m: [0, 0, 0], up: [0, 0, 1]}\n"
                "objects:\n"
                "  - name: station\n"
                "    mesh: station.obj\n"
                "    materials:\n"
                "      surfaces:\n"
                "        - {name: foil, material: {model: metal, reflectance: 0.8, roughness: 0.6}}\n"
                "        - {name: white, material: {reflectance: 0.8}}\n"
                "        - {name: mirror, material: {model: mirror, reflectance: 0.9}}\n"
                "        - {name: window, material: {model: glass, refractive_index: 1.5, transmittance: "
                "0.9}}\n"
                "        - {name: polished, material: {model: metal, reflectance: 0.9, roughness: 0.28}}\n"
                "        - {name: cells, material: {model: dielectric, reflectance: 0.1, roughness: 0.4}}\n"
                "        - {name: hot, material: {reflectance: 0.1, temperature_k: 2500}}\n"
                "  - {name: speck, mesh: speck.obj, pose: {position_m: " +
                list({-3, -3, 0}) +
                "}}\n"
                "lamps:\n"
                "  - {name: flood, on: station, position_m: " +
                list({-0.5, 0, 1.2}) + ", axis: " + list({0, 0, -1}) +
                ", intensity_w_sr_um: 200, beam_angle_deg: 60}\n"
                "radiance: emissive\n"
                "earth: {albedo: 0.3}\nmoon: {visible: false}\n"
                "spectrum_edges_um: [0.45, 0.55, 0.7]\nquality: " HILCAM_SOURCE_DIR "/configs/quality/" +
                quality + ".yaml\n");
        std::vector<std::string> overrides = {"quality.probes=1500", "quality.guard_px=8"};
        overrides.insert(overrides.end(), more.begin(), more.end());
        return load_scenario(file, overrides);
    }
    static ScenarioConfig landing(const std::string& step_px) {
        const std::vector<std::string> overrides = {
            "camera.width_px=128", "camera.height_px=96", "camera.pitch_um=44",
            "terrain.edge_px=6",   "quality.guard_px=8",  "quality.ground_step_px=" + step_px};
        return load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/lunar_landing.yaml", overrides);
    }
};

constexpr RandomKey kKey{1, 1};
std::vector<float> values_of(const RadianceImage& image) { return {image.all().begin(), image.all().end()}; }

// A picture with its parts, and the same without.
struct TakenApart {
    StillCamera camera;
    std::vector<float> without, with;
    PartsBuffer buffer;
    const LightParts& parts = buffer.parts;

    explicit TakenApart(const ScenarioConfig& s, StillCamera::Light light = StillCamera::Light::kRadiance)
        : camera(s, 0, light),
          without(values_of(camera.render(kKey))),
          buffer(camera.renderer().make_parts_buffer(camera.radiance())) {
        camera.renderer().keep_parts(&buffer);
        with = values_of(camera.render(kKey));
        camera.renderer().keep_parts(nullptr);
    }
    std::span<const float> of(std::size_t part) const { return parts.of(static_cast<LightPart>(part)).all(); }
    bool has(LightPart part) const {
        const auto all = parts.of(part).all();
        return std::any_of(all.begin(), all.end(), [](float value) { return value > 0; });
    }
};

// Single precision's distance from a number to the next.
double ulp(float value) {
    return static_cast<double>(std::nextafter(value, std::numeric_limits<float>::infinity()) - value);
}

// Holds the sum of parts against the picture, and the parts against nothing. Returns by how many units in the last place of the largest
// part of a pixel the sum is off at most.
double ulps_off(const TakenApart& apart, const std::string& what) {
    const RadianceImage sum = apart.parts.sum();
    double most = 0;
    std::size_t negative = 0;
    for (std::size_t i = 0; i < apart.with.size(); ++i) {
        float largest_part = 0;
        for (std::size_t part = 0; part < kImageParts; ++part) {
            const float value = apart.of(part)[i];
            largest_part = std::max(largest_part, value);
            negative += value < -1e-6f * apart.with[i] ? 1u : 0u;
        }
        const double off = std::abs(static_cast<double>(sum.all()[i]) - static_cast<double>(apart.with[i]));
        most = std::max(most, off > 0 ? off / ulp(largest_part) : 0.0);
    }
    EXPECT_EQ(negative, 0u) << what;
    return most;
}

constexpr std::array kOfStation = {LightPart::kEmission,     LightPart::kSun,         LightPart::kLamps,
                                   LightPart::kPlanetshine,  LightPart::kMirroredSun, LightPart::kDiffuse,
                                   LightPart::kGlossy,       LightPart::kGlossyRays,  LightPart::kMirrorRays,
                                   LightPart::kTransmission, LightPart::kBackground,  LightPart::kPoints};

TEST_F(PartsOfPictures, AreAllOfAStationAtEachQuality) {
    for (const char* const quality : {"realtime", "still", "fast"}) {
        const TakenApart apart(station(quality));
        EXPECT_EQ(apart.without, apart.with) << quality;
        const double off = ulps_off(apart, quality);
        RecordProperty(std::string("ulps_") + quality, std::to_string(off));
        EXPECT_LE(off, 8) << quality;
        for (const LightPart part : kOfStation) {
            // A polished plate's four rays have less than half of white paint's light each.
            if (part == LightPart::kGlossyRays && quality == std::string("fast")) continue;
            EXPECT_TRUE(apart.has(part)) << quality << ": " << name_of(part);
        }
    }
}

// What a detector's channels make of the light is taken apart as well.
TEST_F(PartsOfPictures, AreThoseOfChargeRatesAsWell) {
    const TakenApart apart(
        station("realtime", {"camera.color_filter=" HILCAM_SOURCE_DIR "/configs/filters/RGGB.yaml"}),
        StillCamera::Light::kCharge);
    EXPECT_EQ(apart.without, apart.with);
    EXPECT_EQ(apart.parts.of(LightPart::kSun).planes(), 3);
    EXPECT_LE(ulps_off(apart, "charge"), 8);
}

TEST_F(PartsOfPictures, DoNotDependOnTheThreadCount) {
    const auto parts = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const TakenApart apart(station("realtime"));
        std::vector<std::vector<float>> out;
        for (std::size_t part = 0; part < kLightParts; ++part)
            out.emplace_back(apart.of(part).begin(), apart.of(part).end());
        return out;
    };
    EXPECT_EQ(parts(1), parts(3));
}

// Ground that is alone is lit by the Sun, by every pixel and by every second one.
TEST_F(PartsOfPictures, OfGroundAloneAreTheSuns) {
    for (const char* const step_px : {"1", "2"}) {
        const TakenApart apart(landing(step_px));
        EXPECT_EQ(apart.without, apart.with) << step_px;
        EXPECT_TRUE(apart.has(LightPart::kSun)) << step_px;
        EXPECT_EQ(values_of(apart.parts.of(LightPart::kSun)), apart.with) << step_px;
        EXPECT_EQ(ulps_off(apart, step_px), 0) << step_px;
    }
}

}  // namespace
}  // namespace hilcam
