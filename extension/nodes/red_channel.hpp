// Numbers out of an image.
#pragma once

#include <godot_cpp/classes/image.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>

namespace tactus {

// The red channel of each pixel, row by row, as floats; black is 0 and white is 1, or what the image holds
// where its own numbers are floats. The image stays as it is.
inline godot::PackedByteArray red_channel(const godot::Ref<godot::Image>& image) {
    const godot::Ref<godot::Image> copy = image->duplicate();
    if (copy->is_compressed()) {
        copy->decompress();
    }
    copy->clear_mipmaps();
    copy->convert(godot::Image::FORMAT_RF);
    return copy->get_data();
}

}  // namespace tactus
