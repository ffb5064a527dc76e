#include "render/vocabulary/light_parts.h"

#include <algorithm>
#include <utility>

namespace hilcam {

namespace {

RadianceImage image_like(const RadianceImage& like) {
    if (like.responses().empty()) return RadianceImage(like.width(), like.height(), like.planes());
    std::vector<Spectrum> responses(like.responses().begin(), like.responses().end());
    return RadianceImage(like.width(), like.height(), std::move(responses));
}

}  // namespace

LightParts::LightParts(const RadianceImage& like, std::optional<LightPart> only) {
    images_.resize(kLightParts);
    for (std::size_t i = 0; i < kLightParts; ++i)
        if (!only || *only == static_cast<LightPart>(i)) images_[i] = image_like(like);
}

void LightParts::clear() {
    for (RadianceImage& image : images_) std::fill(image.all().begin(), image.all().end(), 0.0f);
}

RadianceImage LightParts::sum() const {
    const RadianceImage& first = images_.front();
    RadianceImage picture = image_like(first);
    const auto out = picture.all();
    std::copy(first.all().begin(), first.all().end(), out.begin());
    for (std::size_t part = 1; part < kImageParts; ++part) {
        const auto in = images_[part].all();
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += in[i];
    }
    return picture;
}

}  // namespace hilcam
