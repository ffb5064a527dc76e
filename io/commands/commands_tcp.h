#pragma once
// Commands over TCP: several clients, each with a stream of packets; answers go back on the same connection.

#include <memory>

#include "io/commands/command_dialect.h"
#include "io/contract/command_receiver.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct TcpCommandConfig {
    std::string address = "127.0.0.1";
    std::int64_t port = 5010;
    std::vector<std::string> allow{};
    std::int64_t clients = 8;
    DialectConfig dialect{};
};
Fields fields(TcpCommandConfig& config);
void validate(const TcpCommandConfig& config);

std::unique_ptr<CommandReceiver> make_tcp_receiver(const TcpCommandConfig& config, CommandHandler& handler);
// Makes the read-only telemetry port: clients get all telemetry, and what they send is ignored.
std::unique_ptr<CommandReceiver> make_telemetry_port(const TcpCommandConfig& config, const std::string& key);

}  // namespace hilcam
