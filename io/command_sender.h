#pragma once
// The sending side of the command protocol: sends, waits for acknowledgements.

#include <cstdint>
#include <string>

#include "io/command_codec.h"
#include "io/fd.h"

namespace hilcam {

class CommandSender {
  public:
    // "ADDRESS:PORT". Throws InputError.
    explicit CommandSender(const std::string& endpoint);

    // Sends once and waits. Throws DeviceError when no acknowledgement comes in time.
    Acknowledgement send(const Command& command, int timeout_ms = 1000);

  private:
    std::string endpoint_;
    Fd socket_;
    std::uint32_t sequence_ = 0;
};

}  // namespace hilcam
