#pragma once
// Checks for bugs of our own, which end the program with a message. Bad input is an InputError or a status
// instead.

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

// Always checked: conditions whose failure would give wrong frames.
#define HILCAM_CHECK(condition)                                                   \
    do {                                                                          \
        if (!(condition)) ::hilcam::check_failed(#condition, __FILE__, __LINE__); \
    } while (false)

// Checked in debug builds only: conditions tested per ray or per pixel.
#ifdef NDEBUG
#define HILCAM_DCHECK(condition) \
    do {                         \
    } while (false)
#else
#define HILCAM_DCHECK(condition) HILCAM_CHECK(condition)
#endif

namespace hilcam {

[[noreturn]] inline void check_failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "hilcam: internal error at %s:%d: %s does not hold\n", file, line, condition);
    std::abort();
}

// The user's input cannot be used: a configuration, a mesh, a catalogue, a command line. Thrown while
// starting, never in the loop. The message is one line: what, where, found, accepted. Exit status 2.
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

// "KEY: found FOUND; accepted: ACCEPTED"
inline InputError refused(const std::string& key, const std::string& found, const std::string& accepted) {
    return InputError(key + ": found " + found + "; accepted: " + accepted);
}

// Something outside failed while starting or running: a device is busy, a disk is full. Exit status 1.
class DeviceError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace hilcam
