// Makes small scene files in a temporary folder for the tests.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "loaders/load.h"
#include "scene/scene.h"

namespace peelray::testing {

using nlohmann::json;

/// A folder that vanishes with the test.
class TempFolder {
  public:
    TempFolder() {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("peelray_scene_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~TempFolder() { std::filesystem::remove_all(path_); }

    std::filesystem::path path() const { return path_; }

    std::string write(const std::string& name, const std::string& content) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << content;
        return file.string();
    }

  private:
    std::filesystem::path path_;
};

template <typename T>
std::string pack(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

inline std::string data_uri(const std::string& bytes) {
    return "data:application/octet-stream;base64," + base64(bytes);
}

/// Adds a buffer with the bytes, a view of all of it and an accessor; returns the accessor's index.
inline size_t add_accessor(json& gltf, const std::string& bytes, int component_type, const char* type, size_t count,
                           bool normalized = false) {
    gltf["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
    gltf["bufferViews"].push_back({{"buffer", gltf["buffers"].size() - 1}, {"byteLength", bytes.size()}});
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"type", type},
                                 {"count", count}});
    if (normalized) gltf["accessors"].back()["normalized"] = true;
    return gltf["accessors"].size() - 1;
}

inline const std::vector<float> unit_square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// A unit square in the plane z = 0 of two indexed triangles, without normals and material.
inline json square() {
    json gltf = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    const size_t positions = add_accessor(gltf, pack(unit_square), 5126, "VEC3", 4);
    const size_t indices = add_accessor(gltf, pack<uint16_t>({0, 1, 2, 0, 2, 3}), 5123, "SCALAR", 6);
    gltf["meshes"] = json::array(
        {{{"primitives", json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}}});
    return gltf;
}

inline json& primitive(json& gltf) {
    return gltf["meshes"][0]["primitives"][0];
}

/// The square with a texture of the base colour, which comes from image 0.
inline json textured(const std::string& uri) {
    json gltf = square();
    gltf["images"] = {{{"uri", uri}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 1, 1, 0, 1}), 5126, "VEC2", 4);
    return gltf;
}

/// Binary glTF of a JSON text and, unless it is empty, a chunk of bytes.
inline std::string glb(const std::string& text, const std::string& binary) {
    const auto chunk = [](std::string bytes, uint32_t type, char filler) {
        bytes.resize((bytes.size() + 3) / 4 * 4, filler);
        return pack<uint32_t>({static_cast<uint32_t>(bytes.size()), type}) + bytes;
    };
    const std::string body = chunk(text, 0x4E4F534A, ' ') + (binary.empty() ? "" : chunk(binary, 0x004E4942, '\0'));
    return "glTF" + pack<uint32_t>({2, static_cast<uint32_t>(body.size() + 12)}) + body;
}

inline Scene load(const TempFolder& folder, const json& gltf) {
    return load_scene(folder.write("scene.gltf", gltf.dump()));
}

inline const Primitive& only_primitive(const Scene& scene) {
    return scene.meshes.at(0).primitives.at(0);
}

/// The error's line; a test failure where nothing is thrown or the message is no single line.
template <typename Work>
std::string error_from(Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        const std::string line = error.what();
        EXPECT_FALSE(line.empty());
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        return line;
    }
    ADD_FAILURE() << "no error";
    return "";
}

inline std::string error_of(const std::string& file) {
    SCOPED_TRACE(file);
    return error_from([&] { load_scene(file); });
}

inline std::string error_of(const TempFolder& folder, const json& gltf) {
    return error_of(folder.write("scene.gltf", gltf.dump()));
}

inline bool has_note(const Scene& scene, const std::string& words) {
    return std::any_of(scene.notes.begin(), scene.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// All notes of a scene, one a line.
inline std::string all_notes(const Scene& scene) {
    std::string out;
    for (const std::string& note : scene.notes) out += note + "\n";
    return out;
}

inline void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-5f)
        << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

#define EXPECT_MENTIONS(line, word) EXPECT_NE((line).find(word), std::string::npos) << (line)

/// A 2×1 PNG image: red, green.
inline std::string tiny_png() {
    const uint8_t bytes[] = {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44,
                             0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x7B,
                             0x40, 0xE8, 0xDD, 0x00, 0x00, 0x00, 0x0F, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9C, 0x63, 0xF8,
                             0xCF, 0xC0, 0xC0, 0xF0, 0x9F, 0x01, 0x00, 0x07, 0xFF, 0x01, 0xFF, 0x01, 0x7F, 0x89, 0xA7,
                             0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
    return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

}  // namespace peelray::testing
