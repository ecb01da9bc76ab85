#pragma once

// Everything Godot asks of one of our classes, as plain functions made from the class. GDCLASS lets this
// struct see the protected members a class may declare: _notification, _set, _get, _get_property_list,
// _validate_property, … A member counts only for the class that declares it itself; classes between it and
// the engine class are asked too.

#include <gdextension_interface.h>

#include <godot_cpp/classes/wrapped.hpp>
#include <memory>
#include <type_traits>
#include <vector>

namespace godot::internal {

// What get_property_list hands to the engine, alive until free_property_list gets it back.
const GDExtensionPropertyInfo* publish_property_list(const List<PropertyInfo>& properties, uint32_t* count);
void release_property_list(GDExtensionClassInstancePtr instance, const GDExtensionPropertyInfo* list,
                           uint32_t count);
void write_back(const PropertyInfo& from, GDExtensionPropertyInfo* to);
void notify_postinitialize(Wrapped* object);

struct ClassAccess {
    template <class T>
    static T* from(void* instance) {
        return static_cast<T*>(static_cast<Wrapped*>(instance));
    }

    // -- Making and freeing
    // ------------------------------------------------------------------------------------

    template <class T>
    static void* create_binding(void*, void* object) {
        if constexpr (T::is_engine_class) {
            return static_cast<Wrapped*>(new T(static_cast<GodotObject*>(object)));
        } else {
            return nullptr;  // our own objects bring their binding with them
        }
    }

    template <class T>
    static void free_binding(void*, void*, void* binding) {
        if constexpr (T::is_engine_class) {
            delete from<T>(binding);
        }
    }

    static GDExtensionBool keep_reference(void*, void*, GDExtensionBool) { return 1; }

    template <class T>
    static inline const GDExtensionInstanceBindingCallbacks binding_callbacks = {
        &create_binding<T>, &free_binding<T>, &keep_reference};

    template <class T>
    static Construction construction(GodotObject* existing_object = nullptr) {
        static_assert(std::is_same_v<T, typename T::self_type>, "the class lacks GDCLASS(class, parent)");
        return {T::is_engine_class ? nullptr : &T::get_class_static(), &binding_callbacks<T>,
                existing_object};
    }

    template <class T>
    static GDExtensionObjectPtr create_instance(void*, GDExtensionBool notify) {
        ConstructionScope scope(construction<T>());
        T* object = new T;
        scope.finish();
        if (notify) {
            notify_postinitialize(object);
        }
        return object->_owner;
    }

    template <class T>
    static GDExtensionClassInstancePtr recreate_instance(void*, GDExtensionObjectPtr existing_object) {
        ConstructionScope scope(construction<T>(existing_object));
        T* object = new T;
        scope.finish();
        return static_cast<Wrapped*>(object);
    }

    template <class T>
    static void free_instance(void*, GDExtensionClassInstancePtr instance) {
        delete from<T>(instance);
    }

    // -- Who declares what
    // -------------------------------------------------------------------------------------

    template <class T, class Declares>
    static constexpr bool any_level(const Declares& declares) {
        if constexpr (T::is_engine_class) {
            return false;
        } else {
            return declares.template operator()<T>() || any_level<typename T::parent_type>(declares);
        }
    }

    template <class T>
    static constexpr bool own_notification = std::is_same_v<decltype(&T::_notification), void (T::*)(int)>;
    template <class T>
    static constexpr bool own_set =
        std::is_same_v<decltype(&T::_set), bool (T::*)(const StringName&, const Variant&)>;
    template <class T>
    static constexpr bool own_get =
        std::is_same_v<decltype(&T::_get), bool (T::*)(const StringName&, Variant&) const>;
    template <class T>
    static constexpr bool own_property_list =
        std::is_same_v<decltype(&T::_get_property_list), void (T::*)(List<PropertyInfo>*) const>;
    template <class T>
    static constexpr bool own_can_revert =
        std::is_same_v<decltype(&T::_property_can_revert), bool (T::*)(const StringName&) const>;
    template <class T>
    static constexpr bool own_get_revert =
        std::is_same_v<decltype(&T::_property_get_revert), bool (T::*)(const StringName&, Variant&) const>;
    template <class T>
    static constexpr bool own_validate =
        std::is_same_v<decltype(&T::_validate_property), void (T::*)(PropertyInfo&) const>;
    template <class T>
    static constexpr bool own_to_string = std::is_same_v<decltype(&T::_to_string), String (T::*)() const>;

    // -- Notifications: from the base up, or from the top down when the engine says "reversed"
    // -------------------

    template <class T>
    static void notify_levels(T* object, int what, bool reversed) {
        if constexpr (!T::is_engine_class) {
            if (!reversed) {
                notify_levels<typename T::parent_type>(object, what, reversed);
            }
            if constexpr (own_notification<T>) {
                object->T::_notification(what);
            }
            if (reversed) {
                notify_levels<typename T::parent_type>(object, what, reversed);
            }
        }
    }

    template <class T>
    static void notification(GDExtensionClassInstancePtr instance, int32_t what, GDExtensionBool reversed) {
        notify_levels<T>(from<T>(instance), what, reversed != 0);
    }

    // -- Dynamic properties: the first level that knows the property answers
    // -------------------------------------

    template <class T>
    static bool set_levels(T* object, const StringName& name, const Variant& value) {
        if constexpr (T::is_engine_class) {
            return false;
        } else {
            if (set_levels<typename T::parent_type>(object, name, value)) {
                return true;
            }
            if constexpr (own_set<T>) {
                return object->T::_set(name, value);
            }
            return false;
        }
    }

    template <class T>
    static GDExtensionBool set(GDExtensionClassInstancePtr instance, GDExtensionConstStringNamePtr name,
                               GDExtensionConstVariantPtr value) {
        return set_levels<T>(from<T>(instance), *static_cast<const StringName*>(name),
                             *static_cast<const Variant*>(value));
    }

    template <class T>
    static bool get_levels(const T* object, const StringName& name, Variant& value) {
        if constexpr (T::is_engine_class) {
            return false;
        } else {
            if (get_levels<typename T::parent_type>(object, name, value)) {
                return true;
            }
            if constexpr (own_get<T>) {
                return object->T::_get(name, value);
            }
            return false;
        }
    }

    template <class T>
    static GDExtensionBool get(GDExtensionClassInstancePtr instance, GDExtensionConstStringNamePtr name,
                               GDExtensionVariantPtr value) {
        return get_levels<T>(from<T>(instance), *static_cast<const StringName*>(name),
                             *static_cast<Variant*>(value));
    }

    template <class T>
    static void list_levels(const T* object, List<PropertyInfo>* properties) {
        if constexpr (!T::is_engine_class) {
            list_levels<typename T::parent_type>(object, properties);
            if constexpr (own_property_list<T>) {
                object->T::_get_property_list(properties);
            }
        }
    }

    template <class T>
    static const GDExtensionPropertyInfo* property_list(GDExtensionClassInstancePtr instance,
                                                        uint32_t* count) {
        List<PropertyInfo> properties;
        list_levels<T>(from<T>(instance), &properties);
        return publish_property_list(properties, count);
    }

    template <class T>
    static bool can_revert_levels(const T* object, const StringName& name) {
        if constexpr (T::is_engine_class) {
            return false;
        } else {
            if (can_revert_levels<typename T::parent_type>(object, name)) {
                return true;
            }
            if constexpr (own_can_revert<T>) {
                return object->T::_property_can_revert(name);
            }
            return false;
        }
    }

    template <class T>
    static GDExtensionBool can_revert(GDExtensionClassInstancePtr instance,
                                      GDExtensionConstStringNamePtr name) {
        return can_revert_levels<T>(from<T>(instance), *static_cast<const StringName*>(name));
    }

    template <class T>
    static bool get_revert_levels(const T* object, const StringName& name, Variant& value) {
        if constexpr (T::is_engine_class) {
            return false;
        } else {
            if (get_revert_levels<typename T::parent_type>(object, name, value)) {
                return true;
            }
            if constexpr (own_get_revert<T>) {
                return object->T::_property_get_revert(name, value);
            }
            return false;
        }
    }

    template <class T>
    static GDExtensionBool get_revert(GDExtensionClassInstancePtr instance,
                                      GDExtensionConstStringNamePtr name, GDExtensionVariantPtr value) {
        return get_revert_levels<T>(from<T>(instance), *static_cast<const StringName*>(name),
                                    *static_cast<Variant*>(value));
    }

    template <class T>
    static void validate_levels(const T* object, PropertyInfo& property) {
        if constexpr (!T::is_engine_class) {
            validate_levels<typename T::parent_type>(object, property);
            if constexpr (own_validate<T>) {
                object->T::_validate_property(property);
            }
        }
    }

    template <class T>
    static GDExtensionBool validate_property(GDExtensionClassInstancePtr instance,
                                             GDExtensionPropertyInfo* property) {
        PropertyInfo info(property);
        validate_levels<T>(from<T>(instance), info);
        write_back(info, property);
        return 1;
    }

    template <class T>
    static String string_of(const T* object) {
        if constexpr (own_to_string<T> || T::is_engine_class) {
            return object->T::_to_string();
        } else {
            return string_of<typename T::parent_type>(object);
        }
    }

    template <class T>
    static void to_string(GDExtensionClassInstancePtr instance, GDExtensionBool* is_valid,
                          GDExtensionStringPtr text) {
        *static_cast<String*>(text) = string_of<T>(from<T>(instance));
        *is_valid = 1;
    }

    // -- All of it, as the engine wants it
    // -----------------------------------------------------------------------

    // What no level declares stays null, so that the engine does not even call.
    template <class T>
    static GDExtensionClassCreationInfo4 creation_info() {
        GDExtensionClassCreationInfo4 info{};
        if constexpr (any_level<T>([]<class L>() { return own_notification<L>; })) {
            info.notification_func = &notification<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_set<L>; })) {
            info.set_func = &set<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_get<L>; })) {
            info.get_func = &get<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_property_list<L>; })) {
            info.get_property_list_func = &property_list<T>;
            info.free_property_list_func = &release_property_list;
        }
        if constexpr (any_level<T>([]<class L>() { return own_can_revert<L>; })) {
            info.property_can_revert_func = &can_revert<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_get_revert<L>; })) {
            info.property_get_revert_func = &get_revert<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_validate<L>; })) {
            info.validate_property_func = &validate_property<T>;
        }
        if constexpr (any_level<T>([]<class L>() { return own_to_string<L>; })) {
            info.to_string_func = &to_string<T>;
        }
        if constexpr (!std::is_abstract_v<T>) {
            info.create_instance_func = &create_instance<T>;
            info.recreate_instance_func = &recreate_instance<T>;
        }
        info.free_instance_func = &free_instance<T>;
        return info;
    }

    // -- Binding
    // -------------------------------------------------------------------------------------------------

    template <class T>
    static void bind_methods() {
        if constexpr (T::is_engine_class) {
            return;
        } else if (&T::_bind_methods != &T::parent_type::_bind_methods) {
            T::_bind_methods();
        }
    }

    template <class T>
    static void register_virtuals() {
        T::template register_virtuals<T, typename T::parent_type>();
    }
};

}  // namespace godot::internal
