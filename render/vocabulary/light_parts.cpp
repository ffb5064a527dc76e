#include "render/vocabulary/light_parts.h"

#include <algorithm>

namespace hilcam {

LightParts::LightParts(const RadianceImage& like) {
    images_.reserve(kLightParts);
    for (std::size_t i = 0; i < kLightParts; ++i)
        if (like.responses().empty())
            images_.emplace_back(like.width(), like.height(), like.planes());
        else
            images_.emplace_back(like.width(), like.height(),
                                 std::vector<Spectrum>(like.responses().begin(), like.responses().end()));
}

void LightParts::clear() {
    for (RadianceImage& image : images_) std::fill(image.all().begin(), image.all().end(), 0.0f);
}

void LightParts::sum_into(RadianceImage& picture) const {
    const auto out = picture.all();
    std::copy(images_.front().all().begin(), images_.front().all().end(), out.begin());
    for (std::size_t part = 1; part < kImageParts; ++part) {
        const auto in = images_[part].all();
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += in[i];
    }
}

}  // namespace hilcam
