// An animated scene, and runs that render it.
#pragma once

#include <signal.h>

#include <thread>

#include "cli/program_fixture.h"

namespace peelray {

using Words = std::vector<std::string>;

/// A square that stands and, before it, one that an animation of one second moves, turns and, in another, scales up
/// from nothing; on demand a camera that the first animation carries. Buffers: square.bin, keys.bin.
inline nlohmann::json moving_gltf(bool with_camera = false) {
    auto gltf = square_gltf();
    gltf["nodes"] = nlohmann::json::parse(R"([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]},
        {"camera": 0, "translation": [0.3, 0.2, 5]}])");
    gltf["scenes"][0]["nodes"] = with_camera ? nlohmann::json({0, 1, 2}) : nlohmann::json({0, 1});
    gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    gltf["buffers"].push_back({{"uri", "keys.bin"}, {"byteLength", 108}});
    const auto view = [&](int offset, int length, const char* type, int count) {
        gltf["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", offset}, {"byteLength", length}});
        gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                     {"componentType", 5126},
                                     {"count", count},
                                     {"type", type}});
    };
    view(0, 12, "SCALAR", 3);
    view(12, 36, "VEC3", 3);
    view(48, 36, "VEC3", 3);
    view(84, 24, "VEC3", 2);
    view(0, 8, "SCALAR", 2);
    gltf["accessors"][2]["min"] = {0};
    gltf["accessors"][2]["max"] = {1};
    gltf["animations"] = nlohmann::json::parse(R"([
        {"name": "fly", "samplers": [{"input": 2, "output": 3}, {"input": 2, "output": 4}],
         "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                      {"sampler": 1, "target": {"node": 2, "path": "translation"}}]},
        {"name": "grow", "samplers": [{"input": 6, "output": 5}],
         "channels": [{"sampler": 0, "target": {"node": 1, "path": "scale"}}]}])");
    if (!with_camera) gltf["animations"][0]["channels"].erase(1);
    return gltf;
}

inline std::string moving_keys() {
    return bytes_of(std::vector<float>{0,    0.5f, 1,                                   // times
                                       0,    0,    1, 2,    0.5f, 1.5f, -1,   3,    1,  // the square
                                       0.3f, 0.2f, 5, 1.3f, 0.4f, 6.1f, 0.7f, 0.2f, 5,  // the camera
                                       0,    0,    0, 1,    1,    1});                  // scales, at 0 and 0.5
}

class SequenceTest : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("square.bin", square_bytes());
        put("keys.bin", moving_keys());
        put("moving.gltf", moving_gltf().dump());
        put("camera.gltf", moving_gltf(true).dump());
    }

    /// `peelray render moving.gltf -o out/NAME --size 64x48 …`
    Words words(const std::string& name, const Words& more, const std::string& scene = "moving.gltf") const {
        Words all = {"render", scene.starts_with("/") || scene.starts_with("builtin:") ? scene : in(scene),
                     "-o",     out(name),
                     "--size", "64x48"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome sequence(const std::string& name, const Words& more, const std::string& scene = "moving.gltf",
                     const std::map<std::string, std::string>& variables = {}) const {
        return run(words(name, more, scene), variables);
    }

    /// All files of out/ with what they hold.
    std::map<std::string, std::string> contents() const {
        std::map<std::string, std::string> all;
        for (const std::string& name : outputs()) all[name] = get(out(name));
        return all;
    }
    /// Refused with status 1 and one line that says so, and every file is as before.
    void expect_refused_untouched(const Outcome& run, const Words& says) const {
        EXPECT_EQ(run.status, 1);
        EXPECT_EQ(run.out, "");
        const auto lines = run.complaints();
        ASSERT_EQ(lines.size(), 1u) << run.err;
        for (const std::string& part : says)
            EXPECT_NE(lines[0].find(part), std::string::npos) << lines[0] << "\n" << part;
    }

    /// Waits until a file is there; false: it did not come in time.
    static bool wait_for(const std::filesystem::path& file, double seconds = 60) {
        for (int i = 0; i < int(seconds * 100); i++) {
            if (std::filesystem::exists(file)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
};

}  // namespace peelray
