// No sequence mixes pictures of two settings: the manifest tells every one that changes pictures.
#include "cli/manifest.h"

#include <gtest/gtest.h>

#include <set>

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

/// Takes another value than it has. False: none of the texts that are tried is one.
bool change(const SettingEntry& entry) {
    const auto before = entry.text();
    std::vector<std::string> texts = {"true", "7", "1.5", "1,2,3", "33x44", "all", "ambient", "other"};
    for (size_t at = 0; at <= entry.info.form.size();) {
        const size_t bar = std::min(entry.info.form.find('|', at), entry.info.form.size());
        texts.push_back(entry.info.form.substr(at, bar - at));
        at = bar + 1;
    }
    for (const std::string& text : texts)
        if (entry.set(text) && entry.text() != before) return true;
    return false;
}

TEST(Manifest, ChangesWithEverySettingThatChangesPictures) {
    std::set<std::string> others;
    RenderArguments names;
    for (const SettingEntry& named : options_of(names)) {
        const std::string& name = named.info.name;
        if (!named.info.changes_picture) {
            others.insert(name);
            continue;
        }
        RenderArguments a;
        const SettingList list = options_of(a);
        const Json before = manifest_settings(list);
        ASSERT_TRUE(before.contains("--" + name));
        ASSERT_TRUE(change(*find_setting(list, name))) << "no value is known for --" << name;
        const Json after = manifest_settings(list);
        EXPECT_NE(before["--" + name], after["--" + name]) << name;
        // And nothing but that.
        for (const auto& [key, value] : before.items())
            if (key != "--" + name) {
                EXPECT_EQ(value, after[key]) << name << " changed " << key;
            }
    }
    // A new setting comes to stand in the manifest, or here.
    EXPECT_EQ(others, (std::set<std::string>{"output", "repeat", "device", "validate", "frames", "shard", "resume",
                                             "stats", "counters", "preview", "keep-partial", "memory-limit"}));
}

TEST(Manifest, WritesValuesAsRunsBegunEarlierDid) {
    RenderArguments a;
    a.sequence.fps = 30;
    a.animation = "0";
    a.tracing.ldc = 32;
    a.tracing.tracer = Tracer::ldc;  // what a run begins with: `auto` is resolved before
    const Json defaults = Json::parse(R"({
        "--size": "1280x1024", "--eye": null, "--look": null, "--up": null, "--fov": null, "--camera": null,
        "--time": null, "--animation": "0", "--frame-moment": null, "--fps": "30", "--turntable": null, "--env": null, "--sky": null,
        "--background": null, "--exposure": "0", "--tonemap": "neutral", "--tracer": "ldc",
        "--effects": "reflection,refraction,shadow", "--bounces": "4", "--spp": "1", "--material": null,
        "--floor": null, "--hit": "auto", "--ldc": "32", "--tolerance": "0.001", "--builder": "auto",
        "--traversal": "voxel", "--block": "8x8", "--routing": "geometry", "--batch": "none", "--depth": "32",
        "--rebuild": null, "--visibility": "auto", "--aov": null})");
    // Whatever the order of keys, and whatever settings came later.
    for (const auto& [key, value] : defaults.items()) EXPECT_EQ(manifest_settings(options_of(a))[key], value) << key;

    a.eye = glm::vec3(1, 2.5f, -3);
    a.fov = 33.5f;
    a.sky = a.floor = true;
    a.effects = {Effect::shadow, Effect::reflection};
    a.material = MaterialOverride::glass;
    a.tracing.traversal = Traversal::two_level;
    a.tracing.block = {8, 4};
    a.tracing.ldc.reset();
    a.aovs = {Aov::normal, Aov::depth, Aov::cost_steps};
    const Json given = Json::parse(R"({
        "--eye": "1,2.5,-3", "--fov": "33.5", "--sky": true, "--floor": true, "--effects": "reflection,shadow",
        "--material": "glass", "--traversal": "two-level", "--block": "8x4", "--ldc": null,
        "--aov": "depth,normal,cost_steps"})");
    for (const auto& [key, value] : given.items()) EXPECT_EQ(manifest_settings(options_of(a))[key], value) << key;
}

}  // namespace
}  // namespace peelray
