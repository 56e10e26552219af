#include "loaders/assimp_loader.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <list>

#include "base/error.h"
#include "base/text.h"
#include "loaders/files.h"
#include "scene/normals.h"

namespace peelray {

namespace {

constexpr float crease = 1.3f;  // radians (75°): a scan's noise stays smooth, a box keeps its edges
const std::string virtual_folder = "@/";

/// Shows Assimp the scene file (already read) and the files beside it, under a made-up folder name, and nothing else.
class FolderIo : public Assimp::IOSystem {
  public:
    /// `files`: those that were read are added.
    FolderIo(std::filesystem::path folder, std::string main_name, const Bytes& main_bytes,
             std::vector<std::filesystem::path>& files)
        : folder_(std::move(folder)), main_name_(std::move(main_name)), main_bytes_(main_bytes), files_(files) {}

    bool Exists(const char* file) const override {
        return file == main_name_ || const_cast<FolderIo*>(this)->find(file) != nullptr;
    }
    char getOsSeparator() const override { return '/'; }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (!mode || mode[0] != 'r') return nullptr;
        const Bytes* bytes = file == main_name_ ? &main_bytes_ : find(file);
        return bytes ? new Assimp::MemoryIOStream(bytes->data(), bytes->size()) : nullptr;
    }

  private:
    // No exception may cross Assimp here; note_missing_libraries() tells the user what could not be read.
    const Bytes* find(std::string_view file) {
        std::string relative(file.starts_with(virtual_folder) ? file.substr(virtual_folder.size()) : file);
        std::replace(relative.begin(), relative.end(), '\\', '/');
        try {
            const std::filesystem::path path = resolve_inside(folder_, relative, "material library");
            side_files_.push_back(read_file(path));
            remember_file(files_, path);
            return &side_files_.back();
        } catch (const Error&) {
            return nullptr;
        }
    }

    std::filesystem::path folder_;
    std::string main_name_;
    const Bytes& main_bytes_;
    std::vector<std::filesystem::path>& files_;
    std::list<Bytes> side_files_;  ///< a list: streams point into its elements
};

/// A material library that is missing or outside the file's folder only costs the materials, so it is a note.
void note_missing_libraries(const Bytes& bytes, const std::filesystem::path& folder, std::vector<std::string>& notes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::string_view key = "mtllib ";
    for (size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1)) {
        if (at > 0 && text[at - 1] != '\n') continue;
        std::string name(text.substr(at + key.size(), text.find_first_of("\r\n", at) - at - key.size()));
        name.erase(name.find_last_not_of(" \t") + 1);
        std::replace(name.begin(), name.end(), '\\', '/');
        std::error_code error;
        try {
            if (std::filesystem::exists(resolve_inside(folder, name, "mtllib"), error)) continue;
            notes.push_back(fmt::format("material library \"{}\" is missing; its materials are grey", printable(name)));
        } catch (const Error& refused) {
            notes.push_back(fmt::format("material library ignored, its materials are grey: {}", refused.what()));
        }
    }
}

glm::vec3 to_vec3(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

void copy_vertices(const aiMesh& mesh, bool use_normals, const std::string& where, Primitive& out) {
    out.positions.reserve(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const glm::vec3 p = to_vec3(mesh.mVertices[i]);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail("{}: vertex {} is at ({}, {}, {}); repair the mesh, positions must be finite", where, i, p.x, p.y,
                 p.z);
        out.positions.push_back(p);
        if (use_normals) out.normals.push_back(to_vec3(mesh.mNormals[i]));
        if (mesh.HasTextureCoords(0)) {
            // OBJ and PLY count v from the bottom of the image, we from the top.
            const glm::vec2 uv(mesh.mTextureCoords[0][i].x, 1 - mesh.mTextureCoords[0][i].y);
            out.uvs.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0));
        }
        if (mesh.HasVertexColors(0)) {
            const aiColor4D& c = mesh.mColors[0][i];
            glm::vec4 color(c.r, c.g, c.b, c.a);
            for (int k = 0; k < 4; ++k) color[k] = std::isfinite(color[k]) ? std::clamp(color[k], 0.f, 1.f) : 1.f;
            out.colors.push_back(color);
        }
    }
}

Primitive convert_mesh(const aiMesh& mesh, const std::string& extension, const std::string& where,
                       std::vector<std::string>& notes) {
    Primitive out;
    out.material = mesh.mMaterialIndex;
    // STL has one normal per triangle, often wrong, and none of the smooth ones that a curved body needs.
    const bool use_normals = mesh.HasNormals() && extension != ".stl" && extension != ".off";
    copy_vertices(mesh, use_normals, where, out);
    out.triangles.reserve(mesh.mNumFaces);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        if (face.mNumIndices != 3) continue;
        const glm::uvec3 t(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
        const unsigned largest = std::max({t.x, t.y, t.z});
        if (largest >= mesh.mNumVertices)
            fail("{}: triangle {} has index {}, the mesh has {} vertices", where, i, largest, mesh.mNumVertices);
        out.triangles.push_back(t);
    }
    if (use_normals) {
        if (const size_t repaired = repair_normals(out))
            notes.push_back(fmt::format("{} normals without direction replaced", repaired));
        weld(out);
    } else {
        make_smooth(out, crease);
    }
    return out;
}

/// Depth first, which is the order of the file. Assimp gives these formats no transforms worth the name, but keeps
/// them.
void convert_nodes(const aiScene& from, const std::string& extension, Scene& scene) {
    std::vector<std::pair<const aiNode*, int>> todo{{from.mRootNode, -1}};
    while (!todo.empty()) {
        const auto [source, parent] = todo.back();
        todo.pop_back();
        Node node;
        node.name = source->mName.C_Str();
        node.parent = parent;
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                node.local[c][r] = source->mTransformation[static_cast<unsigned>(r)][static_cast<unsigned>(c)];
        if (source->mNumMeshes) {
            node.mesh = static_cast<int>(scene.meshes.size());
            Mesh mesh{node.name, {}};
            for (unsigned i = 0; i < source->mNumMeshes; ++i) {
                const aiMesh& part = *from.mMeshes[source->mMeshes[i]];
                if (part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)
                    mesh.primitives.push_back(convert_mesh(
                        part, extension, fmt::format("{}: mesh {}", scene.name, source->mMeshes[i]), scene.notes));
            }
            scene.meshes.push_back(std::move(mesh));
        }
        const int self = static_cast<int>(scene.nodes.size());
        scene.nodes.push_back(std::move(node));
        for (unsigned i = source->mNumChildren; i-- > 0;) todo.emplace_back(source->mChildren[i], self);
    }
}

const aiScene* import(Assimp::Importer& importer, const std::string& file, const std::string& name) {
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    // Neither step reorders triangles; JoinIdenticalVertices and GenSmoothNormals are ours (normals.h), since Assimp's
    // compare within a tolerance and take quadratic time where many vertices coincide.
    const aiScene* scene =
        importer.ReadFile(file, aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType);
    if (!scene || !scene->mRootNode) {
        const std::string reason = importer.GetErrorString();
        fail("{}: no mesh could be read from the file: {}", name,
             reason.empty() ? "it has no surface" : printable(reason, 200));
    }
    return scene;
}

}  // namespace

Scene load_assimp(const std::filesystem::path& path, const std::string& extension) {
    Scene scene;
    scene.name = printable(path.filename().string());
    scene.files = {path};
    Bytes bytes = read_file(path);
    if (bytes.empty()) fail("{}: the file is empty", scene.name);
    if (extension == ".obj") note_missing_libraries(bytes, path.parent_path(), scene.notes);
    if (extension == ".ply") {
        const size_t body = check_ply(bytes, scene.name);
        const std::string_view header(reinterpret_cast<const char*>(bytes.data()), body);
        // Assimp takes a first byte of 10 in a binary body for the second half of "\r\n" and drops it: give it one to
        // drop.
        if (header.find("format binary") != std::string_view::npos && !header.ends_with("\r\n") &&
            body < bytes.size() && bytes[body] == '\n')
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(body), '\n');
    }
    if (extension == ".off") check_off(bytes, scene.name);
    const std::string file = virtual_folder + path.stem().string() + extension;
    Assimp::Importer importer;
    importer.SetIOHandler(new FolderIo(path.parent_path(), file, bytes, scene.files));  // the importer deletes it
    try {
        const aiScene* from = import(importer, file, scene.name);
        for (unsigned i = 0; i < from->mNumMaterials; ++i)
            scene.materials.push_back(convert_material(*from->mMaterials[i], path.parent_path(), scene));
        if (scene.materials.empty()) scene.materials.emplace_back();
        convert_nodes(*from, extension, scene);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail("{}: no mesh could be read from the file: {}", scene.name, printable(error.what(), 200));
    }
    return scene;
}

}  // namespace peelray
