#pragma once
// The flight camera: a GigE Vision one, opened with Aravis as any vendor's would be. Nothing here knows that
// it is emulated, but that its frames say in GenICam chunks when they were taken on the simulated clock.

#include <arv.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace flight {

struct Frame {
    cv::Mat image;  // one channel of 16 bits
    std::uint64_t id = 0;
    std::uint32_t pose_sequence = 0;       // of the newest pose command that it shows
    std::int64_t exposure_mid_tai_ns = 0;  // simulated
};

// One thread. All but lost() throw std::runtime_error.
class Camera {
  public:
    // An IPv4 address or a name as arv-tool prints it. Frames come from here on.
    explicit Camera(const std::string& name);
    ~Camera();

    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }
    // The next whole frame; false: none came in time.
    bool take(std::chrono::microseconds timeout, Frame& frame);
    // Frames of which packets were missing.
    std::uint64_t lost() const { return lost_; }

  private:
    bool read(ArvBuffer* buffer, Frame& frame) const;
    std::int64_t chunk(ArvBuffer* buffer, const char* name) const;

    struct Unref {
        void operator()(gpointer object) const { g_object_unref(object); }
    };
    template <class T>
    using Object = std::unique_ptr<T, Unref>;
    // In this order: the stream goes first.
    Object<ArvCamera> camera_;
    Object<ArvChunkParser> chunks_;
    Object<ArvStream> stream_;
    int width_px_ = 0, height_px_ = 0;
    std::uint64_t lost_ = 0;
};

}  // namespace flight
