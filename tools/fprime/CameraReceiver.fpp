module Hilcam {

  @ Puts pictures together from the image packets of hilcam's output `packets` (docs/packets.md)
  passive component CameraReceiver {

    @ Bytes of a driver: a datagram, or a piece of a stream
    guarded input port drvReceive: Drv.ByteStreamData

    @ Gives the driver's buffer back
    output port drvReceiveReturn: Fw.BufferSend

    @ Asks for a buffer for a picture
    output port allocate: Fw.BufferGet

    @ A picture: its pixels row by row, U16 in the processor's byte order; whoever gets it gives it back to the buffer manager
    output port pictureOut: Fw.BufferSend

    @ A picture came
    event PictureReceived(
      frame: U64 @< the frame's number
      width: U16
      height: U16
      missingPackets: U32 @< their pixels are 0
    ) severity activity high format "Frame {}: {} x {} px, {} packets missing"

    @ A picture was dropped, as there is no buffer for it
    event NoBuffer(frame: U64) severity warning high format "Frame {}: no buffer" throttle 10

    @ Pictures since the start
    telemetry Pictures: U32
    @ Pictures of which nothing is missing
    telemetry WholePictures: U32
    @ Packets that could not be read
    telemetry RefusedPackets: U64

    event port logOut
    text event port logTextOut
    telemetry port tlmOut
    time get port timeCaller

  }

}
