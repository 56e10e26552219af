// Toy bricks: parts as CAD programs export them, whose flat faces with holes are cut into long thin triangles, and
// which touch each other. A duck is built of them, as large as the number of triangles allows; what is left of it lies
// around.

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "base/error.h"
#include "builtin/shapes.h"
#include "builtin/soft_body.h"
#include "builtin/solids.h"
#include "builtin/watch.h"

namespace peelray {
namespace {

// Millimetres, as everywhere in this file; the scene is in metres.
constexpr float kPitch = 8, kHeight = 9.6f, kGap = 0.1f, kStud = 2.4f, kStudHeight = 1.7f, kWall = 1.5f, kBevel = 0.2f;

/// Where the corners of the i-th circle of a row begin: elsewhere in each, so that those of several do not lie on one
/// line, which would leave triangles without area between them.
float phase(uint32_t i) {
    return 0.2f + 0.023f * float(i);
}

Outline rectangle(float x0, float y0, float x1, float y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// Its lower side is y = 0, its middle x = z = 0; `around`: corners of its circles.
Primitive brick(uint32_t width, uint32_t depth, uint32_t around) {
    Shell shell;
    const float x = 0.5f * kPitch * float(width) - kGap, z = 0.5f * kPitch * float(depth) - kGap,
                ceiling = kHeight - 1.2f;
    const Outline outside = rectangle(-x, -z, x, z), inside = inset(outside, kWall), top = inset(outside, kBevel);
    shell.wall(outside, 0, kHeight - kBevel, true);
    shell.wall(outside, kHeight - kBevel, top, kHeight, true);
    std::vector<Outline> studs, tubes;
    const auto middle = [](uint32_t i, uint32_t n) { return kPitch * (float(i) - 0.5f * float(n - 1)); };
    for (uint32_t i = 0; i < width; i++)
        for (uint32_t j = 0; j < depth; j++) {
            const Outline stud = circle({middle(i, width), middle(j, depth)}, kStud, around, phase(i + 5 * j)),
                          tip = inset(stud, kBevel);
            shell.wall(stud, kHeight, kHeight + kStudHeight - kBevel, true);
            shell.wall(stud, kHeight + kStudHeight - kBevel, tip, kHeight + kStudHeight, true);
            shell.face(tip, {}, kHeight + kStudHeight, true);
            studs.push_back(stud);
        }
    shell.face(top, studs, kHeight, true);
    // Below: a rim, a hollow, and in it tubes that hold the studs of the brick below; in narrow bricks pins do.
    const bool narrow = width == 1 || depth == 1;
    const uint32_t across = narrow ? std::max(width, depth) - 1 : width - 1, along = narrow ? 1 : depth - 1;
    for (uint32_t i = 0; i < across; i++)
        for (uint32_t j = 0; j < along; j++) {
            const float u = middle(i, across), v = middle(j, along);
            const glm::vec2 at = narrow && width == 1 ? glm::vec2(v, u) : glm::vec2(u, v);
            const Outline tube = circle(at, narrow ? 1.5f : 3.2f, around, phase(i + 5 * j));
            shell.wall(tube, 0, ceiling, true);
            tubes.push_back(tube);
            if (narrow) {
                shell.face(tube, {}, 0, false);
                continue;
            }
            const Outline bore = circle(at, kStud, around, phase(i + 5 * j));
            shell.face(tube, std::vector<Outline>{bore}, 0, false);
            shell.wall(bore, 0, ceiling, false);
            shell.face(bore, {}, ceiling, false);
        }
    shell.face(outside, std::vector<Outline>{inside}, 0, false);
    shell.wall(inside, 0, ceiling, false);
    shell.face(inside, tubes, ceiling, false);
    return shell.take();
}

/// A beam with round ends and holes for pins, lying flat.
Primitive beam(uint32_t length, uint32_t around) {
    constexpr float radius = 3.7f, height = 7.4f, sink = 0.8f;
    const float half = 0.5f * kPitch * float(length - 1);
    Outline outside;
    for (const float side : {1.f, -1.f})
        for (uint32_t i = 0; i <= around / 2; i++) {
            const float angle = kTurn / 2 * (float(i) / float(around / 2) - 0.5f);
            outside.push_back(side * glm::vec2(half + radius * std::cos(angle), radius * std::sin(angle)));
        }
    Shell shell;
    const Outline edge = inset(outside, kBevel);
    shell.wall(edge, 0, outside, kBevel, true);
    shell.wall(outside, kBevel, height - kBevel, true);
    shell.wall(outside, height - kBevel, edge, height, true);
    std::vector<Outline> sinks;
    for (uint32_t i = 0; i < length; i++) {
        const glm::vec2 at(kPitch * float(i) - half, 0);
        const Outline wide = circle(at, 3.05f, around, phase(i)), bore = circle(at, 2.45f, around, phase(i));
        shell.wall(wide, 0, sink, false);
        shell.face(wide, std::vector<Outline>{bore}, sink, false);
        shell.wall(bore, sink, height - sink, false);
        shell.face(wide, std::vector<Outline>{bore}, height - sink, true);
        shell.wall(wide, height - sink, height, false);
        sinks.push_back(wide);
    }
    shell.face(edge, sinks, height, true);
    shell.face(edge, sinks, 0, false);
    return shell.take();
}

/// A wheel with a profiled tyre, lying flat.
Primitive tyre(uint32_t around) {
    Outline outside;
    for (uint32_t i = 0; i < 2 * around; i++) {
        const float angle = kTurn * (float(i / 2) + (i % 2 ? 0.62f : 0.38f)) / float(around),
                    r = i / 2 % 2 ? 15.2f : 14.2f;
        outside.push_back(r * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return plate(outside, std::vector<Outline>{circle({0, 0}, 8.8f, around)}, 0, 12, 1.2f);
}

Primitive rim(uint32_t around) {
    std::vector<Outline> holes{circle({0, 0}, 2.45f, around)};
    for (int i = 0; i < 6; i++) {
        const float angle = kTurn * float(i) / 6;
        holes.push_back(circle(5.6f * glm::vec2(std::cos(angle), std::sin(angle)), 1.7f, around));
    }
    return plate(circle({0, 0}, 8.7f, 2 * around), holes, 0.8f, 11.2f, 0.4f);
}

/// The least parts: a tile, and half of it cut off aslant.
Primitive tile() {
    Shell shell;
    const Outline outside = rectangle(-3.9f, -3.9f, 3.9f, 3.9f);
    shell.wall(outside, 0, 3.2f, true);
    shell.face(outside, {}, 3.2f, true);
    shell.face(outside, {}, 0, false);
    return shell.take();
}

Primitive wedge() {
    Shell shell;
    const Outline outside{{-3.9f, -3.9f}, {3.9f, -3.9f}, {-3.9f, 3.9f}};
    shell.wall(outside, 0, 3.2f, true);
    shell.face(outside, {}, 3.2f, true);
    shell.face(outside, {}, 0, false);
    return shell.take();
}

enum class Color : uint8_t { yellow, orange, black, red, blue, green, white, grey, count };

/// The duck of one unit of length in height, about; its beak points to +x.
SoftBody duck_body() {
    SoftBody body;
    const auto group = [&](Color color, std::vector<Piece> pieces) {
        SoftGroup out;
        out.part = uint32_t(color);
        out.seam = 0;
        out.pieces = std::move(pieces);
        for (Piece& piece : out.pieces) piece.blend = 0.07f;
        out.measure();
        body.groups.push_back(std::move(out));
    };
    group(Color::yellow, {cone({-0.16f, 0.26f, 0}, 0.25f, {0.10f, 0.24f, 0}, 0.26f, {1, 1, 1.05f}),
                          cone({-0.30f, 0.34f, 0}, 0.14f, {-0.50f, 0.52f, 0}, 0.05f), ball({0.20f, 0.66f, 0}, 0.215f),
                          cone({0.12f, 0.40f, 0}, 0.18f, {0.18f, 0.55f, 0}, 0.15f)});
    group(Color::white, {cone({0.02f, 0.30f, 0.225f}, 0.085f, {-0.24f, 0.36f, 0.215f}, 0.055f, {1, 1, 1.3f}),
                         cone({0.02f, 0.30f, -0.225f}, 0.085f, {-0.24f, 0.36f, -0.215f}, 0.055f, {1, 1, 1.3f})});
    group(Color::orange, {cone({0.40f, 0.615f, 0}, 0.09f, {0.50f, 0.60f, 0}, 0.065f, {1, 1.5f, 0.8f + 0.2f})});
    group(Color::black, {ball({0.345f, 0.735f, 0.125f}, 0.055f), ball({0.345f, 0.735f, -0.125f}, 0.055f)});
    return body;
}

struct Placed {
    uint32_t width, depth;
    glm::vec3 at;
    Color color;
};

/// Bricks that lie next to and on each other, in courses that run crosswise by turns.
class Builder {
  public:
    /// `size`: studs to the unit of length of the body.
    Builder(const SoftBody& body, float size) : body_(body), size_(size), cells_(int(std::ceil(1.3f * size))) {}

    std::vector<Placed> build() {
        const int courses = int(std::ceil(size_ / (kHeight / kPitch)));
        for (int y = 0; y < courses; y++) lay(y);
        return std::move(out_);
    }

  private:
    static constexpr uint8_t empty = 255;

    uint8_t& cell(int x, int z) { return plan_[size_t(z) * size_t(cells_) + size_t(x)]; }

    /// What of a course there is to be: a wall of two bricks, and nothing within.
    void survey(int y) {
        plan_.assign(size_t(cells_) * size_t(cells_), empty);
        const float thick = 2.6f / size_;
        for (int z = 0; z < cells_; z++)
            for (int x = 0; x < cells_; x++) {
                const glm::vec3 p = middle(x, y, z) / size_;
                const float distance = body_.at(p);
                if (distance < 0 && distance > -thick) cell(x, z) = uint8_t(body_.part_at(p));
            }
    }

    /// In studs.
    glm::vec3 middle(int x, int y, int z) const {
        return {float(x) + 0.5f - 0.5f * float(cells_), (float(y) + 0.5f) * kHeight / kPitch,
                float(z) + 0.5f - 0.5f * float(cells_)};
    }

    bool fits(int x, int z, int width, int depth, uint8_t color) {
        if (x + width > cells_ || z + depth > cells_) return false;
        for (int j = 0; j < depth; j++)
            for (int i = 0; i < width; i++)
                if (cell(x + i, z + j) != color) return false;
        return true;
    }

    void lay(int y) {
        survey(y);
        constexpr int sizes[][2] = {{4, 2}, {3, 2}, {2, 2}, {4, 1}, {3, 1}, {2, 1}, {1, 1}};
        for (int z = 0; z < cells_; z++)
            for (int x = 0; x < cells_; x++) {
                const uint8_t color = cell(x, z);
                if (color == empty) continue;
                for (const auto& s : sizes) {
                    const int w = y % 2 ? s[1] : s[0], d = y % 2 ? s[0] : s[1];
                    if (!fits(x, z, w, d, color)) continue;
                    for (int j = 0; j < d; j++)
                        for (int i = 0; i < w; i++) cell(x + i, z + j) = empty;
                    const glm::vec3 corner = middle(x, y, z) - glm::vec3(0.5f);
                    out_.push_back({uint32_t(w),
                                    uint32_t(d),
                                    {kPitch * (corner.x + 0.5f * float(w)), kHeight * float(y),
                                     kPitch * (corner.z + 0.5f * float(d))},
                                    Color(color)});
                    break;
                }
            }
    }

    const SoftBody& body_;
    float size_;
    int cells_;
    std::vector<uint8_t> plan_;
    std::vector<Placed> out_;
};

/// Makes each kind of part once.
class Catalogue {
  public:
    explicit Catalogue(uint32_t around) : around_(around) {}

    const Primitive& brick(uint32_t width, uint32_t depth) {
        Primitive& out = bricks_[{width, depth}];
        if (out.triangles.empty()) out = finished(peelray::brick(width, depth, around_));
        return out;
    }
    uint64_t triangles(const std::vector<Placed>& placed) {
        uint64_t sum = 0;
        for (const Placed& p : placed) sum += brick(p.width, p.depth).triangles.size();
        return sum;
    }
    uint32_t around() const { return around_; }

  private:
    uint32_t around_;
    std::map<std::pair<uint32_t, uint32_t>, Primitive> bricks_;
};

/// The largest duck of at most `triangles`; empty: not even a small one.
std::vector<Placed> largest_duck(Catalogue& catalogue, uint64_t triangles) {
    const SoftBody body = duck_body();
    // The number of bricks grows with the square of the size: a wall has an area.
    std::vector<Placed> best;
    float low = 6, step = 8;
    for (float size = low; step >= 0.5f;) {
        std::vector<Placed> tried = Builder(body, size).build();
        if (catalogue.triangles(tried) <= triangles) {
            best = std::move(tried);
            low = size;
            size += step;
        } else if (best.empty()) {
            return {};
        } else {
            step /= 2;
            size = low + step;
        }
    }
    return best;
}

/// Parts that lie around the duck, until there are as many triangles as there should be.
class Scattering {
  public:
    Scattering(SceneBuilder& build, Catalogue& catalogue, const uint32_t* materials, float from)
        : build_(build), catalogue_(catalogue), materials_(materials), from_(from) {
        const uint32_t n = catalogue.around();
        Primitive wheel = finished(tyre(2 * n)), hub = finished(rim(n));
        kinds_ = {{"brick 4x2", catalogue.brick(4, 2)},
                  {"beam", finished(beam(7, n))},
                  {"brick 2x2", catalogue.brick(2, 2)},
                  {"gear", finished(gear({.teeth = 24,
                                          .radius = 12.6f,
                                          .tooth = 2.2f,
                                          .rim = 1.6f,
                                          .hub = 4.2f,
                                          .bore = 2.45f,
                                          .spokes = 4,
                                          .spoke = 2.4f,
                                          .thickness = 3.7f,
                                          .bevel = 0.25f}))},
                  {"wheel", std::move(wheel)},
                  {"hub", std::move(hub)},
                  {"brick 3x1", catalogue.brick(3, 1)},
                  {"brick 1x1", catalogue.brick(1, 1)},
                  {"tile", finished(tile())},
                  {"wedge", finished(wedge())}};
    }

    /// Returns how many triangles were added.
    uint64_t add(uint64_t triangles) {
        uint64_t left = triangles;
        for (size_t next = 0; left >= 8; next++) {
            // By turns; small ones only where no larger one has room.
            const size_t large = kinds_.size() - 3;
            size_t kind = next % large, tried = 0;
            while (tried < large && kinds_[kind].shape.triangles.size() > left) kind = (kind + 1) % large, tried++;
            if (tried == large)
                for (kind = large; kinds_[kind].shape.triangles.size() > left;) kind++;
            put(kinds_[kind].name, kinds_[kind].shape);
            left -= kinds_[kind].shape.triangles.size();
        }
        return triangles - left;
    }

  private:
    struct Kind {
        const char* name;
        Primitive shape;
    };

    /// On a spiral whose turns are as far apart as its steps.
    void put(const char* name, const Primitive& shape) {
        const float angle = 2.399963f * float(count_), r = std::sqrt(from_ * from_ + 620 * float(count_));
        const Color color = Color(uint32_t(Color::red) + count_ * 3 % 5);
        count_++;
        const bool rubber = std::string_view(name) == "wheel";
        const glm::vec3 at = 0.001f * glm::vec3(r * std::cos(angle), 0.02f, r * std::sin(angle));
        const glm::mat4 place =
            glm::scale(glm::rotate(glm::translate(glm::mat4(1), at), random_.between(0, kTurn), glm::vec3(0, 1, 0)),
                       glm::vec3(0.001f));
        build_.add(name, shape, materials_[size_t(rubber ? Color::black : color)], place);
    }

    SceneBuilder& build_;
    Catalogue& catalogue_;
    const uint32_t* materials_;
    float from_;
    uint32_t count_ = 0;
    Random random_{17};
    std::vector<Kind> kinds_;
};

}  // namespace

Scene make_bricks(uint64_t triangles) {
    const std::string name = fmt::format("builtin:bricks:{}", triangles);
    SceneBuilder build(name.c_str());
    const glm::vec3 colors[] = {{0.90f, 0.58f, 0.02f},  {0.88f, 0.22f, 0.02f}, {0.02f, 0.02f, 0.022f},
                                {0.60f, 0.03f, 0.025f}, {0.02f, 0.13f, 0.50f}, {0.03f, 0.30f, 0.08f},
                                {0.80f, 0.79f, 0.76f},  {0.35f, 0.37f, 0.38f}};
    const char* names[] = {"yellow", "orange", "black", "red", "blue", "green", "white", "grey"};
    uint32_t materials[size_t(Color::count)];
    for (size_t i = 0; i < size_t(Color::count); i++) {
        Material plastic = matte(names[i], colors[i]);
        plastic.roughness = 0.04f;
        materials[i] = build.material(plastic);
    }
    Catalogue catalogue(triangles < 60'000 ? 8 : triangles < 400'000 ? 16 : 24);
    const std::vector<Placed> built = largest_duck(catalogue, triangles);
    uint64_t made = 0;
    float reach = 0, height = 0;
    for (const Placed& p : built) {
        const Primitive& shape = catalogue.brick(p.width, p.depth);
        made += shape.triangles.size();
        reach = std::max(reach, glm::length(glm::vec2(p.at.x, p.at.z)) + 3 * kPitch);
        height = std::max(height, p.at.y + kHeight);
        const glm::mat4 place =
            glm::scale(glm::translate(glm::mat4(1), 0.001f * (p.at + glm::vec3(0, 0.02f, 0))), glm::vec3(0.001f));
        build.add(fmt::format("brick {}x{}", std::max(p.width, p.depth), std::min(p.width, p.depth)).c_str(), shape,
                  materials[size_t(p.color)], place);
    }
    made += Scattering(build, catalogue, materials, reach).add(triangles - made);
    const float size = 0.001f * std::max(reach, 40.f);
    Material table = matte("table", {0.62f, 0.68f, 0.72f});
    table.roughness = 0;
    build.add("table", parallelogram({-6 * size, 0, 6 * size}, {12 * size, 0, 0}, {0, 0, -12 * size}),
              build.material(table));
    const float middle = 0.00042f * height;
    build.camera({1.45f * size, middle + 1.15f * size, 2.15f * size}, {0.05f * size, middle, 0.05f * size}, 38);
    Scene scene = build.take();
    scene.notes.push_back(fmt::format("the parts have {} triangles, the table 2", made));
    return scene;
}

}  // namespace peelray
