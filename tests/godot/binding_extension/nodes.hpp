#pragma once

#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/primitive_mesh.hpp>
#include <godot_cpp/core/class_db.hpp>

namespace probe {

// A node with one of everything a class of ours can declare.
class BindingNode : public godot::Node3D {
    GDCLASS(BindingNode, godot::Node3D)

public:
    enum Mode { MODE_OFF, MODE_ON };

    BindingNode() { ++alive; }
    ~BindingNode() override { --alive; }

    void _enter_tree() override { note("enter_tree"); }
    void _ready() override { note("ready"); }
    void _exit_tree() override { note("exit_tree"); }
    void _process(double delta) override;
    void _physics_process(double delta) override;
    void _input(const godot::Ref<godot::InputEvent>& event) override;
    godot::PackedStringArray _get_configuration_warnings() const override;

    void set_stiffness(double value);
    double get_stiffness() const { return stiffness_; }
    void set_mode(Mode value) { mode_ = value; }
    Mode get_mode() const { return mode_; }
    void set_material(const godot::Ref<godot::PhysicsMaterial>& value) { material_ = value; }
    godot::Ref<godot::PhysicsMaterial> get_material() const { return material_; }
    void set_part(int index, double value) { parts_[index] = value; }
    double get_part(int index) const { return parts_[index]; }

    godot::PackedStringArray get_notes() const { return notes_; }
    godot::Array get_seen_delta() const { return godot::Array{process_delta_, physics_delta_}; }

    void watch(godot::Object* object);
    bool is_watched_alive() const;
    godot::Variant get_watched() const { return watched_; }
    void on_signal(int64_t count, const godot::String& what);
    void connect_to(godot::Object* source, const godot::StringName& signal);
    void disconnect_from(godot::Object* source, const godot::StringName& signal);
    bool is_connected_to(godot::Object* source, const godot::StringName& signal) const;

    static int64_t count_alive() { return alive; }

protected:
    static void _bind_methods();
    void _notification(int what);
    bool _set(const godot::StringName& name, const godot::Variant& value);
    bool _get(const godot::StringName& name, godot::Variant& value) const;
    void _get_property_list(godot::List<godot::PropertyInfo>* properties) const;
    bool _property_can_revert(const godot::StringName& name) const;
    bool _property_get_revert(const godot::StringName& name, godot::Variant& value) const;
    void _validate_property(godot::PropertyInfo& property) const;
    godot::String _to_string() const { return "a binding node"; }

    void note(const char* what) { notes_.push_back(what); }

private:
    inline static int64_t alive = 0;

    double stiffness_ = 100.0;
    Mode mode_ = MODE_OFF;
    godot::Ref<godot::PhysicsMaterial> material_;
    double parts_[2] = {0.0, 0.0};
    int64_t extra_ = 3;
    double process_delta_ = -1.0;
    double physics_delta_ = -1.0;
    godot::PackedStringArray notes_;
    godot::Variant watched_;
};

// Derives from a class of ours.
class BindingDerived : public BindingNode {
    GDCLASS(BindingDerived, BindingNode)

public:
    void _ready() override;
    int64_t own() const { return 42; }

protected:
    static void _bind_methods();
    void _notification(int what);
};

// Derives from a resource of the engine.
class BindingMaterial : public godot::PhysicsMaterial {
    GDCLASS(BindingMaterial, godot::PhysicsMaterial)

public:
    BindingMaterial() { ++alive; }
    ~BindingMaterial() override { --alive; }
    void set_softness(double value) { softness_ = value; }
    double get_softness() const { return softness_; }
    void set_curve(const godot::PackedVector2Array& value) { curve_ = value; }
    godot::PackedVector2Array get_curve() const { return curve_; }

    static int64_t count_alive() { return alive; }
    // Makes a material here and hands it over; nobody here keeps it.
    static godot::Ref<BindingMaterial> make(double softness);
    // Takes many references, by every way there is, lets go of all of them, and says how many are left.
    static int64_t references_gained(const godot::Ref<BindingMaterial>& material);

protected:
    static void _bind_methods();

private:
    inline static int64_t alive = 0;

    double softness_ = 0.5;
    godot::PackedVector2Array curve_;
};

// Answers a virtual method with a container.
class BindingMesh : public godot::PrimitiveMesh {
    GDCLASS(BindingMesh, godot::PrimitiveMesh)

public:
    // One triangle.
    godot::Array _create_mesh_array() const override;

protected:
    static void _bind_methods() {}
};

}  // namespace probe

VARIANT_ENUM_CAST(probe::BindingNode::Mode)
