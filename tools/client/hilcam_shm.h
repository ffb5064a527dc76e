#pragma once
// A reader of the shared memory that hilcam's outputs.shm fills (docs/shared_memory.md): frames without a copy,
// and what is known of each. C99 and C++ on Linux with GCC or Clang, one file, nothing beyond libc.
//
//     hilcam_shm ring;
//     const char* problem = hilcam_shm_open(&ring, "hilcam");         // NULL: it is open
//     uint64_t number = hilcam_shm_newest(&ring);
//     while (hilcam_shm_wait(&ring, number, 5000) == HILCAM_SHM_NEW) {
//         number = hilcam_shm_newest(&ring);
//         hilcam_shm_frame frame;
//         if (!hilcam_shm_get(&ring, number, &frame)) continue;       // it was overtaken
//         look_at(frame.pixels, frame.report.width_px, frame.report.height_px);
//         if (!hilcam_shm_is_whole(&frame)) forget_what_was_seen();   // it was overwritten meanwhile
//     }
//     hilcam_shm_close(&ring);
//
// The writer never waits: a frame that was read too slowly is told by hilcam_shm_is_whole(), and frames that
// were missed by their numbers. A writer that was killed says nothing: the kernel's lock on its memory tells that it is
// gone, and counts as its end. Threads: any number of readers, each with a hilcam_shm of its own or a common one.

// glibc declares syscall() and clock_gettime() under -std=c99 only with this. A program that is compiled so includes this
// file before any other.
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE 1
#endif
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HILCAM_SHM_VERSION 1
enum { HILCAM_SHM_NEW = 1, HILCAM_SHM_NOTHING = 0, HILCAM_SHM_ENDED = -1 };
// Bits of hilcam_shm_report.flags.
enum {
    HILCAM_SHM_REVERSE_X = 1,
    HILCAM_SHM_REVERSE_Y = 2,
    HILCAM_SHM_HAS_POSE = 4,
    HILCAM_SHM_HAS_TRUTH = 8
};

typedef struct {
    uint64_t id;                        // of the frame in this run, from 1; skipped frames leave a gap
    int64_t exposure_mid_tai_ns;        // simulated time, since 1970-01-01T00:00:00 TAI
    int64_t exposure_mid_monotonic_ns;  // the same instant on CLOCK_MONOTONIC; 0: none
    int64_t published_monotonic_ns;     // when it lay in the memory
    double exposure_s, gain_db, black_level_dn;
    uint32_t bits;  // significant bits of a pixel
    uint32_t width_px, height_px, row_bytes;
    uint32_t binning_x, binning_y;
    uint32_t pose_sequence, trigger_sequence;  // of the newest command, and of the `expose` that asked for it
    int64_t pose_tai_ns;
    uint64_t faults;         // docs/faults.md
    uint32_t quality_level;  // 0: as configured
    uint32_t flags;
    int64_t command_arrival_monotonic_ns;
    double camera_position_m[3];     // in the world, at the exposure's middle, with HILCAM_SHM_HAS_POSE
    double camera_attitude_wxyz[4];  // turns camera axes into the world's
} hilcam_shm_report;

typedef struct {
    const unsigned char* base;
    size_t bytes;
    uint64_t slot_bytes;
    uint32_t slots, header_bytes, slot_header_bytes;
    int file;  // -1: none
} hilcam_shm;

typedef struct {
    hilcam_shm_report report;  // a copy
    const uint16_t* pixels;    // in the memory: row y begins y * row_bytes bytes behind it
    uint64_t number;           // counts the frames of the memory from 1, without gaps
    const unsigned char* slot;
} hilcam_shm_frame;

static inline uint32_t hilcam_shm_u32(const unsigned char* at) {
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return value;
}
static inline uint64_t hilcam_shm_u64(const unsigned char* at) {
    uint64_t value;
    memcpy(&value, at, sizeof value);
    return value;
}
static inline uint64_t hilcam_shm_newest(const hilcam_shm* ring) {
    return __atomic_load_n((const uint64_t*)(const void*)(ring->base + 192), __ATOMIC_ACQUIRE);
}
// 1 when no process writes the memory any more: the writer has let its lock go, by its end or by being killed.
static inline int hilcam_shm_is_abandoned(const hilcam_shm* ring) {
    if (ring->file < 0 || flock(ring->file, LOCK_SH | LOCK_NB) != 0) return 0;
    flock(ring->file, LOCK_UN);
    return 1;
}
// 1 when no more frames come. Two system calls.
static inline int hilcam_shm_has_ended(const hilcam_shm* ring) {
    return __atomic_load_n((const uint32_t*)(const void*)(ring->base + 204), __ATOMIC_ACQUIRE) != 0 ||
           hilcam_shm_is_abandoned(ring);
}

// Reads the header of `bytes` bytes at `base`, which are aligned to 8. Returns NULL, or what is wrong with them.
static inline const char* hilcam_shm_use(hilcam_shm* ring, const void* base, size_t bytes) {
    const unsigned char* at = (const unsigned char*)base;
    static __thread char problem[128];
    if (bytes < 208) return "too short for a shared memory of hilcam's";
    if (__atomic_load_n((const uint64_t*)base, __ATOMIC_ACQUIRE) == 0) return "not ready yet; try again";
    if (memcmp(at, "HLCSHM 1", 8) != 0) return "not a shared memory of hilcam's";
    if (hilcam_shm_u32(at + 8) != HILCAM_SHM_VERSION) {
        snprintf(problem, sizeof problem, "version %u of hilcam's shared memory; accepted: %d",
                 (unsigned)hilcam_shm_u32(at + 8), HILCAM_SHM_VERSION);
        return problem;
    }
    ring->base = at, ring->bytes = bytes, ring->file = -1;
    ring->header_bytes = hilcam_shm_u32(at + 12), ring->slots = hilcam_shm_u32(at + 16);
    ring->slot_header_bytes = hilcam_shm_u32(at + 20), ring->slot_bytes = hilcam_shm_u64(at + 24);
    if (hilcam_shm_u64(at + 32) != bytes || hilcam_shm_u32(at + 48) != 2 || ring->slots < 1 ||
        ring->header_bytes < 208 || ring->header_bytes % 8 != 0 || ring->header_bytes > bytes ||
        ring->slot_header_bytes < 184 || ring->slot_header_bytes % 8 != 0 || ring->slot_bytes % 8 != 0 ||
        ring->slot_bytes < ring->slot_header_bytes ||
        ring->slot_bytes > (bytes - ring->header_bytes) / ring->slots)
        return "its header's figures do not fit its size";
    return NULL;
}

// Opens /dev/shm/NAME. Returns NULL, or what is wrong.
static inline const char* hilcam_shm_open(hilcam_shm* ring, const char* name) {
    char path[256] = "";
    struct stat facts;
    const char* problem;
    void* base;
    int file;
    memset(ring, 0, sizeof *ring);
    ring->file = -1;
    if (snprintf(path, sizeof path, "/%s", name) >= (int)sizeof path) return "a name of more than 254 bytes";
    file = shm_open(path, O_RDONLY, 0);
    if (file < 0)
        return errno == ENOENT ? "there is no such shared memory: does hilcam run with outputs.shm?"
                               : strerror(errno);
    if (fstat(file, &facts) != 0 || facts.st_size < 208) {
        close(file);
        return "not ready yet; try again";
    }
    base = mmap(NULL, (size_t)facts.st_size, PROT_READ, MAP_SHARED, file, 0);
    problem = base == MAP_FAILED ? strerror(errno) : hilcam_shm_use(ring, base, (size_t)facts.st_size);
    if (!problem) {
        ring->file = file;
        return NULL;
    }
    if (base != MAP_FAILED) munmap(base, (size_t)facts.st_size);
    close(file);
    memset(ring, 0, sizeof *ring);
    ring->file = -1;
    return problem;
}
static inline void hilcam_shm_close(hilcam_shm* ring) {
    if (ring->base) munmap((void*)ring->base, ring->bytes);
    if (ring->base && ring->file >= 0) close(ring->file);
    memset(ring, 0, sizeof *ring);
    ring->file = -1;
}

// 1 while the frame is still what it was; ask after its pixels were read.
static inline int hilcam_shm_is_whole(const hilcam_shm_frame* frame) {
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    return __atomic_load_n((const uint64_t*)(const void*)frame->slot, __ATOMIC_RELAXED) == 2 * frame->number;
}
// Finds a frame by its number: 1, or 0 when it is not there yet or no longer.
static inline int hilcam_shm_get(const hilcam_shm* ring, uint64_t number, hilcam_shm_frame* frame) {
    const unsigned char* slot;
    if (number == 0) return 0;
    slot = ring->base + ring->header_bytes + (number - 1) % ring->slots * ring->slot_bytes;
    if (__atomic_load_n((const uint64_t*)(const void*)slot, __ATOMIC_ACQUIRE) != 2 * number) return 0;
    memcpy(&frame->report, slot + 8, sizeof frame->report);
    frame->slot = slot, frame->number = number;
    frame->pixels = (const uint16_t*)(const void*)(slot + ring->slot_header_bytes);
    if (!hilcam_shm_is_whole(frame)) return 0;
    return frame->report.row_bytes >= 2ull * frame->report.width_px && frame->report.row_bytes % 2 == 0 &&
           (uint64_t)frame->report.row_bytes * frame->report.height_px <=
               ring->slot_bytes - ring->slot_header_bytes;
}
// Waits until there is a frame newer than number `after`: HILCAM_SHM_NEW, HILCAM_SHM_NOTHING when none came in
// time, HILCAM_SHM_ENDED when none will come. A writer that was killed is missed within a tenth of a second.
static inline int hilcam_shm_wait(const hilcam_shm* ring, uint64_t after, int timeout_ms) {
    struct timespec now, until, left;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += timeout_ms / 1000, until.tv_nsec += timeout_ms % 1000 * 1000000l;
    for (;;) {
        const uint32_t* word = (const uint32_t*)(const void*)(ring->base + 200);
        const uint32_t seen = __atomic_load_n(word, __ATOMIC_ACQUIRE);
        if (hilcam_shm_newest(ring) > after) return HILCAM_SHM_NEW;
        if (hilcam_shm_has_ended(ring)) return HILCAM_SHM_ENDED;
        clock_gettime(CLOCK_MONOTONIC, &now);
        left.tv_sec = until.tv_sec - now.tv_sec, left.tv_nsec = until.tv_nsec - now.tv_nsec;
        while (left.tv_nsec < 0) left.tv_nsec += 1000000000l, left.tv_sec -= 1;
        while (left.tv_nsec >= 1000000000l) left.tv_nsec -= 1000000000l, left.tv_sec += 1;
        if (left.tv_sec < 0) return HILCAM_SHM_NOTHING;
        if (left.tv_sec > 0 || left.tv_nsec > 100000000l) left.tv_sec = 0, left.tv_nsec = 100000000l;
        syscall(SYS_futex, word, FUTEX_WAIT, seen, &left, NULL, 0);
    }
}

#ifdef __cplusplus
}
#endif
