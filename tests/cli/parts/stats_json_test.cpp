// The statistics' JSON of structs with known values: every key, in its order.
#include "cli/stats_json.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& json) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    return keys;
}

/// A picture with one cube that is built once and a bare body.
PictureStats traced_picture() {
    PictureStats stats;
    stats.machine = {"device", "CPU", "driver 1", "1.3.250"};
    stats.width = 64;
    stats.height = 48;
    stats.triangles = 12;
    stats.box = {{-1, -2, -3}, {1, 2, 3}};
    stats.rays = {3072, 100, 50, 20, 700, 7};
    RenderStats& s = stats.render;
    s.timed = true;
    s.frame_ms = 8;
    s.build_ms = 2;
    s.passes = {{"build/sort", 2}, {"trace", 3}, {"trace_shadow", 0.5}};
    s.cubes.bodies = 2;
    s.cubes.fixed = 1;
    s.cubes.bare = 1;
    s.cubes.resolution = 256;
    s.cubes.counts.fragments = 99;
    s.cubes.bytes = 1000;
    s.cubes.scratch_bytes = 10;
    s.bodies.resize(2);
    s.bodies[0].triangles = 10;
    s.bodies[0].resolution = 256;
    s.bodies[0].grid.dims = {16, 32, 48};
    s.bodies[0].grid.voxel = 0.5f;
    s.bodies[1].triangles = 2;
    s.bodies[1].resolution = LDC_BARE;
    s.shown = {3, 1};
    s.rebuilt = 1;
    s.moved = 2;
    s.scene_bytes = 5;
    s.frame_bytes = 6;
    s.peak_bytes = 7;
    s.memory = {{"scene", "positions", 40}, {"cubes", "samples", 60}};
    s.peak_memory = {{"scene", "positions", 80}};
    return stats;
}

TEST(StatsJson, AllOfATracedPictureInOrder) {
    const Json json = picture_json(traced_picture());
    EXPECT_EQ(keys_of(json), (std::vector<std::string>{
                                 "tracer",   "device",     "kind",    "driver",           "api_version", "commit",
                                 "image",    "camera",     "samples", "triangles",        "timed",       "frame_ms",
                                 "build_ms", "passes",     "rays",    "mrays_per_second", "ldc",         "moved",
                                 "bands",    "visibility", "hit",     "memory_bytes",     "memory",      "redone"}));
    EXPECT_EQ(json["tracer"], "ldc");
    EXPECT_EQ(json["api_version"], "1.3.250");
    EXPECT_EQ(json["image"], (Json{64, 48}));
    EXPECT_EQ(json["passes"][1], (Json{{"name", "trace"}, {"ms", 3.0}}));
    EXPECT_EQ(json["rays"], (Json{{"primary", 3072},
                                  {"reflection", 100},
                                  {"refraction", 50},
                                  {"diffuse", 20},
                                  {"shadow", 700},
                                  {"ambient", 7},
                                  {"cut", {{"reflection", 0}, {"refraction", 0}}},
                                  {"crowded", 0}}));
    EXPECT_DOUBLE_EQ(json["mrays_per_second"]["reflection_and_refraction"], 170 / 3e3);
    EXPECT_DOUBLE_EQ(json["mrays_per_second"]["shadow_and_ambient"], 707 / 0.5e3);
    EXPECT_EQ(json["moved"], (Json{{"cubes_rebuilt", 1}, {"cubes_reused", 1}, {"instances_transformed", 2}}));
    EXPECT_EQ(json["hit"], "exact");
    EXPECT_EQ(json["memory_bytes"], (Json{{"scene", 5},
                                          {"cube", 1000},
                                          {"acceleration_structures", 0},
                                          {"build_scratch", 10},
                                          {"frame", 6},
                                          {"peak", 7}}));
    EXPECT_EQ(json["memory"]["bytes"], 100);
    EXPECT_EQ(json["memory"]["parts"]["cubes"], (Json{{"bytes", 60}, {"buffers", {{"samples", 60}}}}));
    EXPECT_EQ(json["memory"]["peak"]["bytes"], 80);
}

TEST(StatsJson, CubesOneByOne) {
    const Json ldc = picture_json(traced_picture())["ldc"];
    EXPECT_EQ(keys_of(ldc),
              (std::vector<std::string>{"n", "box", "builder", "traversal", "block", "sampling", "samples", "layers",
                                        "layers_of", "occupied_voxels", "occupied_nodes", "bytes",
                                        "build_scratch_bytes", "triangles_without_area", "triangles_not_finite",
                                        "count", "bare_bodies", "no_room", "cubes"}));
    EXPECT_EQ(ldc["n"], 256);
    EXPECT_EQ(ldc["box"]["upper"], (Json{1.0, 2.0, 3.0}));
    EXPECT_EQ(ldc["count"], 1);
    ASSERT_EQ(ldc["cubes"].size(), 2u);
    EXPECT_EQ(ldc["cubes"][0], (Json{{"triangles", 10},
                                     {"instances", 3},
                                     {"bare", false},
                                     {"built", "once"},
                                     {"n", 256},
                                     {"voxels", {16, 32, 48}},
                                     {"voxel_size", 0.5},
                                     {"box", {{"lower", {0.0, 0.0, 0.0}}, {"upper", {8.0, 16.0, 24.0}}}}}));
    EXPECT_EQ(ldc["cubes"][1]["built"], "never");
    EXPECT_EQ(ldc["cubes"][1]["n"], 0);
}

TEST(StatsJson, TheReferenceHasNoDevice) {
    PictureStats stats;
    stats.render.tracer = Tracer::reference;
    stats.machine = {"2 CPU threads", "cpu", "Embree 3", ""};
    stats.render.timed = true;
    stats.render.passes = {{"build/bvh", 1}, {"trace and shade", 2}};
    const Json json = picture_json(stats);
    EXPECT_EQ(keys_of(json), (std::vector<std::string>{"tracer", "device", "kind", "driver", "api_version", "commit",
                                                       "image", "camera", "samples", "triangles", "timed", "frame_ms",
                                                       "build_ms", "passes", "rays", "hit"}));
    EXPECT_EQ(json["tracer"], "reference");
    EXPECT_TRUE(json["api_version"].is_null());
    EXPECT_EQ(json["hit"], "double");
}

TEST(StatsJson, RaysThroughStructuresTellOfNoCubes) {
    TraceStats stats;
    stats.machine = {"device", "discrete", "driver", "1.3"};
    stats.rays = 2000;
    stats.hits = 1;
    stats.trace_ms = 4;
    EXPECT_EQ(trace_json(stats)["tracer"], "ldc");
    EXPECT_TRUE(trace_json(stats).contains("ldc"));
    EXPECT_DOUBLE_EQ(trace_json(stats)["mrays_per_second"], 0.5);
    stats.structures = Structures::Stats{.bodies = 2, .kept = 2};
    const Json json = trace_json(stats);
    EXPECT_EQ(json["tracer"], "khr");
    EXPECT_EQ(json["hit"], "none");
    EXPECT_EQ(json["khr"]["built"], "once");
    EXPECT_FALSE(json.contains("ldc"));
    stats.trace_ms = 0;
    EXPECT_TRUE(trace_json(stats)["mrays_per_second"].is_null());
}

}  // namespace
}  // namespace peelray
