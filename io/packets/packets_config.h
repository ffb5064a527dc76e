#pragma once
// The keys of outputs.packets.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/contract/output_shape.h"
#include "io/contract/run_folder.h"
#include "io/contract/when_slow.h"
#include "io/packets/payload.h"
#include "io/packets/spacewire.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct PacketsConfig {
    static constexpr const char* kKey = "packets";
    static constexpr const char* kMeaning = "frames as CCSDS space packets (docs/packets.md)";

    enum class Transport : std::uint8_t { kUdp, kTcp, kTcpServer, kUnix, kUnixServer, kUsb, kFile, kFiles };

    Transport transport = Transport::kUdp;
    std::string address = "127.0.0.1";
    std::int64_t port = 5020;
    std::vector<std::string> allow{};
    std::int64_t clients = 8;
    std::filesystem::path path;
    std::filesystem::path folder = "packets";
    bool overwrite = false;

    std::int64_t apid = 0x110;
    std::int64_t packet_bytes = 1400;
    bool crc = true;
    Payload payload = Payload::kRawLittleEndian;
    std::int64_t strip_rows = 0;
    bool has_spacewire = false;
    SpaceWireConfig spacewire{};

    std::int64_t every_nth = 1;
    double rate_bytes_s = 100e6;
    double patience_s = 5;
    WhenSlow when_slow = WhenSlow::kAuto;

    bool has_address() const {
        return transport == Transport::kUdp || transport == Transport::kTcp ||
               transport == Transport::kTcpServer;
    }
    bool has_path() const {
        return transport == Transport::kUnix || transport == Transport::kUnixServer ||
               transport == Transport::kUsb;
    }
    bool is_server() const {
        return transport == Transport::kTcpServer || transport == Transport::kUnixServer;
    }
    bool is_tcp_server() const { return transport == Transport::kTcpServer; }
    bool has_folder() const { return transport == Transport::kFile || transport == Transport::kFiles; }
};
Fields fields(PacketsConfig& config);
void validate(const PacketsConfig& config);
// Returns the port of a TCP server.
std::vector<ListeningPort> listening(const PacketsConfig& config);
// Returns the folder of files; one without a path where packets go elsewhere.
RunFolder run_folder(const PacketsConfig& config);
// True when frames go to clients as they are made, which must not wait for a disk.
bool is_live(const PacketsConfig& config);

// Names of files in the folder.
inline constexpr const char* kPacketsFile = "packets.bin";
std::string packets_file_of(std::uint64_t frame);  // "frame_00000001.bin"

}  // namespace hilcam
