#pragma once

#include <godot_cpp/core/memory.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

namespace internal {

// The RefCounted half of an object. All three are the engine's own counters.
bool init_reference(GodotObject* object);
bool add_reference(GodotObject* object);
bool drop_reference(GodotObject* object);

}  // namespace internal

// Shared ownership of a RefCounted: counts in the engine, so C++ and scripts share one counter.
template <class T>
class Ref {
public:
    Ref() = default;
    Ref(T* object) { take_new(object); }
    Ref(const Ref& other) { share(other.object_); }
    Ref(Ref&& other) noexcept : object_(other.object_) { other.object_ = nullptr; }
    template <class U>
    Ref(const Ref<U>& other) {
        share(Object::cast_to<T>(other.ptr()));
    }
    Ref(const Variant& variant) { share(Object::cast_to<T>(static_cast<Object*>(variant))); }
    ~Ref() { unref(); }

    Ref& operator=(const Ref& other) {
        Ref copy(other);
        swap(copy);
        return *this;
    }
    Ref& operator=(Ref&& other) noexcept {
        swap(other);
        return *this;
    }
    template <class U>
    Ref& operator=(const Ref<U>& other) {
        return *this = Ref(other);
    }
    Ref& operator=(const Variant& variant) { return *this = Ref(variant); }

    // Takes over an object together with a reference that was counted for us already.
    static Ref adopt(Object* object) {
        Ref ref;
        ref.object_ = Object::cast_to<T>(object);
        if (object != nullptr && ref.object_ == nullptr && internal::drop_reference(object->_owner)) {
            internal::destroy_object(object->_owner);
        }
        return ref;
    }

    template <class... A>
    void instantiate(A&&... arguments) {
        *this = Ref(memnew(T(std::forward<A>(arguments)...)));
    }

    void unref() {
        if (object_ != nullptr && internal::drop_reference(object_->_owner)) {
            internal::destroy_object(object_->_owner);
        }
        object_ = nullptr;
    }

    T* ptr() const { return object_; }
    T* operator->() const { return object_; }
    T* operator*() const { return object_; }
    bool is_valid() const { return object_ != nullptr; }
    bool is_null() const { return object_ == nullptr; }

    operator Variant() const { return Variant(static_cast<const Object*>(object_)); }

    bool operator==(const Ref& other) const { return object_ == other.object_; }
    bool operator!=(const Ref& other) const { return object_ != other.object_; }
    bool operator==(const T* other) const { return object_ == other; }
    bool operator!=(const T* other) const { return object_ != other; }
    bool operator<(const Ref& other) const { return object_ < other.object_; }

private:
    void swap(Ref& other) {
        T* mine = object_;
        object_ = other.object_;
        other.object_ = mine;
    }

    // A fresh RefCounted starts with one reference that belongs to whoever holds it first.
    void take_new(T* object) {
        if (object != nullptr && internal::init_reference(object->_owner)) {
            object_ = object;
        }
    }

    void share(T* object) {
        if (object != nullptr && internal::add_reference(object->_owner)) {
            object_ = object;
        }
    }

    T* object_ = nullptr;
};

}  // namespace godot
