#include "loaders/obj.h"

#include "scene/origin.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>

#include "base/error.h"
#include "base/text.h"
#include "loaders/files.h"
#include "loaders/mtl.h"
#include "loaders/text_lines.h"

namespace peelray {

namespace {

std::string_view as_text(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Finds the libraries of an OBJ file and reads their materials.
class MaterialLibraries {
  public:
    MaterialLibraries(const std::filesystem::path& folder, Scene& scene) : folder_(folder), scene_(scene) {}

    bool is_any_missing() const { return is_any_missing_; }

    /// What stands after one mtllib: one name, with blanks in it, or several. The longest that is a file counts.
    void read(std::string_view names, Tally& tally) {
        if (read_file_named(names, tally, false)) return;
        names = name_without_comment(names);
        const std::vector<std::string_view> words = split(names);
        for (size_t first = 0; first < words.size();) {
            size_t last = words.size() - 1;
            while (last > first && !read_file_named(span_of(words[first], words[last]), tally, false)) --last;
            if (last == first && !read_file_named(words[first], tally, false))
                last = read_elsewhere(words, first, tally);
            first = last + 1;
        }
    }

    std::vector<MtlMaterial> materials;

  private:
    static std::vector<std::string_view> split(std::string_view names) {
        std::vector<std::string_view> words;
        while (!trimmed(names).empty()) {
            names = trimmed(names);
            const size_t quoted = names[0] == '"' ? names.find('"', 1) : std::string_view::npos;
            words.push_back(quoted == std::string_view::npos ? take_word(names) : names.substr(0, quoted + 1));
            if (quoted != std::string_view::npos) names.remove_prefix(quoted + 1);
        }
        return words;
    }

    static std::string_view span_of(std::string_view first, std::string_view last) {
        return {first.data(), static_cast<size_t>(last.data() + last.size() - first.data())};
    }

    static std::string_view unquoted(std::string_view name) {
        const bool is_quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
        return is_quoted ? name.substr(1, name.size() - 2) : name;
    }

    /// False: there is no such file, or only elsewhere, which is not wanted.
    bool read_file_named(std::string_view name, Tally& tally, bool elsewhere) {
        const std::optional<SideFile> file = find_beside(folder_, unquoted(name));
        if (!file || (file->is_elsewhere && !elsewhere)) return false;
        if (!read_.insert(file->path).second) return true;
        try {
            const Bytes bytes = peelray::read_file(file->path);
            remember_file(scene_.files, file->path);
            for (MtlMaterial& material : parse_mtl(as_text(bytes), file->path.filename().string(), tally))
                materials.push_back(std::move(material));
        } catch (const Error& error) {
            is_any_missing_ = true;
            scene_.notes.push_back(fmt::format("material library ignored, its materials are grey: {}", error.what()));
        }
        return true;
    }

    /// A library whose name, the words up to the next one that ends like one, leads nowhere: looked for by its bare
    /// name, or noted as missing. Returns the last of the words.
    size_t read_elsewhere(const std::vector<std::string_view>& words, size_t first, Tally& tally) {
        size_t last = first;
        while (last + 1 < words.size() && lower_extension(std::filesystem::path(unquoted(words[last]))) != ".mtl")
            ++last;
        if (last + 1 == words.size() && lower_extension(std::filesystem::path(unquoted(words[last]))) != ".mtl")
            last = first;
        const std::string_view name = span_of(words[first], words[last]);
        if (!read_file_named(name, tally, true)) note_missing(std::string(unquoted(name)));
        return last;
    }

    void note_missing(std::string name) {
        std::replace(name.begin(), name.end(), '\\', '/');
        is_any_missing_ = true;
        if (!missing_.insert(name).second) return;
        try {
            if (std::filesystem::path(name).is_relative()) resolve_inside(folder_, name, "mtllib");
            scene_.notes.push_back(
                fmt::format("material library \"{}\" is missing; its materials are grey", printable(name)));
        } catch (const Error& refused) {
            scene_.notes.push_back(fmt::format("material library ignored, its materials are grey: {}", refused.what()));
        }
    }

    std::filesystem::path folder_;
    Scene& scene_;
    std::set<std::filesystem::path> read_;
    std::set<std::string> missing_;
    bool is_any_missing_ = false;
};

/// The scene's material for each name after usemtl. The first of several with one name counts, as the format says.
class MaterialNames {
  public:
    MaterialNames(const std::vector<MtlMaterial>& materials, Tally& tally) {
        for (size_t i = 0; i < materials.size(); ++i)
            if (!exact_.try_emplace(materials[i].name, i).second)
                ++tally["{} material{|s} whose name an earlier one has already: the first counts"];
        for (size_t i = 0; i < materials.size(); ++i)
            plain_.try_emplace(std::string(name_without_comment(materials[i].name)), i);
    }

    /// Both may end with a comment, and both may have a name with " #" in it.
    std::optional<size_t> find(const std::string& name) const {
        if (const auto found = exact_.find(name); found != exact_.end()) return found->second;
        const auto found = plain_.find(std::string(name_without_comment(name)));
        return found == plain_.end() ? std::nullopt : std::optional(found->second);
    }

  private:
    std::map<std::string, size_t> exact_, plain_;
};

/// Makes the scene's materials, the default one first, and gives the mesh's parts their numbers.
void add_materials(ObjFile& file, const std::filesystem::path& folder, Scene& scene) {
    MtlConverter converter(folder, scene);
    MaterialLibraries libraries(folder, scene);
    for (const std::string& names : file.libraries) libraries.read(names, converter.tally);
    const MaterialNames names(libraries.materials, converter.tally);
    converter.add({.name = "DefaultMaterial"});
    for (MtlMaterial& material : libraries.materials) {
        material.name = name_without_comment(material.name);
        converter.add(material);
    }
    std::vector<uint32_t> numbers{0};
    std::vector<std::string> unknown;
    std::map<std::string, uint32_t> unknown_ids;
    for (size_t i = 1; i < file.materials.size(); ++i) {
        if (const std::optional<size_t> found = names.find(file.materials[i])) {
            numbers.push_back(static_cast<uint32_t>(*found + 1));
            continue;
        }
        const std::string name(name_without_comment(file.materials[i]));
        const auto [entry, added] = unknown_ids.try_emplace(name, static_cast<uint32_t>(scene.materials.size()));
        if (added) {
            unknown.push_back(name);
            converter.add({.name = name});
        }
        numbers.push_back(entry->second);
    }
    for (PolygonMesh::Part& part : file.mesh.parts) part.material = numbers[part.material];
    if (!unknown.empty() && !libraries.is_any_missing())
        scene.notes.push_back(fmt::format("{} grey, the first is \"{}\"",
                                          counted("{} material{|s} that no library defines {is|are}", unknown.size()),
                                          printable(unknown[0], 80)));
    converter.write_notes();
}

}  // namespace

Scene load_obj(const std::filesystem::path& path) {
    Scene scene;
    scene.name = printable(path.filename().string());
    scene.files = {path};
    ObjFile file;
    {
        const Bytes bytes = read_file(path);
        if (bytes.empty()) fail("{}: the file is empty", scene.name);
        file = parse_obj(as_text(bytes), scene.name);
        if (const auto middle = far_middle(file.mesh)) file = parse_obj(as_text(bytes), scene.name, *middle);
    }
    scene.notes = std::move(file.notes);
    add_materials(file, path.parent_path(), scene);
    add_polygon_mesh(std::move(file.mesh), scene);
    settle_origin(scene);
    return scene;
}

}  // namespace peelray
