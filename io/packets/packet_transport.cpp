#include "io/packets/packet_transport.h"

#include "io/packets/packets_config.h"

namespace hilcam {

std::unique_ptr<PacketTransport> make_packet_transport(const PacketsConfig& config) {
    using Transport = PacketsConfig::Transport;
    switch (config.transport) {
        case Transport::kTcp:
        case Transport::kUnix:
            return make_stream_client(config);
        case Transport::kTcpServer:
        case Transport::kUnixServer:
            return make_stream_server(config);
        case Transport::kUsb:
            return make_usb_transport(config);
        case Transport::kFile:
        case Transport::kFiles:
            return make_file_transport(config);
        case Transport::kUdp:
            break;
    }
    return make_udp_transport(config);
}

}  // namespace hilcam
