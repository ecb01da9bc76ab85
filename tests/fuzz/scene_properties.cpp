// What a scene says of its bodies, joints, hands and tools, in any order and of any value, while it runs:
// each is taken or refused, and everything that the session shows afterwards is a number and a place.
#include <array>
#include <string>

#include "core/soft/soft_model.hpp"
#include "fuzz_target.hpp"
#include "session/input_records.hpp"
#include "session/plain_commands.hpp"
#include "shared/meshes.hpp"
#include "shared/sound_snapshot.hpp"
#include "small_session.hpp"

namespace tactus::fuzz {
namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr int most_steps = 48, most_ticks = 96;

enum Step : std::uint8_t { asks, moves, gives, count };

class SaidDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return sample; }
    void write(Nanoseconds, const Vec3& force) override {
        must(shared::is_sound(force), "what a device is given is a force");
    }
    void twist(const Vec3& torque) override {
        must(shared::is_sound(torque), "what a device is given is a torque");
    }
    DeviceCapabilities capabilities() const override { return able; }

    DeviceSample sample;
    DeviceCapabilities able;
};

class Scene {
public:
    void play(ValueReader& reader) {
        for (int steps = 0; steps < most_steps && reader.remaining() > 0; ++steps) {
            std::uint8_t step = 0;
            pass(reader, step);
            switch (step % Step::count) {
                case asks:
                    ask_for(reader);
                    break;
                case moves:
                    move(reader);
                    break;
                default:
                    add_what_gives(reader);
            }
            if (!reader.good()) {
                break;
            }
        }
        tick(4);
    }

private:
    void ask_for(ValueReader& reader) {
        InputCall call;
        pass(reader, call);
        if (reader.good()) {
            std::visit([this](const auto& c) { carry_out(c); }, call);
        }
    }

    template <PlainCommand Command>
    void carry_out(const Command& c) {
        ask(session_, c);
    }
    void carry_out(const command::AddJoint& c) { session_.add_joint(c.joint, c.first, c.second); }
    void carry_out(const call::AddBody& c) {
        session_.add_body(Session::prepare_body(addition(c.form)), c.former);
    }
    void carry_out(const call::DeformBody& c) {
        session_.deform_body(c.handle, Session::prepare_body(addition(c.form)));
    }
    void carry_out(const call::AddDevice& c) {
        session_.add_device(devices_[c.handle % max_devices], c.workspace);
    }
    void carry_out(const call::AddProxy& c) { session_.add_proxy(c.description); }
    void carry_out(const call::AddTool& c) { session_.add_tool(c.shape, c.use); }
    // Of links and recordings: not the scene's.
    template <typename Other>
    void carry_out(const Other&) {}

    static BodyAddition addition(const call::Form& form) {
        BodyAddition made;
        made.description = form.description;
        made.touch_shapes = form.touch_shapes;
        made.touch_material = form.touch_material;
        made.detail = form.detail;
        return made;
    }

    void move(ValueReader& reader) {
        std::uint8_t device = 0, ticks = 0;
        pass(reader, device);
        pass(reader, devices_[device % max_devices].sample);
        pass(reader, ticks);
        if (reader.good()) {
            tick(ticks % 16);
        }
    }

    void add_what_gives(ValueReader& reader) {
        std::array<double, 7> values{};
        std::uint8_t cells = 0;
        Vec3 place{};
        pass(reader, values);
        pass(reader, cells);
        pass(reader, place);
        if (!reader.good()) {
            return;
        }
        const SoftMaterial material{values[0], values[1], values[2], values[3],
                                    values[4], values[5], values[6]};
        BodyAddition made;
        made.description.pose.position = place;
        made.soft = make_soft_volume(shared::box(Vec3(0.05)), cells % 4, material, {}, 1e-3).model;
        if (made.soft != nullptr) {
            session_.add_body(made);
        }
    }

    void tick(int ticks) {
        for (int i = 0; i < ticks && ticks_ < most_ticks; ++i, ++ticks_) {
            session_.tick(now_ += period);
        }
        session_.collect();
        session_.refresh();
        const std::string unsound = shared::unsound_in(session_.snapshot());
        must(unsound.empty(), ("everything shown is a place: " + unsound).c_str());
    }

    std::array<SaidDevice, max_devices> devices_;
    Session session_{small_session(32, 128)};
    Nanoseconds now_ = 0;
    int ticks_ = 0;
};

}  // namespace

void play(std::span<const std::byte> input) {
    ValueReader reader(input);
    Scene scene;
    scene.play(reader);
}

namespace {

class Written {
public:
    template <typename Call>
    Written& ask(const Call& call) {
        const InputCall one = call;
        return put(std::uint8_t{asks}).put(one);
    }
    Written& move(const Vec3& place, std::uint8_t ticks) {
        DeviceSample sample;
        sample.position = place;
        sample.connected = true;
        return put(std::uint8_t{moves}).put(std::uint8_t{0}).put(sample).put(ticks);
    }
    template <typename Value>
    Written& put(const Value& value) {
        ValueWriter writer(sink_);
        pass(writer, value);
        return *this;
    }
    Bytes& bytes() { return sink_.bytes(); }

private:
    ByteSink sink_;
};

call::AddBody body(const Shape& shape, const Vec3& place, Motion motion) {
    call::AddBody added;
    added.form.description.shapes = {{shape, {}}};
    added.form.description.pose.position = place;
    added.form.description.motion = motion;
    added.form.description.mass = 0.5;
    added.form.touch_material = {500.0, 1.0, 0.3, 0.2};
    return added;
}

Written with_a_hand() {
    Written scene;
    Workspace workspace;
    workspace.force_limit = 10.0;
    ProxyDescription pointer;
    pointer.device = 0;
    scene.ask(body(PlaneShape{}, Vec3(0.0), Motion::Static));
    scene.ask(call::AddDevice{0, workspace}).ask(call::AddProxy{0, pointer});
    return scene;
}

}  // namespace

std::vector<Bytes> seeds() {
    std::vector<Bytes> all;
    const auto ball = std::make_shared<const TriangleMesh>(shared::icosphere(0, 0.05));
    const auto heights =
        std::make_shared<const std::vector<float>>(std::vector<float>{0, 0.1f, 0, 0.1f, 0.2f, 0, 0, 0, 0});
    for (const Shape& shape :
         {Shape(SphereShape{0.05}), Shape(BoxShape{Vec3(0.05)}), Shape(CapsuleShape{0.03, 0.05}),
          Shape(CylinderShape{0.05, 0.05}), Shape(ConvexHullShape{ball}), Shape(MeshShape{ball, 0.5, true}),
          Shape(HeightFieldShape{3, 3, Vec3(0.1, 1.0, 0.1), heights})}) {
        const bool is_field = std::holds_alternative<HeightFieldShape>(shape);
        Written scene = with_a_hand();
        scene.ask(body(shape, {0.0, 0.06, 0.0}, is_field ? Motion::Static : Motion::Dynamic));
        scene.move({0.0, 0.2, 0.0}, 1).move({0.0, 0.11, 0.0}, 8).move({0.02, 0.09, 0.0}, 8);
        all.push_back(std::move(scene.bytes()));
    }
    Written joined = with_a_hand();
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.angular[2] = {-1.0, 1.0};
    hinge.motor_speed = hinge.motor_torque = 1.0;
    const Pose there{{0.0, 0.3, 0.1}, {1.0, 0.0, 0.0, 0.0}};
    joined.ask(body(BoxShape{Vec3(0.05)}, {0.0, 0.06, 0.0}, Motion::Dynamic));
    joined.ask(body(BoxShape{Vec3(0.05)}, {0.2, 0.06, 0.0}, Motion::Kinematic));
    joined.ask(command::AddJoint{0, hinge, 1, 2}).move({0.0, 0.11, 0.0}, 8);
    joined.ask(command::MoveBody{2, there, 0.01}).ask(command::TeleportBody{1, there, Session::all_of_pose});
    joined.ask(command::TeleportBody{1, there, 0b1010})
        .ask(command::ShiftBody{1, Vec3(0.01), there.rotation});
    joined.ask(command::SetBodyVelocity{1, Vec3(1.0), Vec3(2.0), Session::all_of_velocity})
        .ask(command::SetBodyPush{1, Vec3(1.0), Vec3(0.1)});
    joined.ask(command::SetTouchMaterial{1, {800.0, 0.0, 0.1, 0.1}, nullptr});
    joined.ask(command::SetBodySurface{1, {0.3, 0.5, false, false}}).ask(command::SetBodyLayers{1, {1, 1}});
    joined.ask(command::SetBodyMotion{1, Motion::Static}).ask(command::SetBodyGravityScale{1, 0.5});
    joined.ask(command::SetBodyDamping{1, 0.1, 0.1})
        .ask(command::PushBody{1, {}})
        .ask(command::SetGravity{Vec3(0.0)});
    joined.ask(command::SeeBody{1, {}}).ask(command::SetWorkspace{0, {}}).ask(command::SetProxy{0, {}});
    joined.ask(call::DeformBody{1, body(SphereShape{0.06}, Vec3(0.0), Motion::Dynamic).form})
        .move(Vec3(0.05), 15);
    joined.ask(command::RemoveJoint{0}).ask(command::RemoveBody{1}).ask(command::RemoveProxy{0});
    joined.ask(command::RemoveDevice{0}).move(Vec3(0.0), 4);
    all.push_back(std::move(joined.bytes()));
    Written held = with_a_hand();
    const ToolShape spheres{{{Vec3(0.0), 0.02}, {Vec3(0.05, 0.0, 0.0), 0.01}}, 1e-3, 0.07, nullptr};
    ToolUse use;
    use.device = 0;
    held.ask(call::AddTool{0, std::make_shared<const ToolShape>(spheres), use});
    held.ask(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic));
    held.move({0.0, 0.3, 0.0}, 2)
        .move({0.0, 0.1, 0.0}, 8)
        .ask(command::SetTool{0, use})
        .ask(command::RemoveTool{0});
    all.push_back(std::move(held.bytes()));
    Written soft = with_a_hand();
    soft.put(std::uint8_t{gives}).put(std::array<double, 7>{2e4, 0.3, 1e3, 1e-3, 2e-3, 0.5, 0.5});
    soft.put(std::uint8_t{2}).put(Vec3(0.0, 0.05, 0.0)).move({0.0, 0.15, 0.0}, 4).move({0.0, 0.1, 0.0}, 8);
    all.push_back(std::move(soft.bytes()));
    return all;
}

}  // namespace tactus::fuzz
