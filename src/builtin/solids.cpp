#include "builtin/solids.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/normals.h"
#include "scene/triangulate.h"

namespace peelray {

void add_shape(Primitive& out, const Primitive& part, const glm::mat4& transform) {
    const auto first = uint32_t(out.positions.size());
    const glm::mat3 linear(transform), turn = glm::transpose(glm::inverse(linear));
    for (const glm::vec3& p : part.positions) out.positions.push_back(linear * p + glm::vec3(transform[3]));
    for (const glm::vec3& n : part.normals) out.normals.push_back(glm::normalize(turn * n));
    out.uvs.insert(out.uvs.end(), part.uvs.begin(), part.uvs.end());
    const bool mirrors = glm::determinant(linear) < 0;
    for (const glm::uvec3& t : part.triangles)
        out.triangles.push_back((mirrors ? glm::uvec3(t.x, t.z, t.y) : t) + first);
}

Primitive finished(Primitive shape, float crease_degrees) {
    make_smooth(shape, glm::radians(crease_degrees));
    return shape;
}

Primitive lathe(std::span<const glm::vec2> profile, uint32_t segments, bool closed) {
    Primitive out;
    const auto rings = uint32_t(profile.size());
    std::vector<uint32_t> first;
    for (const glm::vec2& p : profile) {
        first.push_back(uint32_t(out.positions.size()));
        // A ring on the axis is one point.
        const uint32_t count = p.x == 0 ? 1 : segments;
        for (uint32_t j = 0; j < count; j++) {
            const double angle = 2 * std::numbers::pi * j / segments;
            out.positions.emplace_back(p.x * std::cos(angle), p.y, p.x * std::sin(angle));
        }
    }
    for (uint32_t i = 0; i + 1 < rings + closed; i++) {
        const uint32_t next = (i + 1) % rings;
        for (uint32_t j = 0; j < segments; j++) {
            const auto at = [&](uint32_t ring, uint32_t k) {
                return first[ring] + (profile[ring].x == 0 ? 0 : k % segments);
            };
            const uint32_t a = at(i, j), b = at(next, j), c = at(next, j + 1), d = at(i, j + 1);
            if (b != c) out.triangles.push_back({a, b, c});
            if (a != d) out.triangles.push_back({a, c, d});
        }
    }
    return out;
}

namespace {

/// A curve through points, finely.
template <typename Point>
class Curve {
  public:
    explicit Curve(std::span<const Point> points) {
        constexpr int fine = 24;
        dense_.push_back(points.front());
        length_.push_back(0);
        for (size_t i = 0; i + 1 < points.size(); i++) {
            const Point &b = points[i], &c = points[i + 1];
            // Beyond an end it goes straight on.
            const Point a = i == 0 ? 2.f * b - c : points[i - 1],
                        d = i + 2 == points.size() ? 2.f * c - b : points[i + 2];
            const float t1 = std::sqrt(glm::distance(a, b)), t2 = t1 + std::sqrt(glm::distance(b, c)),
                        t3 = t2 + std::sqrt(glm::distance(c, d));
            for (int k = 1; k <= fine; k++) {
                // Barry and Goldman's pyramid.
                const float t = t1 + (t2 - t1) * float(k) / fine;
                const Point ab = a + (b - a) * (t / t1), bc = b + (c - b) * ((t - t1) / (t2 - t1)),
                            cd = c + (d - c) * ((t - t2) / (t3 - t2));
                const Point abc = ab + (bc - ab) * (t / t2), bcd = bc + (cd - bc) * ((t - t1) / (t3 - t1));
                const Point at = k == fine ? c : abc + (bcd - abc) * ((t - t1) / (t2 - t1));
                length_.push_back(length_.back() + glm::distance(at, dense_.back()));
                dense_.push_back(at);
            }
            ends_.push_back(length_.back());
        }
    }

    std::vector<Point> evenly(uint32_t count) const {
        std::vector<Point> out{dense_.front()};
        const auto begin = [&](size_t i) { return i == 0 ? 0 : ends_[i - 1]; };
        if (count < ends_.size()) {
            for (uint32_t i = 1; i < count; i++) out.push_back(at(length_.back() * float(i) / float(count)));
            out.push_back(dense_.back());
            return out;
        }
        // Each further piece shortens those that are longest.
        std::vector<uint32_t> pieces(ends_.size(), 1);
        for (size_t left = count - ends_.size(); left > 0; left--) {
            size_t longest = 0;
            for (size_t i = 1; i < ends_.size(); i++)
                if ((ends_[i] - begin(i)) / float(pieces[i]) >
                    (ends_[longest] - begin(longest)) / float(pieces[longest]))
                    longest = i;
            pieces[longest]++;
        }
        for (size_t i = 0; i < ends_.size(); i++)
            for (uint32_t k = 1; k <= pieces[i]; k++)
                out.push_back(at(begin(i) + (ends_[i] - begin(i)) * float(k) / float(pieces[i])));
        return out;
    }

  private:
    Point at(float length) const {
        const auto above = std::upper_bound(length_.begin(), length_.end() - 1, length);
        const auto i = size_t(above - length_.begin());
        return glm::mix(dense_[i - 1], dense_[i], (length - length_[i - 1]) / (length_[i] - length_[i - 1]));
    }

    std::vector<Point> dense_;
    std::vector<float> length_;  ///< up to each of them
    std::vector<float> ends_;    ///< the lengths up to the points that the curve goes through, but for the first
};

}  // namespace

Outline smooth_line(std::span<const glm::vec2> points, uint32_t count) {
    return Curve<glm::vec2>(points).evenly(count);
}

std::vector<glm::vec3> smooth_path(std::span<const glm::vec3> points, uint32_t count) {
    return Curve<glm::vec3>(points).evenly(count);
}

namespace {

/// A corner of a cross-section: on a superellipse, evenly in angle.
glm::vec2 section_corner(const CrossSection& section, uint32_t i, uint32_t sides) {
    const float angle = kTurn * (float(i) + 0.5f) / float(sides), power = 1 - 0.75f * section.squareness;
    const auto bent = [&](float x) { return std::copysign(std::pow(std::abs(x), power), x); };
    return section.half * glm::vec2(bent(std::cos(angle)), bent(std::sin(angle)));
}

}  // namespace

Primitive sweep(std::span<const glm::vec3> path, uint32_t sides, const std::function<CrossSection(float)>& section,
                const glm::vec3& up, bool closed) {
    Primitive out;
    const size_t count = path.size();
    glm::vec3 above = up;
    for (size_t i = 0; i < count; i++) {
        const glm::vec3 &before = path[i > 0    ? i - 1
                                       : closed ? count - 1
                                                : 0],
                        &after = path[i + 1 < count ? i + 1
                                      : closed      ? 0
                                                    : i];
        const glm::vec3 along = glm::normalize(after - before);
        above = glm::normalize(above - along * glm::dot(above, along));
        const glm::vec3 side = glm::cross(along, above);
        const CrossSection here = section(float(i) / float(closed ? count : count - 1));
        for (uint32_t k = 0; k < sides; k++) {
            const glm::vec2 corner = section_corner(here, k, sides);
            out.positions.push_back(path[i] + side * corner.x + above * corner.y);
        }
    }
    for (uint32_t i = 0; i + 1 < count + closed; i++)
        for (uint32_t k = 0; k < sides; k++) {
            const uint32_t next = (i + 1) % uint32_t(count), a = i * sides + k, b = i * sides + (k + 1) % sides,
                           c = next * sides + (k + 1) % sides, d = next * sides + k;
            out.triangles.push_back({a, c, b});
            out.triangles.push_back({a, d, c});
        }
    if (closed) return out;
    const auto last = uint32_t(count - 1) * sides;
    for (uint32_t k = 1; k + 1 < sides; k++) {
        out.triangles.push_back({0, k, k + 1});
        out.triangles.push_back({last, last + k + 1, last + k});
    }
    return out;
}

Primitive wire(std::span<const glm::vec3> path, uint32_t sides, float radius, bool closed) {
    const glm::vec3 along = path[1] - path[0],
                    up = std::abs(along.y) < 0.9f * glm::length(along) ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    return sweep(
        path, sides,
        [&](float) {
            return CrossSection{glm::vec2(radius), 0};
        },
        up, closed);
}

Outline circle(const glm::vec2& centre, float radius, uint32_t corners, float phase) {
    Outline out;
    for (uint32_t i = 0; i < corners; i++) {
        const float angle = phase + kTurn * float(i) / float(corners);
        out.push_back(centre + radius * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return out;
}

Outline rounded_rectangle(const glm::vec2& lower, const glm::vec2& upper, float radius, uint32_t steps) {
    Outline out;
    for (int corner = 0; corner < 4; corner++) {
        const glm::vec2 centre(corner == 0 || corner == 3 ? upper.x - radius : lower.x + radius,
                               corner < 2 ? upper.y - radius : lower.y + radius);
        for (uint32_t i = 0; i <= steps; i++) {
            const float angle = kTurn / 4 * (float(corner) + float(i) / float(steps));
            out.push_back(centre + radius * glm::vec2(std::cos(angle), std::sin(angle)));
        }
    }
    return out;
}

Outline bridged(Outline outer, std::span<const Outline> holes) {
    // From the right: then nothing but what is there already lies between a hole's rightmost corner and the polygon
    // (Eberly, "Triangulation by ear clipping", 2002).
    std::vector<const Outline*> order;
    for (const Outline& hole : holes) order.push_back(&hole);
    const auto rightmost = [](const Outline& hole) {
        return std::max_element(hole.begin(), hole.end(), [](auto a, auto b) { return a.x < b.x; });
    };
    std::sort(order.begin(), order.end(), [&](auto* a, auto* b) { return rightmost(*a)->x > rightmost(*b)->x; });
    for (const Outline* hole : order) {
        const auto from = rightmost(*hole);
        // The nearest edge to the right, and of its ends and the corners in the triangle before it the one that is
        // seen under the least angle.
        size_t best = 0;
        float nearest = INFINITY;
        for (size_t i = 0; i < outer.size(); i++) {
            const glm::vec2 a = outer[i], b = outer[(i + 1) % outer.size()];
            if (!(a.y <= from->y && b.y > from->y)) continue;
            const float x = a.x + (b.x - a.x) * (from->y - a.y) / (b.y - a.y);
            if (x >= from->x && x < nearest) nearest = x, best = a.x > b.x ? i : (i + 1) % outer.size();
        }
        const glm::vec2 hit(nearest, from->y), end = outer[best];
        const auto area = [](const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
            return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        };
        // A corner that has ways into other holes already is there several times, each with a part of the view.
        const auto opens = [&](size_t i) {
            const glm::vec2 p = outer[i], before = outer[(i + outer.size() - 1) % outer.size()],
                            after = outer[(i + 1) % outer.size()];
            const bool left = area(before, p, *from) >= 0, right = area(p, after, *from) >= 0;
            return area(before, p, after) >= 0 ? left && right : left || right;
        };
        float least = INFINITY;
        size_t chosen = best;
        for (size_t i = 0; i < outer.size(); i++) {
            const glm::vec2 p = outer[i];
            const float s1 = area(*from, hit, p), s2 = area(hit, end, p), s3 = area(end, *from, p);
            const bool inside = (s1 >= 0 && s2 >= 0 && s3 >= 0) || (s1 <= 0 && s2 <= 0 && s3 <= 0);
            if (!inside || p.x <= from->x || !opens(i)) continue;
            const float slope = std::abs(p.y - from->y) / (p.x - from->x);
            if (slope < least) least = slope, chosen = i;
        }
        Outline way;
        // The hole runs the other way round, since the inside of the polygon lies outside of it.
        for (size_t k = 0; k <= hole->size(); k++)
            way.push_back((*hole)[(size_t(from - hole->begin()) + 2 * hole->size() - k) % hole->size()]);
        way.push_back(outer[chosen]);
        outer.insert(outer.begin() + long(chosen) + 1, way.begin(), way.end());
    }
    return outer;
}

Outline inset(const Outline& outline, float by) {
    Outline out;
    const size_t n = outline.size();
    for (size_t i = 0; i < n; i++) {
        const glm::vec2 before = glm::normalize(outline[i] - outline[(i + n - 1) % n]),
                        after = glm::normalize(outline[(i + 1) % n] - outline[i]);
        const glm::vec2 inwards(-before.y - after.y, before.x + after.x);
        // Mitred, up to a right angle's.
        out.push_back(outline[i] + inwards * (by / std::max(0.5f * glm::dot(inwards, inwards), 0.5f)));
    }
    return out;
}

uint32_t Shell::add_corners(const Outline& outline, float y) {
    const auto first = uint32_t(out_.positions.size());
    for (const glm::vec2& p : outline) out_.positions.emplace_back(p.x, y, -p.y);
    return first;
}

void Shell::face(const Outline& outer, std::span<const Outline> holes, float y, bool up) {
    const uint32_t first = add_corners(bridged(outer, holes), y);
    std::vector<glm::uvec3> triangles;
    triangulate(std::span(out_.positions).subspan(first), triangles);
    for (const glm::uvec3& t : triangles) out_.triangles.push_back((up ? t : glm::uvec3(t.x, t.z, t.y)) + first);
}

void Shell::wall(const Outline& lower, float bottom, const Outline& upper, float top, bool outwards) {
    const uint32_t below = add_corners(lower, bottom), above = add_corners(upper, top), n = uint32_t(lower.size());
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t next = (k + 1) % n, a = below + k, b = below + next, c = above + next, d = above + k;
        out_.triangles.push_back(outwards ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
        out_.triangles.push_back(outwards ? glm::uvec3(a, c, d) : glm::uvec3(a, d, c));
    }
}

Primitive plate(const Outline& outer, std::span<const Outline> holes, float bottom, float top, float bevel) {
    Shell shell;
    std::vector<Outline> openings;
    const auto walls = [&](const Outline& outline, bool outwards) {
        const Outline in = bevel > 0 ? inset(outline, outwards ? bevel : -bevel) : outline;
        if (bevel > 0) {
            shell.wall(in, bottom, outline, bottom + bevel, outwards);
            shell.wall(outline, top - bevel, in, top, outwards);
        }
        shell.wall(outline, bottom + bevel, top - bevel, outwards);
        return in;
    };
    const Outline edge = walls(outer, true);
    for (const Outline& hole : holes) openings.push_back(walls(hole, false));
    shell.face(edge, openings, top, true);
    shell.face(edge, openings, bottom, false);
    return shell.take();
}

Primitive bevelled_box(const glm::vec3& lower, const glm::vec3& upper, float bevel) {
    return plate({{lower.x, -upper.z}, {upper.x, -upper.z}, {upper.x, -lower.z}, {lower.x, -lower.z}}, {}, lower.y,
                 upper.y, bevel);
}

}  // namespace peelray
