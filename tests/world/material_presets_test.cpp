#include "world/material_presets.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/haptics/touch_values.hpp"

namespace tactus::material_presets_test {
namespace {

TEST(MaterialPresets, EachIsKnownByItsValues) {
    for (const MaterialPreset preset :
         {MaterialPreset::rubber, MaterialPreset::ice, MaterialPreset::sandpaper, MaterialPreset::steel,
          MaterialPreset::sponge, MaterialPreset::wood, MaterialPreset::glass, MaterialPreset::skin,
          MaterialPreset::foam}) {
        MaterialValues stored = values_of(preset);
        stored.friction = static_cast<float>(stored.friction);  // as Godot gives it back
        stored.bounce = static_cast<float>(stored.bounce);
        EXPECT_EQ(PresetChoice().preset(stored), preset);
    }
}

TEST(MaterialPresets, ValuesOfNoneAreCustom) {
    MaterialValues own = values_of(MaterialPreset::steel);
    own.touch.stiffness += 1.0;
    EXPECT_EQ(PresetChoice().preset(own), MaterialPreset::custom);
}

TEST(MaterialPresets, OwnValuesComeBack) {
    MaterialValues own;
    own.touch.stiffness = 321.0;
    own.friction = 0.4;
    PresetChoice choice;
    const auto ice = choice.choose(MaterialPreset::ice, own);
    ASSERT_TRUE(ice.has_value());
    EXPECT_EQ(ice->touch.stiffness, values_of(MaterialPreset::ice).touch.stiffness);
    const auto back = choice.choose(MaterialPreset::custom, *ice);
    ASSERT_TRUE(back.has_value());
    EXPECT_TRUE(same_values(back->touch, own.touch));
    EXPECT_EQ(back->friction, 0.4);
}

TEST(MaterialPresets, AChangedPresetComesBackAsItWasLeft) {
    PresetChoice choice;
    MaterialValues ice = *choice.choose(MaterialPreset::ice, {});
    ice.touch.damping = 3.0;
    const MaterialValues steel = *choice.choose(MaterialPreset::steel, ice);
    EXPECT_EQ(choice.choose(MaterialPreset::ice, steel)->touch.damping, 3.0);
}

TEST(MaterialPresets, TheSameAgainChangesNothing) {
    PresetChoice choice;
    const MaterialValues ice = *choice.choose(MaterialPreset::ice, {});
    EXPECT_FALSE(choice.choose(MaterialPreset::ice, ice).has_value());
}

TEST(Grain, IsBetweenZeroAndOneAndTheSameAlways) {
    const auto image = grain();
    ASSERT_EQ(image->values.size(), std::size_t{image->columns} * image->rows);
    double sum = 0.0;
    for (const float height : image->values) {
        ASSERT_GE(height, 0.0f);
        ASSERT_LT(height, 1.0f);
        sum += static_cast<double>(height);
    }
    EXPECT_NEAR(sum / static_cast<double>(image->values.size()), 0.5, 0.02);
    EXPECT_EQ(grain(), image);
}

TEST(TouchImage, IsMadeOfPackedFloatsBetweenZeroAndOne) {
    const float packed[] = {0.25f, -1.0f, 7.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f, 0.5f};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(packed);
    const auto image = touch_image(3, 2, {bytes, sizeof(packed)});
    ASSERT_NE(image, nullptr);
    EXPECT_EQ(image->columns, 3u);
    EXPECT_EQ(image->values, (std::vector<float>{0.25f, 0.0f, 1.0f, 0.0f, 1.0f, 0.5f}));
    EXPECT_EQ(touch_image(3, 2, {bytes, sizeof(packed) - 1}), nullptr);
}

}  // namespace
}  // namespace tactus::material_presets_test
