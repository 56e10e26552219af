// Photons: what becomes of them at surfaces, and the light that those around a hit bring (docs/frame.md section 5).
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "reference/lamp_shape.h"
#include "reference/optics.h"
#include "reference/photon_flight.h"

namespace peelray::inline PRECISION {

using namespace optics;

/// Is a lobe one that photons are reflected by? Coats are no metal.
bool Shader::photons_follow(real roughness, real metallic) {
    return roughness < TRACED_ROUGHNESS || metallic > MOSTLY_METAL;
}

/// Does another ray's light lack what the material's lobe mirrors, since photons bring it?
bool Shader::photons_bring_lobe(const Optics& m, const Path& path) const {
    return context_.photons && path.scattered > 0 && (m.transmits() || photons_follow(m.lobe_roughness(), m.metallic));
}

bool Shader::photons_bring_coat(const Optics& m, const Path& path) const {
    return context_.photons && path.scattered > 0 && photons_follow(m.coat_roughness, 0);
}

/// The share of light that a surface scatters at most; photons come to rest where that is more than nothing.
static real resting_share(const Optics& m) {
    return m.unlit ? real(0) : (1 - m.metallic) * (1 - m.transmission);
}

/// The density of the flux of the photons around, by Epanechnikov's kernel, times what the surface scatters of it.
Vec3 Shader::caustic_light(const Lit& at) const {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    Vec3 sum(0);
    if (!context_.photons || resting_share(m) == 0) return sum;
    const real radius = context_.photons->radius();
    const Vec3 view = -at.path.direction;
    context_.photons->visit(s.position, [&](const RestingPhoton& photon, real distance2) {
        if (std::abs(glm::dot(photon.position - s.position, s.geometric)) > PHOTON_FLATNESS * radius) return;
        const Vec3 to_light = -photon.direction;
        const real n_l = glm::dot(s.normal, to_light), side = glm::dot(photon.normal, s.geometric);
        const bool from_behind = m.behind > 0 && n_l < 0;
        if ((from_behind ? -side : side) < PHOTON_SAME_SIDE) return;
        Vec3 share(0);
        if (from_behind) {
            share = m.behind * at.seen.scattered * at.seen.sheen * m.behind_color;
        } else if (n_l > 0) {
            const real v_h = std::clamp(glm::dot(view, glm::normalize(view + to_light)), 0.0, 1.0);
            const Vec3 mirrored = m.wall_reflectance(v_h, m.leaves(s.front), Channel::green);
            share = (1 - m.behind) * (1 - largest(mirrored)) * m.base_color;
            if (largest(m.sheen) > 0) share *= std::min(at.seen.sheen, below_sheen(s, n_l));
        }
        sum += photon.flux * share * (1 - distance2 / (radius * radius));
    });
    return sum * resting_share(m) * (1 - at.seen.coat) * 2.0 / (pi * pi * radius * radius);
}

namespace {

enum class Fate { rest, pass, reflection, refraction, loss };

/// Probabilities of a photon's fates; it is lost with what is left of 1.
struct Fates {
    std::array<real, 4> of;  ///< by Fate

    Fate drawn(real random) const {
        for (size_t i = 0; i < of.size(); i++) {
            if (random < of[i]) return Fate(i);
            random -= of[i];
        }
        return Fate::loss;
    }
};

/// By the photon's light that takes each way, over the usual light of a photon, which what goes on is to have; nothing
/// else need happen to what may rest.
Fates fates_of(real rests, real passes, real reflects, real refracts) {
    const real others = passes + reflects + refracts;
    if (rests > 0) rests = others == 0 ? real(1) : std::max(rests / (rests + others), real(PHOTON_LEAST_END));
    const real rest = (1 - rests) / std::max(others, real(1));
    return {{rests, passes * rest, reflects * rest, refracts * rest}};
}

}  // namespace

/// Where the photon comes to rest; nowhere where it is lost.
std::optional<RestingPhoton> Shader::fly(const SentPhoton& sent, uint32_t seed, real usual) const {
    Path path;
    path.origin = sent.origin;
    path.direction = sent.direction;
    path.seed = seed;
    Vec3 flux = sent.flux;
    const uint32_t last = context_.bounce_levels;
    for (uint32_t specular = 0; path.level <= last && flux != Vec3(0); path.level++) {
        const Meeting meeting = hit(path);
        if (!meeting.hit.hit()) break;
        Surface surface = context_.surfaces.at(meeting.hit.triangle, meeting.hit.u, meeting.hit.v, path.direction);
        surface.error = std::max(surface.error, meeting.lift);
        flux *= meeting.passed * transmittance(meeting.before.counting(context_.media), meeting.hit.t);
        path.media = meeting.before;
        path.length += meeting.hit.t;
        const real coverage = surface.optics.alpha;
        surface.optics.alpha = 1;
        const Scattered out = scatter(surface, path, meeting);
        const bool ends = path.level == last || surface.optics.catcher,
                   bounces = !ends && specular < context_.settings.bounces;
        const Vec3 light = glm::abs(flux) / usual;
        const auto weight = [&](const Branch& branch) {
            const bool on = branch.mirrors ? context_.settings.reflection
                                           : context_.settings.refraction && context_.settings.shadow;
            return bounces && on ? coverage * largest(light * branch.weight) : real(0);
        };
        const Fates fates =
            fates_of(specular > 0 ? coverage * resting_share(surface.optics) * largest(light) : 0,
                     ends ? 0 : (1 - coverage) * largest(light), weight(out.reflection), weight(out.refraction));
        const Vec2 u = random(path, RANDOM_PHOTON_WAY);
        const Fate fate = fates.drawn(u.x);
        if (fate == Fate::loss) break;
        const real scale = (fate == Fate::pass ? 1 - coverage : coverage) / fates.of[size_t(fate)];
        if (fate == Fate::rest)
            return RestingPhoton{surface.position, surface.geometric, path.direction,
                                 flux * within_range(*sent.light, path.length) / fates.of[0]};
        Branch next = fate == Fate::reflection ? out.reflection : out.refraction;
        if (fate == Fate::refraction && !out.split.empty()) {
            next = out.split[std::min(size_t(u.y * 3), size_t(2))];
            next.weight *= 3;
        }
        if (fate == Fate::pass) {
            next = Branch();
            next.weight = Vec3(1);
            next.direction = path.direction;
            next.media = meeting.behind;
        }
        flux *= next.weight * scale;
        specular += fate != Fate::pass;
        path.origin = surface.start(surface.position, next.direction);
        path.direction = next.direction;
        path.media = next.media;
        path.skip = meeting.hit.triangle;
        if (next.channel != Channel::all) path.channel = next.channel;
    }
    return std::nullopt;
}

std::vector<RestingPhoton> fly_photons(const RenderContext& context, const PhotonPlan& plan, const PhotonPass& pass) {
    std::vector<std::optional<RestingPhoton>> all(plan.photons);
    parallel_for(all.size(), 256, [&](size_t i) {
        const uint32_t number = uint32_t(i);
        const SentPhoton sent = send_photon(context, plan, pass, number);
        all[i] = Shader(context, {number, pass.bits, pass.picture}).fly(sent, pass.seed, real(plan.flux));
    });
    std::vector<RestingPhoton> resting;
    for (const auto& photon : all)
        if (photon) resting.push_back(*photon);
    return resting;
}

}  // namespace peelray::inline PRECISION
