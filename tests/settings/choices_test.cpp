// Tables of names: every value has one, and no two the same.
#include "settings/choices.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "settings/aovs.h"

namespace peelray {
namespace {

template <typename Value>
class Choices : public testing::Test {};
using All = testing::Types<Tracer, HitTest, Traversal, BuilderKind, Routing, Batch, Visibility, Tonemap,
                           MaterialOverride, Effect, RayKind, Aov>;
TYPED_TEST_SUITE(Choices, All);

TYPED_TEST(Choices, AreParsedAsTheyArePrinted) {
    std::set<std::string> names;
    std::set<TypeParam> values;
    for (const TypeParam value : values_of<TypeParam>()) {
        const std::string name = name_of(value);
        EXPECT_FALSE(name.empty());
        EXPECT_EQ(value_named<TypeParam>(name), value);
        names.insert(name);
        values.insert(value);
    }
    EXPECT_EQ(names.size(), values_of<TypeParam>().size());
    // Without gaps, so that none was left out of the table.
    EXPECT_EQ(values.size(), names.size());
    EXPECT_EQ(size_t(*values.rbegin()) + 1, values.size());
    EXPECT_FALSE(value_named<TypeParam>(""));
    EXPECT_FALSE(value_named<TypeParam>("VOXEL"));
}

TEST(ChoiceSet, HoldsWhatWasPutIn) {
    ChoiceSet<Effect> set = {Effect::shadow};
    EXPECT_TRUE(set.has(Effect::shadow));
    EXPECT_FALSE(set.has(Effect::reflection));
    set.add(Effect::reflection);
    EXPECT_EQ(set, (ChoiceSet<Effect>{Effect::reflection, Effect::shadow}));
    EXPECT_NE(set, ChoiceSet<Effect>());
}

TEST(Aovs, OfCostsAreCalledByTheirFields) {
    size_t costs = 0;
    for (const Aov aov : values_of<Aov>())
        if (const RayCostField* field = cost_field(aov)) {
            EXPECT_EQ(name_of(aov), std::string("cost_") + field->name);
            costs++;
        }
    EXPECT_EQ(costs, kRayCostFields.size());
}

}  // namespace
}  // namespace peelray
