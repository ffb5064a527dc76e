#include "emulator/recording/recording_header.h"

#include <fstream>

#include "emulator/recording/machine_report.h"
#include "emulator/recording/program_version.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/system/crc32.h"

namespace hilcam {
namespace {

std::uint32_t crc_of_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::vector<std::uint8_t> piece(1u << 16);
    std::uint32_t crc = 0;
    while (in) {
        in.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
        crc = crc32_of(std::span(piece).first(static_cast<std::size_t>(in.gcount())), crc);
    }
    return crc;
}

}  // namespace

RecordingHeader recording_header(const ScenarioConfig& scenario) {
    RecordingHeader header;
    header.program = kProgramVersion;
    header.build = crc_of_file("/proc/self/exe");
    header.processor = processor_name();
    header.start = parse_utc(scenario.time_utc);
    header.cameras = static_cast<std::uint16_t>(1 + scenario.more_cameras.size());
    header.lockstep = scenario.mode == CameraMode::kLockstep;
    header.scenario = scenario_listing(scenario);
    return header;
}

std::vector<std::string> recording_warnings(const ScenarioConfig& scenario) {
    std::vector<std::string> out;
    if (scenario.terrain && !scenario.terrain->wait)
        out.push_back(
            "terrain comes when it is ready, so a replay may show it differently; 'terrain.wait: true' makes "
            "frames wait for it");
    return out;
}

}  // namespace hilcam
