#include "io/config/key_places.h"

namespace hilcam {

std::string KeyPlaces::of(std::string_view asked) const {
    if (!known_) return {};
    std::string key(asked);
    for (const auto& [from, to] : renamed_)
        if (key.starts_with(from)) {
            key.replace(0, from.size(), to);
            break;
        }
    while (true) {
        if (const auto found = known_->places.find(key); found != known_->places.end()) return found->second;
        const std::size_t dot = key.rfind('.');
        if (dot == std::string::npos) return known_->file;
        key.resize(dot);
    }
}

std::string KeyPlaces::at(std::string_view key, std::string_view text) const {
    const std::string place = of(key);
    return (place.empty() ? "" : place + ": ") + (label_.empty() ? "" : label_ + ": ") + std::string(text);
}

KeyPlaces KeyPlaces::labelled(std::string label) const {
    KeyPlaces out = *this;
    out.label_ = std::move(label);
    return out;
}

KeyPlaces KeyPlaces::with(std::string from, std::string to) const {
    KeyPlaces out = *this;
    out.renamed_[std::move(from)] = std::move(to);
    return out;
}

}  // namespace hilcam
