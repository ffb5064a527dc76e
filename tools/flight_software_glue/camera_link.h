// The part of a flight program that speaks with hilcam: it makes command packets into the caller's bytes and
// takes packets that came. It has no socket, no thread and no allocation, so that a cFS app, an F' component
// or a plain task brings its own; docs/flight_software.md says how. It is not for several threads at a time.
//
// Times are simulated TAI, attitudes turn body axes into world axes, scalar first (docs/protocol.md).
#ifndef CAMERA_LINK_H
#define CAMERA_LINK_H

#include "tools/client/hilcam_client.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int dialect;        // HILCAM_DIALECT_OWN or HILCAM_DIALECT_CFS: as the scenario's commands.udp.dialect
    uint32_t sequence;  // of the next command

    unsigned long sent, accepted, refused;
    char refusal[HILCAM_MOST_REASON_BYTES + 1];  // why the last one was refused

    unsigned long frames, telemetry_lost,
        foreign;                 // frame reports; gaps in their count; packets of no known kind
    uint16_t next_report;        // count of the next frame report, 14 bits
    hilcam_frame_report newest;  // valid while frames > 0
} camera_link;

void camera_link_begin(camera_link* link, int dialect);

// Each makes one packet in `bytes`, which has room for HILCAM_MOST_PACKET_BYTES, and returns its size.

// Asks for a report of each frame. A sender that is silent for a minute is forgotten and has to ask again.
size_t camera_link_subscribe(camera_link* link, uint8_t* bytes);

// Says where the camera is; a time of 0 is that of the packet's arrival.
size_t camera_link_pose(camera_link* link, int64_t time_tai_ns, const double position_m[3],
                        const double attitude_wxyz[4], uint8_t* bytes);

size_t camera_link_exposure(camera_link* link, double exposure_s, uint8_t* bytes);

// Takes one packet: a datagram, or what hilcam_find() cuts out of a stream. Returns what it was.
hilcam_kind camera_link_take(camera_link* link, const uint8_t* bytes, size_t size);

// True when the newest frame shows the command with this sequence number, or a later one of this sender's.
int camera_link_shows(const camera_link* link, uint32_t sequence);

#ifdef __cplusplus
}
#endif
#endif
