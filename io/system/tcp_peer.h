#pragma once
// The peer that has connected to a listening TCP socket of ours.

#include <string>

#include "io/system/allow_list.h"

namespace hilcam {

// True when the peer of an accepted socket may stay; gives "ADDRESS:PORT". Prepares the socket: small packets
// leave at once, and a peer that vanished without a word is noticed within half a minute.
bool admit_tcp(const AllowList& allow, int socket, std::string& peer);

}  // namespace hilcam
