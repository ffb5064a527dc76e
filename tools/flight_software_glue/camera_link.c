#include "tools/flight_software_glue/camera_link.h"

// cFS counts packets in the 14 bits of the primary header.
static uint32_t on_wire(const camera_link* link, uint32_t sequence) {
    return link->dialect == HILCAM_DIALECT_CFS ? sequence & 0x3FFFu : sequence;
}

static hilcam_envelope next_envelope(camera_link* link) {
    hilcam_envelope e;
    e.dialect = (uint8_t)link->dialect;
    e.camera = 0;
    e.sequence = link->sequence++;
    ++link->sent;
    return e;
}

void camera_link_begin(camera_link* link, int dialect) {
    memset(link, 0, sizeof *link);
    link->dialect = dialect;
}

size_t camera_link_subscribe(camera_link* link, uint8_t* bytes) {
    const hilcam_envelope e = next_envelope(link);
    return hilcam_encode_subscribe(&e, HILCAM_TELL_FRAMES, bytes, HILCAM_MOST_PACKET_BYTES);
}

size_t camera_link_pose(camera_link* link, int64_t time_tai_ns, const double position_m[3],
                        const double attitude_wxyz[4], uint8_t* bytes) {
    const hilcam_envelope e = next_envelope(link);
    hilcam_pose pose;
    memset(&pose, 0, sizeof pose);  // object 0: the camera, at rest
    pose.time_tai_ns = time_tai_ns;
    memcpy(pose.position_m, position_m, sizeof pose.position_m);
    memcpy(pose.attitude_wxyz, attitude_wxyz, sizeof pose.attitude_wxyz);
    return hilcam_encode_pose(&e, &pose, bytes, HILCAM_MOST_PACKET_BYTES);
}

size_t camera_link_exposure(camera_link* link, double exposure_s, uint8_t* bytes) {
    const hilcam_envelope e = next_envelope(link);
    hilcam_settings settings;
    memset(&settings, 0, sizeof settings);
    settings.mask = HILCAM_SET_EXPOSURE;
    settings.exposure_s = exposure_s;
    return hilcam_encode_settings(&e, &settings, bytes, HILCAM_MOST_PACKET_BYTES);
}

static void take_acknowledgement(camera_link* link, const hilcam_acknowledgement* a) {
    if (a->status == HILCAM_ACCEPTED) {
        ++link->accepted;
        return;
    }
    ++link->refused;
    memcpy(link->refusal, a->reason, sizeof link->refusal);
}

static void take_report(camera_link* link, uint16_t count, const hilcam_frame_report* report) {
    if (link->frames > 0) link->telemetry_lost += (uint16_t)(count - link->next_report) & 0x3FFFu;
    link->next_report = (count + 1u) & 0x3FFFu;
    link->newest = *report;
    ++link->frames;
}

hilcam_kind camera_link_take(camera_link* link, const uint8_t* bytes, size_t size) {
    hilcam_packet packet;
    switch (hilcam_decode(link->dialect, bytes, size, &packet)) {
        case HILCAM_KIND_ACKNOWLEDGEMENT:
            take_acknowledgement(link, &packet.as.acknowledgement);
            break;
        case HILCAM_KIND_FRAME_REPORT:
            take_report(link, packet.count, &packet.as.frame_report);
            break;
        case HILCAM_KIND_HOUSEKEEPING:
            break;
        case HILCAM_KIND_NONE:
            ++link->foreign;
            break;
    }
    return packet.kind;
}

int camera_link_shows(const camera_link* link, uint32_t sequence) {
    if (link->frames == 0) return 0;
    const uint32_t mask = link->dialect == HILCAM_DIALECT_CFS ? 0x3FFFu : 0xFFFFFFFFu;
    const uint32_t ahead = (link->newest.pose_sequence - on_wire(link, sequence)) & mask;
    return ahead <= mask / 2;
}
