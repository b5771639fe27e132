#include "core/io/array_names.h"

#include <gtest/gtest.h>

namespace adamas {

using namespace io;

namespace {

TEST(ArrayNames, FractionNamesTheMaterial) {
  EXPECT_EQ(fraction_material("Volume Fraction for Armor Plate"), "Armor Plate");
  EXPECT_EQ(fraction_material("Void Volume Fraction"), "Void");
  EXPECT_EQ(fraction_material("volume_fraction_steel"), "steel");
  EXPECT_EQ(fraction_material("steel_VOLUME_fraction"), "steel");
  EXPECT_EQ(fraction_material("Volume Fraction for Body, Nose"), "Body, Nose");
  EXPECT_EQ(fraction_material("volume fraction of Format"), "Format");
  EXPECT_EQ(fraction_material("Pressure"), std::nullopt);
  EXPECT_EQ(fraction_material("Volume Fraction"), std::nullopt);
  EXPECT_EQ(fraction_material(""), std::nullopt);
}

TEST(ArrayNames, FieldKnowsMaterialUnitAndAxis) {
  const std::vector<std::string> materials{"Plate", "Armor Plate", "Void"};
  const FieldName mass = parse_field_name("Mass for Armor Plate", materials);
  EXPECT_EQ(mass.name, "Mass");
  EXPECT_EQ(mass.material, 1u) << "the longest name that fits";
  EXPECT_EQ(parse_field_name("density_Armor_Plate", materials).name, "density");
  EXPECT_EQ(parse_field_name("Armor Plate density", materials).material, 1u);
  EXPECT_EQ(parse_field_name("Plate density", materials).material, 0u);

  const FieldName unit = parse_field_name("X Velocity for Void [m/s]", materials);
  EXPECT_EQ(unit.name, "Velocity");
  EXPECT_EQ(unit.unit, "m/s");
  EXPECT_EQ(unit.material, 2u);
  EXPECT_EQ(unit.axis, 0);
  EXPECT_EQ(parse_field_name("velocity_z", materials).axis, 2);
  EXPECT_EQ(parse_field_name("density (g/cm^3)", materials).unit, "g/cm^3");
  EXPECT_EQ(parse_field_name("f(x)", materials).name, "f(x)") << "no space before the bracket, no unit";

  const FieldName plain = parse_field_name("Voidness", materials);
  EXPECT_EQ(plain.name, "Voidness");
  EXPECT_EQ(plain.material, std::nullopt);
  EXPECT_EQ(parse_field_name("Void", materials).material, std::nullopt);
}

}  // namespace
}  // namespace adamas
