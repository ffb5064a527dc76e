#include "emulator/scenario/spice_config.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "io/spice/ephemeris_time.h"
#include "io/spice/instrument_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(KernelFileConfig& k) {
    return {required(path("file", k.file,
                          "kernel (SPK, CK, PCK, FK, IK, SCLK, LSK), or a meta-kernel that lists others"))};
}

Fields fields(SpiceConfig& s) {
    return {
        required(
            sections("kernels", s.kernels, "kernels in the order of loading; later ones take precedence")),
        choice("bodies", s.bodies, {"kernels", "own"},
               "source of positions and rotations of the Sun, the Moon and the planets. kernels: the "
               "kernels, for bodies that they cover at the start; own: the program's own series"),
        text("camera", s.camera,
             "instrument whose kernel (IK) gives focal length, pixel pitch and number of pixels, in place of "
             "the camera file: a name or a NAIF code"),
        number("tolerance_s", s.tolerance_s, 1, {0, 1e6},
               "longest time from an attitude's instant for which the attitude applies, as in C-kernels of "
               "single instants (type 1)"),
    };
}

void validate(const SpiceConfig& s) {
    if (s.kernels.empty()) throw KeyError("kernels", "has none; accepted: one or more");
}

Fields fields(SpiceObjectConfig& o) {
    return {required(text("object", o.object, "SPICE object: a name or a NAIF code"))};
}

Fields fields(SpiceFrameConfig& f) {
    return {
        text("frame", f.frame, "SPICE frame; left out: the instrument's frame"),
        text("instrument", f.instrument, "instrument whose kernel (IK) gives frame and boresight"),
        optional(vector3("boresight", f.boresight, 1, {-1e6, 1e6},
                         "axis of the frame along which the camera looks; left out: the instrument's "
                         "boresight, or z of the frame"),
                 f.has_boresight),
        vector3("right", f.right, 1, {-1e6, 1e6}, "axis of the frame that points right in the picture"),
    };
}

void validate(const SpiceFrameConfig& f) {
    if (f.frame.empty() && f.instrument.empty())
        throw KeyError("frame", "is not given, and no 'instrument'; accepted: one of them");
    const double across = length(cross(f.boresight, f.right));
    if (f.has_boresight && !(across > 1e-9 * length(f.boresight) * length(f.right)))
        throw KeyError("right", "is parallel to 'boresight'; accepted: another direction");
}

namespace {

// Names the leap seconds of the program's own table that a kernel lacks at its end; empty: none.
std::string missing_leap_seconds(const KernelPool& pool, const std::vector<LeapSecond>& kernel,
                                 const std::vector<LeapSecond>& own) {
    if (kernel.empty()) return {};
    const auto month = [](const LeapSecond& leap) { return leap.year * 12 + leap.month; };
    std::string dates;
    for (const LeapSecond& leap : own)
        if (month(leap) > month(kernel.back()))
            dates += fmt::format("{}{}-{:02}-01", dates.empty() ? "" : ", ", leap.year, leap.month);
    if (dates.empty()) return {};
    return fmt::format(
        "spice: {}: DELTET/DELTA_AT lacks the leap seconds of {}, which the program has: later times follow "
        "the kernel and are up to {} s off UTC; accepted without this warning: naif0012.tls or a newer one",
        pool.find("DELTET/DELTA_AT")->where, dates,
        own.back().tai_minus_utc_s - kernel.back().tai_minus_utc_s);
}

}  // namespace

std::string load_spice(SpiceConfig& s) {
    std::vector<std::filesystem::path> files;
    for (const KernelFileConfig& k : s.kernels) files.push_back(k.file);
    try {
        s.loaded = std::make_shared<SpiceKernels>(files, s.tolerance_s);
        const KernelPool& pool = s.loaded->set.pool;
        const std::vector<LeapSecond> kernel = leap_seconds_of(pool);
        const std::string warning = missing_leap_seconds(pool, kernel, leap_seconds_in_use());
        use_leap_seconds(kernel);
        return warning;
    } catch (const InputError& error) {
        throw InputError(std::string("spice: ") + error.what());
    }
}

std::string apply_instrument(const SpiceConfig& s, CameraModel& camera) {
    if (s.camera.empty()) return "";
    const InstrumentKernel k = instrument_kernel(s.loaded->set.pool, s.camera, "spice.camera");
    if (!k.focal_length_m || !k.pitch_m)
        throw InputError("spice.camera: the kernel of " + in_quotes(s.camera) + " has no INS" +
                         std::to_string(k.code) +
                         (k.focal_length_m ? "_PIXEL_PITCH or _PIXEL_SIZE" : "_FOCAL_LENGTH") +
                         "; accepted: a kernel with both, or a camera's sheet alone");
    camera.focal_length_m = *k.focal_length_m, camera.pitch_m = *k.pitch_m;
    if (k.samples) camera.width_px = *k.samples;
    if (k.lines) camera.height_px = *k.lines;
    // A kernel's principal point is in its own pixels.
    if (k.center_px && k.samples && k.lines && camera.principal_point_px.empty())
        camera.principal_point_px = {k.center_px->x, k.center_px->y};
    if (!k.half_field_rad || !k.samples || !k.lines) return "";
    const double half_m =
        0.5 * camera.pitch_m *
        std::hypot(static_cast<double>(camera.width_px), static_cast<double>(camera.height_px));
    const double half_rad = std::atan2(half_m, camera.focal_length_m);
    if (std::abs(half_rad - *k.half_field_rad) < 0.02 * half_rad) return "";
    return "spice.camera: the instrument kernel's field of view is " +
           plain(2 * *k.half_field_rad / kDegree_rad) +
           " deg over its corners; its focal length and pixels make " + plain(2 * half_rad / kDegree_rad) +
           " deg";
}

SpiceMounting mounting_of(const SpiceFrameConfig& f, const SpiceKernels& kernels) {
    std::string frame = f.frame;
    Vec3d boresight = f.boresight;
    if (!f.instrument.empty()) {
        const InstrumentKernel k =
            instrument_kernel(kernels.set.pool, f.instrument, "attitude.spice.instrument");
        if (frame.empty()) frame = k.frame;
        if (!f.has_boresight && k.boresight) boresight = *k.boresight;
        if (frame.empty())
            throw InputError("attitude.spice.instrument: the kernel of " + in_quotes(f.instrument) +
                             " has no INS" + std::to_string(k.code) + "_FOV_FRAME; accepted: with a 'frame'");
    }
    const Vec3d z = normalized(boresight), across = f.right - dot(f.right, z) * z;
    if (!(length(across) > 1e-9 * length(f.right)))
        throw InputError("attitude.spice.right: is parallel to the boresight; accepted: another direction");
    const Vec3d x = normalized(across);
    return {frame, to_quat(transposed(Mat3d{x, cross(z, x), z}))};
}

}  // namespace hilcam
