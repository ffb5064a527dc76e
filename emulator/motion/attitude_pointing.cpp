// Attitude that points one body axis at something, and a second axis as closely as possible at something
// else.

#include "emulator/motion/attitude_laws.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// A vector and its rate.
struct Moving {
    Vec3d v, rate;
};

// Returns the rate of a vector's unit vector.
Vec3d unit_rate(const Moving& m) {
    const double size = length(m.v);
    const Vec3d u = m.v / size;
    return (m.rate - dot(u, m.rate) * u) / size;
}

// Orthonormal axes in rows: along a, perpendicular to a and b, and completing them.
struct Triad {
    Vec3d x, y, z;
};
Triad triad(Vec3d a, Vec3d b) {
    const Vec3d x = normalized(a), z = normalized(cross(a, b));
    return {x, cross(z, x), z};
}

bool nearly_parallel(Vec3d a, Vec3d b) {
    // Below 1e-9 rounding makes the roll meaningless. Also true for zero vectors.
    return !(length(cross(a, b)) > 1e-9 * length(a) * length(b));
}

Moving aim_at(const Aim& aim, const MotionContext& context, const OwnMotion& self) {
    const auto towards = [&](const StateVector& s) {
        return Moving{s.position_m - self.state.position_m,
                      s.velocity_m_s - (self.stands ? Vec3d{} : self.state.velocity_m_s)};
    };
    const auto own = [&] { return about_center(context, self.state, aim.center); };
    // In free fall, the acceleration of the unperturbed orbit; J2 turns the velocity by a thousandth of this.
    const auto acceleration = [&](const StateVector& s) {
        if (self.stands) return Vec3d{};
        if (self.acceleration_m_s2) return *self.acceleration_m_s2;
        const double r = length(s.position_m);
        return (-gravity_m3_s2(aim.center) / (r * r * r)) * s.position_m;
    };
    switch (aim.kind) {
        case Aim::Kind::kNorth:
            return {{0, 0, 1}, {}};
        case Aim::Kind::kDirection:
            return {aim.direction, {}};
        case Aim::Kind::kNadir:
            return towards(context.frame.center(aim.center));
        case Aim::Kind::kSun:
            return towards(context.frame.center({std::nullopt}));
        case Aim::Kind::kVelocity:
            return {own().velocity_m_s, acceleration(own())};
        case Aim::Kind::kOrbitNormal:
            // r x v changes only by r x a, so not at all in free fall.
            return {cross(own().position_m, own().velocity_m_s),
                    cross(own().position_m, acceleration(own()))};
        case Aim::Kind::kThing:
            break;
    }
    const Motion& thing = context.things[aim.thing];
    return towards(
        {thing.pose.position_world_m, context.stands(aim.thing) ? Vec3d{} : thing.velocity_world_m_s});
}

class PointingLaw final : public AttitudeLaw {
  public:
    explicit PointingLaw(const Pointing& p) : pointing_(p) {
        if (nearly_parallel(p.axis, p.second_axis))
            throw InputError(
                "axis and second_axis must not be parallel or zero: the roll would be undefined");
        body_ = triad(p.axis, p.second_axis);
    }

    AttitudeState at(const MotionContext& context, const OwnMotion& self) const override {
        Moving first = aim_at(pointing_.aim, context, self);
        Moving second = aim_at(pointing_.second_aim, context, self);
        if (!(length(first.v) > 0)) first = {{0, 0, 1}, {}};  // the thing is at its own target
        if (nearly_parallel(first.v, second.v)) second = {{1, 0, 0}, {}};
        if (nearly_parallel(first.v, second.v)) second = {{0, 1, 0}, {}};
        const Triad world = triad(first.v, second.v);
        // The columns of world_from_body combine the world's triad with the body's.
        const Mat3d world_from_body =
            transposed(Mat3d{world.x, world.y, world.z}) * Mat3d{body_.x, body_.y, body_.z};

        const Vec3d x_rate = unit_rate(first);
        const Vec3d z_rate =
            unit_rate({cross(first.v, second.v), cross(first.rate, second.v) + cross(first.v, second.rate)});
        const Vec3d y_rate = cross(z_rate, world.x) + cross(world.z, x_rate);
        // u' = omega x u for all three, so omega is half the sum of u x u'.
        const Vec3d rate = 0.5 * (cross(world.x, x_rate) + cross(world.y, y_rate) + cross(world.z, z_rate));
        return {to_quat(world_from_body), transposed(world_from_body) * rate};
    }
    std::vector<MotionNeed> needs() const override {
        std::vector<MotionNeed> things;
        for (const Aim* aim : {&pointing_.aim, &pointing_.second_aim})
            if (aim->kind == Aim::Kind::kThing) things.push_back({aim->thing, false});
        return things;
    }
    std::string name() const override { return "pointing"; }

  private:
    Pointing pointing_;
    Triad body_;
};

}  // namespace

std::unique_ptr<AttitudeLaw> make_pointing(const Pointing& pointing) {
    return std::make_unique<PointingLaw>(pointing);
}

}  // namespace hilcam
