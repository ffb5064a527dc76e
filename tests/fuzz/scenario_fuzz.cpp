// Any scenario, with any files that it names, is refused in one line, or gives pictures of 8 x 8 px of numbers, at its start and long after.
//
// An input is a bundle: a line "#### NAME" begins each file, "scenario.yaml" among them. What a bundle may not have are programs and what
// takes long: generated meshes, plug-ins, terrain, air, stars.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/scene_loader.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "sensor/exposure.h"
#include "sensor/published_frame.h"

namespace {

using namespace hilcam;

constexpr std::string_view kBegin = "#### ";

struct Part {
    std::string name;
    std::string bytes;
};

std::vector<Part> parts_of(std::string_view bundle) {
    std::vector<Part> parts;
    while (bundle.starts_with(kBegin)) {
        bundle.remove_prefix(kBegin.size());
        const std::size_t line = std::min(bundle.find('\n'), bundle.size());
        Part& part = parts.emplace_back();
        part.name = bundle.substr(0, line);
        bundle.remove_prefix(std::min(line + 1, bundle.size()));
        const std::size_t next = bundle.find("\n" + std::string(kBegin));
        part.bytes = bundle.substr(0, next);
        bundle.remove_prefix(next == std::string_view::npos ? bundle.size() : next + 1);
    }
    return parts;
}

std::string bundle_of(const std::vector<Part>& parts) {
    std::string out;
    for (const Part& part : parts) {
        if (!out.empty()) out += '\n';
        out.append(kBegin).append(part.name).append("\n").append(part.bytes);
    }
    return out;
}

bool is_plain_name(const std::string& name) {
    return !name.empty() && name.size() < 40 && name[0] != '.' &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
           });
}

bool takes_long(const ScenarioConfig& s) {
    return s.terrain || s.stars || !s.plugins.empty() || s.objects.size() > 20 ||
           std::any_of(s.objects.begin(), s.objects.end(),
                       [](const ObjectConfig& o) { return o.generate.has_value(); });
}

// The loop's way from the world to the picture, at instants from the start to a century after.
void look_at(const ScenarioConfig& s) {
    const SpectralGrid grid(s.spectrum_edges_um);
    const auto renderer = load_renderer(s, grid, geometry_of(s.camera, 0, 1));
    const TimeTai start = parse_utc(s.time_utc);
    WorldState world(initial_motions(s, start), s.origin, joints_of(s), s.mount, load_motion_sources(s),
                     lamp_mounts(s));
    ExposureRenderer exposures(*renderer, exposure_config_of(s), s.camera, grid, world.placed_objects());
    RadianceImage radiance = exposures.make_image();
    std::vector<PointSource> points;
    points.reserve(exposures.max_points());
    TruthRequest wishes = truth_request(s);
    wishes.object = wishes.range = wishes.stars = true;
    FrameTruth truth = make_truth(s, *renderer, wishes);
    truth.raster = raster_of(s.camera, 1, {s.camera.binning_x, s.camera.binning_y});
    for (const std::int64_t seconds : {0LL, 330LL, 1'000'000LL, 3'000'000'000LL}) {
        Exposure exposure{s.camera.exposure_s, s.camera.gain_db};
        exposures.render(world, start + seconds * 1'000'000'000, {1, static_cast<std::uint64_t>(seconds + 1)},
                         radiance, points, exposure, &truth);
        for (const float value : radiance.all()) HILCAM_CHECK(std::isfinite(value));
        const WorldSnapshot& shown = exposures.middle_world();
        HILCAM_CHECK(is_possible(shown.camera));
        for (const Pose& pose : shown.objects) HILCAM_CHECK(is_possible(pose));
        HILCAM_CHECK(is_finite(shown.bodies.sun_world_m) && is_finite(truth.camera_velocity_m_s));
        for (const SeenThing& thing : truth.things)
            HILCAM_CHECK(is_finite(thing.position_camera_m) && std::isfinite(thing.distance_m));
    }
    HILCAM_CHECK(renderer->fault().empty());
}

void write(const std::filesystem::path& folder, const std::vector<Part>& parts) {
    for (const Part& part : parts)
        if (is_plain_name(part.name)) std::ofstream(folder / part.name, std::ios::binary) << part.bytes;
}

const std::vector<std::string> kCheap = {"camera.width_px=8",          "camera.height_px=8",
                                         "quality.guard_px=0",         "quality.oversampling=1",
                                         "quality.samples_per_axis=1", "quality.max_depth=2",
                                         "quality.path_model=direct",  "quality.visibility=rays",
                                         "earth.visible=false",        "moon.visible=false"};

// --- damage that reaches past the readers

constexpr std::array<const char*, 12> kExtremes = {"nan", "1e300", "-1e300", "1e18", "1.5e15", "-1e13",
                                                   "3e8", "0",     "1e-300", "-1",   "1e9",    "31"};

// Another number in a number's place, or another digit in it.
void change_number(std::string& text, std::mt19937& random) {
    const std::size_t from =
        text.find_first_of("0123456789", random() % std::max<std::size_t>(text.size(), 1));
    if (from == std::string::npos) return;
    if (random() % 2) {
        text[from] = static_cast<char>('0' + random() % 10);
        return;
    }
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE", from), text.size());
    text.replace(from, end - from, kExtremes[random() % kExtremes.size()]);
}

// The words of a kernel come after four records.
void change_word(std::string& bytes, std::mt19937& random) {
    constexpr std::array<double, 9> kWords = {
        1e300, -1e300, 1e18, 1.5e12, 3e5, 0, -1, 1e-300, std::numeric_limits<double>::quiet_NaN()};
    constexpr std::size_t kFirst = 4096;
    if (bytes.size() < kFirst + 8) return;
    char* const at = bytes.data() + kFirst + 8 * (random() % ((bytes.size() - kFirst) / 8));
    double word = 0;
    std::memcpy(&word, at, 8);
    word = random() % 2 ? word * std::pow(4, static_cast<double>(random() % 17) - 8)
                        : kWords[random() % kWords.size()];
    std::memcpy(at, &word, 8);
}

void change_byte(std::string& bytes, std::mt19937& random) {
    if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<char>(random());
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Part> parts = parts_of({reinterpret_cast<const char*>(data), size});
    if (parts.empty()) return size;
    for (auto count = 1 + random() % 2; count > 0; --count) {
        std::string& bytes = parts[random() % parts.size()].bytes;
        const bool binary = bytes.find('\0') != std::string::npos;
        if (random() % 16 == 0)
            change_byte(bytes, random);
        else
            binary ? change_word(bytes, random) : change_number(bytes, random);
    }
    const std::string bundle = bundle_of(parts);
    const std::size_t kept = std::min(bundle.size(), most);
    std::memcpy(data, bundle.data(), kept);
    return kept;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("hilcam_scenario_fuzz_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    write(folder, parts_of({reinterpret_cast<const char*>(data), size}));
    try {
        const ScenarioConfig scenario = load_scenario(folder / "scenario.yaml", kCheap);
        if (!takes_long(scenario)) look_at(scenario);
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    std::filesystem::remove_all(folder);
    return 0;
}
