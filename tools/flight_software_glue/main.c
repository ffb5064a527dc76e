// Stands in for the app or component around camera_link.c: a POSIX socket and a loop of 25 Hz. The comments
// name the calls of cFS's operating system layer (OSAL 7.0) that a cFS app has in their places.
//
//     flight_software_glue ADDRESS PORT hilcam|cfs POSES
//
// Sends the poses, and an exposure that the camera refuses; prints figures as a line of JSON. Exit status 1
// when a frame with the last pose does not come within five seconds, or an answer is missing.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/flight_software_glue/camera_link.h"

enum { PERIOD_MS = 40, PATIENCE_PERIODS = 125 };

// OS_SocketOpen with OS_SocketDomain_INET and OS_SocketType_DATAGRAM; the address for OS_SocketSendTo is made
// by OS_SocketAddrInit, OS_SocketAddrFromString and OS_SocketAddrSetPort.
static int open_socket(const char* address, const char* port) {
    struct sockaddr_in to;
    memset(&to, 0, sizeof to);
    to.sin_family = AF_INET;
    to.sin_port = htons((uint16_t)atoi(port));
    if (inet_pton(AF_INET, address, &to.sin_addr) != 1) return -1;
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    return fd >= 0 && connect(fd, (const struct sockaddr*)&to, sizeof to) == 0 ? fd : -1;
}

// OS_SocketSendTo.
static void send_packet(int fd, const uint8_t* bytes, size_t size) {
    if (size == 0 || send(fd, bytes, size, 0) != (ssize_t)size) perror("flight_software_glue: send"), exit(1);
}

// OS_SocketRecvFrom with a timeout; it waits for the rest of the period and takes what has come.
static void receive_packets(int fd, camera_link* link) {
    uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
    struct pollfd p = {fd, POLLIN, 0};
    poll(NULL, 0, PERIOD_MS);
    while (poll(&p, 1, 0) > 0) {
        const ssize_t got = recv(fd, bytes, sizeof bytes, 0);
        if (got > 0) camera_link_take(link, bytes, (size_t)got);
    }
}

int main(int argc, char** argv) {
    static const double towards_x_wxyz[4] = {0.70710678118654752, 0, 0.70710678118654752, 0};
    const int is_cfs = argc == 5 && strcmp(argv[3], "cfs") == 0;
    if (argc != 5 || (!is_cfs && strcmp(argv[3], "hilcam") != 0)) {
        fprintf(stderr, "usage: flight_software_glue ADDRESS PORT hilcam|cfs POSES\n");
        return 2;
    }
    const int fd = open_socket(argv[1], argv[2]), poses = atoi(argv[4]);
    if (fd < 0) return perror("flight_software_glue: no socket"), 1;
    camera_link link;
    camera_link_begin(&link, is_cfs ? HILCAM_DIALECT_CFS : HILCAM_DIALECT_OWN);

    uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
    send_packet(fd, bytes, camera_link_subscribe(&link, bytes));
    send_packet(fd, bytes, camera_link_exposure(&link, 1e6, bytes));  // 11 days: refused
    for (int i = 0; i < poses; ++i) {
        const double position_m[3] = {-40 + 0.04 * i, 0, 0};
        send_packet(fd, bytes, camera_link_pose(&link, 0, position_m, towards_x_wxyz, bytes));
        receive_packets(fd, &link);
    }
    const uint32_t last = link.sequence - 1;
    for (int i = 0; i < PATIENCE_PERIODS &&
                    !(camera_link_shows(&link, last) && link.accepted + link.refused == link.sent);
         ++i)
        receive_packets(fd, &link);
    close(fd);
    printf(
        "{\"sent\": %lu, \"accepted\": %lu, \"refused\": %lu, \"refusal\": \"%s\", \"frames\": %lu, "
        "\"telemetry_lost\": %lu, \"foreign\": %lu, \"newest_frame\": %lu, \"pose_shown\": %lu}\n",
        link.sent, link.accepted, link.refused, link.refusal, link.frames, link.telemetry_lost, link.foreign,
        (unsigned long)link.newest.frame, (unsigned long)link.newest.pose_sequence);
    return camera_link_shows(&link, last) && link.accepted + link.refused == link.sent ? 0 : 1;
}
