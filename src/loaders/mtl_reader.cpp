// The text of a material library, after the format's specification (Wavefront Advanced Visualizer, appendix B2, version
// 4.2) with the parameters of physically based materials that Exocortex proposed and Blender writes.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "loaders/mtl.h"
#include "loaders/text_lines.h"

namespace peelray {

namespace {

constexpr std::array<std::string_view, 3> normal_maps = {"norm", "map_kn", "map_norm"};

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& name, Tally& tally) : text_(text), name_(name), tally_(tally) {}

    std::vector<MtlMaterial> read() {
        if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) {
            ++tally_["{} material librar{y|ies} in UTF-16 ignored; save it in ASCII or UTF-8"];
            return {};
        }
        TextLines lines(text_);
        while (lines.next()) {
            std::string_view rest = lines.line();
            const std::string key(take_word(rest));
            if (key.empty() || key[0] == '#') continue;
            if (key == "newmtl") {
                out_.emplace_back().name = trimmed(rest);
            } else if (out_.empty()) {
                ++tally_[fmt::format("{{}} statement{{|s}} before the first newmtl of \"{}\" ignored",
                                     escaped(name_, 80))];
            } else if (!statement(key, trimmed(rest))) {
                ++tally_[fmt::format("{{}} statement{{|s}} in line {} of \"{}\" ignored, its value cannot be read: {}",
                                     lines.number(), escaped(name_, 80), escaped(trimmed(lines.line()), 60))];
            }
        }
        return std::move(out_);
    }

  private:
    /// False: its value cannot be read.
    bool statement(const std::string& key, std::string_view rest) {
        MtlMaterial& m = out_.back();
        const std::string lower = lower_case(key);
        if (key == "Kd") return color(rest, m.diffuse);
        if (key == "Ks") return color(rest, m.specular);
        if (key == "Ke") return color(rest, m.emissive);
        if (key == "Tf") return color(rest, m.filter);
        if (key == "Ns") return number(rest, m.shininess);
        if (key == "Ni") return number(rest, m.ior);
        if (key == "Tr") return number(rest, m.transparency);
        if (key == "Pr") return number(rest, m.roughness);
        if (key == "Pm") return number(rest, m.metallic);
        if (key == "Pc") return number(rest, m.coat);
        if (key == "Pcr") return number(rest, m.coat_roughness);
        if (key == "d") return dissolve(rest, m);
        if (key == "illum") return illumination(rest, m);
        if (lower == "map_kd") return map(rest, m.diffuse_map);
        if (lower == "map_ke") return map(rest, m.emissive_map);
        if (lower == "map_d") return map(rest, m.dissolve_map);
        if (lower == "map_pr") return map(rest, m.roughness_map);
        if (lower == "map_pm") return map(rest, m.metallic_map);
        if (std::find(normal_maps.begin(), normal_maps.end(), lower) != normal_maps.end())
            return map(rest, m.normal_map, true);
        if (lower == "bump" || lower == "map_bump")
            ++tally_["{} bump map{|s} (map_bump), which {holds|hold} heights, ignored; normal maps (norm) are read"];
        else
            ++tally_[fmt::format("{{}} \"{}\" statement{{|s}} of material libraries without effect", escaped(key, 20))];
        return true;
    }

    static bool number(std::string_view rest, std::optional<float>& out) {
        rest = without_comment(rest);
        const std::optional<float> value = take_number(rest);
        if (!value || !std::isfinite(*value) || !trimmed(rest).empty()) return false;
        out = value;
        return true;
    }

    /// One number stands for all three. "spectral FILE" and "xyz X Y Z" are not read.
    static bool color(std::string_view rest, std::optional<glm::vec3>& out) {
        rest = without_comment(rest);
        glm::vec3 value;
        int count = 0;
        for (; count < 3; ++count) {
            const std::optional<float> n = take_number(rest);
            if (!n) break;
            if (!std::isfinite(*n)) return false;
            value[count] = std::max(*n, 0.f);
        }
        if (count == 1) value = glm::vec3(value.x);
        if ((count != 1 && count != 3) || !trimmed(rest).empty()) return false;
        out = value;
        return true;
    }

    bool dissolve(std::string_view rest, MtlMaterial& m) {
        std::string_view after = rest;
        if (take_word(after) == "-halo") {
            ++tally_["{} dissolve{|s} that {grows|grow} towards the rim (d -halo) taken as even"];
            rest = after;
        }
        return number(rest, m.dissolve);
    }

    bool illumination(std::string_view rest, MtlMaterial& m) {
        std::optional<float> value;
        if (!number(rest, value)) return false;
        if (*value != std::floor(*value) || *value < 0 || *value > 10) return false;
        m.illum = static_cast<int>(*value);
        return true;
    }

    bool map(std::string_view rest, std::optional<MtlTexture>& out, bool is_normal = false) {
        MtlTexture texture = parse_mtl_texture(rest, tally_, is_normal);
        if (texture.name.empty()) return false;
        out = std::move(texture);
        return true;
    }

    std::string_view text_;
    const std::string& name_;
    Tally& tally_;
    std::vector<MtlMaterial> out_;
};

/// Options of map_… statements: how many numbers may follow; 0: one word does.
struct Option {
    std::string_view name;
    size_t numbers;
};
constexpr std::array<Option, 13> texture_options = {{{"-s", 3},
                                                     {"-o", 3},
                                                     {"-t", 3},
                                                     {"-mm", 2},
                                                     {"-bm", 1},
                                                     {"-boost", 1},
                                                     {"-texres", 1},
                                                     {"-clamp", 0},
                                                     {"-blendu", 0},
                                                     {"-blendv", 0},
                                                     {"-cc", 0},
                                                     {"-imfchan", 0},
                                                     {"-type", 0}}};

const Option* find_option(std::string_view word) {
    const auto found = std::find_if(texture_options.begin(), texture_options.end(),
                                    [&](const Option& option) { return option.name == word; });
    return found == texture_options.end() ? nullptr : found;
}

class TextureOptions {
  public:
    TextureOptions(MtlTexture& out, Tally& tally, bool is_normal) : out_(out), tally_(tally), is_normal_(is_normal) {}

    /// Takes an option with its values off the front; false: no option stands there.
    bool take(std::string_view& rest) {
        std::string_view after = rest;
        const Option* option = find_option(take_word(after));
        if (!option) return false;
        if (option->numbers == 0) {
            word(option->name, take_word(after));
        } else {
            std::array<float, 3> values = {option->name == "-s" ? 1.f : 0.f, option->name == "-s" ? 1.f : 0.f, 0};
            size_t count = 0;
            // A last word is the file's name, also where it looks like a number.
            for (; count < option->numbers && (!needs_name_ || has_two_words(after)); ++count) {
                const std::optional<float> value = take_number(after);
                if (!value) break;
                values[count] = std::isfinite(*value) ? *value : values[count];
            }
            numbers(option->name, values, count);
        }
        rest = after;
        return true;
    }

    /// False: the name is known already, options stand behind it.
    void set_needs_name(bool needs) { needs_name_ = needs; }

  private:
    static bool has_two_words(std::string_view rest) {
        take_word(rest);
        return !trimmed(rest).empty();
    }

    void numbers(std::string_view name, const std::array<float, 3>& values, size_t count) {
        if (name == "-s" && count) {
            out_.scale = {values[0], values[1]};
        } else if (name == "-o" && count) {
            out_.offset = {values[0], values[1]};
        } else if (name == "-bm" && count && is_normal_) {
            out_.strength = values[0];
        } else if (name == "-mm" && count == 2 && values[0] == 0 && values[1] == 1) {
            return;  // as it is
        } else {
            ignore(name);
        }
    }

    void word(std::string_view name, std::string_view value) {
        if (name == "-clamp") {
            out_.is_clamped = value == "on";
        } else if (name == "-imfchan" && value.size() == 1) {
            out_.channel = value[0];
        } else if ((name == "-blendu" || name == "-blendv") ? value != "on" : name != "-cc" || value != "off") {
            ignore(name);
        }
    }

    void ignore(std::string_view name) {
        ++tally_[fmt::format("{{}} texture option{{|s}} \"{}\" without effect", name)];
    }

    MtlTexture& out_;
    Tally& tally_;
    bool is_normal_;
    bool needs_name_ = true;
};

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, Tally& tally) {
    return MtlReader(text, name, tally).read();
}

MtlTexture parse_mtl_texture(std::string_view rest, Tally& tally, bool is_normal) {
    MtlTexture out;
    TextureOptions reader(out, tally, is_normal);
    while (reader.take(rest)) {
    }
    rest = trimmed(rest);
    // Some programs write the options behind the name.
    reader.set_needs_name(false);
    for (size_t at = rest.find(" -"); at != std::string_view::npos; at = rest.find(" -", at + 1)) {
        std::string_view after = rest.substr(at), word = after;
        if (!find_option(take_word(word))) continue;
        while (reader.take(after)) {
        }
        if (!name_without_comment(after).empty()) continue;
        rest = trimmed(rest.substr(0, at));
        break;
    }
    if (rest.starts_with('"')) {
        const size_t end = rest.find('"', 1);
        rest = rest.substr(1, end == std::string_view::npos ? end : end - 1);
    }
    out.name = rest;
    return out;
}

}  // namespace peelray
