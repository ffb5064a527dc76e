#pragma once
// Commands over a Unix socket: several clients of this machine, with the file's owner and group to keep
// others out.

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

// A socket file that nobody listens at any more (its program was killed) is replaced; start() throws
// DeviceError when somebody does, or when the path is some other kind of file. The file goes with stop().
std::unique_ptr<CommandReceiver> make_unix_receiver(const UnixCommandConfig& config, CommandHandler& handler);

}  // namespace hilcam
