#pragma once
// The peer that has connected to one of our listening TCP sockets.

#include <string>

#include "io/system/allow_list.h"

namespace hilcam {

// Returns true when the peer of an accepted socket may stay; sets `peer` to "ADDRESS:PORT". Prepares the
// socket: small packets leave at once, and a peer that vanished silently is noticed within half a minute.
bool admit_tcp(const AllowList& allow, int socket, std::string& peer);

}  // namespace hilcam
