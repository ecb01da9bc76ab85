// The bytes of a file that is said to be Wavefront .obj, whatever they are.
#pragma once

#include <string>
#include <string_view>

#include "core/mesh/obj_text.hpp"

namespace tactus {

// What the bytes are that is no text of an .obj file, and what to do: "it is an STL file: …". Empty where
// nothing speaks against it.
std::string kind_of_other_file(std::string_view bytes);

// UTF-16 in UTF-8, by its byte order mark; all else as it is. What is no character is read as a blank.
std::string as_utf8(std::string_view bytes);

// As read_obj_text() reads it, in UTF-8 or UTF-16. The error of what is none says what it is, or names the
// first line that is not understood; a file that only lacks triangles is no error here: see check_mesh.
ObjResult read_obj_file(std::string_view bytes, const ObjLimits& limits = {});

}  // namespace tactus
