#pragma once
// A client's side of hilcam's command protocol (docs/protocol.md): every command to bytes, every
// acknowledgement and telemetry packet from bytes, in both dialects. C99 and C++, one file, for flight
// computers as well: no allocation, no global state, no system call, no libc beyond memcpy, whatever the
// machine's byte order.
//
// Sending and receiving is the caller's:
//
//     uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
//     hilcam_envelope envelope = {0};                 // dialect, camera, and:
//     envelope.sequence = next_sequence++;            // one more for each command
//     size_t size = hilcam_encode_ping(&envelope, 42, bytes, sizeof bytes);
//     send(socket, bytes, size, 0);
//     ssize_t got = recv(socket, bytes, sizeof bytes, 0);
//     hilcam_packet answer;
//     if (hilcam_decode(HILCAM_DIALECT_OWN, bytes, (size_t)got, &answer) == HILCAM_KIND_ACKNOWLEDGEMENT)
//         printf("%s\n", hilcam_status_name(answer.as.acknowledgement.status));
//
// Encoders give the packet's length, or 0 when it does not fit in `room` bytes. They do not judge: what is
// out of range is encoded as it is, and hilcam's answer says what is wrong. A double must be an IEEE 754
// binary64. Times are nanoseconds since 1970-01-01T00:00:00 TAI on hilcam's simulated clock. Threads: any,
// nothing is shared.

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

// The longest packet of any kind, in either dialect.
#define HILCAM_MOST_PACKET_BYTES 256
#define HILCAM_MOST_REASON_BYTES 96

enum { HILCAM_DIALECT_OWN = 0, HILCAM_DIALECT_CFS = 1 };

// --- commands

typedef struct {
    uint8_t dialect;  // HILCAM_DIALECT_OWN or HILCAM_DIALECT_CFS
    uint16_t
        camera;  // which one settings, modes, exposures and faults are for, from 1; 0: every one; not in cfs
    uint32_t sequence;  // the answer has it again; in cfs its low 14 bits travel
} hilcam_envelope;

typedef struct {
    uint16_t object;      // 0: the camera; 1, 2, ...: the scenario's objects
    int64_t time_tai_ns;  // when the pose is true; 0: on arrival
    double position_m[3];
    double velocity_m_s[3];
    double attitude_wxyz[4];  // turns body axes into world axes; the camera's +z is its boresight, +x right,
                              // +y down
    double rate_rad_s[3];     // about the body's own axes
} hilcam_pose;

typedef struct {
    uint16_t object, joint;  // both from 1
    int64_t time_tai_ns;     // 0: on arrival
    double angle_rad;
    double rate_rad_s;
} hilcam_joint;

typedef struct {
    uint16_t lamp;        // from 1
    int64_t time_tai_ns;  // from when on; 0: on arrival
    double level;         // 0: off; 1: as its data sheet says
} hilcam_lamp;

enum { HILCAM_SET_EXPOSURE = 1, HILCAM_SET_GAIN = 2, HILCAM_SET_FRAME_RATE = 4 };
typedef struct {
    uint32_t mask;  // which of them are set; the others are not looked at
    double exposure_s;
    double gain_db;
    double frame_rate_hz;
} hilcam_settings;

typedef struct {
    uint16_t frames;      // 0: as the settings have it
    int64_t time_tai_ns;  // triggered: of the trigger; lockstep: of the exposure's middle; 0: now, or next
} hilcam_expose;

typedef struct {
    uint8_t triggered;      // 0: free-run
    uint16_t burst_frames;  // 0: as it is
} hilcam_mode;

enum { HILCAM_TELL_FRAMES = 1, HILCAM_TELL_HOUSEKEEPING = 2 };

// How simulated time goes on, and half of an exchange of clock readings (hilcam_clock_filter).
enum {
    HILCAM_CLOCK_ASK = 0,
    HILCAM_CLOCK_SCALE = 1,
    HILCAM_CLOCK_PAUSE = 2,
    HILCAM_CLOCK_RESUME = 3,
    HILCAM_CLOCK_STEP = 4
};
typedef struct {
    uint8_t action;
    int64_t sender_ns;  // the sender's clock as this leaves; comes back
    double scale;       // SCALE: simulated seconds in one of the machine's
    int64_t step_ns;    // STEP: so much simulated time, then it stands again
} hilcam_clock;

// `hilcam send fault list` says what each does and what its value means.
typedef enum {
    HILCAM_FAULT_NONE = 0,  // ends them all
    HILCAM_FAULT_PACKET_DROP = 1,
    HILCAM_FAULT_PACKET_DUPLICATE = 2,
    HILCAM_FAULT_PACKET_REORDER = 3,
    HILCAM_FAULT_PACKET_DELAY = 4,
    HILCAM_FAULT_PACKET_CORRUPT = 5,
    HILCAM_FAULT_PACKET_WRONG_ID = 6,
    HILCAM_FAULT_PACKET_TRUNCATE = 7,
    HILCAM_FAULT_LEADER_LOST = 8,
    HILCAM_FAULT_TRAILER_LOST = 9,
    HILCAM_FAULT_RESEND_REFUSED = 10,
    HILCAM_FAULT_RESEND_DELAYED = 11,
    HILCAM_FAULT_RESEND_WRONG_ID = 12,
    HILCAM_FAULT_BANDWIDTH_CAP = 13,
    HILCAM_FAULT_FRAME_DROP = 20,
    HILCAM_FAULT_FRAME_REPEAT = 21,
    HILCAM_FAULT_WRONG_SIZE_Y = 22,
    HILCAM_FAULT_TIMESTAMP_STEP = 30,
    HILCAM_FAULT_TIMESTAMP_DRIFT = 31,
    HILCAM_FAULT_TIMESTAMP_FREEZE = 32,
    HILCAM_FAULT_BLOCK_ID_WRAP = 33,
    HILCAM_FAULT_CONTROL_SILENCE = 40,
    HILCAM_FAULT_CONTROL_SLOW = 41,
    HILCAM_FAULT_CONTROL_BUSY = 42,
    HILCAM_FAULT_CONTROL_DENIED = 43,
    HILCAM_FAULT_HEARTBEAT_IGNORED = 44,
    HILCAM_FAULT_DEVICE_RESET = 50,
    HILCAM_FAULT_LINK_DOWN = 51,
    HILCAM_FAULT_IP_CHANGE = 52,
    HILCAM_FAULT_TEST_PACKET_LIMIT = 53,
    HILCAM_FAULT_V4L2_STALL = 60,
    HILCAM_FAULT_V4L2_RESTART = 61,
    HILCAM_FAULT_V4L2_FORMAT_FLIP = 62,
    HILCAM_FAULT_USB_DETACH = 70,
    HILCAM_FAULT_USB_SHORT_TRANSFER = 71,
    HILCAM_FAULT_USB_STALL = 72,
    HILCAM_FAULT_USB_BAD_CRC = 73,
    HILCAM_FAULT_IMAGE_STUCK = 80,
    HILCAM_FAULT_IMAGE_BLACK = 81,
    HILCAM_FAULT_IMAGE_SATURATED = 82,
    HILCAM_FAULT_IMAGE_BIT_FLIPS = 83,
    HILCAM_FAULT_IMAGE_TEAR = 84
} hilcam_fault_kind;

typedef struct {
    hilcam_fault_kind kind;
    double rate;           // 0 to 1, the share that is struck; 0 ends this kind
    double value;          // by kind
    uint64_t first_frame;  // 0: at once
    uint64_t frames;       // 0: no end
    double duration_s;     // from the arrival; 0: no end
} hilcam_fault;

// --- answers

enum {
    HILCAM_ACCEPTED = 0,
    HILCAM_BAD_LENGTH = 1,
    HILCAM_BAD_HEADER = 2,
    HILCAM_UNKNOWN_APID = 3,
    HILCAM_BAD_CHECKSUM = 4,
    HILCAM_UNKNOWN_FUNCTION = 5,
    HILCAM_BAD_ARGUMENT = 6,
    HILCAM_UNKNOWN_OBJECT = 7,
    HILCAM_TIME_OUT_OF_RANGE = 8,
    HILCAM_BUSY = 9,
    HILCAM_NOT_NOW = 10,
    HILCAM_TIME_WENT_BACK = 11
};

// From the answer's departure on:
//     simulated = min(departure_tai + scale (monotonic - departure_monotonic), stands_at_tai)
typedef struct {
    int64_t arrival_tai_ns, arrival_monotonic_ns;  // of the command
    int64_t departure_tai_ns, departure_monotonic_ns;
    double scale;              // while time runs
    int64_t stands_at_tai_ns;  // where time stands or will; INT64_MAX: nowhere
} hilcam_clock_reading;

typedef struct {
    uint8_t function;  // of the command: 1 pose, 2 settings, ...
    uint8_t status;
    uint32_t sequence;         // of the command
    uint64_t token;            // of a ping; of a clock command its sender_ns; else 0
    int64_t simulated_tai_ns;  // when the answer was made
    char reason[HILCAM_MOST_REASON_BYTES + 1];
    uint8_t has_clock;  // with an accepted clock command
    hilcam_clock_reading clock;
} hilcam_acknowledgement;

// Bits of `faults` beside those of the faults on demand: some motion was no number or out of its bounds, light between
// surfaces is not kept yet, simulated time stood, no poses came, a time tag went back.
#define HILCAM_IMPOSSIBLE_MOTION ((uint64_t)1 << 58)
#define HILCAM_NO_KEPT_LIGHT ((uint64_t)1 << 59)
#define HILCAM_TIME_STANDS ((uint64_t)1 << 60)
#define HILCAM_POSES_STALE ((uint64_t)1 << 61)
#define HILCAM_TAGS_WENT_BACK ((uint64_t)1 << 62)

typedef struct {
    uint8_t camera;  // from 1
    uint64_t frame;
    int64_t exposure_mid_tai_ns;
    int64_t exposure_mid_monotonic_ns;  // the same instant on the machine's CLOCK_MONOTONIC
    double exposure_s;
    double gain_db;
    uint32_t pose_sequence;     // of the newest command that the frame shows
    uint32_t trigger_sequence;  // of the `expose` that asked for it; 0: none
    int64_t pose_time_tai_ns;   // the shown command's time tag
    int64_t latency_ns;         // from that command's arrival to the frame's hand-over; -1: no new command
    uint64_t faults;            // bit n: the n-th line, from 0, of `hilcam send fault list`
    uint32_t quality_level;     // 0: as configured
} hilcam_frame_report;

typedef struct {
    uint8_t mode;  // 0 free-run, 1 triggered, 2 lockstep
    uint8_t running;
    int64_t simulated_tai_ns;
    int64_t monotonic_ns;
    double uptime_s;
    uint64_t frames;
    double frame_rate_hz;
    uint64_t deadline_misses;
    uint64_t commands_received, commands_refused, commands_lost;
    double latency_p50_s, latency_p99_s;
    double temperature_c;
    uint32_t faults;
    uint32_t clients;
} hilcam_housekeeping;

typedef enum {
    HILCAM_KIND_NONE = 0,  // no packet of hilcam's
    HILCAM_KIND_ACKNOWLEDGEMENT = 0x101,
    HILCAM_KIND_FRAME_REPORT = 0x102,
    HILCAM_KIND_HOUSEKEEPING = 0x103
} hilcam_kind;

typedef struct {
    hilcam_kind kind;
    uint16_t count;  // 14 bits, of this kind: a gap in telemetry's is telemetry that was dropped
    union {
        hilcam_acknowledgement acknowledgement;
        hilcam_frame_report frame_report;
        hilcam_housekeeping housekeeping;
    } as;
} hilcam_packet;

// --- bytes; names that end in _ are this file's own

// Does not compile where doubles are not eight bytes.
typedef char hilcam_double_is_binary64_[sizeof(double) == 8 ? 1 : -1];

typedef struct {
    uint8_t* bytes;
    size_t room, at;  // `at` counts on past `room`, where nothing is written
} hilcam_writer_;

static inline void hilcam_put_(hilcam_writer_* w, uint64_t value, unsigned count) {
    while (count-- > 0) {
        if (w->at < w->room) w->bytes[w->at] = (uint8_t)(value >> (8 * count) & 0xFF);
        ++w->at;
    }
}

static inline void hilcam_put_doubles_(hilcam_writer_* w, const double* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        hilcam_put_(w, bits, 8);
    }
}

typedef struct {
    const uint8_t* bytes;  // long enough: lengths are checked before
} hilcam_reader_;

static inline uint64_t hilcam_get_(hilcam_reader_* r, unsigned count) {
    uint64_t value = 0;
    while (count-- > 0) value = value << 8 | *r->bytes++;
    return value;
}

// Two's complement, without a conversion that C leaves to the compiler.
static inline int64_t hilcam_i64_(uint64_t bits) {
    int64_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline int64_t hilcam_get_i64_(hilcam_reader_* r) { return hilcam_i64_(hilcam_get_(r, 8)); }

static inline double hilcam_get_double_(hilcam_reader_* r) {
    const uint64_t bits = hilcam_get_(r, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF (CCSDS 132.0-B-3, 4.1.6.2). Without a table: a command
// is a hundred bytes. Over bytes that end in their own CRC it is 0.
static inline uint16_t hilcam_crc16(const uint8_t* bytes, size_t size) {
    unsigned crc = 0xFFFFu;
    for (size_t i = 0; i < size; ++i) {
        crc ^= (unsigned)bytes[i] << 8;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1;
    }
    return (uint16_t)crc;
}

// --- encoders

static inline hilcam_writer_ hilcam_begin_(const hilcam_envelope* e, unsigned function, uint8_t* bytes,
                                           size_t room) {
    hilcam_writer_ w;
    w.bytes = bytes, w.room = room, w.at = 0;
    hilcam_put_(&w, 0x1900u, 2);  // a telecommand with a secondary header, APID 0x100
    hilcam_put_(&w, 0xC000u | (e->sequence & 0x3FFFu), 2);
    hilcam_put_(&w, 0, 2);  // the length comes last
    if (e->dialect == HILCAM_DIALECT_CFS) {
        hilcam_put_(&w, function, 1);
        hilcam_put_(&w, 0, 1);  // the checksum, too
    } else {
        hilcam_put_(&w, 1, 1);  // protocol version
        hilcam_put_(&w, function, 1);
        hilcam_put_(&w, e->camera, 2);
        hilcam_put_(&w, e->sequence, 4);
    }
    return w;
}

static inline size_t hilcam_end_(const hilcam_envelope* e, hilcam_writer_* w) {
    const int cfs = e->dialect == HILCAM_DIALECT_CFS;
    const size_t covered = w->at, total = covered + (cfs ? 0 : 2);
    if (total > w->room) return 0;
    w->at = 4;
    hilcam_put_(w, total - 7, 2);  // bytes after the primary header's six, minus 1
    if (cfs) {
        unsigned sum = 0xFFu;
        for (size_t i = 0; i < total; ++i) sum ^= w->bytes[i];
        w->bytes[7] = (uint8_t)sum;
    } else {
        w->at = covered;
        hilcam_put_(w, hilcam_crc16(w->bytes, covered), 2);
    }
    return total;
}

static inline size_t hilcam_encode_pose(const hilcam_envelope* e, const hilcam_pose* pose, uint8_t* bytes,
                                        size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 1, bytes, room);
    hilcam_put_(&w, pose->object, 2);
    hilcam_put_(&w, 0, 2);
    hilcam_put_(&w, (uint64_t)pose->time_tai_ns, 8);
    hilcam_put_doubles_(&w, pose->position_m, 3);
    hilcam_put_doubles_(&w, pose->velocity_m_s, 3);
    hilcam_put_doubles_(&w, pose->attitude_wxyz, 4);
    hilcam_put_doubles_(&w, pose->rate_rad_s, 3);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_settings(const hilcam_envelope* e, const hilcam_settings* s,
                                            uint8_t* bytes, size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 2, bytes, room);
    double values[3];
    values[0] = (s->mask & HILCAM_SET_EXPOSURE) != 0 ? s->exposure_s : 0;
    values[1] = (s->mask & HILCAM_SET_GAIN) != 0 ? s->gain_db : 0;
    values[2] = (s->mask & HILCAM_SET_FRAME_RATE) != 0 ? s->frame_rate_hz : 0;
    hilcam_put_(&w, s->mask, 4);
    hilcam_put_doubles_(&w, values, 3);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_start(const hilcam_envelope* e, uint8_t* bytes, size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 3, bytes, room);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_stop(const hilcam_envelope* e, uint8_t* bytes, size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 4, bytes, room);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_ping(const hilcam_envelope* e, uint64_t token, uint8_t* bytes,
                                        size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 5, bytes, room);
    hilcam_put_(&w, token, 8);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_joint(const hilcam_envelope* e, const hilcam_joint* joint, uint8_t* bytes,
                                         size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 6, bytes, room);
    hilcam_put_(&w, joint->object, 2);
    hilcam_put_(&w, joint->joint, 2);
    hilcam_put_(&w, (uint64_t)joint->time_tai_ns, 8);
    hilcam_put_doubles_(&w, &joint->angle_rad, 1);
    hilcam_put_doubles_(&w, &joint->rate_rad_s, 1);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_fault(const hilcam_envelope* e, const hilcam_fault* fault, uint8_t* bytes,
                                         size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 7, bytes, room);
    hilcam_put_(&w, (uint64_t)fault->kind, 1);
    hilcam_put_(&w, 0, 3);
    hilcam_put_doubles_(&w, &fault->rate, 1);
    hilcam_put_doubles_(&w, &fault->value, 1);
    hilcam_put_(&w, fault->first_frame, 8);
    hilcam_put_(&w, fault->frames, 8);
    hilcam_put_doubles_(&w, &fault->duration_s, 1);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_expose(const hilcam_envelope* e, const hilcam_expose* expose,
                                          uint8_t* bytes, size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 8, bytes, room);
    hilcam_put_(&w, expose->frames, 2);
    hilcam_put_(&w, 0, 2);
    hilcam_put_(&w, (uint64_t)expose->time_tai_ns, 8);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_mode(const hilcam_envelope* e, const hilcam_mode* mode, uint8_t* bytes,
                                        size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 9, bytes, room);
    hilcam_put_(&w, mode->triggered, 1);
    hilcam_put_(&w, 0, 1);
    hilcam_put_(&w, mode->burst_frames, 2);
    return hilcam_end_(e, &w);
}

// telemetry: a mask of HILCAM_TELL_FRAMES and HILCAM_TELL_HOUSEKEEPING; what is not in it ends.
static inline size_t hilcam_encode_subscribe(const hilcam_envelope* e, unsigned telemetry, uint8_t* bytes,
                                             size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 10, bytes, room);
    hilcam_put_(&w, telemetry, 1);
    hilcam_put_(&w, 0, 3);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_clock(const hilcam_envelope* e, const hilcam_clock* clock, uint8_t* bytes,
                                         size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 11, bytes, room);
    hilcam_put_(&w, clock->action, 1);
    hilcam_put_(&w, 0, 3);
    hilcam_put_(&w, (uint64_t)clock->sender_ns, 8);
    hilcam_put_doubles_(&w, &clock->scale, 1);
    hilcam_put_(&w, (uint64_t)clock->step_ns, 8);
    return hilcam_end_(e, &w);
}

static inline size_t hilcam_encode_lamp(const hilcam_envelope* e, const hilcam_lamp* lamp, uint8_t* bytes,
                                        size_t room) {
    hilcam_writer_ w = hilcam_begin_(e, 12, bytes, room);
    hilcam_put_(&w, lamp->lamp, 2);
    hilcam_put_(&w, 0, 2);
    hilcam_put_(&w, (uint64_t)lamp->time_tai_ns, 8);
    hilcam_put_doubles_(&w, &lamp->level, 1);
    return hilcam_end_(e, &w);
}

// --- decoders

static inline int hilcam_read_acknowledgement_(hilcam_reader_* r, size_t left, hilcam_acknowledgement* a) {
    if (left < 25) return 0;
    a->function = (uint8_t)(hilcam_get_(r, 1) & 0x7F);
    a->status = (uint8_t)hilcam_get_(r, 1);
    (void)hilcam_get_(r, 1);
    a->sequence = (uint32_t)hilcam_get_(r, 4);
    a->token = hilcam_get_(r, 8);
    a->simulated_tai_ns = hilcam_get_i64_(r);
    const size_t reason_bytes = (size_t)hilcam_get_(r, 2);
    a->has_clock = a->function == 11 && left - 25 == reason_bytes + 40;
    if (reason_bytes > HILCAM_MOST_REASON_BYTES || (left - 25 != reason_bytes && !a->has_clock)) return 0;
    memcpy(a->reason, r->bytes, reason_bytes);
    a->reason[reason_bytes] = 0;
    if (!a->has_clock) return 1;
    r->bytes += reason_bytes;
    a->clock.arrival_tai_ns = hilcam_get_i64_(r);
    a->clock.arrival_monotonic_ns = hilcam_get_i64_(r);
    a->clock.departure_monotonic_ns = hilcam_get_i64_(r);
    a->clock.scale = hilcam_get_double_(r);
    a->clock.stands_at_tai_ns = hilcam_get_i64_(r);
    a->clock.departure_tai_ns = a->simulated_tai_ns;
    return 1;
}

static inline void hilcam_read_frame_report_(hilcam_reader_* r, hilcam_frame_report* f) {
    f->camera = (uint8_t)hilcam_get_(r, 1);
    (void)hilcam_get_(r, 1);
    f->frame = hilcam_get_(r, 8);
    f->exposure_mid_tai_ns = hilcam_get_i64_(r);
    f->exposure_mid_monotonic_ns = hilcam_get_i64_(r);
    f->exposure_s = hilcam_get_double_(r);
    f->gain_db = hilcam_get_double_(r);
    f->pose_sequence = (uint32_t)hilcam_get_(r, 4);
    f->trigger_sequence = (uint32_t)hilcam_get_(r, 4);
    f->pose_time_tai_ns = hilcam_get_i64_(r);
    f->latency_ns = hilcam_get_i64_(r);
    f->faults = hilcam_get_(r, 8);
    f->quality_level = (uint32_t)hilcam_get_(r, 4);
}

static inline void hilcam_read_housekeeping_(hilcam_reader_* r, hilcam_housekeeping* h) {
    h->mode = (uint8_t)hilcam_get_(r, 1);
    h->running = (uint8_t)hilcam_get_(r, 1);
    h->simulated_tai_ns = hilcam_get_i64_(r);
    h->monotonic_ns = hilcam_get_i64_(r);
    h->uptime_s = hilcam_get_double_(r);
    h->frames = hilcam_get_(r, 8);
    h->frame_rate_hz = hilcam_get_double_(r);
    h->deadline_misses = hilcam_get_(r, 8);
    h->commands_received = hilcam_get_(r, 8);
    h->commands_refused = hilcam_get_(r, 8);
    h->commands_lost = hilcam_get_(r, 8);
    h->latency_p50_s = hilcam_get_double_(r);
    h->latency_p99_s = hilcam_get_double_(r);
    h->temperature_c = hilcam_get_double_(r);
    h->faults = (uint32_t)hilcam_get_(r, 4);
    h->clients = (uint32_t)hilcam_get_(r, 4);
}

// Exactly one packet, as a datagram brings it or hilcam_find() has cut it out. HILCAM_KIND_NONE: it is no
// answer of hilcam's, or a damaged one.
static inline hilcam_kind hilcam_decode(int dialect, const uint8_t* bytes, size_t size,
                                        hilcam_packet* packet) {
    const int cfs = dialect == HILCAM_DIALECT_CFS;
    const size_t header = cfs ? 16 : 6, check = cfs ? 0 : 2;
    hilcam_reader_ r;
    packet->kind = HILCAM_KIND_NONE;
    if (size < header + 2 + check) return HILCAM_KIND_NONE;
    r.bytes = bytes;
    const unsigned identification = (unsigned)hilcam_get_(&r, 2);
    packet->count = (uint16_t)(hilcam_get_(&r, 2) & 0x3FFF);
    if (hilcam_get_(&r, 2) + 7 != size) return HILCAM_KIND_NONE;
    if (!cfs && hilcam_crc16(bytes, size) != 0) return HILCAM_KIND_NONE;
    r.bytes = bytes + header;
    if (hilcam_get_(&r, 1) != 1) return HILCAM_KIND_NONE;  // protocol version
    const size_t left = size - header - check - 1;
    if (identification == 0x0901) {
        if (hilcam_read_acknowledgement_(&r, left, &packet->as.acknowledgement))
            packet->kind = HILCAM_KIND_ACKNOWLEDGEMENT;
        return packet->kind;
    }
    const unsigned kind = (unsigned)hilcam_get_(&r, 1);
    if (identification == 0x0902 && kind == 1 && left == 79) {
        hilcam_read_frame_report_(&r, &packet->as.frame_report);
        packet->kind = HILCAM_KIND_FRAME_REPORT;
    } else if (identification == 0x0903 && kind == 2 && left == 107) {
        hilcam_read_housekeeping_(&r, &packet->as.housekeeping);
        packet->kind = HILCAM_KIND_HOUSEKEEPING;
    }
    return packet->kind;
}

// The first whole answer among a stream's bytes (TCP, Unix sockets, USB): it begins at *at, its length is
// given. 0: there is none yet; the first *at bytes belong to none and can go. Sync markers and damage are
// stepped over.
static inline size_t hilcam_find(int dialect, const uint8_t* bytes, size_t size, size_t* at) {
    hilcam_packet packet;
    for (*at = 0; *at < size; ++*at) {
        const uint8_t* from = bytes + *at;
        const size_t left = size - *at;
        if (from[0] != 0x09) continue;
        if (left < 6) return 0;  // perhaps a header, not all of it
        const size_t length = ((size_t)from[4] << 8 | from[5]) + 7;
        if (from[1] < 1 || from[1] > 3 || length > HILCAM_MOST_PACKET_BYTES) continue;
        if (left < length) return 0;
        if (hilcam_decode(dialect, from, length, &packet) != HILCAM_KIND_NONE) return length;
    }
    return 0;
}

static inline const char* hilcam_status_name(unsigned status) {
    static const char* const names[] = {"accepted",     "bad length",     "bad header",
                                        "unknown APID", "bad checksum",   "unknown function",
                                        "bad argument", "unknown object", "time out of range",
                                        "busy",         "not now",        "time went back"};
    return status < sizeof names / sizeof names[0] ? names[status] : "unknown status";
}

// --- time
//
// How far hilcam's machine clock (CLOCK_MONOTONIC) is ahead of the sender's, from four instants of each
// exchange: t1 sent and t4 received by the sender's clock, t2 arrived and t3 departed by the machine's. RFC
// 5905, section 8: offset ((t2 - t1) + (t3 - t4)) / 2, delay (t4 - t1) - (t3 - t2), which errs by no more
// than half the delay. Of the last eight the one with the least error counts (section 10), which grows by 15
// ppm of its age. No scale and no pause of simulated time touches the offset; how simulated time goes on from
// there is in the newest answer.
//
//     hilcam_clock_filter filter = {0};
//     clock.sender_ns = my_clock_ns();                         // then hilcam_encode_clock, send, receive
//     hilcam_clock_take(&filter, clock.sender_ns, my_clock_ns(), &answer.as.acknowledgement.clock);
//     pose.time_tai_ns = hilcam_clock_simulated(&filter, my_clock_ns());

enum { HILCAM_CLOCK_SAMPLES = 8 };
typedef struct {
    struct {
        int64_t offset_ns, delay_ns, received_ns;
    } samples[HILCAM_CLOCK_SAMPLES];
    uint32_t count;  // of them; `next` is overwritten next
    uint32_t next;
    hilcam_clock_reading newest;
} hilcam_clock_filter;

// Clocks of any epoch: what overflows wraps.
static inline int64_t hilcam_minus_(int64_t a, int64_t b) { return hilcam_i64_((uint64_t)a - (uint64_t)b); }

// 0, and nothing is changed, for an exchange that cannot be: an answer before its question.
static inline int hilcam_clock_take(hilcam_clock_filter* f, int64_t sent_ns, int64_t received_ns,
                                    const hilcam_clock_reading* r) {
    const int64_t there = hilcam_minus_(r->arrival_monotonic_ns, sent_ns);
    const int64_t back = hilcam_minus_(r->departure_monotonic_ns, received_ns);
    const int64_t delay = hilcam_minus_(there, back);
    if (received_ns < sent_ns || r->departure_monotonic_ns < r->arrival_monotonic_ns || delay < 0) return 0;
    f->samples[f->next].offset_ns = there / 2 + back / 2 + (there % 2 + back % 2) / 2;
    f->samples[f->next].delay_ns = delay;
    f->samples[f->next].received_ns = received_ns;
    f->next = (f->next + 1) % HILCAM_CLOCK_SAMPLES;
    if (f->count < HILCAM_CLOCK_SAMPLES) ++f->count;
    f->newest = *r;
    return 1;
}

// How far the machine's clock is ahead, at an instant of the sender's: the error at the most [ns] is given,
// -1 before the first exchange. delay_ns: there and back.
static inline double hilcam_clock_estimate(const hilcam_clock_filter* f, int64_t sender_ns,
                                           int64_t* offset_ns, int64_t* delay_ns) {
    double least = -1;
    for (uint32_t i = 0; i < f->count; ++i) {
        const double age = (double)hilcam_minus_(sender_ns, f->samples[i].received_ns);
        const double error = (double)f->samples[i].delay_ns / 2 + 15e-6 * (age < 0 ? -age : age);
        if (least >= 0 && error >= least) continue;
        least = error;
        *offset_ns = f->samples[i].offset_ns;
        *delay_ns = f->samples[i].delay_ns;
    }
    return least;
}

// The simulated time then, while nobody changes how it goes; it errs by the error times the scale. 0 before
// the first exchange: as a time tag, "on arrival".
static inline int64_t hilcam_clock_simulated(const hilcam_clock_filter* f, int64_t sender_ns) {
    const hilcam_clock_reading* r = &f->newest;
    int64_t offset = 0, delay = 0, since, simulated;
    double scaled;
    if (hilcam_clock_estimate(f, sender_ns, &offset, &delay) < 0) return 0;
    since = hilcam_minus_(hilcam_i64_((uint64_t)sender_ns + (uint64_t)offset), r->departure_monotonic_ns);
    scaled = r->scale * (double)since;
    if (r->scale != 1 && scaled > -4e18 && scaled < 4e18)
        since = (int64_t)(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
    simulated = hilcam_i64_((uint64_t)r->departure_tai_ns + (uint64_t)since);
    return simulated < r->stands_at_tai_ns ? simulated : r->stands_at_tai_ns;
}

#ifdef __cplusplus
}
#endif
