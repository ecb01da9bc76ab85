#pragma once

#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>
#include <memory>

#include "world/input_player.hpp"

namespace tactus {

// Plays the inputs that a HapticWorld has recorded.
class HapticReplay : public godot::RefCounted {
    GDCLASS(HapticReplay, godot::RefCounted)

public:
    bool open(const godot::String& inputs_path, const godot::String& csv_path);
    int64_t play(double seconds);
    bool is_over() const { return player_ == nullptr || is_over_; }
    godot::Dictionary get_report() const;

protected:
    static void _bind_methods();

private:
    InputReplay::Report report() const;

    std::unique_ptr<InputPlayer> player_;  // null: nothing is open
    bool is_over_ = false;
};

}  // namespace tactus
