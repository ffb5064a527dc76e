// Basilisk's own vizInterface, without Python: it reads the world and the steps from standard input, line by
// line, and writes the images. basilisk_itself.py compiles it against a checkout of Basilisk's sources (2.1.5
// or later) and speaks to it; it is no part of hilcam's build.
//
//     epoch YEAR MONTH DAY HOURS MINUTES SECONDS
//     body "NAME" POSITION VELOCITY MATRIX          m, m/s, J2000 to body by rows: 15 numbers
//     spacecraft "NAME" POSITION VELOCITY MRPS      m, m/s, sigma_BN: 9 numbers
//     camera ID "PARENT" IS_ON POSITION MRPS VIEW WIDTH HEIGHT   m, sigma_CB, rad, px
//     reset PORT IS_LIVE                            connects
//     last                                          the next step tells Vizard to end, if this version can
//     step TIME                                     ns
//
// Answers: "ready" to reset; "can end" or "cannot" to last; to step, for each image "image ID BYTES", a newline
// and the bytes, then "done FRAME", where FRAME is that of the user's input (-1: this version asks for none).
// An error of Basilisk's ends the program.

#include <cstdio>
#include <exception>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include "simulation/vizard/vizInterface/vizInterface.h"

namespace {

template <class Array>
void read(std::istream& in, Array& values) {
    for (double& v : values) in >> v;
}

// What differs between versions is asked of the class itself.
template <class Viz>
void connect(Viz& viz, const std::string& port, bool live) {
    viz.liveStream = live;
    if constexpr (requires { viz.noDisplay; })
        viz.noDisplay = !live;
    else
        viz.opNavMode = live ? 0 : 2;  // until 2.3
    if constexpr (requires { viz.reqPortNumber; })
        viz.reqPortNumber = port;
    else
        viz.comPortNumber = port;  // until 2.3
    viz.Reset(0);
    viz.UpdateState(0);
}

template <class Viz>
bool ends_with_next(Viz& viz) {
    if constexpr (requires { viz.liveSettings.terminateVizard; })
        return viz.liveSettings.terminateVizard = true;
    else
        return false;  // until 2.7
}

template <class Viz>
long long input_frame(Viz& viz) {
    if constexpr (requires { viz.userInputMsg; }) {
        auto input = viz.userInputMsg.addSubscriber();
        return input.isWritten() ? input().frameNumber : 0;
    } else {
        return -1;  // until 2.3
    }
}

class Driver {
  public:
    void obey(const std::string& line);

  private:
    void body(std::istream& in);
    void spacecraft(std::istream& in);
    void camera(std::istream& in);
    void step(std::uint64_t time_ns);

    VizInterface viz_;
    Message<EpochMsgPayload> epoch_;
    std::map<std::string, Message<SpicePlanetStateMsgPayload>> bodies_;
    std::map<std::string, Message<SCStatesMsgPayload>> spacecraft_;
    std::map<long long, Message<CameraConfigMsgPayload>> cameras_;
    std::vector<long long> camera_ids_;  // in the interface's order
    std::uint64_t written_ = 0;          // a time of its own for each message: vizInterface reads what is new
};

void Driver::obey(const std::string& line) {
    std::istringstream in(line);
    std::string word, port;
    in >> word;
    if (word == "epoch") {
        EpochMsgPayload p{};
        in >> p.year >> p.month >> p.day >> p.hours >> p.minutes >> p.seconds;
        epoch_.write(&p, 0, ++written_);
        viz_.epochInMsg = epoch_.addSubscriber();
    } else if (word == "body") {
        body(in);
    } else if (word == "spacecraft") {
        spacecraft(in);
    } else if (word == "camera") {
        camera(in);
    } else if (word == "reset") {
        bool live = false;
        in >> port >> live;
        connect(viz_, port, live);
        std::cout << "ready" << std::endl;
    } else if (word == "last") {
        std::cout << (ends_with_next(viz_) ? "can end" : "cannot") << std::endl;
    } else if (word == "step") {
        std::uint64_t time_ns = 0;
        in >> time_ns;
        step(time_ns);
    }
    if (!in) throw std::runtime_error("cannot be read: " + line);
}

void Driver::body(std::istream& in) {
    SpicePlanetStateMsgPayload p{};
    std::string name;
    in >> std::quoted(name);
    read(in, p.PositionVector);
    read(in, p.VelocityVector);
    for (auto& row : p.J20002Pfix) read(in, row);
    const bool is_new = bodies_.count(name) == 0;
    auto& message = bodies_[name];
    message.write(&p, 0, ++written_);
    if (!is_new) return;
    GravBodyInfo info{};
    info.bodyName = name;
    viz_.gravBodyInformation.push_back(info);
    viz_.spiceInMsgs.push_back(message.addSubscriber());
}

void Driver::spacecraft(std::istream& in) {
    SCStatesMsgPayload p{};
    std::string name;
    in >> std::quoted(name);
    read(in, p.r_BN_N);
    read(in, p.v_BN_N);
    read(in, p.sigma_BN);
    const bool is_new = spacecraft_.count(name) == 0;
    auto& message = spacecraft_[name];
    message.write(&p, 0, ++written_);
    if (!is_new) return;
    VizSpacecraftData data;
    data.spacecraftName = name;
    data.scStateInMsg = message.addSubscriber();
    viz_.scData.push_back(data);
}

void Driver::camera(std::istream& in) {
    CameraConfigMsgPayload p{};
    std::string parent;
    in >> p.cameraID >> std::quoted(parent) >> p.isOn;
    std::snprintf(p.parentName, sizeof p.parentName, "%s", parent.c_str());
    read(in, p.cameraPos_B);
    read(in, p.sigma_CB);
    in >> p.fieldOfView >> p.resolution[0] >> p.resolution[1];
    p.renderRate = 1;  // an image at each step where it is on
    const bool is_new = cameras_.count(p.cameraID) == 0;
    auto& message = cameras_[p.cameraID];
    message.write(&p, 0, ++written_);
    if (!is_new) return;
    camera_ids_.push_back(p.cameraID);
    viz_.addCamMsgToModule(&message);
}

void Driver::step(std::uint64_t time_ns) {
    viz_.UpdateState(time_ns);
    for (std::size_t i = 0; i < camera_ids_.size(); ++i) {
        auto message = viz_.opnavImageOutMsgs.at(i)->addSubscriber();
        if (!message.isWritten() || message.timeWritten() != time_ns) continue;
        const CameraImageMsgPayload image = message();
        const std::streamsize bytes = image.valid ? image.imageBufferLength : 0;
        std::cout << "image " << camera_ids_[i] << " " << bytes << "\n";
        std::cout.write(static_cast<const char*>(image.imagePointer), bytes);
    }
    std::cout << "done " << input_frame(viz_) << std::endl;
}

}  // namespace

int main() try {
    setDefaultLogLevel(BSK_WARNING);
    Driver driver;
    for (std::string line; std::getline(std::cin, line);) driver.obey(line);
} catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
}
