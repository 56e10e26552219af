// The text of an OBJ file, after the format's specification (Wavefront Advanced Visualizer, appendix B1, version 3.0)
// and what other programs add to it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/text.h"
#include "loaders/obj.h"
#include "loaders/text_lines.h"

namespace peelray {

namespace {

/// Statements that describe free-form curves and surfaces.
constexpr std::array<std::string_view, 22> free_form_statements = {
    "vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole",
    "scrv", "sp",     "end", "con",  "mg",   "bzp",  "bsp",   "cdc",  "cdp",  "res",  "ctech"};
/// Further statements of the format that say nothing about the polygons' shape.
constexpr std::array<std::string_view, 11> idle_statements = {
    "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "stech", "maplib", "usemap", "call", "csh"};

constexpr const char* vertex_name = "a vertex";

template <size_t n>
bool is_among(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// How often something was met, and where first.
struct Occurrences {
    size_t count = 0, line = 0;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& name, const glm::dvec3& origin)
        : text_(text), name_(name), lines_(text) {
        out_.mesh.origin = origin;
        out_.materials.emplace_back();
        // 30 bytes are a usual vertex or triangle; what is too much is given back in the end.
        out_.mesh.positions.reserve(std::min<size_t>(text.size() / 90, 1u << 28));
    }

    ObjFile read() {
        if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
            fail("{}: the text is in UTF-16; save it in ASCII or UTF-8", name_);
        while (lines_.next()) statement(lines_.line());
        if (out_.mesh.corners.empty())
            fail("{}: none of its {} a face with three or more corners; export the surface as polygons", name_,
                 counted("{} line{|s} is", lines_.number()));
        finish_indices();
        finish_colors();
        write_notes();
        return std::move(out_);
    }

  private:
    template <typename... Args>
    [[noreturn]] void broken(fmt::format_string<Args...> format, Args&&... args) const {
        broken_at(lines_.number(), format, std::forward<Args>(args)...);
    }
    template <typename... Args>
    [[noreturn]] void broken_at(size_t line, fmt::format_string<Args...> format, Args&&... args) const {
        fail("{}, line {}: {}", name_, line, fmt::format(format, std::forward<Args>(args)...));
    }

    void statement(std::string_view line) {
        std::string_view rest = line;
        const std::string_view key = take_word(rest);
        if (key.empty()) return;
        if (key[0] == '#') return comment(key, rest);
        if (key == "v") return vertex(without_comment(rest));
        if (key == "f" || key == "fo") return face(without_comment(rest));
        if (key == "vt") return texture_vertex(without_comment(rest));
        if (key == "vn") return normal(without_comment(rest));
        const std::string_view name = name_without_comment(rest);
        if (key == "usemtl") return use_material(name, trimmed(rest));
        if (key == "o") return object(name);
        if (key == "g") return group(name);
        if (key == "mtllib") return library(trimmed(rest));
        if (key == "s") return smoothing_group(name);
        if (key == "l") return count(lines_met_);
        if (key == "p") return count(points_met_);
        if (is_among(free_form_statements, key)) return count(free_form_met_);
        count(is_among(idle_statements, key) ? without_effect_[std::string(key)] : unknown_[printable(key, 20)]);
    }

    void count(Occurrences& met) const {
        if (met.count++ == 0) met.line = lines_.number();
    }

    /// ZBrush writes the vertices' colours as comments: "#MRGB " and up to 64 times mask, red, green, blue in hex.
    void comment(std::string_view key, std::string_view rest) {
        if (key != "#MRGB") return;
        const std::string_view digits = take_word(rest);
        const auto byte = [&](size_t at) {
            const auto digit = [](char c) { return c >= 'a' ? c - 'a' + 10 : c >= 'A' ? c - 'A' + 10 : c - '0'; };
            return static_cast<uint8_t>(digit(digits[at]) * 16 + digit(digits[at + 1]));
        };
        if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos || digits.size() % 8)
            return count(broken_polypaint_);
        for (size_t at = 0; at < digits.size(); at += 8)
            polypaint_.push_back({byte(at + 2), byte(at + 4), byte(at + 6)});
    }

    /// The numbers of a statement, at most eight, up to a word that is none: that is left in `rest`.
    size_t numbers(std::string_view& rest, std::array<float, 8>& out, const char* what) const {
        size_t count = 0;
        for (;;) {
            const std::optional<float> value = take_number(rest);
            if (!value) break;
            if (count == out.size())
                broken("more than {} numbers for {}; one statement belongs on a line", count, what);
            out[count++] = *value;
        }
        rest = trimmed(rest);
        return count;
    }

    [[noreturn]] void not_a_number(size_t line, std::string_view rest, const char* what) const {
        broken_at(line, "\"{}\" is no number of {}; repair the file", printable(take_word(rest), 30), what);
    }

    void vertex(std::string_view rest) {
        std::array<float, 8> n;
        const std::string_view text = rest;
        const size_t count = numbers(rest, n, vertex_name);
        std::vector<glm::vec3>& positions = out_.mesh.positions;
        if (positions.size() == no_value - 1) broken("more than {} vertices; split the scene", no_value - 1);
        // What cannot be read counts only where a face uses it, see finish_positions().
        if (!rest.empty()) {
            positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
            return;
        }
        if (count < 3) broken("a vertex has three coordinates, here are {}; repair the file", count);
        glm::vec3 position(n[0], n[1], n[2]);
        if (count == 4 && n[3] != 1) {
            if (n[3] == 0) broken("the vertex has the weight 0 and lies at infinity; repair the file");
            position /= n[3];
            this->count(weighted_);
        }
        if (out_.mesh.origin != glm::dvec3(0)) position = far_position(text, count == 4 ? n[3] : 1);
        positions.push_back(position);
        if (count == 5 || count == 8) this->count(surplus_);
        if (count == 6 || count == 7) color({n[3], n[4], n[5], count == 7 ? n[6] : 1});
    }

    /// A vertex whose floats would be too coarse: its first three numbers once more.
    glm::vec3 far_position(std::string_view text, float weight) const {
        glm::dvec3 p;
        for (int k = 0; k < 3; ++k)
            p[k] = to_number(take_word(text)).value_or(std::numeric_limits<double>::quiet_NaN());
        return out_.mesh.relative(p / double(weight));
    }

    void color(glm::vec4 color) {
        std::vector<glm::vec4>& colors = out_.mesh.colors.values;
        colors.resize(out_.mesh.positions.size() - 1, glm::vec4(1));  // those before had none
        for (int k = 0; k < 4; ++k) {
            if (!(color[k] >= 0 && color[k] <= 1)) {
                count(bright_);
                color[k] = std::isnan(color[k]) ? 1.f : std::clamp(color[k], 0.f, 1.f);
            }
        }
        colors.push_back(color);
    }

    void texture_vertex(std::string_view rest) {
        std::array<float, 8> n;
        const size_t count = numbers(rest, n, "a texture coordinate");
        if (!rest.empty()) not_a_number(lines_.number(), rest, "a texture coordinate");
        if (count < 1 || count > 3) broken("a texture coordinate has one to three numbers, here are {}", count);
        if (count == 3 && n[2] != 0) this->count(volume_coordinates_);
        out_.mesh.uvs.values.emplace_back(n[0], count > 1 ? n[1] : 0.f);
    }

    void normal(std::string_view rest) {
        std::array<float, 8> n;
        const size_t count = numbers(rest, n, "a normal");
        if (!rest.empty()) not_a_number(lines_.number(), rest, "a normal");
        if (count != 3) broken("a normal has three numbers, here are {}; repair the file", count);
        out_.mesh.normals.values.emplace_back(n[0], n[1], n[2]);
    }

    /// One kind of index in corners: what it counts, how many the file has so far, and the largest that ran ahead.
    struct Reference {
        const char* what;
        uint32_t ahead = 0;
        size_t line = 0;
        size_t early = 0;  ///< the line of a corner that counts back where there are none yet
    };

    /// Index from 0, of one that the file counts from 1 or, below 0, back from the last.
    uint32_t index(int64_t value, size_t count, Reference& reference) {
        if (value < 0) {
            if (count == 0 && &reference != &vertices_) {
                reference.early = lines_.number();
                return 0;
            }
            if (-value > static_cast<int64_t>(count))
                broken("a corner names {} {}, counted back from the last one; there are {} so far", reference.what,
                       value, count);
            return static_cast<uint32_t>(static_cast<int64_t>(count) + value);
        }
        if (value == 0) broken("a corner names {} 0; they are counted from 1", reference.what);
        if (value >= no_value) broken("a corner names {} {}, the file has {}", reference.what, value, count);
        const auto found = static_cast<uint32_t>(value - 1);
        if (value > static_cast<int64_t>(count) && value > reference.ahead) {
            reference.ahead = static_cast<uint32_t>(value);
            reference.line = lines_.number();
        }
        return found;
    }

    /// Takes a whole number off the front; false: none is there. Beyond 13 digits it stays as large as that.
    static bool take_whole(const char*& at, const char* end, int64_t& value) {
        const char* begin = at;
        const bool negative = at < end && *at == '-';
        if (at < end && (*at == '-' || *at == '+')) ++at;
        const char* digits = at;
        value = 0;
        for (; at < end && *at >= '0' && *at <= '9'; ++at)
            if (value < 1000000000000) value = value * 10 + (*at - '0');
        if (at == digits) at = begin;
        if (negative) value = -value;
        return at != begin;
    }

    void face(std::string_view rest) {
        PolygonMesh& mesh = out_.mesh;
        const size_t first = mesh.corners.size();
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) corner(word);
        const size_t count = mesh.corners.size() - first;
        if (count < 3) {
            mesh.corners.resize(first);
            if (!mesh.uvs.indices.empty()) mesh.uvs.indices.resize(first);
            if (!mesh.normals.indices.empty()) mesh.normals.indices.resize(first);
            return this->count(count == 0 ? empty_faces_ : count == 1 ? points_met_ : lines_met_);
        }
        if (mesh.corners.size() >= no_value) broken("more than {} corners; split the scene", no_value);
        if (count != 3 && mesh.ends.empty())
            for (size_t end = 3; end <= first; end += 3) mesh.ends.push_back(static_cast<uint32_t>(end));
        if (count != 3 || !mesh.ends.empty()) mesh.ends.push_back(static_cast<uint32_t>(mesh.corners.size()));
        begin_part();
        ++polygons_;
    }

    /// "v", "v/vt", "v//vn", "v/vt/vn", also with nothing after the last slash.
    void corner(std::string_view word) {
        PolygonMesh& mesh = out_.mesh;
        const char *at = word.data(), *end = at + word.size();
        int64_t value = 0;
        const auto wrong = [&] {
            broken("\"{}\" is no corner of a face: it needs v, v/vt, v//vn or v/vt/vn", printable(word, 40));
        };
        if (!take_whole(at, end, value)) wrong();
        mesh.corners.push_back(index(value, mesh.positions.size(), vertices_));
        uint32_t uv = no_value, normal = no_value;
        if (at < end && *at++ != '/') wrong();
        if (at < end && *at != '/') {
            if (!take_whole(at, end, value)) wrong();
            uv = index(value, mesh.uvs.values.size(), uvs_);
        }
        if (at < end && *at++ != '/') wrong();
        if (at < end) {
            if (!take_whole(at, end, value)) wrong();
            normal = index(value, mesh.normals.values.size(), normals_);
        }
        if (at < end) wrong();
        add_index(mesh.uvs.indices, uv);
        add_index(mesh.normals.indices, normal);
    }

    /// The list stays empty until a corner has such an attribute.
    void add_index(std::vector<uint32_t>& list, uint32_t value) const {
        if (list.empty() && value != no_value) list.assign(out_.mesh.corners.size() - 1, no_value);
        if (!list.empty() || value != no_value) list.push_back(value);
    }

    void begin_part() {
        if (is_part_open_) return;
        is_part_open_ = true;
        if (object_ == no_value) {
            object_ = static_cast<uint32_t>(out_.mesh.objects.size());
            object_ids_.try_emplace(object_name_, object_);
            out_.mesh.objects.push_back(object_name_);
        }
        out_.mesh.parts.push_back({polygons_, object_, material_});
    }

    void object(std::string_view name) {
        if (name.empty()) return;
        is_part_open_ = false;
        object_name_ = name;
        const auto found = object_ids_.find(object_name_);
        object_ = found == object_ids_.end() ? no_value : found->second;
    }

    /// A group is an object of its own, unless it goes on.
    void group(std::string_view name) {
        if (name.empty() || group_ == name) return;
        is_part_open_ = false;
        group_ = object_name_ = name;
        object_ = no_value;
    }

    void use_material(std::string_view name, std::string_view whole) {
        if (name.empty()) return;
        const auto [entry, added] =
            material_ids_.try_emplace(std::string(whole), static_cast<uint32_t>(out_.materials.size()));
        if (added) out_.materials.emplace_back(whole);
        is_part_open_ = is_part_open_ && material_ == entry->second;
        material_ = entry->second;
    }

    void library(std::string_view names) {
        if (names.empty()) return;
        if (std::find(out_.libraries.begin(), out_.libraries.end(), names) == out_.libraries.end())
            out_.libraries.emplace_back(names);
    }

    void smoothing_group(std::string_view name) {
        if (out_.mesh.normals.values.empty() && name != "off" && name != "0") count(smoothing_);
        if (out_.mesh.normals.values.empty() && (name == "off" || name == "0")) count(flat_);
    }

    /// Indices that ran ahead of the list must be in it now. A file without any such element may name them all the
    /// same: some programs write 1/1/1 whatever there is.
    template <typename T>
    void finish_attribute(MeshAttribute<T>& attribute, const Reference& reference) {
        attribute.per = MeshAttribute<T>::Per::corner;
        if (attribute.values.empty() && !attribute.indices.empty()) {
            out_.notes.push_back(fmt::format("faces name {}s, the file has none", reference.what));
            attribute.indices.clear();
        }
        check(reference, attribute.values.size());
        if (attribute.indices.empty()) attribute.values.clear();
    }

    void check(const Reference& reference, size_t count) const {
        if (count > 0 && reference.ahead > count)
            broken_at(reference.line, "a corner names {} {}, the file has {}; it is damaged or cut off", reference.what,
                      reference.ahead, count);
        if (count > 0 && reference.early)
            broken_at(reference.early, "a corner counts back to a {} where there are none yet", reference.what);
    }

    void finish_indices() {
        PolygonMesh& mesh = out_.mesh;
        if (mesh.positions.empty()) broken_at(vertices_.line, "a face without any vertex in the file; it is cut off");
        check(vertices_, mesh.positions.size());
        finish_positions();
        for (glm::vec2& uv : mesh.uvs.values)
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
                uv = glm::vec2(0);
                ++infinite_uvs_;
            }
        finish_attribute(mesh.uvs, uvs_);
        finish_attribute(mesh.normals, normals_);
    }

    /// Positions that are used must be finite.
    void finish_positions() const {
        for (const uint32_t corner : out_.mesh.corners) {
            const glm::vec3& p = out_.mesh.positions[corner];
            if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
            TextLines lines(text_);
            std::string_view rest;
            for (uint32_t before = corner; lines.next();) {
                rest = lines.line();
                if (take_word(rest) == "v" && before-- == 0) break;
            }
            rest = without_comment(rest);
            std::array<float, 8> n;
            numbers(rest, n, vertex_name);
            if (!rest.empty()) not_a_number(lines.number(), rest, vertex_name);
            broken_at(lines.number(), "the vertex is at ({}, {}, {}); repair the mesh, positions must be finite", p.x,
                      p.y, p.z);
        }
    }

    void finish_colors() {
        PolygonMesh& mesh = out_.mesh;
        if (!mesh.colors.values.empty()) mesh.colors.values.resize(mesh.positions.size(), glm::vec4(1));
        if (polypaint_.empty() || !mesh.colors.values.empty()) return;
        for (const std::array<uint8_t, 3>& c : polypaint_)
            mesh.colors.values.push_back(encoded_color(c[0], c[1], c[2]));
        mesh.colors.values.resize(mesh.positions.size(), glm::vec4(1));
        if (polypaint_.size() != mesh.positions.size())
            out_.notes.push_back(fmt::format("{} for {}; the others are white",
                                             counted("{} colour{|s} (#MRGB)", polypaint_.size()),
                                             counted("{} vert{ex|ices}", mesh.positions.size())));
    }

    void note(const Occurrences& met, std::string_view what) {
        if (met.count)
            out_.notes.push_back(fmt::format("{}, {}in line {}", counted(what, met.count),
                                             met.count == 1 ? "" : "the first ", met.line));
    }

    void write_notes() {
        note(points_met_, "{} point statement{|s} dropped");
        note(lines_met_, "{} line statement{|s} dropped");
        note(free_form_met_, "{} statement{|s} of free-form curves and surfaces dropped");
        note(empty_faces_, "{} face{|s} without corners dropped");
        note(weighted_, "{} vert{ex|ices} divided by {its|their} weight (w)");
        note(surplus_, "{} vert{ex|ices} with numbers after the coordinates that are no colour; those are ignored");
        note(bright_, "{} channel{|s} of vertex colours outside of 0 to 1 cut to that");
        note(broken_polypaint_,
             "{} line{|s} of colours (#MRGB) that {is|are} no groups of eight hexadecimal digits ignored");
        note(volume_coordinates_, "{} texture coordinate{|s} whose third number is ignored");
        if (infinite_uvs_)
            out_.notes.push_back(
                counted("{} texture coordinate{|s} that {is|are} not finite {counts|count} as 0", infinite_uvs_));
        if (out_.mesh.normals.values.empty()) {
            note(smoothing_, "{} smoothing group{|s} ignored: without normals, edges up to 75 degrees are smooth");
            note(flat_, "{} \"s off\" ignored: without normals, edges up to 75 degrees are smooth");
        }
        for (const auto& [key, met] : without_effect_)
            note(met, fmt::format("{{}} \"{}\" statement{{|s}} without effect", key));
        if (unknown_.empty()) return;
        Occurrences all;
        for (const auto& [key, met] : unknown_) {
            all.line = all.count ? std::min(all.line, met.line) : met.line;
            all.count += met.count;
        }
        note(all, fmt::format("{{}} line{{|s}} that {{begins|begin}} with no OBJ keyword (such as \"{}\") ignored",
                              escaped(unknown_.begin()->first)));
    }

    const std::string_view text_;
    const std::string& name_;
    TextLines lines_;
    ObjFile out_;

    Reference vertices_{"vertex"}, uvs_{"texture coordinate"}, normals_{"normal"};
    uint32_t polygons_ = 0, object_ = no_value, material_ = 0;
    bool is_part_open_ = false;
    std::string object_name_ = "defaultobject", group_;
    std::unordered_map<std::string, uint32_t> object_ids_, material_ids_;
    std::vector<std::array<uint8_t, 3>> polypaint_;

    Occurrences points_met_, lines_met_, free_form_met_, empty_faces_, weighted_, surplus_, bright_, broken_polypaint_,
        volume_coordinates_, smoothing_, flat_;
    size_t infinite_uvs_ = 0;
    std::map<std::string, Occurrences> without_effect_, unknown_;
};

}  // namespace

ObjFile parse_obj(std::string_view text, const std::string& name, const glm::dvec3& origin) {
    return ObjReader(text, name, origin).read();
}

}  // namespace peelray
