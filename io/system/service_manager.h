#pragma once
// Reports the program's state to a service manager by systemd's protocol, sd_notify(3): one datagram to the
// socket that the environment names. A `Type=notify` unit is then ready when the camera is.

#include <string_view>

namespace hilcam {

// Sends a state such as "READY=1" or "STOPPING=1" to $NOTIFY_SOCKET. Returns false when the variable is not
// set or sending failed; neither is an error of the program. Owner thread.
bool notify_service_manager(std::string_view state) noexcept;

}  // namespace hilcam
