#include "reference/shader.h"

#include <algorithm>
#include <cmath>

#include "reference/optics.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

/// Paths that bring a pixel this much of its light, per sample, are followed for certain, and those that bring the most
/// of it that is asked for: at 64 samples the error that the others leave is about 2 % of what they bring.
constexpr real ROULETTE_PER_SAMPLE = 1.0 / 192, MOST_ROULETTE = 1.0 / 3;
constexpr uint32_t LEAST_FOR_ROULETTE = 32;

}  // namespace

Meeting Shader::hit(const Path& path, const Hit* first) const {
    return walk().next({path.origin, 0, path.direction, endless}, path.skip, path.media, false, first);
}

Vec3 Shader::transmittance(uint32_t medium, real distance) const {
    if (medium == Media::air) return Vec3(1);
    const Vec3& absorption = context_.surfaces.optics(medium).absorption;
    return absorption == Vec3(0) ? Vec3(1) : glm::exp(-absorption * distance);
}

Vec3 Shader::radiance(const Path& arriving, const Meeting& meeting) {
    const Hit& hit = meeting.hit;
    if (!hit.hit()) return meeting.passed * missed(arriving, arriving.weight * meeting.passed);
    const real width = arriving.cone.width_at(hit.t);
    Surface surface = context_.surfaces.at(hit.triangle, hit.u, hit.v, arriving.direction, width);
    surface.error = std::max(surface.error, meeting.lift);
    const Vec3 kept = meeting.passed * transmittance(meeting.before.counting(context_.media), hit.t);
    Path path = arriving;
    path.weight *= kept;
    path.media = meeting.before;
    path.cone.width = width;  // at the hit
    path.length += hit.t;
    const Scattered scattered = scatter(surface, path, meeting);
    if (surface.optics.catcher) return kept * caught(surface, path, meeting, scattered.reflection);
    Vec3 sum = scattered.radiance;
    if (path.level == 0 && surface.optics.unlit) {
        const Branch& on = scattered.refraction;
        unlit_ = kept * (sum + (on.traced ? Vec3(0) : untraced(on, path)));
    }
    const std::optional<uint32_t> guiding = guiding_branch(surface, path, scattered);
    if (context_.before && path.guided) look_back(path, meeting.hit, guiding, scattered);
    // The reference goes on in all of them; the GPU's rays do not.
    if (path.level > 0) rays_.crowded += meeting.behind.kinds() > std::max<size_t>(MEDIA_TOGETHER, path.media.kinds());
    if (scattered.reflection.traced) rays_.reflection++;
    rays_.cut_reflection += is_cut(scattered.reflection, path);
    sum += follow(scattered.reflection, surface, path, hit.triangle, 0, guiding == 0u);
    const Branch& whole = scattered.refraction;
    (whole.mirrors ? rays_.cut_reflection : rays_.cut_refraction) += is_cut(whole, path);
    Vec3 beside(0);
    const auto second = [&](const Branch& branch) {
        if (branch.traced) (branch.mirrors ? rays_.reflection : rays_.refraction)++;
        beside += follow(branch, surface, path, hit.triangle, 1, guiding == 1u);
    };
    if (scattered.split.empty()) second(whole);
    for (const Branch& channel : scattered.split) second(channel);
    sum += beside;
    const Vec3 lit = surface.optics.unlit ? Vec3(0) : scattered_light(surface, path, meeting);
    sum += lit;
    if (path.guided && !guiding) guide(surface, path, sum, beside, lit);
    return kept * sum;
}

/// Light from lamps and from what else is not mirrored.
Vec3 Shader::scattered_light(const Surface& s, const Path& path, const Meeting& meeting) {
    const Seen seen = this->seen(s, path);
    const bool volume = meeting.wall && s.optics.transmits() && !s.optics.thin;
    const Lit at{s, meeting.hit.triangle, path, seen, volume ? meeting.behind : path.media};
    const Branch diffuse = diffuse_branch(at);
    const bool sky = context_.filters_environment() || !diffuse.traced;
    const Vec3 direct = s.optics.alpha * (direct_light(at, sky) + caustic_light(at));
    if (!diffuse.traced) return direct;
    rays_.diffuse++;
    return direct + follow(diffuse, s, path, at.triangle, 2);
}

/// A branch that no ray follows sees the environment or, straight from the camera, what is to be seen instead.
Vec3 Shader::untraced(const Branch& branch, const Path& path) const {
    if (branch.passes && path.is_straight() && context_.settings.backdrop.kind != Backdrop::Kind::environment)
        return branch.weight * backdrop(branch.direction);
    const Vec2 place = Surroundings::place(branch.direction);
    const Vec3 weight = branch.weight * environment_share(place, branch.density);
    const bool filters = context_.filters_environment();
    if (filters && !branch.sees_sun) return weight * filtered_lobe(branch.direction, branch.cone);
    const real blur = std::max(filters ? 0 : branch.blur, environment_blur(branch.cone, branch.density));
    return weight * context_.surroundings.radiance_at(place, blur);
}

/// The light of one of a hit's branches; `which`: 0 the first, 1 the second, which a channel is a
/// part of, 2 the diffuse one.
Vec3 Shader::follow(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle, uint32_t which,
                    bool guided) {
    if (branch.weight == Vec3(0)) return Vec3(0);
    if (!branch.traced) {
        if (branch.passes && path.is_straight()) through_ += luminance(path.weight * branch.weight);
        return untraced(branch, path);
    }
    Path next = next_path(branch, surface, path, triangle, which);
    next.guided = guided;
    const real kept = guided ? 1 : roulette(largest(next.weight), path, RANDOM_ROULETTE + which);
    if (kept == 0) return Vec3(0);
    next.weight /= kept;
    if (!is_reference && next.density > 0) {
        // What the ray sees if it meets nothing comes while it is traced.
        next.ahead = Surroundings::place(next.direction);
        context_.surroundings.prefetch(*next.ahead, context_.samples_environment());
    }
    return branch.weight * radiance(next, hit(next)) / kept;
}

/// Chance that a path was followed which brings that much of a pixel's usual light, 0 if it is not. The reference
/// follows all: in single precision one that brings so little that a picture's samples level out whether it is there
/// goes on as often as it is bright, and brings as much more (Arvo and Kirk, Particle Transport and Image Synthesis,
/// 1990).
real Shader::roulette(real brings, const Path& path, uint32_t purpose) const {
    // A bound on samples would take what the paths that are followed bring for the others.
    if (is_reference || context_.settings.spp < LEAST_FOR_ROULETTE || context_.settings.clamp) return 1;
    const real enough = std::min(MOST_ROULETTE, context_.settings.spp * ROULETTE_PER_SAMPLE);
    if (!(brings < enough)) return 1;
    return random(path, purpose).x * enough < brings ? brings / enough : 0;
}

Shader::Path Shader::next_path(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle,
                               uint32_t which) {
    Path next;
    next.origin = surface.start(surface.position, branch.direction);
    next.direction = branch.direction;
    next.skip = triangle;
    next.weight = path.weight * branch.weight;
    next.media = branch.media;
    next.cone = branch.cone;
    next.sees_sun = branch.sees_sun;
    next.density = branch.density;
    next.seed = branch_seed(path.seed, which, path.level);
    next.level = path.level + 1;
    next.scattered = path.scattered + (which == 2);
    next.passed = path.passed + branch.passes;
    next.channel = branch.channel == Channel::all ? path.channel : branch.channel;
    next.length = path.length;
    return next;
}

/// What a surface shows that holds nothing but shadows and mirror images: of what is behind it the share of its light
/// that arrives, less what mirror images cover, and these.
Vec3 Shader::caught(const Surface& s, const Path& path, const Meeting& meeting, const Branch& reflection) {
    if (path.level == 0) catches_ = true;
    const uint32_t triangle = meeting.hit.triangle;
    const Seen at_point = this->seen(s, path);
    Vec3 left = left_by_shadows({s, triangle, path, at_point, path.media}), mirrored(0);
    rays_.cut_reflection += is_cut(reflection, path);
    if (reflection.traced) {
        rays_.reflection++;
        const Path next = next_path(reflection, s, path, triangle, 0);
        const Meeting seen = hit(next);
        if (seen.hit.hit()) {
            mirrored = reflection.weight * radiance(next, seen);
            left *= 1.0 - reflection.weight;
        }
    }
    return mirrored + left * missed(path, path.weight * left);
}

/// What the camera sees where nothing is before it.
Vec3 Shader::backdrop(const Vec3& direction) const {
    const Backdrop& seen = context_.settings.backdrop;
    return seen.kind == Backdrop::Kind::blurred ? context_.surroundings.blurred(direction) : Vec3(seen.color);
}

/// What a ray that hits nothing sees; `weight`: of the pixel's light.
Vec3 Shader::missed(const Path& path, const Vec3& weight) {
    const bool straight = path.is_straight();
    if (straight) through_ += luminance(weight);
    if (straight && context_.settings.backdrop.kind != Backdrop::Kind::environment) return backdrop(path.direction);
    const Vec2 place = path.ahead ? *path.ahead : Surroundings::place(path.direction);
    const real share = environment_share(place, path.density);
    if (share == 0) return Vec3(0);
    if (context_.filters_environment() && !path.sees_sun) return share * filtered_lobe(path.direction, path.cone);
    return share * context_.surroundings.seen(path.direction, place, environment_blur(path.cone, path.density),
                                              path.sees_sun, context_.rough_limit);
}

/// Has the path come as far as it is followed, but for what `passes` straight through a blended surface? Diffuse
/// bounces are counted apart.
bool Shader::is_last(const Path& path, bool passes) const {
    if (path.level >= context_.last_level) return true;
    const uint32_t most = context_.bounce_levels;
    return path.level - path.scattered >= (passes ? most : std::min(most, context_.settings.bounces + path.passed));
}

/// Is it bright enough, and its effect on?
bool Shader::is_wanted(const Branch& branch, const Path& path) const {
    const bool effect = branch.mirrors ? context_.settings.reflection : context_.settings.refraction;
    return effect && largest(branch.weight * path.weight) >= LEAST_WEIGHT;
}

bool Shader::is_traced(const Branch& branch, const Path& path) const {
    return is_wanted(branch, path) && !is_last(path, branch.passes);
}

/// Would it be traced if it were not too far along the path? With no bounces at all nobody asked for it.
bool Shader::is_cut(const Branch& branch, const Path& path) const {
    return context_.settings.bounces > 0 && path.level > 0 && is_wanted(branch, path) && is_last(path, branch.passes);
}

}  // namespace peelray::inline PRECISION
