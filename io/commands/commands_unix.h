#pragma once
// Commands over a Unix socket: several clients on this machine. The file's owner and group restrict access.

#include <filesystem>
#include <memory>

#include "io/commands/command_dialect.h"
#include "io/contract/command_receiver.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct UnixCommandConfig {
    // Stream: bytes, as over TCP. Seqpacket: every message is one or more whole packets.
    enum class Type : std::uint8_t { kStream, kSeqpacket };

    std::filesystem::path path;
    Type type = Type::kStream;
    std::int64_t clients = 8;
    DialectConfig dialect{};
};
Fields fields(UnixCommandConfig& config);
void validate(const UnixCommandConfig& config);

// start() replaces a socket file without a listener, as a killed program leaves. It throws DeviceError when
// there is a listener, or when the path is another kind of file. stop() removes the file.
std::unique_ptr<CommandReceiver> make_unix_receiver(const UnixCommandConfig& config, CommandHandler& handler);

}  // namespace hilcam
