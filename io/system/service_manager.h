#pragma once
// Says to a service manager how the program stands: systemd's protocol of sd_notify(3), one datagram to the
// socket that the environment names, so that `Type=notify` units are ready when the camera is.

#include <string_view>

namespace hilcam {

// Sends a state, as "READY=1" or "STOPPING=1", to $NOTIFY_SOCKET. False when nobody asked for it, or it could
// not be sent, which is no failure of the program. Owner thread.
bool notify_service_manager(std::string_view state) noexcept;

}  // namespace hilcam
