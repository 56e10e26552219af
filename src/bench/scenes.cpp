#include "bench/scenes.h"

#include <algorithm>

#include "base/error.h"
#include "bench/paper_scenes.h"
#include "builtin/builtin.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

const PaperScene* paper_scene(const std::string& name) {
    for (const PaperScene& scene : paper_scenes())
        if (scene.name == name) return &scene;
    return nullptr;
}

std::string without_builtin(const std::string& name) {
    constexpr std::string_view prefix = "builtin:";
    return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

bool is_builtin(const std::string& name) {
    const std::string own = without_builtin(name), first = own.substr(0, own.find(':'));
    const auto known = builtin_scenes();
    return std::any_of(known.begin(), known.end(),
                       [&](const BuiltinScene& scene) { return scene.name.substr(0, scene.name.find(':')) == first; });
}

}  // namespace

std::vector<std::string> default_bench_scenes() {
    std::vector<std::string> names;
    for (const PaperScene& scene : paper_scenes()) names.emplace_back(scene.name);
    for (const char* name : {"blob:8000", "blob:120000", "blob:300000", "blob:1000000", "blob:3000000", "blob:10000000",
                             "room", "desk", "kitchen", "bricks", "cloth"})
        names.emplace_back(name);
    return names;
}

std::vector<std::string> quick_bench_scenes() {
    return {"blob:8000", "blob:120000", "room"};
}

void check_bench_scene(const std::string& name) {
    std::error_code error;
    if (paper_scene(name) || is_builtin(name) || fs::is_regular_file(name, error)) return;
    std::string known;
    for (const PaperScene& scene : paper_scenes()) known += fmt::format("{}, ", scene.name);
    for (const BuiltinScene& scene : builtin_scenes()) known += fmt::format("{}, ", scene.name);
    fail("there is no scene '{}': choose {}or a file ({})", name, known, Setting{"scenes"});
}

BenchSceneChoice choose_bench_scene(const std::string& name, const BenchSettings& a) {
    BenchSceneChoice choice;
    choice.name = name;
    PictureArguments& p = choice.picture;
    p.size = a.size;
    p.tracing.refine = a.refine;
    p.tracing.merge = a.merge;
    p.double_sided = true;  // rays are compared with those of tracers that know no sides
    if (const PaperScene* scene = paper_scene(name)) {
        const auto file = find_model(a.models.value_or("models"), *scene);
        choice.stands_in = !file;
        choice.shown = file ? file->filename().string() : scene->stand_in;
        p.scene = file ? file->string() : scene->stand_in;
        p.floor = p.sky = file.has_value();
        if (file) p.material = scene->material;
        p.animation = file ? scene->animation : scene->stand_in_animation;
        if (!p.animation.empty()) p.time = 0.4;
        return choice;
    }
    const bool builtin = is_builtin(name);
    p.scene = builtin ? "builtin:" + without_builtin(name) : name;
    choice.shown = builtin ? p.scene : fs::path(name).filename().string();
    if (without_builtin(name).starts_with("cloth")) {
        p.animation = "wind";
        p.time = 1.2;
    }
    if (without_builtin(name).starts_with("blob")) {
        // A view and a lamp of its own, so that figures of different versions can be compared.
        p.eye = glm::vec3(0.9f, 1.1f, 2.9f);
        p.look = glm::vec3(0, -0.15f, 0);
        p.fov = 28.45f;
        choice.light = Light{};
        choice.light->kind = Light::Kind::point;
        choice.light->position = {1.5f, 2.5f, 1.5f};
    }
    return choice;
}

}  // namespace peelray
