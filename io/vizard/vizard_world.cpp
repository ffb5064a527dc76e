#include "io/vizard/vizard_world.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>

#include "io/vizard/vizard_geometry.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Largest number of remarks in a run, and in all runs, because a flood of them does not help.
constexpr std::size_t kMaxRemarks = 100, kMaxRemarksInAll = 1000;
// Names of things that are not shown; a constellation's leave room for other remarks.
constexpr std::size_t kMaxNamed = 10;
constexpr std::size_t kNoCamera = SIZE_MAX;
// Tolerance between fields of view, because data sheets round pitch and focal length.
constexpr double kViewTolerance_ratio = 0.01;

// Returns "mars" for "mars barycenter", "Mars" and "mars_planet_data".
std::string body_word(const std::string& name) {
    std::string word;
    for (const char c : name) {
        if (!std::isalpha(static_cast<unsigned char>(c))) break;
        word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return word;
}

std::optional<BodyId> body_of(const std::string& name) {
    const std::string word = body_word(name);
    const auto at = std::find(kBodyNames.begin(), kBodyNames.end(), word);
    if (at == kBodyNames.end()) return {};
    return static_cast<BodyId>(at - kBodyNames.begin());
}

std::string degrees(double rad) { return plain(std::round(rad / kDegree_rad * 1e3) / 1e3) + " deg"; }

std::string picture_size_text(std::int64_t width, std::int64_t height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

Fields fields(VizardCameraConfig& c) {
    return {
        required(integer("id", c.id, {0, 9e15}, "cameraID in the simulator")),
        required(integer("camera", c.camera, {1, 255},
                         "number of the bench's camera that makes the pictures, from 1")),
    };
}

VizardWorld::VizardWorld(const Rules& rules, VizardBench bench, Remark remark)
    : rules_(rules), bench_(std::move(bench)), remark_(std::move(remark)), start_(bench_.start) {}

void VizardWorld::remark_once(const std::string& topic, const std::string& text) {
    if (said_.size() >= kMaxRemarks || said_in_all_ >= kMaxRemarksInAll || !said_.insert(topic).second)
        return;
    remark_(text);
    ++said_in_all_;
    if (said_.size() == kMaxRemarks || said_in_all_ == kMaxRemarksInAll)
        remark_("more remarks than these are not shown");
}

bool VizardWorld::refuse(const std::string& reason) {
    remark(reason);
    return false;
}

void VizardWorld::take(VizardUpdate update) {
    const TimeTai before = time();
    if (update.epoch) {
        epoch_known_ = true;
        if (rules_.time == VizardTime::kMessage) start_ = *update.epoch;
        // Some scripts send the epoch at every step, so a run also begins where time goes back.
        if (start_ + update.elapsed_ns < before) said_.clear();
    }
    if (!epoch_known_ && rules_.time == VizardTime::kMessage)
        remark("no message had an epoch (was hilcam started after the simulation?): time counts from " +
               format_utc(start_));
    update_ = std::move(update);
    known_ = true;
}

bool VizardWorld::shot(std::int64_t id, VizardShot& shot) {
    if (!known_)
        return refuse("camera " + std::to_string(id) + ": no picture before a SIM_UPDATE that can be read");
    const auto camera = std::find_if(update_.cameras.begin(), update_.cameras.end(),
                                     [id](const VizardCamera& c) { return c.id == id; });
    if (camera == update_.cameras.end())
        return refuse("camera " + std::to_string(id) + ": no picture, as SIM_UPDATE has no such camera");
    const auto place = static_cast<std::size_t>(camera - update_.cameras.begin());
    const std::size_t own = bench_camera(place, id);
    if (own == kNoCamera)
        return refuse("camera " + std::to_string(id) +
                      ": no picture, as no camera of the scenario stands for it (more_cameras, "
                      "commands.vizard.cameras)");
    if (camera->wants_depth)
        return refuse("camera " + std::to_string(id) + ": no picture, as it asks for depth (renderMode 1)");
    const VizardThing* const parent = parent_of(*camera);
    if (!parent)
        return refuse("camera " + std::to_string(id) + ": no picture, as SIM_UPDATE has no spacecraft " +
                      in_quotes(camera->parent));
    check_camera(*camera, bench_.cameras[own]);

    const Bodies bodies = bodies_at(time(), bench_.origin);
    const Shift shift = shift_at(time(), bodies);
    const Motion spacecraft = motion_of(*parent, shift);
    const Mat3d world_from_spacecraft = to_matrix(spacecraft.pose.world_from_body);
    const Vec3d camera_world_m =
        spacecraft.pose.position_world_m + world_from_spacecraft * camera->position_body_m;
    const Quat world_from_camera = spacecraft.pose.world_from_body * camera->body_from_camera;
    check_bodies(bodies, shift, camera_world_m);

    // The pose of the body that carries the bench's camera: removes the mount.
    const Pose& mount = bench_.cameras[own].body_from_camera;
    PoseCommand carrier;
    carrier.alone = true;
    carrier.motion = spacecraft;
    Pose& body = carrier.motion.pose;
    body.world_from_body = normalized(world_from_camera * conjugate(mount.world_from_body));
    body.position_world_m = camera_world_m - to_matrix(body.world_from_body) * mount.position_world_m;
    shot.camera = static_cast<std::uint16_t>(own + 1);
    shot.time = time();
    shot.poses = {carrier};
    pose_objects(shift, shot.poses);
    return true;
}

std::size_t VizardWorld::bench_camera(std::size_t place, std::int64_t id) const {
    if (rules_.cameras.empty()) return place < bench_.cameras.size() ? place : kNoCamera;
    for (const VizardCameraConfig& c : rules_.cameras)
        if (c.id == id) return static_cast<std::size_t>(c.camera - 1);
    return kNoCamera;
}

const VizardThing* VizardWorld::parent_of(const VizardCamera& camera) const {
    const std::vector<VizardThing>& all = update_.spacecraft;
    if (camera.parent.empty()) return all.empty() ? nullptr : &all.front();
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const VizardThing& s) { return s.name == camera.parent; });
    return at == all.end() ? nullptr : &*at;
}

VizardWorld::Shift VizardWorld::shift_at(TimeTai time, const Bodies& bodies) {
    // In free space, the message's frame is the world's.
    if (!bench_.origin.center()) return {};
    const BodyId center = *bench_.origin.center();
    Shift shift{bodies[center].world_m, {}};
    if (bench_.origin.turns()) {
        // The origin's velocity about the body is a difference over two seconds, accurate to 1e-9.
        constexpr std::int64_t kStep_ns = 1'000'000'000;
        const Vec3d before = bodies_at(time + -kStep_ns, bench_.origin)[center].world_m;
        const Vec3d after = bodies_at(time + kStep_ns, bench_.origin)[center].world_m;
        shift.velocity_m_s = (after - before) / (2 * kStep_ns * kSecondsPerNs);
    }
    const auto home = std::find_if(update_.bodies.begin(), update_.bodies.end(),
                                   [&](const VizardThing& b) { return body_of(b.name) == center; });
    if (home == update_.bodies.end()) {
        remark("SIM_UPDATE has no body '" + std::string(kBodyNames[index_of(center)]) +
               "': its positions are taken from there on");
        return shift;
    }
    return {shift.position_m - home->position_n_m, shift.velocity_m_s - home->velocity_n_m_s};
}

Motion VizardWorld::motion_of(const VizardThing& thing, const Shift& shift) {
    if (!thing.n_from_body)
        remark("SIM_UPDATE has no attitude of " + in_quotes(thing.name) +
               ": it stands along the axes of the simulation's frame");
    return {time(),
            {thing.position_n_m + shift.position_m, thing.n_from_body.value_or(Quat{})},
            thing.velocity_n_m_s + shift.velocity_m_s,
            {}};
}

void VizardWorld::pose_objects(const Shift& shift, std::vector<PoseCommand>& poses) {
    std::vector<bool> told(bench_.objects.size());
    const auto pose = [&](const VizardThing& thing) {
        const auto object = std::find(bench_.objects.begin(), bench_.objects.end(), thing.name);
        if (object == bench_.objects.end()) return false;
        const auto index = static_cast<std::size_t>(object - bench_.objects.begin());
        told[index] = true;
        PoseCommand command;
        command.object = static_cast<std::uint16_t>(index + 1);
        command.motion = motion_of(thing, shift);
        command.alone = true;
        poses.push_back(command);
        return true;
    };
    std::size_t hidden = 0;
    const auto hide = [&](const std::string& kind, const VizardThing& thing) {
        if (++hidden <= kMaxNamed)
            remark(kind + " " + in_quotes(thing.name) + " is not shown, as no object has its name");
    };
    std::set<const VizardThing*> carriers;
    for (const VizardCamera& camera : update_.cameras) carriers.insert(parent_of(camera));
    for (const VizardThing& spacecraft : update_.spacecraft)
        if (!pose(spacecraft) && carriers.count(&spacecraft) == 0) hide("spacecraft", spacecraft);
    for (const VizardThing& body : update_.bodies)
        if (!pose(body) && !body_of(body.name) && body_word(body.name) != "sun") hide("body", body);
    if (hidden > kMaxNamed)
        remark_once("hidden", std::to_string(hidden - kMaxNamed) +
                                  " more spacecraft and bodies are not shown, as no object has their names");
    for (std::size_t i = 0; i < told.size(); ++i)
        if (!told[i])
            remark("object " + std::to_string(i + 1) + " " + in_quotes(bench_.objects[i]) +
                   " stays where it is, as SIM_UPDATE does not name it");
}

void VizardWorld::check_camera(const VizardCamera& c, const VizardBench::Camera& own) {
    const std::string who = "camera " + std::to_string(c.id) + ": ";
    if (c.width_px > 0 && (c.width_px != own.width_px || c.height_px != own.height_px))
        remark(who + "the simulation's picture is " + picture_size_text(c.width_px, c.height_px) +
               " px, the scenario's camera gives " + picture_size_text(own.width_px, own.height_px));
    if (c.field_of_view_rad > 0 &&
        std::abs(c.field_of_view_rad / own.field_of_view_rad - 1) > kViewTolerance_ratio)
        remark(who + "the simulation's field of view is " + degrees(c.field_of_view_rad) +
               " from edge to edge along the columns, the scenario's camera has " +
               degrees(own.field_of_view_rad));
}

void VizardWorld::check_bodies(const Bodies& bodies, const Shift& shift, Vec3d camera_world_m) {
    for (const VizardThing& body : update_.bodies) {
        const std::optional<BodyId> id = body_of(body.name);
        const bool is_sun = body_word(body.name) == "sun";
        if (!id && !is_sun) continue;
        const Vec3d own_world_m = is_sun ? bodies.sun_world_m : bodies[*id].world_m;
        const double aside_rad = angle_between_rad(body.position_n_m + shift.position_m - camera_world_m,
                                                   own_world_m - camera_world_m);
        const std::string who = "body " + in_quotes(body.name) + ": the simulation ";
        if (!(aside_rad <= rules_.tolerance_rad))
            remark_once(who + "place", who + "has it " + degrees(aside_rad) +
                                           " from where the picture shows it (the scenario's ephemerides)");
        if (!id || !body.n_from_body) continue;
        const double turned_rad =
            turn_between_rad(transposed(to_matrix(*body.n_from_body)), bodies[*id].fixed_from_world);
        if (!(turned_rad <= rules_.tolerance_rad))
            remark_once(who + "turn", who + "turns it " + degrees(turned_rad) +
                                          " from how the picture shows it (the scenario's ephemerides)");
    }
}

}  // namespace hilcam
