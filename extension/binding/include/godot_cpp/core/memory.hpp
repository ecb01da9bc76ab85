#pragma once

#include <godot_cpp/classes/wrapped.hpp>
#include <godot_cpp/private/class_access.hpp>
#include <type_traits>
#include <utility>

namespace godot {
namespace internal {

void notify_postinitialize(Wrapped* object);
void destroy_object(GodotObject* object);

// `Made<T>().finish(new T(…))`: the scope exists before T's constructor runs, the engine is told afterwards.
template <class T, bool Wraps = std::is_base_of_v<Wrapped, T>>
struct Made {
    T* finish(T* object) { return object; }
};

template <class T>
struct Made<T, true> {
    ConstructionScope scope{ClassAccess::construction<T>()};

    T* finish(T* object) {
        scope.finish();
        notify_postinitialize(object);
        return object;
    }
};

}  // namespace internal

template <class T>
void memdelete(T* object) {
    if constexpr (std::is_base_of_v<Wrapped, T>) {
        internal::destroy_object(object->_owner);
    } else {
        delete object;
    }
}

}  // namespace godot

#define memnew(m_class) \
    (::godot::internal::Made<std::remove_pointer_t<decltype(new m_class)>>().finish(new m_class))

#define memdelete_notnull(m_pointer)   \
    if (m_pointer) {                   \
        ::godot::memdelete(m_pointer); \
    } else                             \
        ((void)0)
