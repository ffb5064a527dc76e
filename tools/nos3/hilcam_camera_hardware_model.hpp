// A camera of NOS3 whose pictures are those of hilcam: packets come over UDP from hilcam's output `packets`
// and leave on a UART of NOS Engine, where the flight software has its camera. README.md.

#ifndef HILCAM_NOS3_CAMERA_HARDWARE_MODEL_HPP
#define HILCAM_NOS3_CAMERA_HARDWARE_MODEL_HPP

#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

#include <boost/property_tree/ptree.hpp>

#include <Uart/Client/Uart.hpp>
#include <sim_i_hardware_model.hpp>

#include "hilcam_image.hpp"

namespace Nos3 {

class HilcamCameraHardwareModel : public SimIHardwareModel {
  public:
    explicit HilcamCameraHardwareModel(const boost::property_tree::ptree& config);
    ~HilcamCameraHardwareModel() override;

    // "STATUS" on the command bus answers with the counters.
    void command_callback(NosEngine::Common::Message message) override;

  private:
    // What has come, for STATUS. Guarded by mutex_.
    struct Status {
        std::uint64_t packets = 0, pictures = 0, whole_pictures = 0, last_frame = 0, missing_packets = 0;
    };
    static void on_picture(void* model, const hilcam_image::Picture& picture);
    void receive();

    std::unique_ptr<NosEngine::Uart::Uart> uart_;
    hilcam_image::PictureReceiver receiver_;  // receive()'s thread
    int socket_ = -1;
    std::mutex mutex_;
    Status status_;
    std::thread thread_;
};

}  // namespace Nos3

#endif
