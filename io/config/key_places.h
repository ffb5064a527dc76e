#pragma once
// Remembers where each key of a configuration was given, so that later findings can name the place.

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace hilcam {

// Copies share their contents.
class KeyPlaces {
  public:
    KeyPlaces() = default;
    // top: prefix of all keys of the file, "camera." for a camera's own; "" for a scenario.
    explicit KeyPlaces(std::string file, std::string top = "")
        : known_(std::make_shared<Known>(Known{std::move(file), std::move(top), {}})) {}

    void note(const std::string& key, std::string place) {
        known_->places[known_->top + key] = std::move(place);
    }
    // Returns "bench.yaml:7:11", or "--set camera.bits". For a key that is not given, it is the place of the
    // section that would hold it; empty when nothing is known.
    std::string of(std::string_view key) const;
    // Returns "bench.yaml:7:11: TEXT"; with a label, "bench.yaml:7:11: LABEL: TEXT".
    std::string at(std::string_view key, std::string_view text) const;
    KeyPlaces labelled(std::string label) const;
    // Returns the same, but looks up a key that begins with `from` as one that begins with `to`; for a
    // further camera.
    KeyPlaces with(std::string from, std::string to) const;

  private:
    struct Known {
        std::string file, top;
        std::map<std::string, std::string, std::less<>> places;
    };
    std::shared_ptr<Known> known_;
    std::map<std::string, std::string> renamed_;
    std::string label_;  // empty: none
};

}  // namespace hilcam
