#include "tools/flight_software_example/camera.h"

#include <stdexcept>

namespace flight {
namespace {

constexpr int kBuffers = 16;

// The GError that a call of Aravis leaves behind, as an exception.
class Errors {
  public:
    ~Errors() { g_clear_error(&error_); }
    operator GError**() { return &error_; }
    void check(const std::string& what) {
        if (error_) throw std::runtime_error(what + ": " + error_->message);
    }

  private:
    GError* error_ = nullptr;
};

}  // namespace

Camera::Camera(const std::string& name) {
    const std::string what = "camera " + name;
    Errors errors;
    camera_.reset(arv_camera_new(name.c_str(), errors));
    errors.check(what);
    if (!camera_) throw std::runtime_error(what + ": there is none");
    // The packet-socket receiver needs rights that a user lacks.
    arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    arv_camera_set_pixel_format_from_string(camera_.get(), "Mono12", errors);
    errors.check(what);
    arv_camera_set_chunks(camera_.get(), "FrameID,PoseSequence,ExposureMid", errors);
    errors.check(what);
    chunks_.reset(arv_camera_create_chunk_parser(camera_.get()));
    arv_camera_get_region(camera_.get(), nullptr, nullptr, &width_px_, &height_px_, errors);
    errors.check(what);
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, errors));
    errors.check(what);
    // A busy machine makes camera and client wait: ask for what is missing for three seconds before giving
    // up.
    g_object_set(stream_.get(), "frame-retention", 3'000'000u, "packet-request-ratio", 2.0, nullptr);
    const std::size_t payload_bytes = arv_camera_get_payload(camera_.get(), errors);
    errors.check(what);
    for (int i = 0; i < kBuffers; ++i)
        arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload_bytes));
    arv_camera_start_acquisition(camera_.get(), errors);
    errors.check(what);
}

Camera::~Camera() { arv_camera_stop_acquisition(camera_.get(), nullptr); }

bool Camera::take(std::chrono::microseconds timeout, Frame& frame) {
    ArvBuffer* const buffer =
        arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(timeout.count()));
    if (!buffer) return false;
    const bool whole = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS && read(buffer, frame);
    arv_stream_push_buffer(stream_.get(), buffer);
    if (!whole) ++lost_;
    return whole;
}

bool Camera::read(ArvBuffer* buffer, Frame& frame) const {
    std::size_t bytes = 0;
    const void* const data = arv_buffer_get_data(buffer, &bytes);
    const cv::Size size(width_px_, height_px_);
    if (bytes < sizeof(std::uint16_t) * static_cast<std::size_t>(size.area())) return false;
    // The buffer goes back to the stream. Mono12 is little-endian words, as this machine's are.
    cv::Mat(size, CV_16U, const_cast<void*>(data)).copyTo(frame.image);
    frame.id = static_cast<std::uint64_t>(chunk(buffer, "ChunkFrameID"));
    frame.pose_sequence = static_cast<std::uint32_t>(chunk(buffer, "ChunkPoseSequence"));
    frame.exposure_mid_tai_ns = chunk(buffer, "ChunkExposureMid");
    return true;
}

std::int64_t Camera::chunk(ArvBuffer* buffer, const char* name) const {
    Errors errors;
    const std::int64_t value = arv_chunk_parser_get_integer_value(chunks_.get(), buffer, name, errors);
    errors.check(name);
    return value;
}

}  // namespace flight
