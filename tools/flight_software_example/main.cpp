// A small flight program in a closed loop with hilcam: takes frames from its GigE Vision camera, finds the
// target, and steers the vehicle so that the target stays in the middle of the picture through an approach.
//
// Two programs of a bench are in it. The flight software (camera, centroid, pointing) knows the pictures
// alone. The dynamics (vehicle, link) move the vehicle as the pointing law asks, and tell hilcam where it is.
// What the law asks for acts a processing delay after the exposure's middle, in both modes.
//
//   lockstep   one frame for each command, simulated time: the same bits on any machine, as slow as it is
//   free-run   the camera at its own rate in real time; poses a hundred times a second

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>

#include "tools/flight_software_example/camera.h"
#include "tools/flight_software_example/centroid.h"
#include "tools/flight_software_example/link.h"
#include "tools/flight_software_example/pointing.h"
#include "tools/flight_software_example/vehicle.h"

namespace flight {
namespace {

struct Options {
    std::string camera = "127.0.0.1";
    std::string commands = "127.0.0.1:5010";
    std::string log = "approach.csv";
    bool free_run = false;
    double duration_s = 100;
    double frame_period_s = 0.2;      // in free-run the camera's own counts
    double processing_delay_s = 0.1;  // lockstep; in free-run it takes what it takes
    std::int64_t frames = 0;          // lockstep; 0: until the approach is over
    std::vector<double> from_m = {1879.4, -684.0, 0};
    std::vector<double> to_m = {470.5, -169.1, 1};     // past the target: the line of sight turns on the way
    std::vector<double> off_pointing_mrad = {9, -20};  // about x and y, at the start
    double focal_px = 25e-3 / 5.5e-6;
    PointingGains gains;
};

void add_options(CLI::App& app, Options& o) {
    app.add_option("--camera", o.camera, "IPv4 address or name of the GigE Vision camera")
        ->capture_default_str();
    app.add_option("--commands", o.commands, "ADDRESS:PORT where hilcam listens")->capture_default_str();
    app.add_option("--log", o.log, "a line for each frame, CSV")->capture_default_str();
    app.add_flag("--free-run", o.free_run,
                 "in real time; else in lockstep, with 'hilcam run --set mode=lockstep'");
    const CLI::Range positive(1e-3, 1e6);
    app.add_option("--duration-s", o.duration_s, "of the approach, simulated")
        ->check(positive)
        ->capture_default_str();
    app.add_option("--frame-period-s", o.frame_period_s, "lockstep: between frames; free-run: the camera's")
        ->check(positive)
        ->capture_default_str();
    app.add_option("--frames", o.frames, "lockstep: end after so many; 0: at the approach's end");
    app.add_option("--processing-delay-s", o.processing_delay_s, "lockstep: from exposure to actuation")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--from-m", o.from_m, "x y z of the rail's far end")->expected(3)->capture_default_str();
    app.add_option("--to-m", o.to_m, "x y z of its near end")->expected(3)->capture_default_str();
    app.add_option("--off-pointing-mrad", o.off_pointing_mrad,
                   "error at the start, about the camera's x and y")
        ->expected(2)
        ->capture_default_str();
    app.add_option("--focal-px", o.focal_px, "the camera's focal length, of its calibration")
        ->check(positive)
        ->capture_default_str();
    app.add_option("--natural-frequency-rad-s", o.gains.natural_frequency_rad_s, "of the pointing loop")
        ->capture_default_str();
    app.add_option("--damping-ratio", o.gains.damping_ratio, "of the pointing loop")->capture_default_str();
}

cv::Vec3d vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

// Ctrl-C ends the flight where it is: the log is whole, the camera is given back. A second one kills.
volatile std::sig_atomic_t interrupted = 0;

void end_on_signals() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

// Where the vehicle was at an instant: what the log compares the frame with.
struct Sample {
    double t_s = 0;
    Attitude attitude;
};

class Approach {
  public:
    explicit Approach(const Options& o)
        : options_(o),
          link_(o.commands),
          camera_(o.camera),
          law_({o.focal_px, {0.5 * (camera_.width_px() - 1), 0.5 * (camera_.height_px() - 1)}}, o.gains),
          rail_{vec3(o.from_m), vec3(o.to_m), o.duration_s},
          // The target is known to be near the world's origin, as a coarse sensor would say.
          attitude_(Attitude::looking(-rail_.from_m, {0, 0.5, 0.866})),
          log_(std::fopen(o.log.c_str(), "w")) {
        if (!log_) throw std::runtime_error(o.log + ": cannot be written");
        std::setvbuf(log_.get(), nullptr, _IOLBF, BUFSIZ);  // whole lines, however the flight ends
        attitude_.offset(1e-3 * cv::Vec3d(o.off_pointing_mrad[0], o.off_pointing_mrad[1], 0));
        std::fputs("frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz,found,error_x_px,error_y_px,light_dn\n", log_.get());
    }

    void in_lockstep() {
        // Simulated time stands until a frame is asked for; the first is a period on.
        const auto at_ns = [&](std::int64_t k) {
            return std::int64_t(std::llround(static_cast<double>(k) * options_.frame_period_s * 1e9));
        };
        start_tai_ns_ = link_.ping().simulated_tai_ns + at_ns(1);
        cv::Vec3d before, now;
        const double delay_s = std::min(options_.processing_delay_s, options_.frame_period_s);
        const std::int64_t all = 1 + std::llround(options_.duration_s / options_.frame_period_s);
        const std::int64_t frames = options_.frames > 0 ? std::min(options_.frames, all) : all;
        for (std::int64_t k = 0; k < frames && !interrupted; ++k) {
            const std::int64_t tag_ns = start_tai_ns_ + at_ns(k);
            const double t_s = 1e-9 * static_cast<double>(at_ns(k));
            link_.set_pose(pose_at(t_s, tag_ns));
            link_.expose(tag_ns);
            Frame frame;
            if (!await(frame)) return;
            if (frame.exposure_mid_tai_ns != tag_ns)
                throw std::runtime_error("frame " + std::to_string(frame.id) +
                                         " is not the one that was asked for");
            before = now;
            now = see(frame, {t_s, attitude_});
            // What the last frame asked for acts on until this one has been looked at.
            attitude_.turn(before, delay_s);
            attitude_.turn(now, options_.frame_period_s - delay_s);
        }
    }

    void in_free_run() {
        constexpr double kStep_s = 0.01;
        const std::int64_t offset_ns = link_.simulated_offset_ns();
        start_tai_ns_ = monotonic_ns() + offset_ns;
        cv::Vec3d acceleration;
        std::deque<Sample> flown;
        double seen_s = 0;  // when the last frame came
        for (double t_s = 0; t_s < options_.duration_s && !interrupted;) {
            const std::int64_t tag_ns = monotonic_ns() + offset_ns;
            const double now_s = 1e-9 * static_cast<double>(tag_ns - start_tai_ns_);
            if (now_s >= t_s + kStep_s || flown.empty()) {
                attitude_.turn(acceleration, now_s - t_s);
                t_s = now_s;
                link_.post_pose(pose_at(t_s, tag_ns));
                flown.push_back({t_s, attitude_});
                if (flown.size() > 500) flown.pop_front();
            }
            // Blind, it coasts, as it does when the target is out of sight.
            if (t_s - seen_s > kBlind_periods * options_.frame_period_s) acceleration = {};
            if (t_s - seen_s > kGone_s) throw std::runtime_error(no_frames(kGone_s));
            Frame frame;
            if (!camera_.take(std::chrono::milliseconds(2), frame)) continue;
            seen_s = t_s;
            const double mid_s = 1e-9 * static_cast<double>(frame.exposure_mid_tai_ns - start_tai_ns_);
            if (mid_s < flown.front().t_s) continue;  // of before the start
            acceleration = see(frame, sample_at(flown, mid_s));
        }
    }

    void print_summary() const {
        std::printf("{\"frames\": %llu, \"target_found\": %llu, \"frames_lost\": %llu}\n",
                    static_cast<unsigned long long>(frames_), static_cast<unsigned long long>(found_),
                    static_cast<unsigned long long>(camera_.lost()));
    }

  private:
    static constexpr double kBlind_periods = 3, kGone_s = 10, kLockstepPatience_s = 20;

    std::string no_frames(double seconds) const {
        return "camera " + options_.camera + ": no whole frame for " + std::to_string(std::lround(seconds)) +
               " s; is 'hilcam run' up, and in the same mode (lockstep, free-run)?";
    }

    // The frame of an exposure in lockstep; false: Ctrl-C.
    bool await(Frame& frame) {
        const std::int64_t until_ns = monotonic_ns() + std::llround(kLockstepPatience_s * 1e9);
        while (!camera_.take(std::chrono::milliseconds(100), frame)) {
            if (interrupted) return false;
            if (monotonic_ns() > until_ns) throw std::runtime_error(no_frames(kLockstepPatience_s));
        }
        return true;
    }

    hilcam_pose pose_at(double t_s, std::int64_t tag_ns) const {
        hilcam_pose pose{};
        pose.time_tai_ns = tag_ns;
        const cv::Vec3d position_m = rail_.position_m(t_s), velocity_m_s = rail_.velocity_m_s(t_s);
        for (int i = 0; i < 3; ++i) {
            pose.position_m[i] = position_m[i];
            pose.velocity_m_s[i] = velocity_m_s[i];
            pose.rate_rad_s[i] = attitude_.rate_rad_s()[i];
        }
        const cv::Quatd& q = attitude_.world_from_body();
        pose.attitude_wxyz[0] = q.w, pose.attitude_wxyz[1] = q.x;
        pose.attitude_wxyz[2] = q.y, pose.attitude_wxyz[3] = q.z;
        return pose;
    }

    // As hilcam does between poses: the one before, turned on at its rate.
    static Sample sample_at(const std::deque<Sample>& flown, double t_s) {
        Sample sample = flown.front();
        for (const Sample& s : flown)
            if (s.t_s <= t_s) sample = s;
        sample.attitude.turn({}, t_s - sample.t_s);
        sample.t_s = t_s;
        return sample;
    }

    // The flight software: a picture in, an acceleration out.
    cv::Vec3d see(const Frame& frame, const Sample& truth) {
        const std::optional<Centroid> target = find_target(frame.image, {});
        std::optional<cv::Vec2d> at_px;
        if (target) at_px = target->at_px;
        ++frames_;
        found_ += target.has_value();
        write(frame, truth, target);
        return law_.acceleration_rad_s2(at_px, truth.t_s);
    }

    void write(const Frame& frame, const Sample& truth, const std::optional<Centroid>& target) {
        const cv::Vec3d p = rail_.position_m(truth.t_s);
        const cv::Quatd& q = truth.attitude.world_from_body();
        cv::Vec2d error_px(std::nan(""), std::nan(""));
        if (target) error_px = target->at_px - law_.camera().boresight_px;
        std::fprintf(log_.get(), "%llu,%.9f,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d,%.17g,%.17g,%.17g\n",
                     static_cast<unsigned long long>(frame.id), truth.t_s, p[0], p[1], p[2], q.w, q.x, q.y,
                     q.z, target ? 1 : 0, error_px[0], error_px[1], target ? target->light_dn : 0.0);
    }

    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    Options options_;
    Link link_;
    Camera camera_;
    PointingLaw law_;
    Rail rail_;
    Attitude attitude_;
    std::int64_t start_tai_ns_ = 0;
    std::uint64_t frames_ = 0, found_ = 0;
    std::unique_ptr<std::FILE, Close> log_;
};

}  // namespace
}  // namespace flight

int main(int argc, char** argv) {
    CLI::App app("keeps a target in the middle of hilcam's pictures through an approach");
    flight::Options options;
    flight::add_options(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        flight::end_on_signals();
        flight::Approach approach(options);
        options.free_run ? approach.in_free_run() : approach.in_lockstep();
        approach.print_summary();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hilcam-flight-example: %s\n", error.what());
        return 1;
    }
    return 0;
}
