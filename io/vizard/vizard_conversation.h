#pragma once
// The protocol between Basilisk's vizInterface and Vizard, in which hilcam takes Vizard's place: requests and
// replies as ZeroMQ messages of several parts. The sockets are in commands_vizard.h.
//
//    request                                        reply
//    PING                                           PONG
//    SIM_UPDATE | empty | empty | VizMessage        OK        (ERROR: the simulator stops)
//    REQUEST_IMAGE_<cameraID>                       length of the picture, 32 bits big-endian | picture
//    REQUEST_IMAGE (until Basilisk 2.1.4)           the same, of the message's first camera
//    REQUEST_INPUT                                  VIZARD_INPUT | VizInput, without input
//    anything else                                  ERROR
//
// When there is no picture (an unknown camera, a missing spacecraft, nothing rendered), length 0 and an empty
// picture are sent, which Basilisk treats as an invalid image. A message that cannot be read is answered
// ERROR, and no pictures are given until a readable one comes.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/vizard/vizard_world.h"

namespace hilcam {

using VizardParts = std::vector<std::string>;

class VizardConversation {
  public:
    // An encoded picture; empty when it could not be taken, with the reason.
    struct Picture {
        std::string bytes;
        std::string trouble;
    };
    using Photograph = std::function<Picture(const VizardShot&)>;
    VizardConversation(VizardWorld& world, Photograph photograph)
        : world_(world), photograph_(std::move(photograph)) {}

    struct Answer {
        VizardParts parts;     // one at least
        bool refused = false;  // the request could not be fulfilled
    };
    Answer answer(const VizardParts& asked);
    // True when the simulator has announced its end, at which Vizard would end.
    bool is_over() const { return over_; }

  private:
    Answer take_update(const VizardParts& asked);
    Answer take_picture(std::string_view which);
    Answer refuse(const std::string& reason);

    VizardWorld& world_;
    Photograph photograph_;
    bool over_ = false;
};

}  // namespace hilcam
