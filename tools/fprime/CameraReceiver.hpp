// Puts pictures together from hilcam's image packets. README.md.

#ifndef HILCAM_CAMERA_RECEIVER_HPP
#define HILCAM_CAMERA_RECEIVER_HPP

#include <memory>

#include "Hilcam/CameraReceiver/CameraReceiverComponentAc.hpp"
#include "hilcam_image.hpp"

namespace Hilcam {

class CameraReceiver : public CameraReceiverComponentBase {
  public:
    explicit CameraReceiver(const char* name) : CameraReceiverComponentBase(name) {}

    // Takes all memory. Call once, before the driver starts. most_pixels: of the largest frame.
    void configure(U16 apid, FwSizeType most_pixels);

  private:
    void drvReceive_handler(FwIndexType port, Fw::Buffer& buffer,
                            const Drv::ByteStreamStatus& status) override;

    static void on_picture(void* component, const hilcam_image::Picture& picture);
    void send(const hilcam_image::Picture& picture);

    std::unique_ptr<hilcam_image::PictureReceiver> m_receiver;
    U32 m_pictures = 0, m_whole = 0;
};

}  // namespace Hilcam

#endif
