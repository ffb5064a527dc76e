#include "hilcam_camera_hardware_model.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

namespace Nos3 {
namespace {

REGISTER_HARDWARE_MODEL(HilcamCameraHardwareModel, "HILCAM_CAMERA");

constexpr int kPoll_ms = 100;  // how soon the thread sees that the simulator ends

struct UartPlace {
    std::string bus = "usart_20";
    int port = 20;
};
UartPlace uart_place(const boost::property_tree::ptree& config) {
    UartPlace place;
    if (const auto connections = config.get_child_optional("simulator.hardware-model.connections"))
        for (const auto& connection : *connections)
            if (connection.second.get("type", "") == "usart") {
                place.bus = connection.second.get("bus-name", place.bus);
                place.port = connection.second.get("node-port", place.port);
            }
    return place;
}

// Returns a UDP socket, or -1 with a line in the log.
int listen_udp(const std::string& address, int port) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(static_cast<std::uint16_t>(port));
    if (inet_pton(AF_INET, address.c_str(), &own.sin_addr) == 1 && fd >= 0 &&
        bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0)
        return fd;
    sim_logger->error("HilcamCameraHardwareModel: no UDP socket at %s:%d: %s", address.c_str(), port,
                      std::strerror(errno));
    if (fd >= 0) ::close(fd);
    return -1;
}

}  // namespace

HilcamCameraHardwareModel::HilcamCameraHardwareModel(const boost::property_tree::ptree& config)
    : SimIHardwareModel(config),
      receiver_(static_cast<std::uint16_t>(config.get("simulator.hardware-model.hilcam.apid", 0x110)),
                config.get<std::size_t>("simulator.hardware-model.hilcam.most-pixels", 4096 * 4096)) {
    const UartPlace place = uart_place(config);
    uart_.reset(new NosEngine::Uart::Uart(_hub, config.get("simulator.name", "hilcam-camera-sim"),
                                          config.get("common.nos-connection-string", "tcp://127.0.0.1:12001"),
                                          place.bus));
    uart_->open(place.port);
    socket_ = listen_udp(config.get("simulator.hardware-model.hilcam.address", "127.0.0.1"),
                         config.get("simulator.hardware-model.hilcam.port", 5020));
    sim_logger->info("HilcamCameraHardwareModel: pictures leave on %s, port %d", place.bus.c_str(),
                     place.port);
    if (socket_ >= 0) thread_ = std::thread([this] { receive(); });
}

HilcamCameraHardwareModel::~HilcamCameraHardwareModel() {
    stop();
    if (thread_.joinable()) thread_.join();
    if (socket_ >= 0) ::close(socket_);
    uart_->close();
}

void HilcamCameraHardwareModel::receive() {
    std::vector<std::uint8_t> datagram(hilcam_image::kMostPacketBytes);
    pollfd waits{socket_, POLLIN, 0};
    while (_keep_running) {
        if (poll(&waits, 1, kPoll_ms) <= 0) continue;
        const ssize_t got = recv(socket_, datagram.data(), datagram.size(), 0);
        if (got <= 0) continue;
        const auto count = static_cast<std::size_t>(got);
        uart_->write(datagram.data(), count);
        receiver_.take(datagram.data(), count, &on_picture, this);
        const std::lock_guard<std::mutex> lock(mutex_);
        status_.packets = receiver_.counts().packets;
    }
}

void HilcamCameraHardwareModel::on_picture(void* model, const hilcam_image::Picture& picture) {
    auto& self = *static_cast<HilcamCameraHardwareModel*>(model);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    ++self.status_.pictures;
    self.status_.whole_pictures += picture.is_whole() ? 1 : 0;
    self.status_.missing_packets += picture.missing_packets;
    self.status_.last_frame = picture.header.frame;
}

void HilcamCameraHardwareModel::command_callback(NosEngine::Common::Message message) {
    NosEngine::Common::DataBufferOverlay asked(const_cast<NosEngine::Utility::Buffer&>(message.buffer));
    std::string answer = "unknown; accepted: STATUS";
    if (std::strncmp(asked.data, "STATUS", 6) == 0) {
        const std::lock_guard<std::mutex> lock(mutex_);
        answer = "packets " + std::to_string(status_.packets) + ", pictures " +
                 std::to_string(status_.pictures) + ", whole " + std::to_string(status_.whole_pictures) +
                 ", missing packets " + std::to_string(status_.missing_packets) + ", last frame " +
                 std::to_string(status_.last_frame);
    }
    _command_node->send_reply_message_async(message, answer.size() + 1, answer.c_str());
}

}  // namespace Nos3
