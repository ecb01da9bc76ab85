// Somebody else's library, loaded when a device needs it and never before; once loaded, it stays: what runs
// in its threads may not vanish.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "platform/shared_library.hpp"

namespace tactus {

class RuntimeLibrary {
public:
    // A function's name in the library, and the pointer that is to lead to it.
    class Function {
    public:
        template <typename Pointer>
        Function(const char* name, Pointer& pointer)
            : name_(name), pointer_(&pointer), set_([](void* into, void* address) {
                  *static_cast<Pointer*>(into) = reinterpret_cast<Pointer>(address);
              }) {}

    private:
        friend class RuntimeLibrary;
        const char* name_;
        void* pointer_;
        void (*set_)(void* pointer, void* address);
    };

    // The first of the names, one or more for each system, under which there is a library with this function.
    bool load(std::initializer_list<const char*> names, const char* function) {
        for (const char* name : names) {
            name_ = name;
            if (address_of(function) != nullptr) {
                return true;
            }
        }
        name_.clear();
        return false;
    }

    // All of them, or none: then every pointer is as it was.
    bool find(std::initializer_list<Function> functions) const {
        std::vector<void*> addresses;
        for (const Function& function : functions) {
            addresses.push_back(address_of(function.name_));
            if (addresses.back() == nullptr) {
                return false;
            }
        }
        for (std::size_t i = 0; const Function& function : functions) {
            function.set_(function.pointer_, addresses[i++]);
        }
        return true;
    }

private:
    void* address_of(const char* function) const {
        std::string error;
        return function_of_library(name_, function, error);
    }

    std::string name_;
};

}  // namespace tactus
