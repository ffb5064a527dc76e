#include "emulator/scenario/object_config.h"

#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(PoseConfig& p) {
    Fields list = {
        choice(
            "frame", p.frame, {"world", "local"},
            "axes of all values in this section. local: x east, y north, z up at the site, turning with it"),
        vector3("position_m", p.position_m, 1, {-kFarthestPlace_m, kFarthestPlace_m},
                "position in the frame"),
        optional(choice("attitude", p.attitude, {"quaternion", "look_at", "nadir"},
                        "way to give the attitude. quaternion: by attitude_wxyz or another form; look_at: +z "
                        "points to a point, and -y near up; nadir: +z points to the centre of nadir_of, and "
                        "+y south. With look_at_m or up it is look_at"),
                 p.has_attitude),
    };
    for (Field& field : attitude_keys(p.forms, {.frame = "the frame"})) list.push_back(std::move(field));
    Fields rest = {
        optional(
            choice("nadir_of", p.nadir_of, std::vector<std::string>(kBodyNames.begin(), kBodyNames.end()),
                   "body that nadir points to; left out: the origin's body, or with frame local the site's "
                   "body"),
            p.has_nadir_of),
        optional(vector3("look_at_m", p.look_at_m, 1, {-kFarthestPlace_m, kFarthestPlace_m},
                         "point in the frame that +z points to"),
                 p.has_look_at),
        optional(
            vector3("up", p.up, 1, {-1e13, 1e13}, "direction in the frame that is near up in the picture"),
            p.has_up),
        optional(vector3("velocity_m_s", p.velocity_m_s, 1, {-kFastestMotion_m_s, kFastestMotion_m_s},
                         "velocity in the frame"),
                 p.has_velocity),
        optional(vector3("rate_deg_s", p.rate_body_rad_s, kDegree_rad, {-1e5, 1e5},
                         "angular rate about the body axes"),
                 p.has_rate),
    };
    for (Field& field : rest) list.push_back(std::move(field));
    return list;
}

PoseConfig::Attitude attitude_of(const PoseConfig& p) {
    if (!p.has_attitude && (p.has_look_at || p.has_up)) return PoseConfig::Attitude::kLookAt;
    return p.attitude;
}

namespace {

void refuse_idle_key(const char* key, const std::string& attitude, const std::string& needed) {
    throw KeyError(key, "has no effect with " + attitude + "; accepted: attitude: " + needed + ", or no '" +
                            key + "' (--set takes 'null' for a key that the file gives)");
}

void check_look_at(const PoseConfig& p) {
    const Vec3d along = p.look_at_m - p.position_m;
    if (!(length(along) > 0)) throw KeyError("look_at_m", "is equal to position_m; accepted: another point");
    if (!(length(p.up) > 0)) throw refused_key("up", "a vector without a direction", "one that is not 0");
    if (!(length(cross(along, p.up)) > 1e-9 * length(along) * length(p.up)))
        throw KeyError("up",
                       "is parallel to the line of sight from position_m to look_at_m, so up in the picture "
                       "is undefined; accepted: any other direction");
}

}  // namespace

void validate(const PoseConfig& p) {
    using Attitude = PoseConfig::Attitude;
    const Attitude attitude = attitude_of(p);
    const std::string named = !p.has_attitude                 ? "look_at_m and up"
                              : attitude == Attitude::kNadir  ? "attitude: nadir"
                              : attitude == Attitude::kLookAt ? "attitude: look_at"
                                                              : "attitude: quaternion";
    check_attitude(p.forms);
    if (p.forms.given() && attitude != Attitude::kQuaternion)
        refuse_idle_key(given_key(p.forms), named, "quaternion");
    if (p.has_nadir_of && attitude != Attitude::kNadir) refuse_idle_key("nadir_of", named, "nadir");
    if (p.has_look_at && attitude != Attitude::kLookAt) refuse_idle_key("look_at_m", named, "look_at");
    if (p.has_up && attitude != Attitude::kLookAt) refuse_idle_key("up", named, "look_at");
    if (attitude == Attitude::kLookAt) check_look_at(p);
}

Motion initial_motion(const PoseConfig& p, TimeTai time, const Bodies& bodies) {
    Quat attitude = frame_from_body(p.forms);
    if (attitude_of(p) == PoseConfig::Attitude::kLookAt)
        attitude = look_along(p.look_at_m - p.position_m, p.up);
    // +z points down and +y along -north, so +x = y x z points east. North is the world's +z at the Earth,
    // which is close to its pole, and otherwise the body's own.
    if (p.attitude == PoseConfig::Attitude::kNadir) {
        const BodyState& body = bodies[p.nadir_of];
        const Vec3d north = p.nadir_of == BodyId::kEarth ? Vec3d{0, 0, 1} : body.fixed_from_world.z;
        attitude = look_along(body.world_m - p.position_m, north);
    }
    return {time, {p.position_m, attitude}, p.velocity_m_s, p.rate_body_rad_s};
}

Fields fields(GeneratedMeshConfig& g) {
    return {
        required(text("program", g.program,
                      "name of a generator installed beside hilcam, such as hilcam-make-spacecraft")),
        integer("triangles", g.triangles, {5000, 20000000}, "number of triangles to make"),
        integer("seed", g.seed, {0, 1e9}, "seed of the mesh's random details"),
        number("wing_angle_deg", g.wing_angle_deg, 1, {-360, 360},
               "rotation of the solar wings about +y: cells face +z at 0, +x at 90"),
    };
}

Fields fields(MaterialSet& set) {
    return {sections("surfaces", set.surfaces, "materials by surface name; the first match is used")};
}

Fields fields(JointConfig& j) {
    return {
        required(text(
            "node", j.node,
            "node of the mesh file that turns, with all nodes below it; a trailing * matches any ending")),
        vector3("pivot_m", j.pivot_m, 1, {-1e6, 1e6}, "point on the axis, in the object's axes"),
        vector3("axis", j.axis, 1, {-1e6, 1e6}, "direction of the axis, in the object's axes"),
        number("angle_deg", j.angle_rad, kDegree_rad, {-36000, 36000},
               "angle from the pose in the file, right-handed"),
        number("rate_deg_s", j.rate_rad_s, kDegree_rad, {-1e5, 1e5}, "angular rate from the start"),
    };
}

void validate(const JointConfig& j) {
    if (!(length(j.axis) > 1e-9)) throw InputError("'axis' has no direction: found a vector of length 0");
}

Fields fields(ObjectConfig& o) {
    return {
        required(text("name", o.name, "name of the object in messages")),
        optional(
            path(
                "mesh", o.mesh, o.mesh_where,
                "mesh file in metres: GLB, glTF, OBJ, STL or PLY; or a shape model (.tab, .plt, .icq, .bds)"),
            o.has_mesh),
        optional(integer("mesh_surface", o.mesh_surface, {-2147483647, 2147483647},
                         "code of the surface in a shape kernel (.bds) with several surfaces"),
                 o.has_mesh_surface),
        optional(path("albedo_file", o.albedo_file, o.albedo_where,
                      "table of albedos, one number for each facet or vertex of the mesh, which scale its "
                      "materials (docs/bodies.md)"),
                 o.has_albedo_file),
        optional(number("albedo_reference", o.albedo_reference, 1, {1e-6, 1e6},
                        "albedo in the table at which a material is unchanged; left out: the mean by area"),
                 o.has_albedo_reference),
        section("generate", o.generate,
                "mesh that a program makes at first use, kept on disk; replaces a file"),
        number("scale", o.scale, 1, {1e-6, 1e6}, "factor on the mesh's coordinates"),
        number("temperature_k", o.temperature_k, 1, {0, 6000},
               "temperature of the surfaces that have none of their own, used with radiance: emissive; 0: "
               "they emit nothing"),
        optional(section("pose", o.pose, "pose of the object until a command changes it"), o.has_pose),
        section("motion", o.motion, "motion of the object until a command changes it; replaces pose"),
        section("materials", o.materials, "materials in place of the mesh's own"),
        sections("joints", o.joints, "parts that turn; commands number them from 1"),
    };
}

void validate(const ObjectConfig& o) {
    if (o.has_mesh == o.generate.has_value())
        throw InputError("an object has either 'mesh' or 'generate'; found " +
                         std::string(o.has_mesh ? "both" : "neither"));
    if (o.has_mesh_surface && !o.has_mesh) throw KeyError("mesh_surface", "has no effect without 'mesh'");
    if (o.has_albedo_reference && !o.has_albedo_file)
        throw KeyError("albedo_reference", "has no effect without 'albedo_file'");
    if (o.has_albedo_file && !o.joints.empty())
        throw KeyError("albedo_file",
                       "has no effect on a mesh of several parts; accepted: an object without joints");
    if (o.has_pose && o.motion)
        throw KeyError("motion", "an object has either 'pose' or 'motion'; found both");
}

Fields fields(PlaceConfig& p) {
    return {
        required(choice("body", p.body, std::vector<std::string>(kBodyNames.begin(), kBodyNames.end()),
                        "body that the place is on and turns with")),
        required(number("longitude_deg", p.place.longitude_rad, kDegree_rad, {-360, 360},
                        "longitude of the place, east positive")),
        required(number("latitude_deg", p.place.latitude_rad, kDegree_rad, {-90, 90},
                        "geodetic latitude of the place")),
        number("height_km", p.place.height_m, 1e3, {-100, 1e5},
               "height of the place above the body's ellipsoid; for terrain, the height of its map's 0"),
    };
}

void validate(const TerrainConfig& t) {
    if (t.heights.has_value() == t.globe.has_value())
        throw InputError("terrain has either 'heights' or 'globe'; found " +
                         std::string(t.globe ? "both" : "neither"));
    if (t.globe)
        for (const auto& [key, given] :
             {std::pair{"pose", t.has_pose}, {"place", t.place.has_value()}, {"radius_km", t.has_radius}})
            if (given) throw KeyError(key, "has no effect with 'globe', which is fixed to its body");
    if (t.has_pose && t.place) throw KeyError("place", "terrain has either 'pose' or 'place'; found both");
    if (t.pose.frame != PoseConfig::Frame::kWorld)
        throw refused_key("pose.frame", "'local'", "terrain.place, which has local axes");
    for (const auto& [key, given] :
         {std::pair{"velocity_m_s", t.pose.has_velocity}, {"rate_deg_s", t.pose.has_rate}})
        if (given) throw KeyError(std::string("pose.") + key, "has no effect: terrain stays where it is");
}

Fields fields(TerrainConfig& t) {
    return {
        text("name", t.name, "name of the terrain in messages"),
        section("heights", t.heights, "height map around one place"),
        section("globe", t.globe, "ground of a whole body from many maps; replaces heights (docs/ground.md)"),
        optional(number("radius_km", t.radius_m, 1000, {0, 1e6},
                        "radius of the sphere under the height map; 0: a plane"),
                 t.has_radius),
        optional(
            section("pose", t.pose,
                    "fixed pose in the world of the map's centre at height 0; axes: x east, y north, z up"),
            t.has_pose),
        section("place", t.place, "place on a body with which the terrain turns; replaces pose"),
        section("material", t.material, "material of the ground"),
        number("edge_px", t.edge_px, 1, {0.25, 64}, "longest edge of the terrain's triangles on the screen"),
        integer("max_triangles", t.max_triangles, {10'000, 50'000'000},
                "largest number of triangles at a time"),
        flag("wait", t.wait,
             "true: each frame waits until its terrain is complete; frames are then the same in every run, "
             "but not in real time"),
    };
}

}  // namespace hilcam
