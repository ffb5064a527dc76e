// A small landing program in a closed loop with hilcam: takes frames from its GigE Vision camera, which looks down, chooses ground
// without hazards in them, follows it as it comes nearer, and brings the vehicle down there, in lockstep.
//
// Two programs of a bench are in it. The flight software (hazard_eye, target_track, the guidance here) knows the pictures, the
// vehicle's height over the site's plane as an altimeter would tell it, and its own motion since the last picture. The dynamics move the vehicle as the
// guidance asks, and tell hilcam where it is, in the world's axes.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <opencv2/core/quaternion.hpp>

#include "tools/flight_software_example/camera.h"
#include "tools/flight_software_example/link.h"
#include "tools/landing_example/hazard_eye.h"
#include "tools/landing_example/target_track.h"

namespace flight {
namespace {

struct Options {
    std::string camera = "127.0.0.1";
    std::string commands = "127.0.0.1:5010";
    std::string log = "landing.csv";
    std::vector<double> axes;  // w x y z
    std::vector<double> from_m = {0, 0, 300};
    double ground_m = 0;       // the site's plane, up
    double touchdown_m = 1.5;  // the camera's height when the legs stand
    double period_s = 0.5;
    double focal_px = 3.4e-3 / 5.5e-6;
    double offset_dn = 64;
    int frames = 1000;                                 // the flight ends after so many, landed or not
    std::vector<double> looks_m = {300, 120, 50, 25};  // heights at which a place is chosen anew
    HazardEyeOptions eye;
};

void add_options(CLI::App& app, Options& o) {
    app.add_option("--camera", o.camera, "IPv4 address or name of the GigE Vision camera")
        ->capture_default_str();
    app.add_option("--commands", o.commands, "ADDRESS:PORT where hilcam listens")->capture_default_str();
    app.add_option("--log", o.log, "a line for each frame, CSV")->capture_default_str();
    app.add_option("--axes", o.axes, "w x y z: the site's axes in the world, of hilcam ground --list axes")
        ->expected(4)
        ->required();
    app.add_option("--from-m", o.from_m, "east north up of the start, from the site")
        ->expected(3)
        ->capture_default_str();
    app.add_option("--ground-m", o.ground_m, "height of the ground about the site, up from it")
        ->capture_default_str();
    app.add_option("--touchdown-m", o.touchdown_m, "height of the camera at touchdown")
        ->capture_default_str();
    app.add_option("--frames", o.frames, "end after so many, landed or not")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    app.add_option("--focal-px", o.focal_px, "the camera's focal length, of its calibration")
        ->capture_default_str();
}

class Landing {
  public:
    explicit Landing(const Options& o)
        : options_(o),
          link_(o.commands),
          camera_(o.camera),
          middle_px_(0.5 * (camera_.width_px() - 1), 0.5 * (camera_.height_px() - 1)),
          world_from_site_(cv::Quatd(o.axes[0], o.axes[1], o.axes[2], o.axes[3]).normalize()),
          position_m_(o.from_m[0], o.from_m[1], o.from_m[2]),
          log_(std::fopen(o.log.c_str(), "w")) {
        if (!log_) throw std::runtime_error(o.log + ": cannot be written");
        std::fputs("frame,time_s,east_m,north_m,up_m,chosen,clear_m,target_x_px,target_y_px,likeness\n",
                   log_.get());
    }

    void fly() {
        const auto period_ns = static_cast<std::int64_t>(std::llround(options_.period_s * 1e9));
        std::int64_t tag_ns = link_.ping().simulated_tai_ns;
        for (int k = 0; k < options_.frames; ++k) {
            tag_ns += period_ns;
            link_.set_pose(pose(tag_ns));
            link_.expose(tag_ns);
            Frame frame;
            if (!camera_.take(std::chrono::seconds(60), frame))
                throw std::runtime_error("camera " + options_.camera + ": no whole frame for 60 s");
            if (frame.exposure_mid_tai_ns != tag_ns)
                throw std::runtime_error("frame " + std::to_string(frame.id) +
                                         " is not the one that was asked for");
            see(frame, options_.period_s * k);
            if (height_m() <= options_.touchdown_m) return;
            move();
        }
    }

    void print_summary() const {
        std::printf(
            "{\"landed\": %s, \"touchdown_east_m\": %.4f, \"touchdown_north_m\": %.4f, \"target_east_m\": "
            "%.4f, "
            "\"target_north_m\": %.4f, \"frames\": %llu, \"lost\": %llu}\n",
            height_m() <= options_.touchdown_m ? "true" : "false", position_m_[0], position_m_[1],
            target_m_[0], target_m_[1], static_cast<unsigned long long>(frames_),
            static_cast<unsigned long long>(lost_));
    }

  private:
    static constexpr double kMaxAside_m_s = 6, kMaxAsideChange_m_s2 = 1.5, kAsideGain_s = 0.35;

    double height_m() const { return position_m_[2] - options_.ground_m; }
    double pixel_m() const { return height_m() / options_.focal_px; }
    // East and north of a place in the picture from the vehicle: right is east, down is south.
    cv::Vec2d aside_m(const cv::Vec2d& px) const {
        return pixel_m() * cv::Vec2d(px[0] - middle_px_[0], middle_px_[1] - px[1]);
    }

    hilcam_pose pose(std::int64_t tag_ns) const {
        // Looking down: half a turn about east.
        const cv::Quatd attitude = world_from_site_ * cv::Quatd(0, 1, 0, 0);
        const cv::Quatd place = world_from_site_ *
                                cv::Quatd(0, position_m_[0], position_m_[1], position_m_[2]) *
                                world_from_site_.conjugate();
        hilcam_pose out{};
        out.time_tai_ns = tag_ns;
        out.position_m[0] = place.x, out.position_m[1] = place.y, out.position_m[2] = place.z;
        out.attitude_wxyz[0] = attitude.w, out.attitude_wxyz[1] = attitude.x;
        out.attitude_wxyz[2] = attitude.y, out.attitude_wxyz[3] = attitude.z;
        return out;
    }

    // The flight software: a picture in, the target's place from the vehicle out.
    void see(const Frame& frame, double t_s) {
        cv::Mat light;
        cv::subtract(frame.image, cv::Scalar(options_.offset_dn), light);
        cv::Vec2d at_px = middle_px_;
        if (track_.begun()) {
            // Where it was, as the vehicle has moved since.
            const cv::Vec2d expected_px =
                middle_px_ +
                cv::Vec2d(target_m_[0] - position_m_[0], position_m_[1] - target_m_[1]) / pixel_m();
            const std::optional<cv::Vec2d> found_px = track_.follow(light, expected_px, height_m());
            lost_ += !found_px;
            at_px = found_px.value_or(expected_px);
        }
        double clear_m = 0;
        bool chosen = false;
        if (look_ < options_.looks_m.size() && height_m() <= options_.looks_m[look_] + 1e-6) {
            while (look_ < options_.looks_m.size() && height_m() <= options_.looks_m[look_] + 1e-6) ++look_;
            // What can still be reached: a fifth of the height.
            const double reach_px = 0.2 * options_.focal_px;
            if (const auto site = find_site(light, pixel_m(), at_px, reach_px, options_.eye)) {
                at_px = site->at_px, clear_m = site->clear_m, chosen = true;
                track_.begin(light, at_px, height_m());
            }
        }
        const cv::Vec2d aside = aside_m(at_px);
        target_m_ = {position_m_[0] + aside[0], position_m_[1] + aside[1]};
        ++frames_;
        std::fprintf(log_.get(), "%llu,%.9f,%.17g,%.17g,%.17g,%d,%.3f,%.3f,%.3f,%.4f\n",
                     static_cast<unsigned long long>(frame.id), t_s, position_m_[0], position_m_[1],
                     position_m_[2], chosen ? 1 : 0, clear_m, at_px[0], at_px[1], track_.likeness());
    }

    // Guidance and dynamics: over the target at a rate that falls with the way to it, down at one that falls with the height.
    void move() {
        const cv::Vec2d way_m(target_m_[0] - position_m_[0], target_m_[1] - position_m_[1]);
        cv::Vec2d wanted_m_s = kAsideGain_s * way_m;
        if (const double fast = cv::norm(wanted_m_s) / kMaxAside_m_s; fast > 1) wanted_m_s /= fast;
        cv::Vec2d change_m_s = wanted_m_s - aside_m_s_;
        if (const double hard = cv::norm(change_m_s) / (kMaxAsideChange_m_s2 * options_.period_s); hard > 1)
            change_m_s /= hard;
        aside_m_s_ += change_m_s;
        position_m_[0] += options_.period_s * aside_m_s_[0],
            position_m_[1] += options_.period_s * aside_m_s_[1];
        const double down_m_s = std::clamp(0.09 * height_m(), 0.5, 9.0);
        position_m_[2] =
            std::max(position_m_[2] - options_.period_s * down_m_s, options_.ground_m + options_.touchdown_m);
    }

    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    Options options_;
    Link link_;
    Camera camera_;
    cv::Vec2d middle_px_;
    cv::Quatd world_from_site_;
    cv::Vec3d position_m_;  // east, north, up of the site
    cv::Vec2d aside_m_s_, target_m_;
    TargetTrack track_;
    std::size_t look_ = 0;
    std::uint64_t frames_ = 0, lost_ = 0;
    std::unique_ptr<std::FILE, Close> log_;
};

}  // namespace
}  // namespace flight

int main(int argc, char** argv) {
    CLI::App app("lands where hilcam's pictures show no hazards");
    flight::Options options;
    flight::add_options(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        flight::Landing landing(options);
        landing.fly();
        landing.print_summary();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hilcam-landing-example: %s\n", error.what());
        return 1;
    }
    return 0;
}
