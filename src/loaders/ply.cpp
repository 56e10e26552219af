#include "loaders/ply.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/text.h"
#include "loaders/files.h"
#include "loaders/images.h"
#include "loaders/polygon_mesh.h"

namespace peelray {

namespace {

/// What a property means to us.
enum class PlyRole : uint8_t {
    x,
    y,
    z,
    nx,
    ny,
    nz,
    u,
    v,
    red,
    green,
    blue,
    alpha,
    texture,
    indices,
    texcoords,
    colors,
    none
};

constexpr size_t role_count = static_cast<size_t>(PlyRole::none) + 1;

/// The names that programs give to a property of a vertex, in lower case.
PlyRole vertex_role(const std::string& name) {
    static const std::map<std::string, PlyRole, std::less<>> roles = {{"x", PlyRole::x},
                                                                      {"y", PlyRole::y},
                                                                      {"z", PlyRole::z},
                                                                      {"nx", PlyRole::nx},
                                                                      {"ny", PlyRole::ny},
                                                                      {"nz", PlyRole::nz},
                                                                      {"normal_x", PlyRole::nx},
                                                                      {"normal_y", PlyRole::ny},
                                                                      {"normal_z", PlyRole::nz},
                                                                      {"s", PlyRole::u},
                                                                      {"t", PlyRole::v},
                                                                      {"u", PlyRole::u},
                                                                      {"v", PlyRole::v},
                                                                      {"texture_u", PlyRole::u},
                                                                      {"texture_v", PlyRole::v},
                                                                      {"texture_s", PlyRole::u},
                                                                      {"texture_t", PlyRole::v},
                                                                      {"texcoord_u", PlyRole::u},
                                                                      {"texcoord_v", PlyRole::v},
                                                                      {"red", PlyRole::red},
                                                                      {"green", PlyRole::green},
                                                                      {"blue", PlyRole::blue},
                                                                      {"alpha", PlyRole::alpha},
                                                                      {"r", PlyRole::red},
                                                                      {"g", PlyRole::green},
                                                                      {"b", PlyRole::blue},
                                                                      {"a", PlyRole::alpha},
                                                                      {"diffuse_red", PlyRole::red},
                                                                      {"diffuse_green", PlyRole::green},
                                                                      {"diffuse_blue", PlyRole::blue},
                                                                      {"diffuse_alpha", PlyRole::alpha}};
    const auto found = roles.find(name);
    return found == roles.end() ? PlyRole::none : found->second;
}

PlyRole face_role(const std::string& name, bool list) {
    if (list)
        return name == "vertex_indices" || name == "vertex_index" ? PlyRole::indices
               : name == "texcoord" || name == "texcoords"        ? PlyRole::texcoords
               : name == "color" || name == "colors"              ? PlyRole::colors
                                                                  : PlyRole::none;
    if (name == "texnumber") return PlyRole::texture;
    const PlyRole role = vertex_role(name);
    return role >= PlyRole::red && role <= PlyRole::alpha ? role : PlyRole::none;
}

/// An element with what its properties mean; of two that mean the same, the first counts.
struct PlyPlan {
    const PlyElement* element = nullptr;
    bool is_vertex = false, is_face = false, is_strip = false;
    std::vector<PlyRole> roles;
    std::array<PlyType, role_count> types{};
    std::array<bool, role_count> has{};

    explicit PlyPlan(const PlyElement& of)
        : element(&of), is_vertex(of.name == "vertex"), is_face(of.name == "face"), is_strip(of.name == "tristrips") {
        for (const PlyProperty& property : of.properties) {
            const std::string name = lower_case(property.name);
            PlyRole role = PlyRole::none;
            if (is_vertex && !property.count) role = vertex_role(name);
            if (is_face || is_strip) role = face_role(name, property.count.has_value());
            if (is_strip && (role == PlyRole::texcoords || role == PlyRole::colors)) role = PlyRole::none;
            if (role != PlyRole::none && std::exchange(has[static_cast<size_t>(role)], true)) role = PlyRole::none;
            if (role != PlyRole::none) types[static_cast<size_t>(role)] = property.type;
            roles.push_back(role);
        }
        keep_whole(PlyRole::nx, PlyRole::nz);
        keep_whole(PlyRole::u, PlyRole::v);
        keep_whole(PlyRole::red, PlyRole::blue);
        if (!knows(PlyRole::red)) drop(PlyRole::alpha);
    }

    bool knows(PlyRole role) const { return has[static_cast<size_t>(role)]; }
    PlyType type(PlyRole role) const { return types[static_cast<size_t>(role)]; }
    /// Does it add polygons?
    bool is_surface() const { return (is_face || is_strip) && element->count > 0; }

  private:
    void drop(PlyRole role) {
        has[static_cast<size_t>(role)] = false;
        std::replace(roles.begin(), roles.end(), role, PlyRole::none);
    }

    /// Without one of its parts a normal, coordinate or colour is none.
    void keep_whole(PlyRole first, PlyRole last) {
        bool whole = true;
        for (auto i = static_cast<int>(first); i <= static_cast<int>(last); ++i)
            whole &= knows(static_cast<PlyRole>(i));
        for (auto i = static_cast<int>(first); i <= static_cast<int>(last) && !whole; ++i)
            drop(static_cast<PlyRole>(i));
    }
};

using Slots = std::array<double, role_count>;

glm::dvec3 slot_vector(const Slots& slots, PlyRole first) {
    const auto i = static_cast<size_t>(first);
    return {slots[i], slots[i + 1], slots[i + 2]};
}

/// A channel of an integer type, scaled to [0, 1]. Types of 32 bits hold what fits 8: nobody uses more.
double channel(double value, PlyType type) {
    switch (type) {
        case PlyType::float32:
        case PlyType::float64:
            return value;
        case PlyType::int8:
            return (value < 0 ? value + 256 : value) / 255;
        case PlyType::int16:
            return (value < 0 ? value + 65536 : value) / 65535;
        case PlyType::uint16:
            return value / 65535;
        default:
            return value / 255;
    }
}

glm::vec4 slot_color(const Slots& slots, const PlyPlan& plan) {
    glm::vec4 out(1);
    for (int k = 0; k < 4; ++k) {
        const auto role = static_cast<PlyRole>(static_cast<int>(PlyRole::red) + k);
        if (plan.knows(role)) out[k] = static_cast<float>(channel(slots[static_cast<size_t>(role)], plan.type(role)));
    }
    return is_floating(plan.type(PlyRole::red)) ? out : encoded_color(out);
}

/// Reads the body into a polygon mesh.
class PlyReader {
  public:
    PlyReader(FileReader& file, const PlyHeader& header, Scene& scene, const glm::dvec3& origin)
        : file_(file), header_(header), body_(file, header.format), scene_(scene) {
        mesh_.origin = origin;
        for (const PlyElement& element : header.elements) plans_.emplace_back(element);
        check_elements();
    }

    PolygonMesh read() {
        for (const PlyPlan& plan : plans_) {
            check_claim(plan);
            if (plan.element->properties.empty()) continue;
            reserve(plan);
            read_element(plan);
        }
        note_rest();
        choose_colors();
        choose_materials();
        return std::move(mesh_);
    }

  private:
    /// Of what is left of the file, before anything is allocated.
    void check_claim(const PlyPlan& plan) const {
        const PlyElement& element = *plan.element;
        if (body_.least_size(element) * static_cast<double>(element.count) <= static_cast<double>(file_.left()) + 1)
            return;
        fail("{}: claims {} \"{}\", but only {} left for {}; the file is truncated or damaged", file_.name(),
             counted("{} element{|s}", element.count), printable(element.name, 40),
             counted("{} byte{|s} {is|are}", file_.left()), counted("{it|them}", element.count));
    }

    void check_elements() {
        for (const PlyPlan& plan : plans_) check_claim(plan);
        const PlyPlan* vertices = nullptr;
        bool surface = false;
        for (const PlyPlan& plan : plans_) {
            if (plan.is_vertex && std::exchange(vertices, &plan))
                fail("{}: the PLY header has two elements \"vertex\"; keep one", file_.name());
            if ((plan.is_face || plan.is_strip) && !plan.knows(PlyRole::indices))
                fail("{}: the PLY header gives element \"{}\" no list vertex_indices", file_.name(),
                     plan.element->name);
            surface |= plan.is_surface();
            face_colors_ |= plan.is_surface() && plan.knows(PlyRole::red);
            texcoords_ |= plan.is_surface() && plan.knows(PlyRole::texcoords);
            corner_colors_ |= plan.is_surface() && plan.knows(PlyRole::colors);
            texnumbers_ |= plan.is_surface() && plan.knows(PlyRole::texture);
        }
        if (!surface) fail_without_surface(vertices ? vertices->element : nullptr);
        if (!vertices || !vertices->knows(PlyRole::x) || !vertices->knows(PlyRole::y) || !vertices->knows(PlyRole::z))
            fail("{}: the PLY header has no element \"vertex\" with x, y and z", file_.name());
        vertex_count_ = vertices->element->count;
        vertex_colors_ = vertices->knows(PlyRole::red);
        vertex_uvs_ = vertices->knows(PlyRole::u);
    }

    [[noreturn]] void fail_without_surface(const PlyElement* vertices) const {
        const auto has = [&](std::string_view name) {
            return vertices && std::any_of(vertices->properties.begin(), vertices->properties.end(),
                                           [&](const PlyProperty& property) { return property.name == name; });
        };
        if (has("f_dc_0") || has("packed_position"))
            fail("{}: a Gaussian splat of {} points, which has no surface to trace; give a triangle mesh", file_.name(),
                 vertices->count);
        if (!vertices || vertices->count == 0) fail("{}: the PLY file has no vertices and no faces", file_.name());
        fail("{}: a point cloud of {} points without faces; reconstruct its surface first and give that mesh",
             file_.name(), vertices->count);
    }

    void reserve(const PlyPlan& plan) {
        const uint64_t count = plan.element->count;
        if (plan.is_vertex) {
            mesh_.positions.reserve(count);
            if (plan.knows(PlyRole::nx)) mesh_.normals.values.reserve(count);
            if (plan.knows(PlyRole::u)) mesh_.uvs.values.reserve(count);
            if (plan.knows(PlyRole::red)) vertex_color_values_.reserve(count);
        }
        if (plan.is_face) {
            const uint64_t size = body_.is_ascii() ? 2 : size_of(plan.type(PlyRole::indices));
            mesh_.corners.reserve(mesh_.corners.size() + std::min(count * 3, file_.left() / size));
            if (face_colors_) face_color_values_.reserve(count);
        }
    }

    void read_element(const PlyPlan& plan) {
        Slots slots{};
        file_.part = {plan.element->name, 0, plan.element->count};
        for (uint64_t item = 0; item < plan.element->count; ++item) {
            file_.part.index = item;
            list_texcoords_.clear();
            list_colors_.clear();
            strip_.clear();
            const size_t first = mesh_.corners.size();
            for (size_t i = 0; i < plan.roles.size(); ++i) {
                const PlyProperty& property = plan.element->properties[i];
                if (property.count)
                    read_list(plan, property, plan.roles[i]);
                else if (plan.roles[i] == PlyRole::none)
                    body_.skip(property.type, 1);
                else
                    slots[static_cast<size_t>(plan.roles[i])] = body_.number(property.type);
            }
            if (plan.is_vertex) add_vertex(plan, slots);
            if (plan.is_face) add_face(plan, slots, first);
            if (plan.is_strip) add_strip(plan, slots);
        }
    }

    void read_list(const PlyPlan& plan, const PlyProperty& property, PlyRole role) {
        const uint64_t count = body_.length(property);
        if (role == PlyRole::indices) {
            std::vector<uint32_t>& out = plan.is_strip ? strip_ : mesh_.corners;
            for (uint64_t i = 0; i < count; ++i) out.push_back(read_index(property.type, plan.is_strip));
        } else if (role == PlyRole::texcoords || role == PlyRole::colors) {
            std::vector<double>& out = role == PlyRole::texcoords ? list_texcoords_ : list_colors_;
            for (uint64_t i = 0; i < count; ++i) out.push_back(body_.number(property.type));
        } else {
            body_.skip(property.type, count);
        }
    }

    uint32_t read_index(PlyType type, bool strip) {
        const int64_t index = body_.whole(type);
        if (strip && (index == -1 || (type == PlyType::uint32 && index == UINT32_MAX))) return no_value;  // a restart
        if (index < 0 || static_cast<uint64_t>(index) >= vertex_count_ || index >= no_value)
            fail("{}: {}: {} has index {}, the file has {}", file_.name(), body_.place(), file_.part_name(), index,
                 counted("{} vert{ex|ices}", vertex_count_));
        return static_cast<uint32_t>(index);
    }

    void add_vertex(const PlyPlan& plan, const Slots& slots) {
        mesh_.positions.push_back(mesh_.relative(slot_vector(slots, PlyRole::x)));
        if (plan.knows(PlyRole::nx)) mesh_.normals.values.emplace_back(slot_vector(slots, PlyRole::nx));
        if (plan.knows(PlyRole::u) && !texcoords_)
            mesh_.uvs.values.emplace_back(slots[static_cast<size_t>(PlyRole::u)],
                                          slots[static_cast<size_t>(PlyRole::v)]);
        if (plan.knows(PlyRole::red)) vertex_color_values_.push_back(slot_color(slots, plan));
    }

    void add_face(const PlyPlan& plan, const Slots& slots, size_t first) {
        const size_t count = mesh_.corners.size() - first;
        if (count != 3 && mesh_.ends.empty())
            for (size_t end = 3; end <= first; end += 3) mesh_.ends.push_back(static_cast<uint32_t>(end));
        if (count != 3 || !mesh_.ends.empty()) mesh_.ends.push_back(static_cast<uint32_t>(mesh_.corners.size()));
        add_corner_values(plan, count);
        add_face_values(plan, slots);
    }

    void add_corner_values(const PlyPlan& plan, size_t count) {
        if (texcoords_) {
            const bool fits = list_texcoords_.size() == count * 2;
            for (size_t i = 0; i < count; ++i)
                mesh_.uvs.values.push_back(fits ? glm::vec2(list_texcoords_[i * 2], list_texcoords_[i * 2 + 1])
                                                : glm::vec2(0));
            if (!fits && !list_texcoords_.empty()) ++unfit_texcoords_;
        }
        if (corner_colors_) {
            const size_t width = count > 0 ? list_colors_.size() / count : 0;
            const bool fits = (width == 3 || width == 4) && list_colors_.size() == count * width;
            const PlyType type = plan.type(PlyRole::colors);
            for (size_t i = 0; i < count; ++i) {
                glm::vec4 color(1);
                for (size_t k = 0; k < width && fits; ++k)
                    color[static_cast<int>(k)] = static_cast<float>(channel(list_colors_[i * width + k], type));
                corner_color_values_.push_back(is_floating(type) ? color : encoded_color(color));
            }
            if (!fits && !list_colors_.empty()) ++unfit_colors_;
        }
    }

    void add_face_values(const PlyPlan& plan, const Slots& slots) {
        if (face_colors_)
            face_color_values_.push_back(plan.knows(PlyRole::red) ? slot_color(slots, plan) : glm::vec4(1));
        if (!texnumbers_) return;
        const double number = plan.knows(PlyRole::texture) ? slots[static_cast<size_t>(PlyRole::texture)] : 0;
        const bool known = number >= 0 && number < static_cast<double>(header_.textures.size());
        if (!known && number != -1) ++unknown_textures_;
        // Material 0 has no texture, the others follow in the order of the textures.
        const uint32_t material = known ? static_cast<uint32_t>(number) + 1 : 0;
        if (mesh_.parts.empty() || mesh_.parts.back().material != material)
            mesh_.parts.push_back({mesh_.polygon_count() - 1, 0, material});
    }

    /// Every vertex of a strip from the third on makes a triangle with the two before it, whose order alternates.
    void add_strip(const PlyPlan& plan, const Slots& slots) {
        size_t begin = 0;
        for (size_t i = 0; i < strip_.size(); ++i) {
            if (strip_[i] == no_value) {
                begin = i + 1;
                continue;
            }
            if (i < begin + 2) continue;
            uint32_t a = strip_[i - 2], b = strip_[i - 1];
            const uint32_t c = strip_[i];
            if (a == b || b == c || a == c) continue;  // it only leads the strip elsewhere
            if ((i - begin) % 2) std::swap(a, b);
            const size_t first = mesh_.corners.size();
            mesh_.corners.insert(mesh_.corners.end(), {a, b, c});
            add_face(plan, slots, first);
        }
    }

    /// The finest colours count: those of corners, then of vertices, then of faces.
    void choose_colors() {
        using Per = MeshAttribute<glm::vec4>::Per;
        if (texcoords_) mesh_.uvs.per = MeshAttribute<glm::vec2>::Per::corner;
        if (texcoords_ && vertex_uvs_)
            note("the texture coordinates of vertices have no effect beside those of corners");
        mesh_.colors.per = corner_colors_ ? Per::corner : vertex_colors_ ? Per::vertex : Per::face;
        mesh_.colors.values = std::move(corner_colors_   ? corner_color_values_
                                        : vertex_colors_ ? vertex_color_values_
                                                         : face_color_values_);
        if (vertex_colors_ && corner_colors_) note("the colours of vertices have no effect beside those of corners");
        if (face_colors_ && (vertex_colors_ || corner_colors_))
            note("the colours of faces have no effect beside those of vertices");
    }

    void choose_materials() {
        scene_.materials.emplace_back();
        if (header_.textures.empty()) {
            if (texnumbers_) note("texture numbers have no effect: the file names no texture");
            mesh_.parts.clear();
            return;
        }
        if (mesh_.uvs.values.empty()) {
            note(counted("{} texture{|s} {has|have} no effect: the file has no texture coordinates",
                         header_.textures.size()));
            mesh_.parts.clear();
            return;
        }
        if (texnumbers_) {
            for (const std::string& name : header_.textures) scene_.materials.push_back(textured(name));
        } else {
            scene_.materials = {textured(header_.textures[0])};
            if (header_.textures.size() > 1)
                note(counted("{} texture{|s} {has|have} no effect: no face has a texnumber",
                             header_.textures.size() - 1));
        }
        if (unknown_textures_)
            note(counted("{} face{|s} {names|name} a texture that the file does not have", unknown_textures_));
    }

    Material textured(const std::string& name) {
        Material out;
        out.name = name;
        try {
            const std::string where = fmt::format("texture \"{}\"", printable(name, 80));
            const std::optional<SideFile> file = find_beside(scene_.files[0].parent_path(), name);
            if (!file) fail("{}: no such file beside the model", where);
            if (file->is_elsewhere)
                note(fmt::format("{} was found as {} beside the model", where,
                                 printable(file->path.filename().string(), 80)));
            Texture texture = decode_image(read_file(file->path), where);
            remember_file(scene_.files, file->path);
            texture.name = name;
            out.base_color_texture = static_cast<int>(scene_.textures.size());
            scene_.textures.push_back(std::move(texture));
        } catch (const Error& error) {
            note(fmt::format("the texture is left out: {}", error.what()));
        }
        return out;
    }

    void note_rest() {
        if (body_.is_ascii() ? !file_.word().empty() : file_.left() > 0)
            note(body_.is_ascii() ? fmt::format("what follows the last element in line {} has no effect", file_.line())
                                  : counted("{} byte{|s} after the last element {has|have} no effect", file_.left()));
        if (unfit_texcoords_)
            note(counted("{} list{|s} of texture coordinates ignored, which {does|do} not have two per corner",
                         unfit_texcoords_));
        if (unfit_colors_)
            note(counted("{} list{|s} of colours ignored, which {does|do} not have three or four numbers per corner",
                         unfit_colors_));
        std::vector<std::string> unused;
        for (const PlyPlan& plan : plans_) {
            if (!plan.is_vertex && !plan.is_face && !plan.is_strip)
                unused.push_back(
                    fmt::format("element {} ({})", printable(plan.element->name, 40), plan.element->count));
            else
                for (size_t i = 0; i < plan.roles.size(); ++i)
                    if (plan.roles[i] == PlyRole::none)
                        unused.push_back(
                            fmt::format("{} {}", plan.element->name, printable(plan.element->properties[i].name, 40)));
        }
        if (unused.empty()) return;
        constexpr size_t most = 12;
        std::string text;
        for (size_t i = 0; i < std::min(unused.size(), most); ++i) text += (i ? ", " : "") + unused[i];
        if (unused.size() > most) text += fmt::format(" and {} more", unused.size() - most);
        note("without effect in the PLY file: " + text);
    }

    void note(std::string text) { scene_.notes.push_back(std::move(text)); }

    FileReader& file_;
    const PlyHeader& header_;
    PlyBody body_;
    Scene& scene_;
    std::vector<PlyPlan> plans_;
    PolygonMesh mesh_;
    uint64_t vertex_count_ = 0;
    bool vertex_uvs_ = false, vertex_colors_ = false, face_colors_ = false, corner_colors_ = false, texcoords_ = false,
         texnumbers_ = false;
    std::vector<glm::vec4> vertex_color_values_, face_color_values_, corner_color_values_;
    std::vector<double> list_texcoords_, list_colors_;
    std::vector<uint32_t> strip_;
    uint64_t unfit_texcoords_ = 0, unfit_colors_ = 0, unknown_textures_ = 0;
};

}  // namespace

Scene load_ply(const std::filesystem::path& path) {
    return load_polygons(path, [](FileReader& file, Scene& scene, const glm::dvec3& origin) {
        const PlyHeader header = read_ply_header(file);
        return PlyReader(file, header, scene, origin).read();
    });
}

}  // namespace peelray
