#pragma once
// The parts of a GigeDevice, only for its own .cpp files.

#include <memory>
#include <string>
#include <vector>

#include "io/gige/device/camera_face.h"
#include "io/gige/device/gige_access.h"
#include "io/gige/device/gige_acquisition.h"
#include "io/gige/device/gige_actions.h"
#include "io/gige/device/gige_answers.h"
#include "io/gige/device/gige_bootstrap.h"
#include "io/gige/device/gige_clock.h"
#include "io/gige/device/gige_device.h"
#include "io/gige/device/gige_fault_registers.h"
#include "io/gige/device/gige_image.h"
#include "io/gige/device/gige_lines.h"
#include "io/gige/device/gige_messages.h"
#include "io/gige/device/gige_sequencer.h"
#include "io/gige/device/gige_transport.h"
#include "io/gige/device/gige_trigger.h"
#include "io/gige/device/gige_user_sets.h"
#include "io/gige/stream/gige_chunk_layout.h"

namespace hilcam {

struct GigeDevice::Answer {
    gvcp::Status status = gvcp::kSuccess;
    std::size_t bytes = 0;
    bool silent = false;  // true: not for this device; no answer at all
};

struct GigeDevice::Parts {
    std::unique_ptr<CameraLines> own_lines;  // where the camera has none
    GigeCore core;
    GigeBootstrap bootstrap;
    GigeAcquisition acquisition;
    GigeTransport transport;
    GigeMessages messages;
    GigeAccess access;
    GigeClock clock;
    GigeImage image;
    GigeTrigger trigger;
    GigeLines lines;
    GigeSequencer sequencer;
    GigeActions actions;
    GigeFaultRegisters faults;
    GigeUserSets user_sets;  // after all parts with settings
    GigeAnswers answers;
    std::string xml;
    std::vector<std::uint8_t> zip;
    // Another camera's features and registers, if the camera has its face.
    std::unique_ptr<FeatureTable> features;
    std::unique_ptr<CameraFace> face;
    GigeChunkLayout chunk_layout;

    std::int64_t ticked_ns = 0;
    bool reset_wanted = false;
    std::uint64_t foreign_resend_requests = 0;
    std::uint32_t only = 0;  // for selectors with one entry
    // The latest request and its attempts, for faults that strike some attempts only.
    Endpoint last_from;
    std::uint16_t last_id = 0;
    std::uint64_t attempt = 0;

    Parts(const GigeIdentity& id, CameraControl& camera, FaultBoard& board, GigeEffects effects,
          CameraLines* lines);
    void add_device_registers();
    void put_on_face(const CameraFaceFiles& files);
    // Access to what clients see: the face's registers if there is one, else hilcam's own.
    gvcp::Status read(std::uint32_t address, std::span<std::uint8_t> out) {
        return face ? face->read(address, out) : core.registers.read(address, out);
    }
    gvcp::Status write(std::uint32_t address, std::span<const std::uint8_t> data, std::size_t& done) {
        return face ? face->write(address, data, core.locked(), done)
                    : core.registers.write(address, data, core.locked(), done);
    }
    void left();  // the controller is gone
    // Returns a request's index for faults, from its id and its number of attempts.
    std::uint64_t fault_index(std::uint16_t request_id);
    bool in_subnet(const Endpoint& from) const {
        return ((from.ip ^ core.identity.ip) & core.identity.mask) == 0;
    }
};

}  // namespace hilcam
