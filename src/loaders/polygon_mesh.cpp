#include "loaders/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "scene/box.h"
#include "scene/encoding.h"
#include "scene/normals.h"
#include "scene/origin.h"
#include "scene/transform.h"
#include "scene/triangulate.h"

namespace peelray {

namespace {

constexpr float hard_edge = 1.3f;  // radians (75°): a scan's noise stays smooth, a box keeps its edges

/// What stands out in a mesh, for the notes.
struct Counts {
    uint64_t too_few_corners = 0, too_many_corners = 0, unused_vertices = 0;
    uint64_t bad_normals = 0, bad_uvs = 0, bad_colors = 0, clear_colors = 0;
};

struct Corner {
    uint32_t vertex, corner, face;
};

template <typename T>
T value_at(const MeshAttribute<T>& attribute, const Corner& at, const T& missing) {
    using Per = typename MeshAttribute<T>::Per;
    uint32_t i = attribute.per == Per::vertex ? at.vertex : attribute.per == Per::corner ? at.corner : at.face;
    if (!attribute.indices.empty()) i = i < attribute.indices.size() ? attribute.indices[i] : no_value;
    return i < attribute.values.size() ? attribute.values[i] : missing;
}

template <typename T>
bool is_per_vertex(const MeshAttribute<T>& attribute) {
    return attribute.values.empty() || attribute.per == MeshAttribute<T>::Per::vertex;
}

/// The vertices of one primitive, in the order in which corners ask for them.
class Vertices {
  public:
    Vertices(const PolygonMesh& mesh, const std::string& where, Counts& counts)
        : mesh_(mesh),
          where_(where),
          counts_(counts),
          per_vertex_(is_per_vertex(mesh.normals) && is_per_vertex(mesh.uvs) && is_per_vertex(mesh.colors)),
          of_position_(mesh.positions.size(), no_value),
          used_(mesh.positions.size()) {}

    void start(Primitive& out) {
        out_ = &out;
        incomplete_ = mesh_.normals.values.empty();
        sources_.clear();
        table_.assign(per_vertex_ ? 0 : 1024, no_value);
    }

    /// The primitive's vertex of a corner.
    uint32_t at(const Corner& corner) {
        uint32_t& known = of_position_[corner.vertex];
        if (per_vertex_) {
            if (known == no_value) {
                known = static_cast<uint32_t>(sources_.size());
                add(corner, read(corner));
            }
            return known;
        }
        used_[corner.vertex] = true;
        return split(corner);
    }

    /// Whether a vertex of the primitive lacks its normal.
    bool incomplete() const { return incomplete_; }

    void finish() {
        for (const uint32_t source : sources_) {
            of_position_[source] = no_value;
            used_[source] = true;
        }
    }

    uint64_t unused() const { return static_cast<uint64_t>(std::count(used_.begin(), used_.end(), false)); }

  private:
    struct Values {
        glm::vec3 normal{0};
        glm::vec2 uv{0};
        glm::vec4 color{1};
    };

    Values read(const Corner& corner) const {
        return {value_at(mesh_.normals, corner, glm::vec3(0)), value_at(mesh_.uvs, corner, glm::vec2(0)),
                value_at(mesh_.colors, corner, glm::vec4(1))};
    }

    static bool same_bits(const float* a, const float* b, size_t count) {
        return std::equal(a, a + count, b,
                          [](float x, float y) { return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y); });
    }

    static bool same(const Values& a, const Values& b) {
        return same_bits(&a.normal.x, &b.normal.x, 3) && same_bits(&a.uv.x, &b.uv.x, 2) &&
               same_bits(&a.color.x, &b.color.x, 4);
    }

    static size_t hash(uint32_t vertex, const Values& values) {
        uint64_t seed = vertex * 0x9E3779B97F4A7C15ull;
        const auto mix = [&](const float* v, size_t count) {
            for (size_t i = 0; i < count; ++i) {
                seed = (seed ^ std::bit_cast<uint32_t>(v[i])) * 0x9E3779B97F4A7C15ull;
                seed ^= seed >> 32;
            }
        };
        mix(&values.normal.x, 3);
        mix(&values.uv.x, 2);
        mix(&values.color.x, 4);
        return seed;
    }

    uint32_t split(const Corner& corner) {
        if (sources_.size() * 2 >= table_.size()) grow();
        const Values values = read(corner);
        const size_t mask = table_.size() - 1;
        size_t slot = hash(corner.vertex, values) & mask;
        for (; table_[slot] != no_value; slot = (slot + 1) & mask)
            if (sources_[table_[slot]] == corner.vertex && same(values_[table_[slot]], values)) return table_[slot];
        table_[slot] = static_cast<uint32_t>(sources_.size());
        values_.resize(sources_.size());
        values_.push_back(values);
        add(corner, values);
        return table_[slot];
    }

    void grow() {
        std::vector<uint32_t> larger(table_.size() * 2, no_value);
        const size_t mask = larger.size() - 1;
        for (uint32_t i = 0; i < sources_.size(); ++i) {
            size_t slot = hash(sources_[i], values_[i]) & mask;
            while (larger[slot] != no_value) slot = (slot + 1) & mask;
            larger[slot] = i;
        }
        table_ = std::move(larger);
    }

    void add(const Corner& corner, const Values& values) {
        const glm::vec3& p = mesh_.positions[corner.vertex];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail("{}: vertex {} is at ({}, {}, {}); repair the mesh, positions must be finite", where_, corner.vertex,
                 p.x, p.y, p.z);
        sources_.push_back(corner.vertex);
        out_->positions.push_back(p);
        if (!mesh_.normals.values.empty()) add_normal(corner, values.normal);
        if (!mesh_.uvs.values.empty()) add_uv(values.uv);
        if (!mesh_.colors.values.empty()) add_color(values.color);
    }

    void add_normal(const Corner& corner, const glm::vec3& normal) {
        const glm::vec3 unit = unit_or(glm::dvec3(normal), glm::vec3(0));
        out_->normals.push_back(unit);
        if (unit != glm::vec3(0)) return;
        incomplete_ = true;
        if (value_at(mesh_.normals, corner, glm::vec3(1)) != glm::vec3(1)) ++counts_.bad_normals;
    }

    void add_uv(const glm::vec2& uv) {
        const bool finite = std::isfinite(uv.x) && std::isfinite(uv.y);
        if (!finite) ++counts_.bad_uvs;
        // We count v from the first row.
        out_->uvs.push_back(finite ? glm::vec2(uv.x, 1 - uv.y) : glm::vec2(0));
    }

    void add_color(const glm::vec4& color) {
        glm::vec4 inside;
        for (int k = 0; k < 4; ++k) inside[k] = std::isfinite(color[k]) ? std::clamp(color[k], 0.f, 1.f) : 1.f;
        if (inside != color) ++counts_.bad_colors;
        if (inside.w < 1) ++counts_.clear_colors;
        out_->colors.push_back(inside);
    }

    const PolygonMesh& mesh_;
    const std::string& where_;
    Counts& counts_;
    const bool per_vertex_;
    std::vector<uint32_t> of_position_;  ///< where all attributes are per vertex: the primitive's vertex
    std::vector<bool> used_;
    Primitive* out_ = nullptr;
    bool incomplete_ = false;
    std::vector<uint32_t> sources_;  ///< per vertex of the primitive: its index in the mesh
    std::vector<Values> values_;     ///< the same: what it was made from, where corners are told apart by it
    std::vector<uint32_t> table_;    ///< open addressing, of the primitive's vertices
};

/// Makes primitives of ranges of polygons.
class Converter {
  public:
    Converter(const PolygonMesh& mesh, const std::string& where)
        : mesh_(mesh), where_(where), vertices_(mesh, where, counts_) {}

    Primitive convert(uint32_t first, uint32_t last, uint32_t material) {
        Primitive out;
        out.material = material;
        out.triangles.reserve(triangle_count(first, last));
        vertices_.start(out);
        for (uint32_t face = first; face < last; ++face) add_polygon(face, out);
        vertices_.finish();
        if (vertices_.incomplete())
            complete_normals(out, hard_edge);
        else
            weld(out);
        return out;
    }

    Counts finish() {
        counts_.unused_vertices = vertices_.unused();
        return counts_;
    }

  private:
    uint32_t begin_of(uint32_t face) const { return mesh_.ends.empty() ? face * 3 : face ? mesh_.ends[face - 1] : 0; }
    uint32_t end_of(uint32_t face) const { return mesh_.ends.empty() ? face * 3 + 3 : mesh_.ends[face]; }

    size_t triangle_count(uint32_t first, uint32_t last) const {
        size_t count = 0;
        for (uint32_t face = first; face < last; ++face) {
            const uint32_t corners = end_of(face) - begin_of(face);
            count += corners < 3 ? 0 : corners - 2;
        }
        return count;
    }

    void add_polygon(uint32_t face, Primitive& out) {
        const uint32_t begin = begin_of(face), end = end_of(face);
        for (uint32_t corner = begin; corner < end; ++corner)
            if (mesh_.corners[corner] >= mesh_.positions.size())
                fail("{}: polygon {} has index {}, the file has {}", where_, face, mesh_.corners[corner],
                     counted("{} vert{ex|ices}", mesh_.positions.size()));
        if (end - begin < 3) {
            ++counts_.too_few_corners;
            return;
        }
        polygon_.clear();
        points_.clear();
        for (uint32_t corner = begin; corner < end; ++corner) {
            polygon_.push_back(vertices_.at({mesh_.corners[corner], corner, face}));
            if (end - begin > 3) points_.push_back(mesh_.positions[mesh_.corners[corner]]);
        }
        if (end - begin == 3) {
            out.triangles.emplace_back(polygon_[0], polygon_[1], polygon_[2]);
            return;
        }
        pieces_.clear();
        if (!triangulate(points_, pieces_)) ++counts_.too_many_corners;
        for (const glm::uvec3& piece : pieces_)
            out.triangles.emplace_back(polygon_[piece.x], polygon_[piece.y], polygon_[piece.z]);
    }

    const PolygonMesh& mesh_;
    const std::string& where_;
    Counts counts_;
    Vertices vertices_;
    std::vector<uint32_t> polygon_;
    std::vector<glm::vec3> points_;
    std::vector<glm::uvec3> pieces_;
};

void add_notes(const Counts& counts, std::vector<std::string>& notes) {
    const auto note = [&](uint64_t count, const char* text) {
        if (count > 0) notes.push_back(counted(text, count));
    };
    note(counts.too_few_corners, "{} polygon{|s} with fewer than three corners dropped");
    note(counts.too_many_corners,
         "{} polygon{|s} with too many corners and dents cut as {a fan|fans}, which may overlap");
    note(counts.unused_vertices, "{} vert{ex|ices} that no polygon uses dropped");
    note(counts.bad_normals, "{} normal{|s} without direction replaced");
    note(counts.bad_uvs, "{} texture coordinate{|s} that {is|are} not finite replaced by 0");
    note(counts.bad_colors, "{} vertex colour{|s} outside of 0 to 1 limited to it");
    note(counts.clear_colors, "{} vertex colour{|s} with an alpha below 1 drawn opaque");
}

}  // namespace

uint32_t PolygonMesh::polygon_count() const {
    return static_cast<uint32_t>(ends.empty() ? corners.size() / 3 : ends.size());
}

glm::vec4 encoded_color(const glm::vec4& c) {
    return {srgb_to_linear(c.x), srgb_to_linear(c.y), srgb_to_linear(c.z), c.w};
}

glm::vec4 encoded_color(uint8_t red, uint8_t green, uint8_t blue, uint8_t alpha) {
    static const std::array<float, 256> linear = [] {
        std::array<float, 256> table;
        for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(srgb_to_linear(i / 255.0));
        return table;
    }();
    return {linear[red], linear[green], linear[blue], alpha / 255.f};
}

std::optional<glm::dvec3> far_middle(const PolygonMesh& mesh) {
    Box box;
    for (const uint32_t corner : mesh.corners) {
        if (corner >= mesh.positions.size()) continue;  // refused when it is converted
        const glm::vec3& p = mesh.positions[corner];
        if (std::isfinite(p.x + p.y + p.z)) box.add(p);
    }
    const glm::dvec3 lower(box.lower), upper(box.upper), middle = 0.5 * lower + 0.5 * upper;
    if (!(lower.x <= upper.x)) return std::nullopt;
    const bool far = is_far(reach_of(middle), reach_of(upper - lower));
    return far ? std::optional(middle) : std::nullopt;
}

Scene load_polygons(const std::filesystem::path& path,
                    const std::function<PolygonMesh(FileReader&, Scene&, const glm::dvec3&)>& read) {
    const auto load = [&](Scene& scene, const glm::dvec3& origin) {
        scene.name = printable(path.filename().string());
        scene.files = {path};
        FileReader file(path, scene.name);
        return read(file, scene, origin);
    };
    Scene scene;
    PolygonMesh mesh = load(scene, glm::dvec3(0));
    if (const auto middle = far_middle(mesh)) {
        mesh = {};
        scene = {};
        mesh = load(scene, *middle);
    }
    add_polygon_mesh(std::move(mesh), scene);
    settle_origin(scene);
    return scene;
}

void add_polygon_mesh(PolygonMesh mesh, Scene& scene) {
    if (mesh.corners.size() >= no_value || mesh.positions.size() >= no_value)
        fail("{}: more than 4,294,967,294 vertices or corners of polygons; split the mesh", scene.name);
    if (mesh.objects.empty()) mesh.objects.emplace_back();
    if (mesh.parts.empty()) mesh.parts.emplace_back();
    std::vector<Mesh> meshes(mesh.objects.size());
    Converter converter(mesh, scene.name);
    for (size_t i = 0; i < mesh.parts.size(); ++i) {
        const PolygonMesh::Part& part = mesh.parts[i];
        const uint32_t last = i + 1 < mesh.parts.size() ? mesh.parts[i + 1].first : mesh.polygon_count();
        Primitive primitive = converter.convert(part.first, last, part.material);
        if (!primitive.triangles.empty()) meshes[part.object].primitives.push_back(std::move(primitive));
    }
    for (size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i].primitives.empty()) continue;
        meshes[i].name = mesh.objects[i];
        Node node;
        node.name = mesh.objects[i];
        node.local[3] = glm::dvec4(mesh.origin, 1);
        node.mesh = static_cast<int>(scene.meshes.size());
        scene.nodes.push_back(std::move(node));
        scene.meshes.push_back(std::move(meshes[i]));
    }
    add_notes(converter.finish(), scene.notes);
}

}  // namespace peelray
