// Where the secret of a link comes from: a file of its own or the environment, never a scene, which is
// shared.
#pragma once

#include <string>

namespace tactus {

struct KeySource {
    std::string text;   // see shared_secret(); empty: there is none
    std::string error;  // what is wrong and what to do; empty where nothing is
};

// The variable of the environment that is asked where no file is named.
inline constexpr const char* key_variable = "TACTUS_KEY";

// Off the loop. `file`: an absolute path, or empty. A file that is named has to be there and to hold a key;
// that others may read it is said in an error too, since then it is none.
KeySource read_key(const std::string& file);

}  // namespace tactus
