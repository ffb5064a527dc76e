// A C99 program that talks to a running hilcam through tools/client/hilcam_client.h and POSIX sockets: every
// command once with its answer, then poses at a steady rate whose answers and frames are checked one by one.
//
//     talk ADDRESS PORT udp|tcp hilcam|cfs SECONDS POSES_A_SECOND
//
// Prints a line of figures. Exit status 1, and what is wrong on standard error, when a command is not
// answered as docs/protocol.md says, when an answer is missing, comes twice or out of order, or when a
// frame's pose is older than that of the frame before it or has not the tag that was sent.
#define _POSIX_C_SOURCE 200809L

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "tools/client/hilcam_client.h"

// Half of what hilcam's receiving socket holds by Linux's default (256 datagrams of this size in 212992
// bytes): no burst of this program overflows it, however long its reader waits for a processor.
enum { MOST_UNANSWERED = 128, REMEMBERED_TAGS = 8192, STREAM_BYTES = 65536 };
#define PATIENCE_NS 10000000000LL

typedef struct {
    int socket, is_stream, dialect;
    uint32_t sequence;  // of the next command
    uint8_t stream[STREAM_BYTES];
    size_t stream_bytes;
    unsigned long problems;
} link_t;

static int64_t now_ns(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static void problem(link_t* l, const char* what, uint32_t number) {
    if (++l->problems <= 20) fprintf(stderr, "talk: %s (%lu)\n", what, (unsigned long)number);
}

static uint32_t on_wire(const link_t* l, uint32_t sequence) {
    return l->dialect == HILCAM_DIALECT_CFS ? sequence & 0x3FFFu : sequence;
}

static hilcam_envelope next_envelope(link_t* l) {
    hilcam_envelope e;
    e.dialect = (uint8_t)l->dialect, e.camera = 0, e.sequence = l->sequence++;
    return e;
}

static void send_all(link_t* l, const uint8_t* bytes, size_t size) {
    while (size > 0) {
        const ssize_t sent = send(l->socket, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR) perror("talk: send"), exit(1);
        if (sent > 0) bytes += sent, size -= (size_t)sent;
    }
}

// The next answer; 0 when there is none in time. A timeout of 0 takes what is there.
static int receive(link_t* l, int timeout_ms, hilcam_packet* packet) {
    for (;;) {
        size_t at;
        const size_t size = hilcam_find(l->dialect, l->stream, l->stream_bytes, &at);
        if (size > 0) hilcam_decode(l->dialect, l->stream + at, size, packet);
        l->stream_bytes -= at + size;
        memmove(l->stream, l->stream + at + size, l->stream_bytes);
        if (size > 0) return 1;
        if (!l->is_stream) l->stream_bytes = 0;  // a datagram is whole
        struct pollfd p = {l->socket, POLLIN, 0};
        if (poll(&p, 1, timeout_ms) <= 0) return 0;
        const ssize_t got = recv(l->socket, l->stream + l->stream_bytes, STREAM_BYTES - l->stream_bytes, 0);
        if (got < 0 && errno != ECONNREFUSED) perror("talk: recv"), exit(1);
        if (got == 0 && l->is_stream) fprintf(stderr, "talk: hilcam hung up\n"), exit(1);
        if (got > 0) l->stream_bytes += (size_t)got;
    }
}

// Sends and waits for the answer, past telemetry.
static hilcam_acknowledgement ask(link_t* l, const uint8_t* bytes, size_t size, uint32_t sequence,
                                  unsigned expected) {
    hilcam_packet packet;
    if (size == 0) problem(l, "a command was not encoded; its sequence", sequence);
    send_all(l, bytes, size);
    while (receive(l, 10000, &packet)) {
        const hilcam_acknowledgement* a = &packet.as.acknowledgement;
        if (packet.kind != HILCAM_KIND_ACKNOWLEDGEMENT || a->sequence != on_wire(l, sequence)) continue;
        if (a->status != expected) {
            fprintf(stderr, "talk: function %u: %s: %s\n", a->function, hilcam_status_name(a->status),
                    a->reason);
            problem(l, "another status was expected", expected);
        }
        return *a;
    }
    fprintf(stderr, "talk: no answer\n");
    exit(1);
}

// --- every command once

static void every_command(link_t* l) {
    uint8_t b[HILCAM_MOST_PACKET_BYTES];
    hilcam_envelope e = next_envelope(l);
    if (ask(l, b, hilcam_encode_ping(&e, 0x0123456789ABCDEFu, b, sizeof b), e.sequence, HILCAM_ACCEPTED)
            .token != 0x0123456789ABCDEFu)
        problem(l, "the ping's token came back changed", e.sequence);
    e = next_envelope(l);
    hilcam_clock clock;
    clock.action = HILCAM_CLOCK_ASK, clock.sender_ns = -5, clock.scale = 0, clock.step_ns = 0;
    const hilcam_acknowledgement told =
        ask(l, b, hilcam_encode_clock(&e, &clock, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    if (told.token != (uint64_t)-5 || !told.has_clock || told.clock.scale < 1 || told.clock.scale > 1)
        problem(l, "the clock's answer is not one", e.sequence);
    e = next_envelope(l);
    hilcam_settings settings;
    settings.mask = HILCAM_SET_EXPOSURE | HILCAM_SET_GAIN;
    settings.exposure_s = 0.0002, settings.gain_db = 0,
    settings.frame_rate_hz = -1;  // not in the mask: not looked at
    ask(l, b, hilcam_encode_settings(&e, &settings, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    settings.gain_db = 1e6;
    ask(l, b, hilcam_encode_settings(&e, &settings, b, sizeof b), e.sequence, HILCAM_BAD_ARGUMENT);
    e = next_envelope(l);
    ask(l, b, hilcam_encode_stop(&e, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    ask(l, b, hilcam_encode_start(&e, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    hilcam_joint joint;
    joint.object = 1, joint.joint = 999, joint.time_tai_ns = 0, joint.angle_rad = 1, joint.rate_rad_s = 0;
    ask(l, b, hilcam_encode_joint(&e, &joint, b, sizeof b), e.sequence, HILCAM_UNKNOWN_OBJECT);
    e = next_envelope(l);
    hilcam_fault fault;
    memset(&fault, 0, sizeof fault);
    fault.kind = HILCAM_FAULT_IMAGE_BLACK, fault.rate = 1, fault.frames = 1;
    ask(l, b, hilcam_encode_fault(&e, &fault, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    fault.kind = HILCAM_FAULT_NONE;
    ask(l, b, hilcam_encode_fault(&e, &fault, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    hilcam_expose expose;
    expose.frames = 1, expose.time_tai_ns = 0;
    ask(l, b, hilcam_encode_expose(&e, &expose, b, sizeof b), e.sequence, HILCAM_NOT_NOW);  // it runs free
    e = next_envelope(l);
    hilcam_mode mode;
    mode.triggered = 0, mode.burst_frames = 0;
    ask(l, b, hilcam_encode_mode(&e, &mode, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
    e = next_envelope(l);
    ask(l, b, hilcam_encode_subscribe(&e, HILCAM_TELL_FRAMES | HILCAM_TELL_HOUSEKEEPING, b, sizeof b),
        e.sequence, HILCAM_ACCEPTED);
}

// --- poses at a steady rate

typedef struct {
    uint32_t first;                    // sequence of the first pose
    uint32_t sent, answered;           // poses
    int64_t tags_ns[REMEMBERED_TAGS];  // by pose's number
    unsigned long frames, fresh, housekeeping, dropped;
    uint32_t newest_shown;   // pose's number + 1
    uint32_t next_count[2];  // of frame reports and housekeeping; UINT32_MAX: none yet
} flight_t;

static void check_answer(link_t* l, flight_t* f, const hilcam_acknowledgement* a) {
    if (a->status != HILCAM_ACCEPTED) problem(l, "a pose was refused; its number", f->answered);
    if (a->sequence != on_wire(l, f->first + f->answered))
        problem(l, "answers are not in order at", f->answered);
    ++f->answered;
}

static void check_report(link_t* l, flight_t* f, const hilcam_frame_report* r) {
    ++f->frames;
    // How many poses after the first it is; frames may still show what another sender sent before.
    const uint32_t mask = l->dialect == HILCAM_DIALECT_CFS ? 0x3FFFu : 0xFFFFFFFFu;
    uint32_t number = (r->pose_sequence - f->first) & mask;
    if (mask == 0x3FFFu && f->newest_shown > 0)  // 14 bits: the one next to what was shown before
        number = f->newest_shown - 1 + ((number - (f->newest_shown - 1)) & mask);
    if (number >= f->sent) {
        if (f->newest_shown > 0)
            problem(l, "a frame shows a pose that was not sent, or an older one", r->pose_sequence);
        return;
    }
    if (number + 1 < f->newest_shown)
        problem(l, "a frame shows an older pose than the one before it", number);
    if (number + 1 > f->newest_shown) ++f->fresh;
    f->newest_shown = number + 1;
    if (f->sent - number < REMEMBERED_TAGS && f->tags_ns[number % REMEMBERED_TAGS] != r->pose_time_tai_ns)
        problem(l, "a frame's pose has another time tag than it was sent with", number);
}

static void check_count(flight_t* f, int which, uint16_t count) {
    if (f->next_count[which] != UINT32_MAX) f->dropped += (count - f->next_count[which]) & 0x3FFFu;
    f->next_count[which] = (count + 1u) & 0x3FFFu;
}

static void take_answers(link_t* l, flight_t* f, int timeout_ms) {
    hilcam_packet packet;
    while (receive(l, timeout_ms, &packet)) {
        timeout_ms = 0;
        if (packet.kind == HILCAM_KIND_ACKNOWLEDGEMENT) {
            check_answer(l, f, &packet.as.acknowledgement);
        } else if (packet.kind == HILCAM_KIND_FRAME_REPORT) {
            check_count(f, 0, packet.count);
            check_report(l, f, &packet.as.frame_report);
        } else {
            check_count(f, 1, packet.count);
            ++f->housekeeping;
        }
    }
}

static void send_pose(link_t* l, flight_t* f, int64_t tag_ns, double t_s) {
    uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
    const hilcam_envelope e = next_envelope(l);
    hilcam_pose pose;
    memset(&pose, 0, sizeof pose);
    pose.time_tai_ns = tag_ns;
    pose.position_m[0] = -30 - 0.001 * t_s, pose.velocity_m_s[0] = -0.001;
    pose.attitude_wxyz[0] = 0.70710678118654752,
    pose.attitude_wxyz[2] = 0.70710678118654752;  // +z along the world's +x
    f->tags_ns[f->sent % REMEMBERED_TAGS] = tag_ns;
    send_all(l, bytes, hilcam_encode_pose(&e, &pose, bytes, sizeof bytes));
    ++f->sent;
}

static void fly(link_t* l, flight_t* f, double seconds, double rate_hz) {
    uint8_t b[HILCAM_MOST_PACKET_BYTES];
    hilcam_clock_filter filter;
    memset(&filter, 0, sizeof filter);
    for (int i = 0; i < HILCAM_CLOCK_SAMPLES; ++i) {
        const hilcam_envelope e = next_envelope(l);
        hilcam_clock clock;
        clock.action = HILCAM_CLOCK_ASK, clock.sender_ns = now_ns(), clock.scale = 0, clock.step_ns = 0;
        const hilcam_acknowledgement told =
            ask(l, b, hilcam_encode_clock(&e, &clock, b, sizeof b), e.sequence, HILCAM_ACCEPTED);
        if (!hilcam_clock_take(&filter, clock.sender_ns, now_ns(), &told.clock))
            problem(l, "an exchange of clock readings cannot be", e.sequence);
    }
    const int64_t start_ns = now_ns();
    const uint32_t total = (uint32_t)(seconds * rate_hz + 0.5);
    int64_t last_progress_ns = start_ns;
    f->first = l->sequence;
    while (f->answered < total) {
        const uint32_t answered = f->answered;
        int64_t now = now_ns();
        // As many as are due by now: what a busy machine delays is made up for, up to the window.
        while (f->sent < total && f->sent - f->answered < MOST_UNANSWERED &&
               (double)(now - start_ns) * 1e-9 * rate_hz >= f->sent) {
            send_pose(l, f, hilcam_clock_simulated(&filter, now), (double)(now - start_ns) * 1e-9);
            now = now_ns();
        }
        take_answers(l, f, 1);
        if (f->answered != answered) last_progress_ns = now;
        if (now - last_progress_ns > PATIENCE_NS) {
            problem(l, "poses without an answer", f->sent - f->answered);
            return;
        }
    }
    // The frames that show the last poses.
    const int64_t until_ns = now_ns() + 2000000000;
    while (now_ns() < until_ns && f->newest_shown < f->sent) take_answers(l, f, 50);
    if (f->newest_shown != f->sent)
        problem(l, "no frame shows the last pose; the newest shown", f->newest_shown);
}

static int open_link(const char* address, const char* port, int is_stream) {
    struct sockaddr_in to;
    memset(&to, 0, sizeof to);
    to.sin_family = AF_INET;
    to.sin_port = htons((uint16_t)atoi(port));
    if (inet_pton(AF_INET, address, &to.sin_addr) != 1) return -1;
    const int fd = socket(AF_INET, is_stream ? SOCK_STREAM : SOCK_DGRAM, 0);
    if (fd < 0 || connect(fd, (const struct sockaddr*)&to, sizeof to) != 0) return -1;
    const int on = 1, room = 1 << 20;
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    if (is_stream) setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
}

int main(int argc, char** argv) {
    static link_t link;
    static flight_t flight;
    if (argc != 7) {
        fprintf(stderr, "usage: talk ADDRESS PORT udp|tcp hilcam|cfs SECONDS POSES_A_SECOND\n");
        return 2;
    }
    link.is_stream = strcmp(argv[3], "tcp") == 0;
    link.dialect = strcmp(argv[4], "cfs") == 0 ? HILCAM_DIALECT_CFS : HILCAM_DIALECT_OWN;
    link.socket = open_link(argv[1], argv[2], link.is_stream);
    if (link.socket < 0) {
        perror("talk: no connection");
        return 1;
    }
    flight.next_count[0] = flight.next_count[1] = UINT32_MAX;
    every_command(&link);
    fly(&link, &flight, atof(argv[5]), atof(argv[6]));
    printf(
        "{\"commands\": %lu, \"poses\": %lu, \"answered\": %lu, \"frames\": %lu, \"frames_with_a_new_pose\": "
        "%lu, "
        "\"housekeeping\": %lu, \"telemetry_dropped\": %lu, \"problems\": %lu}\n",
        (unsigned long)link.sequence, (unsigned long)flight.sent, (unsigned long)flight.answered,
        flight.frames, flight.fresh, flight.housekeeping, flight.dropped, link.problems);
    close(link.socket);
    return link.problems == 0 ? 0 : 1;
}
