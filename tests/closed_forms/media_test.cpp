// Media that touch, overlap and contain each other, in closed form: walls at the same place are one, and where two
// media are that of the smaller volume counts, from whichever side and in whichever order the file has them.
#include <pictures.h>

#include "layers.h"

namespace peelray {
namespace {

using MediaTest = PictureTest;

Material liquid(float ior = 1.33f) {
    Material m = clear_glass(ior);
    m.attenuation_color = {0.9f, 0.4f, 0.2f};
    m.attenuation_distance = 0.8f;
    return m;
}
const glm::dvec3 kLiquid = -glm::log(glm::dvec3(0.9, 0.4, 0.2)) / 0.8;

const Camera kOblique = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50);

/// Two panes with liquid between them, from `front` to `back`; in the order of the file that `first` says.
Stage panes(float front, float back, bool liquid_first) {
    Stage stage;
    add_lit_wall(stage);
    if (liquid_first) stage.add(plate(front, back), liquid());
    stage.add(plate(0.7f, 0.4f), clear_glass());
    stage.add(plate(-0.4f, -0.7f), clear_glass());
    if (!liquid_first) stage.add(plate(front, back), liquid());
    return stage;
}

TEST_F(MediaTest, LiquidBetweenPanes) {
    const std::vector<Layer> layers = {{0.7, 1.5}, {0.4, 1.33, kLiquid}, {-0.4, 1.5}, {-0.7, 1}};
    // In contact; reaching into the glass, whose volume is smaller; by less than single precision can tell.
    for (const float reach : {0.0f, 0.15f, 1e-7f})
        for (const bool liquid_first : {false, true}) {
            SCOPED_TRACE(fmt::format("reach {}, liquid first: {}", reach, liquid_first));
            const Stage stage = panes(0.4f + reach, -0.4f - reach, liquid_first);
            tally_layers(render(stage, black, settings_for(kOblique, 48)), kOblique, layers).expect(0, 1500);
        }
}

TEST_F(MediaTest, AGapIsSeenAsOne) {
    const std::vector<Layer> layers = {{0.7, 1.5}, {0.4, 1}, {0.35, 1.33, kLiquid}, {-0.35, 1}, {-0.4, 1.5}, {-0.7, 1}};
    RenderSettings settings = settings_for(kOblique, 48);
    settings.bounces = 8;
    tally_layers(render(panes(0.35f, -0.35f, false), black, settings), kOblique, layers).expect(0, 1500);
}

TEST_F(MediaTest, SmallerVolumeCountsInTheOverlap) {
    // A thick block of glass and a thin film of liquid that reaches into it.
    Stage stage;
    add_lit_wall(stage);
    stage.add(plate(0.5f, -1.5f), clear_glass());
    stage.add(plate(0.9f, 0.1f), liquid());
    tally_layers(render(stage, black, settings_for(kOblique, 48)), kOblique,
                 {{0.9, 1.33, kLiquid}, {0.1, 1.5}, {-1.5, 1}})
        .expect(0, 1500);
}

TEST_F(MediaTest, WhatIsInsideAMediumIsThere) {
    // Ice in a drink, in either order of the materials: the drink goes on behind it.
    for (const bool ice_first : {false, true}) {
        SCOPED_TRACE(ice_first);
        Stage stage;
        add_lit_wall(stage);
        if (ice_first) stage.add(plate(0.2f, -0.3f, 3.5f), clear_glass(1.2f));
        stage.add(plate(0.7f, -0.7f), liquid());
        if (!ice_first) stage.add(plate(0.2f, -0.3f, 3.5f), clear_glass(1.2f));
        tally_layers(render(stage, black, settings_for(kOblique, 48)), kOblique,
                     {{0.7, 1.33, kLiquid}, {0.2, 1.2}, {-0.3, 1.33, kLiquid}, {-0.7, 1}})
            .expect(0, 1500);
    }
}

TEST_F(MediaTest, BodiesOfOneMediumAreOneBody) {
    for (const float reach : {0.3f, 0.0f}) {
        SCOPED_TRACE(reach);
        Stage stage;
        add_lit_wall(stage);
        stage.add(plate(0.7f, -reach), liquid(1.5f));
        Primitive other = plate(reach, -0.7f);
        other.material = 1;  // that of the first slab
        Node node;
        node.mesh = int(stage.scene.meshes.size());
        stage.scene.meshes.push_back({"other", {std::move(other)}});
        stage.scene.nodes.push_back(node);
        tally_layers(render(stage, black, settings_for(kOblique, 48)), kOblique, {{0.7, 1.5, kLiquid}, {-0.7, 1}})
            .expect(0, 1500);
    }
}

TEST_F(MediaTest, InstancesOfOneBodyAreOneBody) {
    // Their walls that coincide are the same triangles, in two instances.
    const glm::dvec3 up(0, 1, 0), mirror(1, 1, -1);
    for (const glm::dmat4& other : {glm::scale(glm::dmat4(1), mirror), glm::rotate(glm::dmat4(1), kPi, up)}) {
        SCOPED_TRACE(other[0][0]);
        Stage stage;
        add_lit_wall(stage);
        stage.add(plate(0.7f, 0), liquid(1.5f));
        Node node = stage.scene.nodes.back();
        node.local = other;
        stage.scene.nodes.push_back(node);
        tally_layers(render(stage, black, settings_for(kOblique, 48)), kOblique, {{0.7, 1.5, kLiquid}, {-0.7, 1}})
            .expect(0, 1500);
    }
}

/// Through one face and out of the other, both normal to z, with a slanted wall y = z between glass and liquid: at 45
/// degrees glass would reflect totally into air, not into the liquid.
TEST_F(MediaTest, NoAirBetweenWallsThatTouch) {
    Stage stage;
    stage.add(prism(), clear_glass());
    stage.add(faces({{{1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}, {1, 1, -1}},
                     {{-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}},
                     {{-1, -1, -1}, {1, -1, -1}, {1, 1, 1}, {-1, 1, 1}},
                     {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}},
                     {{-1, -1, -1}, {-1, 1, 1}, {-1, 1, -1}}}),
              clear_glass(1.33f));
    const auto light = [](const glm::dvec3& p) { return glm::dvec3(1 + 0.2 * p.x, 1 + 0.2 * p.y, 1); };
    stage.add(gradient_quad({-4, -4, -3}, {8, 0, 0}, {0, 8, 0}, [&](glm::vec3 p) { return glm::vec3(light(p)); }),
              unlit({1, 1, 1}));
    const Camera camera = orthographic({0.013f, 0.107f, 5}, {0.013f, 0.107f, 0}, 1.3f);
    const double sine = 1.5 * std::sqrt(0.5) / 1.33, slant = std::asin(sine) - kPi / 4;  // from -z, down
    tally(render(stage, black, settings_for(camera, 48)), camera, 6e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double y = ray.origin.y, down = y + 1;  // from the wall at z = y to the back at z = -1
              const double y_back = y - std::tan(slant) * down;
              if (y_back < -0.95) return {};
              const double out = 1.33 * std::sin(slant);
              const double y_end = y_back - out / std::sqrt(1 - out * out) * 2;
              const double passed =
                  0.96 * (1 - fresnel(std::sqrt(0.5), 1.5, 1.33)) * (1 - fresnel(std::cos(slant), 1.33, 1));
              return passed * light({ray.origin.x, y_end, -3});
          })
        .expect(0.002, 1500);
}

TEST_F(MediaTest, ShadowsKnowTheMedium) {
    const Camera camera = orthographic({3, 0.5f, 0}, {3, 0, 0}, 1, {0, 0, -1});  // below the layers
    for (const float reach : {0.0f, 0.05f}) {
        SCOPED_TRACE(reach);
        Stage stage;
        stage.add(ground(6), lambert({1, 1, 1}));
        stage.add(box({-0.1f, 1, -2}, {6, 1.1f, 2}), clear_glass());
        stage.add(box({-0.1f, 1.1f - reach, -2}, {6, 1.5f + reach, 2}), liquid());
        stage.add(box({-0.1f, 1.5f, -2}, {6, 1.6f, 2}), clear_glass());
        stage.sun({0, -1, 0}, {3, 3, 3});
        const double faces = 0.96 * 0.96 * std::pow(1 - fresnel(1, 1.5, 1.33), 2);
        const glm::dvec3 want = 3 / kPi * faces * glm::exp(-kLiquid * 0.4);
        tally(render(stage, black, settings_for(camera, 32)), camera, 2e-3, [&](const ViewRay&) {
            return want;
        }).expect(0, 1024);
    }
}

TEST_F(MediaTest, ACameraUnderWater) {
    Stage stage;
    add_lit_wall(stage);
    stage.add(plate(5, -1, 8), liquid());
    stage.add(plate(0.6f, 0.2f), clear_glass());
    const Camera camera = perspective({0.4f, 0.3f, 2}, {0.2f, 0.1f, 0}, 40);
    tally_layers(render(stage, black, settings_for(camera, 48)), camera, {{0.6, 1.5}, {0.2, 1.33, kLiquid}, {-1, 1}},
                 {2, 1.33, kLiquid})
        .expect(0, 1500);
}

TEST_F(MediaTest, WaterBeforeTheCameraIsNoEffect) {
    // Nothing is reflected, refracted or in shadow: what the camera is in still absorbs.
    Stage stage;
    add_lit_wall(stage);
    stage.add(plate(5, -4, 8), liquid());
    const Camera camera = perspective({0.4f, 0.3f, 2}, {0.2f, 0.1f, 0}, 40);
    RenderSettings settings = settings_for(camera, 32);
    settings.reflection = settings.refraction = settings.shadow = settings.ambient = false;
    tally(render(stage, black, settings), camera, 2e-3, [](const ViewRay& ray) {
        const glm::dvec3 at = ray.at_plane(2, -2);
        return wall_light(at) * glm::exp(-kLiquid * glm::length(at - ray.origin));
    }).expect(0, 1024);
}

TEST_F(MediaTest, BlendedSheetInWater) {
    // What passes beside it goes on in the water.
    Stage stage;
    add_lit_wall(stage);
    stage.add(plate(5, -4, 8), liquid());
    Material sheet = unlit({0.9f, 0.2f, 0.1f});
    sheet.blended = true;
    sheet.alpha = 0.3f;
    stage.add(parallelogram({-7, -7, 1}, {14, 0, 0}, {0, 14, 0}), sheet);
    const Camera camera = perspective({0.4f, 0.3f, 2}, {0.2f, 0.1f, 0}, 40);
    tally(render(stage, black, settings_for(camera, 32)), camera, 2e-3, [](const ViewRay& ray) {
        const glm::dvec3 wall = ray.at_plane(2, -2);
        const auto left = [&](const glm::dvec3& at) { return glm::exp(-kLiquid * glm::length(at - ray.origin)); };
        return left(ray.at_plane(2, 1)) * 0.3 * glm::dvec3(0.9f, 0.2f, 0.1f) + 0.7 * left(wall) * wall_light(wall);
    }).expect(0, 1024);
}

TEST_F(MediaTest, NoAirUnderWhatStandsOnATable) {
    // Through the side of a block that stands on a table: from inside, its bottom would reflect totally.
    for (const bool table_first : {false, true}) {
        SCOPED_TRACE(table_first);
        Stage stage;
        if (table_first) stage.add(ground(6), unlit({1, 0.5f, 0.25f}));
        stage.add(box({-2, 0, -2}, {2, 1, 2}), clear_glass());
        stage.add(box({-1, 0.5f, -1}, {1, 0.9f, 1}), clear_glass(1.2f));  // so that media overlap at all
        if (!table_first) stage.add(ground(6), unlit({1, 0.5f, 0.25f}));
        const Camera camera = orthographic({0, 1.4f, 4}, {0, 0.4f, 2}, 0.3f);
        // What the side reflects is the table as well.
        tally(render(stage, black, settings_for(camera, 32)), camera, 1e-3, [&](const ViewRay&) {
            return glm::dvec3(1, 0.5, 0.25);
        }).expect(0, 1024);
    }
}

TEST_F(MediaTest, ManyMediaInEachOther) {
    // Boxes in boxes: four are followed, more are counted.
    for (const int boxes : {4, 5}) {
        SCOPED_TRACE(boxes);
        Stage stage;
        add_lit_wall(stage);
        std::vector<Layer> layers;
        for (int i = 0; i < boxes; i++) {
            const float half = 0.9f - 0.15f * float(i);
            stage.add(plate(half, -half, 4 - 0.1f * float(i)), clear_glass(1.1f + 0.1f * float(i)));
            layers.push_back({half, 1.1 + 0.1 * i});
        }
        for (int i = boxes; i-- > 1;) layers.push_back({-(0.9 - 0.15 * i), 1.0 + 0.1 * i});
        layers.push_back({-0.9, 1});
        RenderSettings settings = settings_for(kOblique, 48);
        settings.bounces = 12;
        const RenderResult picture = render(stage, black, settings);
        EXPECT_EQ(picture.rays.crowded > 0, boxes == 5);
        if (boxes == 4) tally_layers(picture, kOblique, layers).expect(0, 1500);
    }
}

TEST_F(MediaTest, WallsTintOnce) {
    // Every wall that light passes has its colour, hidden in another medium or not; that of a body inside a body of the
    // same material has none.
    Material tinted = clear_glass(1.33f);
    tinted.base_color = {0.5f, 0.8f, 1};
    const Camera camera = orthographic({0.1f, 0.2f, 3}, {0.1f, 0.2f, 0}, 2);
    for (const float reach : {0.0f, 0.15f}) {
        SCOPED_TRACE(reach);
        Stage stage;
        stage.add(parallelogram({-6, -6, -2}, {12, 0, 0}, {0, 12, 0}), unlit({1, 1, 1}));
        stage.add(plate(0.7f, 0.4f), clear_glass());
        stage.add(plate(0.4f + reach, -0.4f), tinted);
        const double passed = 0.96 * (1 - fresnel(1, 1.5, 1.33)) * (1 - fresnel(1, 1.33, 1));
        tally(render(stage, black, settings_for(camera, 32)), camera, 6e-3, [&](const ViewRay&) {
            return passed * glm::dvec3(0.25, 0.64, 1);
        }).expect(0, 1024);
    }
}

/// A cup of glass with a drink in contact with its wall, tessellated alike: with many samples it looks as if the drink
/// reached a little into the wall, without speckle.
TEST_F(MediaTest, DrinkInACupHasNoSpeckle) {
    const auto ring = [](float radius, float y) {
        std::vector<glm::vec3> points;
        for (int i = 0; i < 32; i++) {
            const double a = -2 * kPi * i / 32;
            points.push_back({radius * std::cos(a), y, radius * std::sin(a)});
        }
        return points;
    };
    const auto can = [&](float radius, float bottom, float top) {
        const auto low = ring(radius, bottom), high = ring(radius, top);
        std::vector<std::vector<glm::vec3>> polygons = {{low.rbegin(), low.rend()}, high};
        for (size_t i = 0; i < low.size(); i++) {
            const size_t k = (i + 1) % low.size();
            polygons.push_back({low[i], low[k], high[k], high[i]});
        }
        return faces(polygons);
    };
    const auto picture = [&](float reach) {
        Stage stage;
        stage.add(joined(can(1, 0, 2), inside_out(can(0.9f, 0.1f, 1.9f))), clear_glass());
        stage.add(can(0.9f + reach, 0.1f - reach, 1.5f), liquid());
        RenderSettings settings = settings_for(perspective({0, 1.6f, 5}, {0, 1, 0}, 30), 40);
        settings.spp = 8;
        settings.bounces = 6;
        return render(stage, white, settings);
    };
    const Picture contact = picture(0), overlap = picture(0.004f);
    tally(contact, overlap, 0.05).expect(0.02, 1600);
    // The drink has its colour in the middle: some 1.8 of it.
    EXPECT_LT(radiance_at(contact, 20, 22).z, 0.2);
    EXPECT_GT(radiance_at(contact, 20, 22).x, 0.5);
}

}  // namespace
}  // namespace peelray
