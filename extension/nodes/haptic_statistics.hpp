// Statistics of one group, as they were when they were asked for: objects whose properties cannot be set. The
// properties of each class are written from the class reference of the node that returns it
// (binding/bind_classes.py).
#pragma once

#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "nodes/properties.hpp"

namespace tactus {

class HapticStatistics : public godot::RefCounted {
    GDCLASS(HapticStatistics, godot::RefCounted)

public:
    // By the keys of get_statistics(). What a node has no value of is left out, and reads as 0.
    template <class Group>
    static godot::Ref<Group> of(const godot::Dictionary& values) {
        godot::Ref<Group> group(memnew(Group));
        group->values_ = values;
        return group;
    }
    godot::Dictionary to_dictionary() const { return values_.duplicate(); }

protected:
    static void _bind_methods();

    template <class Value>
    Value value_of(const char* key) const {
        return godot::VariantCaster<Value>::cast(values_.get(key, Value()));
    }

private:
    godot::Dictionary values_;
};

#define TACTUS_STATISTICS(Class)                      \
    class Class : public HapticStatistics {           \
        GDCLASS(Class, HapticStatistics)              \
                                                      \
    public:                                           \
        template <tactus::FixedText key, class Value> \
        Value figure() const {                        \
            return value_of<Value>(key.text);         \
        }                                             \
                                                      \
    protected:                                        \
        static void _bind_methods();                  \
    }

TACTUS_STATISTICS(HapticLoadStatistics);
TACTUS_STATISTICS(HapticTimingStatistics);
TACTUS_STATISTICS(HapticSensingStatistics);
TACTUS_STATISTICS(MMTNetworkStatistics);
TACTUS_STATISTICS(MMTModelStatistics);
TACTUS_STATISTICS(MMTPassivityStatistics);
TACTUS_STATISTICS(MMTPlayoutStatistics);

}  // namespace tactus
