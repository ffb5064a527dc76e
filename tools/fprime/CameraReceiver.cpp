#include "Hilcam/CameraReceiver/CameraReceiver.hpp"

#include <cstring>

namespace Hilcam {

void CameraReceiver::configure(U16 apid, FwSizeType most_pixels) {
    m_receiver.reset(new hilcam_image::PictureReceiver(apid, static_cast<std::size_t>(most_pixels)));
}

void CameraReceiver::drvReceive_handler(FwIndexType, Fw::Buffer& buffer,
                                        const Drv::ByteStreamStatus& status) {
    if (status == Drv::ByteStreamStatus::OP_OK && m_receiver) {
        m_receiver->take(buffer.getData(), static_cast<std::size_t>(buffer.getSize()), &on_picture, this);
        this->tlmWrite_RefusedPackets(m_receiver->counts().refused);
    }
    this->drvReceiveReturn_out(0, buffer);
}

void CameraReceiver::on_picture(void* component, const hilcam_image::Picture& picture) {
    static_cast<CameraReceiver*>(component)->send(picture);
}

void CameraReceiver::send(const hilcam_image::Picture& picture) {
    const hilcam_image::Packet& head = picture.header;
    const std::size_t bytes = 2 * std::size_t{head.width} * head.height;
    Fw::Buffer buffer = this->allocate_out(0, static_cast<U32>(bytes));
    if (buffer.getData() == nullptr || buffer.getSize() < bytes) {
        this->log_WARNING_HI_NoBuffer(head.frame);
        return;
    }
    (void)std::memcpy(buffer.getData(), picture.pixels, bytes);
    buffer.setSize(static_cast<U32>(bytes));
    this->pictureOut_out(0, buffer);
    this->tlmWrite_Pictures(++m_pictures);
    if (picture.is_whole()) this->tlmWrite_WholePictures(++m_whole);
    this->log_ACTIVITY_HI_PictureReceived(head.frame, head.width, head.height, picture.missing_packets);
}

}  // namespace Hilcam
