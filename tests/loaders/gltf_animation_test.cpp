// Animations of glTF files: what bad ones say, and what odd ones mean.
#include <set>

#include "loaders/animated_files.h"
#include "motion/animation.h"

namespace peelray::testing {
namespace {

TEST(GltfAnimation, MatricesWithoutInverse) {
    const TempFolder folder;
    for (const json& matrix : {json({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}),
                               json({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                               json({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                               json({1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})}) {
        json gltf = lifted();
        gltf["nodes"][1]["matrix"] = matrix;
        Scene scene = load(folder, gltf);
        expect_defined(scene);
        gltf = lifted();
        gltf["nodes"][0].erase("skin");
        gltf["nodes"][0]["matrix"] = matrix;
        Scene rigid = load(folder, gltf);
        expect_defined(rigid);
    }
}

TEST(GltfAnimation, ScaleGoesThroughZero) {
    const TempFolder folder;
    for (const bool with_skin : {true, false}) {
        json gltf = skinned();
        if (!with_skin) gltf["nodes"][0].erase("skin");
        animate_node(gltf, with_skin ? 1 : 0, "scale", {0, 1, 2}, {1, 1, 1, -1, 1, 1, 1, 0, 1}, "VEC3");
        Scene scene = load(folder, gltf);
        expect_defined(scene);
        Geometry g = flatten(scene, moment_of(scene, "0", 0.5));
        EXPECT_EQ(g.zero_area, 2u);  // flat in x
        for (const glm::vec3& n : g.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5);
        // Inside out: fronts stay fronts.
        g = flatten(scene, moment_of(scene, "0", 1));
        EXPECT_EQ(g.zero_area, 0u);
        for (const glm::uvec3& t : g.triangles)
            EXPECT_GT(glm::dot(glm::cross(g.positions[t.y] - g.positions[t.x], g.positions[t.z] - g.positions[t.x]),
                               g.normals[t.x]),
                      0);
        EXPECT_EQ(flatten(scene, moment_of(scene, "0", 2)).zero_area, 2u);
    }
}

TEST(GltfAnimation, KeyTimes) {
    const TempFolder folder;
    const auto with = [&](const std::vector<float>& times) {
        json gltf = skinned();
        animate_node(gltf, 2, "translation", times, std::vector<float>(3 * times.size(), 1.f), "VEC3");
        return gltf;
    };
    const std::string where = "animations[0].channels[0]";
    EXPECT_MENTIONS(error_of(folder, with({0, 2, 1})), where + ": the time 1 of key 2 is not after the one before");
    EXPECT_MENTIONS(error_of(folder, with({0, 1, 1})), where + ": the time 1 of key 2 is not after the one before");
    EXPECT_MENTIONS(error_of(folder, with({-1, 1})), where + ": the time -1 of key 0 is no number of seconds");
    EXPECT_MENTIONS(error_of(folder, with({0, NAN})), "of key 1 is no number of seconds");
    EXPECT_MENTIONS(error_of(folder, with({0, INFINITY})), "of key 1 is no number of seconds");
    EXPECT_NO_THROW(load(folder, with({0})));
    json gltf = with({0, 1});
    const size_t input = gltf["animations"][0]["samplers"][0]["input"];
    gltf["accessors"][input]["count"] = 0;
    EXPECT_MENTIONS(error_of(folder, gltf), "the animation has no keys");
    gltf = with({0, 1});
    gltf["animations"][0]["samplers"][0]["input"] = add_accessor(gltf, pack<uint8_t>({0, 1}), 5121, "SCALAR", 2);
    EXPECT_MENTIONS(error_of(folder, gltf), "key times must be single floats");
    gltf["animations"][0]["samplers"][0]["input"] = add_accessor(gltf, pack<float>({0, 1, 2, 3}), 5126, "VEC2", 2);
    EXPECT_MENTIONS(error_of(folder, gltf), "key times must be single floats");
}

TEST(GltfAnimation, KeysWithoutTimesAreAllAtZero) {
    const TempFolder folder;
    json gltf = skinned();
    animate_node(gltf, 2, "translation", {0, 1, 2}, {0, 1, 0, 0, 2, 0, 0, 3, 0}, "VEC3");
    const size_t input = gltf["animations"][0]["samplers"][0]["input"];
    gltf["accessors"][input].erase("bufferView");
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.animations.at(0).channels.size(), 1u);
    EXPECT_EQ(scene.animations[0].channels[0].at(0.5f), (std::vector<float>{0, 3, 0}));
    EXPECT_EQ(scene.animations[0].duration, 0);
    EXPECT_TRUE(has_note(scene, "all at 0 seconds"));
    gltf["accessors"][input]["count"] = 2;
    EXPECT_MENTIONS(error_of(folder, gltf), "2 keys need 6 numbers");
}

TEST(GltfAnimation, CountsAndTypesOfValues) {
    const TempFolder folder;
    const auto with = [&](const char* path, std::vector<float> values, const char* type, const char* interpolation) {
        json gltf = skinned();
        animate_node(gltf, 2, path, {0, 1}, values, type, interpolation);
        return error_of(folder, gltf);
    };
    const std::vector<float> twelve(12, 0.5f);
    EXPECT_MENTIONS(with("translation", {1, 2, 3}, "VEC3", "LINEAR"), "2 keys need 6 numbers, the output has 3");
    EXPECT_MENTIONS(with("scale", twelve, "VEC3", "STEP"), "2 keys need 6 numbers, the output has 12");
    EXPECT_MENTIONS(with("rotation", {0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", "CUBICSPLINE"), "2 keys need 24 numbers");
    EXPECT_MENTIONS(with("translation", {0, 0, 0, 0, 0, 0}, "SCALAR", "LINEAR"), "its values need 3 components");
    EXPECT_MENTIONS(with("translation", twelve, "VEC4", "LINEAR"), "its values need 3 components");
    EXPECT_MENTIONS(with("rotation", twelve, "VEC3", "LINEAR"), "its values need 4 components");
    EXPECT_MENTIONS(with("scale", {1, 1, 1, 1, NAN, 1}, "VEC3", "LINEAR"), "a value is not finite");
    EXPECT_MENTIONS(with("scale", {1, 1, 1, 1, 1, 1}, "VEC3", "BOUNCE"), "the interpolation \"BOUNCE\" is unknown");
    json gltf = lifted();
    gltf["animations"][0]["samplers"][0]["output"] =
        add_accessor(gltf, pack<int16_t>({0, 0, 0, 1, 1, 1}), 5122, "VEC3", 2);
    EXPECT_MENTIONS(error_of(folder, gltf), "must be floats or normalized integers");
}

TEST(GltfAnimation, ChannelsWithoutTheirParts) {
    const TempFolder folder;
    const auto changed = [&](auto change) {
        json gltf = lifted();
        change(gltf["animations"][0]);
        return gltf;
    };
    const auto error = [&](auto change) { return error_of(folder, changed(change)); };
    EXPECT_MENTIONS(error([](json& a) { a["channels"][0].erase("sampler"); }), "channels[0]: \"sampler\" is missing");
    EXPECT_MENTIONS(error([](json& a) { a["channels"][0]["sampler"] = 1; }), "sampler 1 is out of range");
    EXPECT_MENTIONS(error([](json& a) { a["samplers"] = json::array(); }), "sampler 0 is out of range");
    EXPECT_MENTIONS(error([](json& a) { a.erase("samplers"); }), "sampler 0 is out of range");
    EXPECT_MENTIONS(error([](json& a) { a["samplers"][0].erase("input"); }), "\"input\" is missing");
    EXPECT_MENTIONS(error([](json& a) { a["samplers"][0].erase("output"); }), "\"output\" is missing");
    EXPECT_MENTIONS(error([](json& a) { a["samplers"][0]["output"] = 99; }), "out of range");
    EXPECT_MENTIONS(error([](json& a) { a["channels"][0].erase("target"); }), "\"target\" is missing");
    EXPECT_MENTIONS(error([](json& a) { a["channels"][0]["target"].erase("path"); }), "\"path\" is missing");
    EXPECT_MENTIONS(error([](json& a) { a["channels"][0]["target"]["node"] = 3; }), "the file has 3 nodes");
    // What is left out has no effect, and a note.
    const auto still = [&](auto change, const char* note) {
        const Scene scene = load(folder, changed(change));
        EXPECT_TRUE(has_note(scene, note));
        EXPECT_EQ(positions_at(scene, 0.5), positions_at(scene, 0));
    };
    still([](json& a) { a["channels"][0]["target"].erase("node"); }, "1 animation channel of nodes that are not shown");
    still([](json& a) { a["channels"][0]["target"]["path"] = "pointer"; }, "1 animation channel of an unknown path");
    still([](json& a) { a["channels"][0]["target"]["path"] = "weights"; }, "1 animation channel of weights without");
    const Scene empty = load(folder, changed([](json& a) { a = json::object(); }));
    EXPECT_EQ(empty.animations.at(0).duration, 0);
    EXPECT_EQ(positions_at(empty, 0.5), positions_at(empty, 0));
    json gltf = lifted();
    gltf["nodes"].push_back({{"name", "elsewhere"}});
    gltf["animations"][0]["channels"][0]["target"]["node"] = 3;
    EXPECT_TRUE(has_note(load(folder, gltf), "1 animation channel of nodes that are not shown"));
    gltf = lifted();
    gltf["nodes"][2].erase("translation");
    gltf["nodes"][2]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1};
    EXPECT_TRUE(has_note(load(folder, gltf), "1 animation channel of nodes with a matrix"));
}

TEST(GltfAnimation, OfTwoChannelsForTheSameTheLaterCounts) {
    const TempFolder folder;
    json gltf = lifted();
    json& animation = gltf["animations"][0];
    const size_t output = add_accessor(gltf, pack<float>({0, 1, 0, 0, 9, 0}), 5126, "VEC3", 2);
    gltf["animations"][0]["samplers"].push_back({{"input", animation["samplers"][0]["input"]}, {"output", output}});
    gltf["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", {{"node", 2}, {"path", "translation"}}}});
    const Scene scene = load(folder, gltf);
    EXPECT_TRUE(has_note(scene, "1 animation channel that moves what an earlier one moves already"));
    float top = 0;
    for (const glm::vec3& p : positions_at(scene, 1)) top = std::max(top, p.y);
    EXPECT_FLOAT_EQ(top, 9);
    // One for each property is as it should be.
    gltf["animations"][0]["channels"][1]["target"]["path"] = "scale";
    EXPECT_TRUE(load(folder, gltf).notes.empty());
}

TEST(GltfAnimation, QuantizedRotations) {
    const TempFolder folder;
    // Half a turn about z: from (0, 0, 0, 1) to (0, 0, 1, 0); in the middle the upper edge's right end points up.
    const auto check = [&](const std::string& bytes, int type) {
        json gltf = skinned();
        animate_node(gltf, 2, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0}, "VEC4");
        const std::vector<glm::vec3> exact = positions_at(load(folder, gltf), 0.5);
        gltf["animations"][0]["samplers"][0]["output"] = add_accessor(gltf, bytes, type, "VEC4", 2, true);
        const std::vector<glm::vec3> quantized = positions_at(load(folder, gltf), 0.5);
        for (size_t i = 0; i < exact.size(); ++i) expect_near(quantized[i], exact[i]);
    };
    check(pack<int8_t>({0, 0, 0, 127, 0, 0, 127, 0}), 5120);
    check(pack<uint8_t>({0, 0, 0, 255, 0, 0, 255, 0}), 5121);
    check(pack<int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}), 5122);
    check(pack<uint16_t>({0, 0, 0, 65535, 0, 0, 65535, 0}), 5123);
}

TEST(GltfAnimation, RotationsWithoutDirectionCountAsNone) {
    const TempFolder folder;
    json gltf = skinned();
    animate_node(gltf, 2, "rotation", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    const Scene scene = load(folder, gltf);
    const std::vector<glm::vec3> rest = flatten(scene).positions, now = positions_at(scene, 0.5);
    for (size_t i = 0; i < rest.size(); ++i) expect_near(now[i], rest[i]);
    // Huge ones and such as pass through zero are defined, too.
    for (const float huge : {1e30f, 3e38f}) {
        json odd = skinned();
        animate_node(odd, 2, "rotation", {0, 1}, {0, 0, 0, huge, 0, 0, 0, -huge}, "VEC4");
        Scene loaded = load(folder, odd);
        expect_defined(loaded);
        odd = skinned();
        animate_node(odd, 2, "rotation", {0, 1}, std::vector<float>(24, huge), "VEC4", "CUBICSPLINE");
        loaded = load(folder, odd);
        expect_defined(loaded);
    }
}

TEST(GltfAnimation, HugeValuesGiveOneLine) {
    const TempFolder folder;
    for (const char* path : {"translation", "scale"})
        for (const char* interpolation : {"LINEAR", "CUBICSPLINE"}) {
            json gltf = skinned();
            const size_t count = interpolation == std::string("LINEAR") ? 6 : 18;
            animate_node(gltf, 1, path, {0, 3e38f}, std::vector<float>(count, 3e38f), "VEC3", interpolation);
            animate_node(gltf, 2, path, {0, 1}, std::vector<float>(count, 3e38f), "VEC3", interpolation);
            Scene scene = load(folder, gltf);
            expect_defined(scene);
            EXPECT_MENTIONS(error_from([&] { positions_at(scene, 0.5); }), "leaves the range of 32-bit floats") << path;
        }
}

// Every value of a file with a skin, targets and animations in turn replaced by one of another type or size: it loads
// and moves, or gives one line.
TEST(GltfAnimation, WrongTypesEverywhere) {
    const TempFolder folder;
    json gltf = lifted();
    primitive(gltf)["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
    gltf["meshes"][0]["weights"] = {0.25, 0};
    animate_node(gltf, 0, "weights", {0, 1}, {0, 0, 1, 1}, "SCALAR");
    animate_node(gltf, 1, "rotation", {0, 1}, std::vector<float>(24, 0.5f), "VEC4", "CUBICSPLINE");
    gltf["animations"][0]["name"] = "up";
    Scene good = load(folder, gltf);
    expect_defined(good);
    size_t loaded = 0, refused = 0;
    std::set<std::string> places;
    const json flat = gltf.flatten();
    for (const auto& [pointer, unused] : flat.items())
        for (json::json_pointer at(pointer); !at.empty(); at.pop_back()) places.insert(at.to_string());
    for (const std::string& place : places)
        for (const json& value :
             {json(nullptr), json("x"), json(-1), json(0), json(1), json(2), json(3), json(5126), json(1e300),
              json(4294967296u * 4ull), json(0.5), json::array(), json::object(), json::array({json::object()})}) {
            json bad = gltf;
            bad[json::json_pointer(place)] = value;
            SCOPED_TRACE(place + " = " + value.dump());
            try {
                Scene scene = load(folder, bad);
                expect_defined(scene);
                ++loaded;
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                ++refused;
            }
        }
    EXPECT_GT(loaded, 100u);
    EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace peelray::testing
