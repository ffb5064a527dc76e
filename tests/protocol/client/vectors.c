// What tools/client/hilcam_client.h makes of numbers, for client_test.py, which feeds the same ones to the
// other encoders. Lines on standard input, an answer on standard output for each; numbers are 64 bits in
// hexadecimal, doubles by their bits, signed ones in two's complement.
//
//     encode DIALECT CAMERA SEQUENCE FUNCTION NUMBERS...   the packet's bytes
//     decode DIALECT BYTES                                 kind, count and fields; a reason by its bytes,
//     last find DIALECT BYTES                                   where the first whole answer begins, and its
//     length
//     filter AT EXCHANGES...                               offset, delay and simulated time at that instant;
//         an exchange: sent, received, arrival (TAI, monotonic), departure (both), scale, where time stands
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tools/client/hilcam_client.h"

enum { MOST_NUMBERS = 161, MOST_STREAM_BYTES = 4096, LINE_BYTES = 2 * MOST_STREAM_BYTES + 64 };

static double number_of(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}
static int64_t signed_of(uint64_t bits) {
    int64_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
static void put(uint64_t value) { printf(" %llx", (unsigned long long)value); }

static size_t encode(const hilcam_envelope* e, unsigned function, const uint64_t* n, uint8_t* bytes,
                     size_t room) {
    switch (function) {
        case 1: {
            hilcam_pose pose;
            pose.object = (uint16_t)n[0];
            pose.time_tai_ns = signed_of(n[1]);
            for (int i = 0; i < 3; ++i) {
                pose.position_m[i] = number_of(n[2 + i]);
                pose.velocity_m_s[i] = number_of(n[5 + i]);
                pose.rate_rad_s[i] = number_of(n[12 + i]);
            }
            for (int i = 0; i < 4; ++i) pose.attitude_wxyz[i] = number_of(n[8 + i]);
            return hilcam_encode_pose(e, &pose, bytes, room);
        }
        case 2: {
            hilcam_settings settings;
            settings.mask = (uint32_t)n[0];
            settings.exposure_s = number_of(n[1]);
            settings.gain_db = number_of(n[2]);
            settings.frame_rate_hz = number_of(n[3]);
            return hilcam_encode_settings(e, &settings, bytes, room);
        }
        case 3:
            return hilcam_encode_start(e, bytes, room);
        case 4:
            return hilcam_encode_stop(e, bytes, room);
        case 5:
            return hilcam_encode_ping(e, n[0], bytes, room);
        case 6: {
            hilcam_joint joint;
            joint.object = (uint16_t)n[0];
            joint.joint = (uint16_t)n[1];
            joint.time_tai_ns = signed_of(n[2]);
            joint.angle_rad = number_of(n[3]);
            joint.rate_rad_s = number_of(n[4]);
            return hilcam_encode_joint(e, &joint, bytes, room);
        }
        case 7: {
            hilcam_fault fault;
            fault.kind = (hilcam_fault_kind)n[0];
            fault.rate = number_of(n[1]);
            fault.value = number_of(n[2]);
            fault.first_frame = n[3];
            fault.frames = n[4];
            fault.duration_s = number_of(n[5]);
            return hilcam_encode_fault(e, &fault, bytes, room);
        }
        case 8: {
            hilcam_expose expose;
            expose.frames = (uint16_t)n[0];
            expose.time_tai_ns = signed_of(n[1]);
            return hilcam_encode_expose(e, &expose, bytes, room);
        }
        case 9: {
            hilcam_mode mode;
            mode.triggered = (uint8_t)n[0];
            mode.burst_frames = (uint16_t)n[1];
            return hilcam_encode_mode(e, &mode, bytes, room);
        }
        case 10:
            return hilcam_encode_subscribe(e, (unsigned)n[0], bytes, room);
        case 11: {
            hilcam_clock clock;
            clock.action = (uint8_t)n[0];
            clock.sender_ns = signed_of(n[1]);
            clock.scale = number_of(n[2]);
            clock.step_ns = signed_of(n[3]);
            return hilcam_encode_clock(e, &clock, bytes, room);
        }
        case 12: {
            hilcam_lamp lamp;
            lamp.lamp = (uint16_t)n[0];
            lamp.time_tai_ns = signed_of(n[1]);
            lamp.level = number_of(n[2]);
            return hilcam_encode_lamp(e, &lamp, bytes, room);
        }
        default:
            return 0;
    }
}

static void print_encoded(const uint64_t* n) {
    uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
    hilcam_envelope e;
    e.dialect = (uint8_t)n[0], e.camera = (uint16_t)n[1], e.sequence = (uint32_t)n[2];
    const size_t size = encode(&e, (unsigned)n[3], n + 4, bytes, sizeof bytes);
    for (size_t i = 0; i < size; ++i) printf("%02x", bytes[i]);
    // A buffer that is a byte too short is refused, and no byte behind it touched.
    uint8_t tight[HILCAM_MOST_PACKET_BYTES];
    memset(tight, 0xA5, sizeof tight);
    if (size == 0 || encode(&e, (unsigned)n[3], n + 4, tight, size - 1) != 0 || tight[size - 1] != 0xA5)
        printf(" short buffer");
    printf("\n");
}

static void print_decoded(unsigned dialect, const uint8_t* bytes, size_t size) {
    hilcam_packet p;
    printf("%x", (unsigned)hilcam_decode((int)dialect, bytes, size, &p));
    if (p.kind != HILCAM_KIND_NONE) put(p.count);
    if (p.kind == HILCAM_KIND_ACKNOWLEDGEMENT) {
        const hilcam_acknowledgement* a = &p.as.acknowledgement;
        put(a->function), put(a->status), put(a->sequence), put(a->token), put((uint64_t)a->simulated_tai_ns);
        if (a->has_clock) {
            put((uint64_t)a->clock.arrival_tai_ns), put((uint64_t)a->clock.arrival_monotonic_ns);
            put((uint64_t)a->clock.departure_monotonic_ns), put(bits_of(a->clock.scale));
            put((uint64_t)a->clock.stands_at_tai_ns);
        }
        printf(" ");
        for (const char* c = a->reason; *c; ++c) printf("%02x", (unsigned char)*c);
    } else if (p.kind == HILCAM_KIND_FRAME_REPORT) {
        const hilcam_frame_report* f = &p.as.frame_report;
        put(f->camera), put(f->frame), put((uint64_t)f->exposure_mid_tai_ns);
        put((uint64_t)f->exposure_mid_monotonic_ns), put(bits_of(f->exposure_s)), put(bits_of(f->gain_db));
        put(f->pose_sequence), put(f->trigger_sequence), put((uint64_t)f->pose_time_tai_ns);
        put((uint64_t)f->latency_ns), put(f->faults), put(f->quality_level);
    } else if (p.kind == HILCAM_KIND_HOUSEKEEPING) {
        const hilcam_housekeeping* h = &p.as.housekeeping;
        put(h->mode), put(h->running), put((uint64_t)h->simulated_tai_ns), put((uint64_t)h->monotonic_ns);
        put(bits_of(h->uptime_s)), put(h->frames), put(bits_of(h->frame_rate_hz)), put(h->deadline_misses);
        put(h->commands_received), put(h->commands_refused), put(h->commands_lost),
            put(bits_of(h->latency_p50_s));
        put(bits_of(h->latency_p99_s)), put(bits_of(h->temperature_c)), put(h->faults), put(h->clients);
    }
    printf("\n");
}

static void print_filtered(const uint64_t* n, size_t count) {
    hilcam_clock_filter filter;
    int64_t offset = 0, delay = 0;
    memset(&filter, 0, sizeof filter);
    for (size_t at = 1; at + 8 <= count; at += 8) {
        hilcam_clock_reading r;
        r.arrival_tai_ns = signed_of(n[at + 2]), r.arrival_monotonic_ns = signed_of(n[at + 3]);
        r.departure_tai_ns = signed_of(n[at + 4]), r.departure_monotonic_ns = signed_of(n[at + 5]);
        r.scale = number_of(n[at + 6]), r.stands_at_tai_ns = signed_of(n[at + 7]);
        hilcam_clock_take(&filter, signed_of(n[at]), signed_of(n[at + 1]), &r);
    }
    hilcam_clock_estimate(&filter, signed_of(n[0]), &offset, &delay);
    put((uint64_t)offset), put((uint64_t)delay),
        put((uint64_t)hilcam_clock_simulated(&filter, signed_of(n[0])));
    printf("\n");
}

static size_t bytes_of(const char* text, uint8_t* bytes) {
    size_t size = 0;
    unsigned byte;
    while (size < MOST_STREAM_BYTES && sscanf(text + 2 * size, "%2x", &byte) == 1)
        bytes[size++] = (uint8_t)byte;
    return size;
}

int main(void) {
    static char line[LINE_BYTES];
    static uint8_t bytes[MOST_STREAM_BYTES];
    while (fgets(line, sizeof line, stdin)) {
        const char* verb = strtok(line, " \n");
        const char* first = strtok(NULL, " \n");
        if (!verb || !first) return 2;
        uint64_t n[MOST_NUMBERS] = {strtoull(first, NULL, 16)};
        if (strcmp(verb, "encode") == 0 || strcmp(verb, "filter") == 0) {
            const char* word;
            size_t count = 1;
            for (; count < MOST_NUMBERS && (word = strtok(NULL, " \n")) != NULL; ++count)
                n[count] = strtoull(word, NULL, 16);
            if (strcmp(verb, "encode") == 0)
                print_encoded(n);
            else
                print_filtered(n, count);
        } else {
            // In memory of just that size: the sanitizers see a byte too far.
            const char* text = strtok(NULL, " \n");
            const size_t size = text ? bytes_of(text, bytes) : 0;
            uint8_t* exact = malloc(size > 0 ? size : 1);
            if (!exact) return 1;
            memcpy(exact, bytes, size);
            if (strcmp(verb, "decode") == 0) {
                print_decoded((unsigned)n[0], exact, size);
            } else {
                size_t at;
                const size_t length = hilcam_find((int)n[0], exact, size, &at);
                printf("%lx %lx\n", (unsigned long)at, (unsigned long)length);
            }
            free(exact);
        }
    }
    return 0;
}
