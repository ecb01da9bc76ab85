// Somebody else's library, loaded when a device needs it and never before; once loaded, it stays: what runs
// in its threads may not vanish.
#pragma once

#include <initializer_list>
#include <string>

#include "platform/shared_library.hpp"

namespace tactus {

class RuntimeLibrary {
public:
    // The first of the names, one or more for each system, under which there is a library with this function.
    bool load(std::initializer_list<const char*> names, const char* function) {
        for (const char* name : names) {
            void* there = nullptr;
            name_ = name;
            if (find(function, there)) {
                return true;
            }
        }
        name_.clear();
        return false;
    }

    template <typename Function>
    bool find(const char* name, Function& function) const {
        std::string error;
        function = reinterpret_cast<Function>(function_of_library(name_, name, error));
        return function != nullptr;
    }

private:
    std::string name_;
};

}  // namespace tactus
