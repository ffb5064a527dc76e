#include "io/packets/packets_config.h"

#include <arpa/inet.h>

#include <array>
#include <cstdio>

#include "io/packets/image_segmenter.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// IPv4's 65,535 bytes without the headers of IP and UDP.
constexpr std::int64_t kMostDatagramBytes = 65507;
constexpr std::int64_t kFewestPacketBytes = 128;

Field only(const PacketsConfig& c, bool (PacketsConfig::*has)() const, const char* transports, Field field) {
    field.why_idle = [&c, has, transports]() -> std::string {
        return (c.*has)() ? "" : std::string("only ") + transports + " has it";
    };
    return field;
}
Field addressed(const PacketsConfig& c, Field field) {
    return only(c, &PacketsConfig::has_address, "transport udp, tcp or tcp_server", std::move(field));
}
Field foldered(const PacketsConfig& c, Field field) {
    return only(c, &PacketsConfig::has_folder, "transport file or files", std::move(field));
}

bool is_ipv4(const std::string& text) {
    in_addr address{};
    return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

Fields transport_fields(PacketsConfig& c) {
    return {
        choice("transport", c.transport,
               {"udp", "tcp", "tcp_server", "unix", "unix_server", "usb", "file", "files"},
               "udp: one packet a datagram; tcp, unix: hilcam connects to a listener; tcp_server, "
               "unix_server: clients connect to hilcam; usb: bulk transfers to a host, by FunctionFS; file: "
               "one file of all packets; files: one file a frame"),
        addressed(c, text("address", c.address,
                          "IPv4 address of the receiver; tcp_server: the own address to listen on")),
        addressed(c, integer("port", c.port, {1, 65535}, "UDP or TCP port there")),
        only(
            c, &PacketsConfig::is_tcp_server, "transport tcp_server",
            texts(
                "allow", c.allow,
                "clients that may connect: IPv4 addresses and networks, or any; required when the address is "
                "not loopback")),
        only(c, &PacketsConfig::is_server, "transport tcp_server or unix_server",
             integer("clients", c.clients, {1, 1000},
                     "largest number of connections at a time; further ones are closed at once")),
        only(c, &PacketsConfig::has_path, "transport unix, unix_server or usb",
             path("path", c.path, "path of the Unix socket; usb: mount point of FunctionFS")),
        foldered(c, path("folder", c.folder,
                         "folder of the files, created if missing: packets.bin, or frame_00000001.bin, ...")),
        foldered(c, flag("overwrite", c.overwrite,
                         "treatment of a folder with packets of another run. false: it is refused; true: the "
                         "files are removed first")),
    };
}

}  // namespace

Fields fields(PacketsConfig& c) {
    Fields list = transport_fields(c);
    const Fields rest = {
        integer("apid", c.apid, {0, 2046},
                "application process identifier of the packets; 2047 is that of idle packets"),
        integer("packet_bytes", c.packet_bytes,
                {kFewestPacketBytes, static_cast<double>(ImageSegmenter::kMostPacketBytes)},
                "longest packet, headers and CRC included, without SpaceWire's bytes"),
        flag("crc", c.crc, "true: each packet ends with a CRC-16 (packet error control of ECSS-E-ST-70-41C)"),
        choice("payload", c.payload, {"raw_le", "raw_be", "packed", "ccsds_121", "jpeg_ls", "jpeg_2000"},
               "pixels in packets. raw_le, raw_be: 16 bits each, little- or big-endian; packed: the sensor's "
               "bits without gaps, as Mono12p; the others are lossless compressions by libaec, CharLS, "
               "OpenJPEG"),
        integer(
            "strip_rows", c.strip_rows, {0, 16384},
            "rows of a strip, which is compressed by itself, so that a lost packet spoils no other strip; "
            "0: the whole frame is one"),
        optional(section("spacewire", c.spacewire, "each packet goes into a SpaceWire packet, for bridges"),
                 c.has_spacewire),
        integer("every_nth", c.every_nth, {1, 1e9}, "number n of which every n-th frame is sent"),
        number("rate_limit_mb_s", c.rate_bytes_s, 1e6, {0.001, 100000},
               "upper limit of the data rate of sockets"),
        number("patience_s", c.patience_s, 1, {0.01, 3600},
               "time for which a receiver may take nothing; then it is disconnected"),
        when_slow(c.when_slow),
    };
    list.insert(list.end(), rest.begin(), rest.end());
    return list;
}

void validate(const PacketsConfig& c) {
    if (c.has_address() && !is_ipv4(c.address))
        throw refused_key("address", in_quotes(c.address), "an IPv4 address, as 192.168.1.5");
    if (c.is_tcp_server()) AllowList(c.allow, c.address, "outputs.packets");
    if (c.has_path()) {
        if (c.path.empty())
            throw refused_key("path", "none", "the path of a Unix socket or, with usb, of FunctionFS");
        if (c.transport != PacketsConfig::Transport::kUsb)
            at_key("path", [&] { unix_address(c.path.string()); });
    }
    const std::int64_t added = c.has_spacewire ? static_cast<std::int64_t>(added_bytes(c.spacewire)) : 0;
    if (c.transport == PacketsConfig::Transport::kUdp && c.packet_bytes + added > kMostDatagramBytes)
        throw refused_key("packet_bytes", std::to_string(c.packet_bytes),
                          std::to_string(kMostDatagramBytes - added) + " at most in a UDP datagram");
    if (c.has_spacewire && c.spacewire.protocol == SpaceWireConfig::Protocol::kRmap &&
        c.spacewire.slots > 1 && c.packet_bytes > c.spacewire.slot_bytes)
        throw refused_key("packet_bytes", std::to_string(c.packet_bytes),
                          std::to_string(c.spacewire.slot_bytes) + " at most, as spacewire.slot_bytes");
}

std::vector<ListeningPort> listening(const PacketsConfig& c) {
    if (!c.is_tcp_server()) return {};
    return {{"outputs.packets.port", c.address, c.port}};
}

RunFolder run_folder(const PacketsConfig& c) {
    if (!c.has_folder()) return {};
    return {.key = "outputs.packets",
            .folder = c.folder,
            .is_own =
                [](std::string_view name) {
                    return name == kPacketsFile || (is_numbered(name, "frame") && name.ends_with(".bin"));
                },
            .overwrite = c.overwrite};
}

bool is_live(const PacketsConfig& c) { return !c.has_folder(); }

std::string packets_file_of(std::uint64_t frame) {
    std::array<char, 40> name{};
    std::snprintf(name.data(), name.size(), "frame_%08llu.bin", static_cast<unsigned long long>(frame));
    return name.data();
}

}  // namespace hilcam
