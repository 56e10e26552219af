#include "reference/surface.h"

#include <algorithm>
#include <cmath>

#include "reference/film.h"
#include "reference/optics.h"
#include "scene/sampling.h"

namespace peelray::inline PRECISION {

Optics::Optics(const Material& m)
    : base_color(m.base_color),
      emissive(m.emissive),
      absorption(0),
      metallic(m.metallic),
      roughness(m.roughness),
      transmission(m.transmission),
      ior(m.ior == 0 ? 1 : std::max(m.ior, 1.0f)),
      specified(m.ior == 0 || m.specular != 1 || m.specular_color != glm::vec3(1)),
      f90(m.specular),
      sheen(m.sheen_color),
      sheen_roughness(m.sheen_roughness),
      film(m.iridescence),
      film_ior(std::max(m.film_ior, 1.0f)),
      film_thickness(m.film_most),
      anisotropy(m.anisotropy),
      behind(m.diffuse_transmission),
      behind_color(m.diffuse_transmission_color),
      thin(m.thickness <= 0),
      unlit(m.unlit),
      catcher(m.catcher) {
    // KHR_materials_ior: an index of 0 stands for an infinite one, which reflects all. KHR_materials_specular.
    normal = m.ior == 0 ? 1 : square((ior - 1) / (ior + 1));
    f0 = glm::min(normal * Vec3(m.specular_color), 1.0) * f90;
    // KHR_materials_dispersion: of volumes alone.
    if (m.thickness > 0 && peelray::transmits(m)) spread = (ior - 1) * DISPERSION_SPREAD * real(m.dispersion);
    // KHR_materials_volume: white becomes attenuation_color after attenuation_distance.
    if (std::isfinite(m.attenuation_distance) && m.attenuation_distance > 0)
        absorption = -glm::log(glm::max(Vec3(m.attenuation_color), Vec3(1e-6))) / real(m.attenuation_distance);
}

Vec2 Optics::alphas() const {
    const real alpha = roughness * roughness;
    if (anisotropy == 0) return Vec2(alpha);
    const real across = std::max(alpha, MIRROR_ROUGHNESS * MIRROR_ROUGHNESS);
    return {glm::mix(across, 1.0, anisotropy * anisotropy), across};
}

real Optics::lobe_roughness() const {
    if (anisotropy == 0) return roughness;
    const Vec2 alpha = alphas();
    return std::max(MIRROR_ROUGHNESS, std::pow(alpha.x * alpha.y, 0.25));
}

real Optics::index(Channel channel) const {
    const real side = channel == Channel::red ? -1 : channel == Channel::blue ? 1 : 0;
    return std::max(1.0, ior + side * spread);
}

/// Whose index counts for a component of what a ray carries.
Channel Optics::channel_of(int component, Channel carried) const {
    return carried == Channel::all ? Channel(component) : carried;
}

/// Cosine in air of light that leaves a volume; negative at total internal reflection.
static real cosine_outside(real cosine, real index) {
    const real sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) * index;
    return sine >= 1 ? -1 : std::sqrt(1 - sine * sine);
}

Vec3 Optics::plain_reflectance(real cosine, bool leaving, Channel channel) const {
    if (!specified && spread == 0) return Vec3(optics::fresnel_dielectric(cosine, leaving ? 1 / ior : ior));
    Vec3 all;
    for (int k = 0; k < 3; k++) {
        const real n = index(channel_of(k, channel));
        if (!specified) {
            all[k] = optics::fresnel_dielectric(cosine, leaving ? 1 / n : n);
            continue;
        }
        // The formula's angle is the one outside, where there is one.
        const real outside = leaving ? cosine_outside(cosine, n) : cosine;
        all[k] = outside < 0 ? 1 : optics::fresnel_schlick(f0, f90, outside)[k];
    }
    return all;
}

/// A lossless film is the same mirror from both of its sides.
Vec3 Optics::film_reflectance(const Vec3& base, real cosine, bool leaving, Channel channel) const {
    if (!leaving) return film::reflectance(std::min(cosine, 1.0), film_ior, film_thickness, base);
    Vec3 all;
    for (int k = 0; k < 3; k++) {
        const real outside = cosine_outside(cosine, index(channel_of(k, channel)));
        all[k] = outside < 0 ? 1 : film::reflectance(outside, film_ior, film_thickness, base)[k];
    }
    return all;
}

Vec3 Optics::film_on_dielectric(real cosine, bool leaving, Channel channel) const {
    return film_reflectance(specified ? film::index_of(f0) : Vec3(ior), cosine, leaving, channel);
}

Vec3 Optics::film_on_metal(real cosine, bool leaving, Channel channel) const {
    return film_reflectance(film::index_of(base_color), cosine, leaving, channel);
}

Vec3 Optics::face_reflectance(real cosine, bool leaving, Channel channel) const {
    const Vec3 plain = plain_reflectance(cosine, leaving, channel);
    return film == 0 ? plain : glm::mix(plain, film_on_dielectric(cosine, leaving, channel), film);
}

Vec3 Optics::metal_reflectance(real cosine, bool leaving, Channel channel) const {
    const Vec3 plain = optics::fresnel_schlick(base_color, 1, cosine);
    const Channel one = channel == Channel::all ? Channel::green : channel;  // metals do not disperse
    return film == 0 || metallic == 0 ? plain : glm::mix(plain, film_on_metal(cosine, leaving, one), film);
}

Vec3 Optics::wall_reflectance(real cosine, bool leaving, Channel channel) const {
    const Vec3 face = face_reflectance(cosine, leaving, channel);
    return transmits() && thin ? 2.0 * face / (1.0 + face) : face;
}

Vec3 Surface::start(const Vec3& point, const Vec3& direction) const {
    return point + geometric * (glm::dot(direction, geometric) >= 0 ? error : -error);
}

Surfaces::Surfaces(const Scene& scene, const Geometry& geometry) : scene_(scene), geometry_(geometry), mipmaps_(scene) {
    for (const Material& m : scene.materials) {
        optics_.emplace_back(m);
        const auto uses = {&m.transmission_texture,
                           &m.clearcoat_texture,
                           &m.coat_roughness_texture,
                           &m.sheen_color_texture,
                           &m.sheen_roughness_texture,
                           &m.iridescence_texture,
                           &m.film_thickness_texture,
                           &m.diffuse_transmission_texture,
                           &m.diffuse_transmission_color_texture,
                           &m.specular_texture,
                           &m.specular_color_texture};
        const bool textured = std::ranges::any_of(uses, [](const MaterialTexture* use) { return bool(*use); });
        is_plain_.push_back(!textured && m.diffuse_transmission == 0);
    }
}

namespace {

/// Seen from one side a stretched lobe has one width: masking knows no other.
real masked_roughness(const Surface& s, const Vec3& direction) {
    if (s.optics.anisotropy == 0) return s.optics.roughness;
    const Vec2 alphas = s.optics.alphas();
    const Vec2 across(glm::dot(direction, s.along), glm::dot(direction, glm::cross(s.normal, s.along)));
    const real length2 = glm::dot(across, across);
    const Vec2 wide = alphas * across;
    return std::pow(length2 > 0 ? glm::dot(wide, wide) / length2 : glm::dot(alphas, alphas) / 2, 0.25);
}

}  // namespace

/// `normal`: in place of that of a triangle without an area. Returns the length of the cross product of its edges.
real Surfaces::face_at(uint32_t triangle, const Vec3 (&p)[3], const Vec3& normal, const Vec3& direction,
                       Face& face) const {
    face.extent = 0;
    for (const Vec3& corner : p)
        face.extent = std::max({face.extent, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    face.material = geometry_.materials[triangle];
    const Vec3 area = glm::cross(p[1] - p[0], p[2] - p[0]);
    const real size = glm::length(area);
    face.geometric = size > 0 ? area / size : normal;
    face.front = glm::dot(face.geometric, direction) < 0;
    if (!face.front) face.geometric = -face.geometric;
    return size;
}

Face Surfaces::face_at(uint32_t triangle, real u, real v, const Vec3& direction) const {
    const auto [a, b, c] = corners(triangle);
    const Vec3 p[3] = {a, b, c};
    Face face;
    return face_at(triangle, p, Vec3(0), direction, face) > 0 ? face : at(triangle, u, v, direction);
}

Surface Surfaces::at(uint32_t triangle, real u, real v, const Vec3& direction, real width) const {
    const glm::uvec3 corners = geometry_.triangles[triangle];
    Place place{corners, {std::max(0.0, 1 - u - v), u, v}, 0, nullptr, {}};
    const Vec3& weights = place.weights;
    Vec3 p[3], n[3];
    for (int i = 0; i < 3; i++) {
        p[i] = geometry_.positions[corners[i]];
        n[i] = geometry_.normals[corners[i]];
    }
    const auto interpolate = [&](const auto& values) {
        return values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2];
    };
    Surface s;
    const Vec3 interpolated = interpolate(n);
    const Vec3 normal = glm::dot(interpolated, interpolated) > 0 ? glm::normalize(interpolated) : Vec3(0, 1, 0);
    const real size = face_at(triangle, p, normal, direction, s);
    s.position = interpolate(p);
    s.error = position_rounding * s.extent;
    // The cone's cross-section, seen slanted (Akenine-Möller et al., JCGT 2021).
    const real slope = std::max(std::abs(glm::dot(s.geometric, direction)), LEAST_COSINE);
    if (size > 0) place.seen = 2 * width * width / (slope * size);
    const real side = glm::dot(normal, s.geometric) < -NORMAL_IN_PLANE ? -1 : 1;
    const Material& m = scene_.materials[s.material];
    const auto seen = [&](const MaterialTexture& use, real scale) {
        const Vec3 turned = bent(use, scale, place, interpolated).value_or(normal);
        return optics::visible_normal(side * turned, s.geometric, -direction);
    };
    s.normal = seen(m.normal_texture, m.normal_scale);
    s.coat_normal = m.clearcoat > 0 ? seen(m.coat_normal_texture, m.coat_normal_scale) : s.normal;
    real turn = 0, way = 0;
    for (int i = 0; i < 3; i++) {
        const Vec3 edge = p[(i + 1) % 3] - p[i];
        turn += side * glm::dot(n[(i + 1) % 3] - n[i], edge);
        way += glm::dot(edge, edge);
    }
    s.curvature = way > 0 ? turn / way : 0;
    s.shadow_start = Vec3(0);
    for (int i = 0; i < 3; i++) {
        // The position, lifted to the plane through each corner along the corner's normal.
        const Vec3 corner_normal = side * n[i];
        const real below = std::min(0.0, glm::dot(s.position - p[i], corner_normal));
        const bool stray = glm::dot(corner_normal, s.geometric) <= STRAY_NORMAL;
        s.shadow_start += weights[i] * (stray ? s.position : s.position - below * corner_normal);
    }
    s.optics = evaluate(s.material, place);
    if (s.optics.anisotropy > 0) stretch(s, place, interpolated);
    s.mean_roughness = masked_roughness(s, direction);
    return s;
}

std::optional<Vec3> Surfaces::plain_emission(uint32_t triangle, real u, real v) const {
    const uint32_t material = geometry_.materials[triangle];
    const Material& m = scene_.materials[material];
    if (m.clearcoat > 0 || m.blended) return {};
    const Place place{geometry_.triangles[triangle], {std::max(0.0, 1 - u - v), u, v}, 0, nullptr, {}};
    return optics_[material].emissive * color(m.emissive_texture, place);
}

bool Surfaces::blocks_itself(const Surface& s, uint32_t triangle, const Vec3& direction) const {
    const real height = glm::dot(s.shadow_start - s.position, s.geometric), fall = -glm::dot(direction, s.geometric);
    if (fall <= 0) return false;
    // Where the ray meets the plane: weights of the corners as areas, against the whole triangle's.
    const Vec3 crossing = s.shadow_start + direction * (height / fall);
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const Vec3 winding = s.front ? s.geometric : -s.geometric;
    const auto area = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        return glm::dot(glm::cross(b - a, c - a), winding);
    };
    const Vec3 a = geometry_.positions[corners.x], b = geometry_.positions[corners.y],
               c = geometry_.positions[corners.z];
    const real least = std::min({area(a, b, crossing), area(b, c, crossing), area(c, a, crossing)});
    return least >= -OWN_TRIANGLE_RIM * area(a, b, c);
}

namespace {

/// Do two uses map a texture alike?
bool maps_alike(const MaterialTexture& a, const MaterialTexture& b) {
    return &a == &b || (a.uv_set == b.uv_set && a.uv_matrix == b.uv_matrix && a.uv_offset == b.uv_offset);
}

}  // namespace

void Surfaces::map(const MaterialTexture& use, const Place& place) const {
    if (place.last_mapped && maps_alike(*place.last_mapped, use)) return;
    const std::vector<glm::vec2>& uvs = geometry_.uv_set(use.uv_set);
    const Vec2 a(uvs[place.corners.x]), b(uvs[place.corners.y]), c(uvs[place.corners.z]);
    const Mat2 matrix(use.uv_matrix);
    place.mapped = matrix * (a * place.weights.x + b * place.weights.y + c * place.weights.z) + Vec2(use.uv_offset);
    place.mapped_area = std::abs(glm::determinant(matrix * Mat2(b - a, c - a))) / 2;
    place.last_mapped = &use;
}

template <typename Sample>
auto Surfaces::filtered(const MaterialTexture& use, const Place& place, bool is_data, Sample sample) const {
    map(use, place);
    const Texture& texture = scene_.textures[size_t(use.texture)];
    // How many texels the footprint covers, as the triangle maps them.
    const real texels = place.seen * place.mapped_area * texture.width * texture.height;
    if (!(texels > 1)) return sample(texture, place.mapped, texture.nearest);
    const LevelChoice choice = choose_level(texture, std::log2(texels) / 2);
    const auto level = [&](uint32_t i) {
        return sample(i == 0 ? texture : mipmaps_.of(use.texture, is_data)[i - 1], place.mapped, choice.nearest);
    };
    if (choice.part == 0) return level(choice.first);
    return glm::mix(level(choice.first), level(choice.second), real(choice.part));
}

Vec4 Surfaces::data(const MaterialTexture& use, const Place& place, bool is_data) const {
    const MaterialTexture* last = place.last_use;
    if (is_data && last && last->texture == use.texture && maps_alike(*last, use)) return place.last_data;
    const Vec4 found = filtered(use, place, is_data, [](const Texture& texture, const Vec2& at, bool nearest) {
        return sample_data(texture, at, nearest);
    });
    if (is_data) {
        place.last_use = &use;
        place.last_data = found;
    }
    return found;
}

real Surfaces::number(const MaterialTexture& use, const Place& place) const {
    return use ? data(use, place)[int(use.channel)] : 1;
}

Vec3 Surfaces::color(const MaterialTexture& use, const Place& place) const {
    if (!use) return Vec3(1);
    return filtered(use, place, false, [](const Texture& texture, const Vec2& at, bool nearest) {
        return sample_color(texture, at, nearest);
    });
}

Optics Surfaces::evaluate(uint32_t material, const Place& place) const {
    const Material& m = scene_.materials[material];
    Optics o = optics_[material];
    if (!geometry_.colors.empty()) o.base_color *= Vec3(place.interpolate(geometry_.colors));
    o.base_color *= color(m.base_color_texture, place);
    if (m.blended) {
        o.alpha = real(m.alpha);
        if (!geometry_.colors.empty()) o.alpha *= place.interpolate(geometry_.colors).w;
        if (m.base_color_texture) o.alpha *= data(m.base_color_texture, place, false).w;
        if (o.alpha >= ALPHA_WHOLE) o.alpha = 1;
    }
    if (o.emissive != Vec3(0)) o.emissive *= color(m.emissive_texture, place);
    o.metallic *= number(m.metallic_texture, place);
    o.roughness *= number(m.roughness_texture, place);
    o.occlusion = 1 + real(m.occlusion_strength) * (number(m.occlusion_texture, place) - 1);
    o.clearcoat = real(m.clearcoat);
    o.coat_roughness = real(m.coat_roughness);
    if (!is_plain_[material]) evaluate_rare(o, m, place);
    return o;
}

void Surfaces::evaluate_rare(Optics& o, const Material& m, const Place& place) const {
    o.transmission *= number(m.transmission_texture, place);
    o.clearcoat *= number(m.clearcoat_texture, place);
    o.coat_roughness *= number(m.coat_roughness_texture, place);
    o.sheen *= color(m.sheen_color_texture, place);
    o.sheen_roughness *= number(m.sheen_roughness_texture, place);
    o.film *= number(m.iridescence_texture, place);
    o.film_thickness = glm::mix(real(m.film_least), real(m.film_most), number(m.film_thickness_texture, place));
    o.behind *= number(m.diffuse_transmission_texture, place);
    o.behind_color *= color(m.diffuse_transmission_color_texture, place);
    if (!o.thin && o.behind > 0)
        o.behind_color *= glm::exp(-o.absorption * real(m.thickness) * number(m.thickness_texture, place));
    if (m.specular_texture || m.specular_color_texture) {
        o.f90 *= number(m.specular_texture, place);
        o.f0 = glm::min(o.normal * Vec3(m.specular_color) * color(m.specular_color_texture, place), 1.0) * o.f90;
        o.specified = true;
    }
}

std::optional<Mat2x3> Surfaces::tangents(const Place& place, const Vec3& normal) const {
    if (geometry_.tangents.empty()) return {};
    const Vec4 along = place.interpolate(geometry_.tangents);
    const Vec3 tangent(along);
    if (along.w == 0 || glm::dot(tangent, tangent) == 0) return {};
    return Mat2x3(tangent, (along.w < 0 ? -1.0 : 1.0) * glm::cross(normal, tangent));
}

/// glTF 2.0, section 3.9.3: red, green and blue are the normal's parts along the tangent, the bitangent and the normal,
/// which are interpolated and, as MikkTSpace has it, not made unit before.
std::optional<Vec3> Surfaces::bent(const MaterialTexture& use, real scale, const Place& place,
                                   const Vec3& normal) const {
    if (!use) return {};
    const auto frame = tangents(place, normal);
    if (!frame) return {};
    const Vec3 texel(data(use, place));
    const Vec3 parts = (texel * 2.0 - 1.0) * Vec3(scale, scale, 1);
    const Vec3 sum = *frame * Vec2(parts) + normal * parts.z;
    if (glm::dot(sum, sum) == 0) return {};
    return glm::normalize(sum);
}

/// KHR_materials_anisotropy: how much the lobe is stretched, and its direction on the surface; none: it is round.
void Surfaces::stretch(Surface& s, const Place& place, const Vec3& normal) const {
    const Material& m = scene_.materials[s.material];
    real strength = s.optics.anisotropy;
    s.optics.anisotropy = 0;
    const auto frame = tangents(place, normal);
    if (!frame) return;
    Vec2 direction(1, 0);
    if (m.anisotropy_texture) {
        const Vec3 texel(data(m.anisotropy_texture, place));
        direction = Vec2(texel) * 2.0 - 1.0;
        strength *= texel.z;
    }
    const real c = std::cos(real(m.anisotropy_rotation)), sine = std::sin(real(m.anisotropy_rotation));
    const Vec2 turned(c * direction.x - sine * direction.y, sine * direction.x + c * direction.y);
    const Vec3 along = *frame * turned, flat = along - glm::dot(along, s.normal) * s.normal;
    if (glm::dot(flat, flat) == 0) return;
    s.along = glm::normalize(flat);
    s.optics.anisotropy = strength;
}

}  // namespace peelray::inline PRECISION
