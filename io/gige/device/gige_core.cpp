#include "io/gige/device/gige_core.h"

namespace hilcam {

void GigeCore::publish_stream() {
    stream.open = stream.destination.ip != 0 && stream.destination.port != 0;
    stream.width = settings.width, stream.height = settings.height;
    stream.offset_x = settings.offset_x, stream.offset_y = settings.offset_y;
    stream.format = settings.format;
    stream.chunk_mode = settings.chunk_mode;
    stream.chunks = settings.chunks;
    stream.components = settings.components ? settings.components : bit_of(GigeComponent::kIntensity);
    stream.frames = settings.mode == AcquisitionMode::kSingleFrame  ? 1
                    : settings.mode == AcquisitionMode::kMultiFrame ? settings.frame_count
                                                                    : 0;
    stream.throughput_limit_bytes_s =
        settings.throughput_limited ? static_cast<double>(settings.throughput_limit_bytes_s) : 0;
    if (effects.stream_changed) effects.stream_changed(stream);
}

}  // namespace hilcam
