// What is generated, on the CPU: it depends on nothing but the moment, and leaves the scene alone.
#include "motion/simulation.h"

#include <gtest/gtest.h>

#include "loaders/load.h"
#include "motion/animation.h"

namespace peelray {
namespace {

Moment placed_at(const Scene& scene, Simulation& simulation, double time) {
    Moment moment = moment_of(scene, "0", time);
    simulation.place(scene, moment);
    return moment;
}

TEST(Simulation, WaterDependsOnNothingButTheMoment) {
    const Scene scene = load_scene("builtin:waves:200");
    Simulation used, fresh;
    placed_at(scene, used, 0.3);
    const Moment later = placed_at(scene, used, 2.1), before = placed_at(scene, used, 0.7);
    EXPECT_EQ(flatten(scene, before).positions, flatten(scene, placed_at(scene, fresh, 0.7)).positions);
    EXPECT_EQ(flatten(scene, later).positions, flatten(scene, placed_at(scene, fresh, 2.1)).positions);
    EXPECT_NE(flatten(scene, later).positions, flatten(scene, before).positions);
    ASSERT_EQ(later.surfaces.size(), 1u);
    EXPECT_EQ(later.surfaces[0].node, scene.generated.waters[0].node);
}

TEST(Simulation, WhatSwimsGoesWithTheWater) {
    const Scene scene = load_scene("builtin:waves:200");
    Simulation simulation;
    const Moment start = placed_at(scene, simulation, 0), later = placed_at(scene, simulation, 1.5);
    for (const Water::Float& f : scene.generated.waters[0].floats) {
        EXPECT_NE(start.worlds[size_t(f.node)], later.worlds[size_t(f.node)]);
        EXPECT_EQ(later.worlds[size_t(f.node)], glm::mat4(later.locals[size_t(f.node)])) << "it has no parent";
    }
}

TEST(Simulation, TheBeginningIsTheSceneAtRest) {
    for (const char* name : {"builtin:waves:200", "builtin:particles:50", "builtin:cloth:50"}) {
        const Scene scene = load_scene(name);
        Simulation simulation;
        EXPECT_EQ(flatten(scene, placed_at(scene, simulation, 0)).positions, flatten(scene).positions) << name;
        EXPECT_NE(flatten(scene, placed_at(scene, simulation, 1.1)).positions, flatten(scene).positions) << name;
    }
}

TEST(Simulation, WhereNothingIsGeneratedNothingHappens) {
    const Scene scene = load_scene("builtin:walker");
    Simulation simulation;
    const Moment moment = placed_at(scene, simulation, 0.4);
    EXPECT_TRUE(moment.surfaces.empty());
    EXPECT_EQ(flatten(scene, moment).positions, flatten(scene, moment_of(scene, "0", 0.4)).positions);
}

}  // namespace
}  // namespace peelray
