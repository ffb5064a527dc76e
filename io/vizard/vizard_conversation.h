#pragma once
// The conversation of Basilisk's vizInterface with Vizard, whose place hilcam takes: what is asked, what is
// answered. ZeroMQ messages of several parts; the sockets are commands_vizard.h's.
//
//     asked                                          answered
//     PING                                           PONG
//     SIM_UPDATE | empty | empty | VizMessage        OK        (ERROR: the simulator stops)
//     REQUEST_IMAGE_<cameraID>                       length of the picture, 32 bits big-endian | picture
//     REQUEST_IMAGE (until Basilisk 2.1.4)           the same, of the message's first camera
//     REQUEST_INPUT                                  VIZARD_INPUT | VizInput, without input
//     anything else                                  ERROR
//
// Without a picture (an unknown camera, a missing spacecraft, nothing rendered) length and picture are 0 and
// empty, which Basilisk takes for an image that is not valid. A message that cannot be read is answered
// ERROR, and there are no pictures until one comes that can.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/vizard/vizard_world.h"

namespace hilcam {

using VizardParts = std::vector<std::string>;

class VizardConversation {
  public:
    // Takes the picture and gives it encoded; empty when that fails, with the reason.
    struct Picture {
        std::string bytes;
        std::string trouble;
    };
    using Photograph = std::function<Picture(const VizardShot&)>;
    VizardConversation(VizardWorld& world, Photograph photograph)
        : world_(world), photograph_(std::move(photograph)) {}

    struct Answer {
        VizardParts parts;     // one at least
        bool refused = false;  // the message does not hold what was asked for
    };
    Answer answer(const VizardParts& asked);
    // The simulator has said that it ends, and wants Vizard to.
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
