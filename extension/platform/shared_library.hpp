#pragma once

#include <string>

namespace tactus {

// A function of a library, which is loaded and stays so; its path is UTF-8. Null: `error` says why.
void* function_of_library(const std::string& library, const char* name, std::string& error);

// The file that the system finds for a library of this name, which is not loaded after that if it was not
// before; empty: there is none.
std::string file_of_library(const std::string& library);

// The file of the library or program that `inside` is an address in; empty where the system cannot tell.
std::string path_of_this_library(const void* inside);

// The library that this code is in stays in the process until its end, even where it is unloaded before: for
// threads that may be left behind in it.
void keep_this_library();

}  // namespace tactus
