#include "settings/settings.h"

#include "settings/aovs.h"

namespace peelray {
namespace {

void add_tracer(SettingList& list, TracingArguments& a) {
    add_setting(list, a.tracer,
                {.name = "tracer",
                 .group = "Effects",
                 .help = "ldc: secondary rays, traced in the layered depth cube; cpu: all rays on the CPU; reference: "
                         "the same in double precision; cubemap: the baseline without rays, cube maps of each object's "
                         "surroundings and shadow maps; khr: secondary rays by the device's own ray tracing, where it "
                         "has one (VK_KHR_ray_tracing_pipeline); none: no rays; auto: ldc on a GPU or with an option "
                         "of the cubes, else cpu",
                 .none = "auto"});
}

void add_measuring(SettingList& list, PictureArguments& a) {
    add_setting(list, a.visibility,
                {.name = "visibility",
                 .group = "Tracing",
                 .help = "what determines the surface that each pixel sees: compute shaders, or the graphics pipeline; "
                         "auto: compute, if the device has 64-bit atomics and is not a software device",
                 .of_cubes = true});
    add_setting(list, a.repeat,
                {.name = "repeat",
                 .group = "More output",
                 .help = "for measuring: render 2 or more frames after one that warms up; times are medians",
                 .limits = kRepeatLimits,
                 .changes_picture = false,
                 .of_cubes = true});
    add_setting(list, a.rebuild,
                {.name = "rebuild",
                 .group = "More output",
                 .help = "for measuring: build every cube or acceleration structure anew in every frame, as if "
                         "everything changed its shape",
                 .of_cubes = true});
}

}  // namespace

std::optional<ChoiceSet<Effect>> parse_effects(const std::string& text) {
    if (text == "none") return ChoiceSet<Effect>();
    const auto named = parse_list<Effect>(
        text, [](const std::string& name) { return value_named<Effect>(name); }, false);
    if (!named) return std::nullopt;
    ChoiceSet<Effect> effects;
    for (const Effect effect : *named) effects.add(effect);
    return effects;
}

std::optional<std::vector<Aov>> parse_aovs(const std::string& text) {
    if (text == "all") return aovs_of(AovSource::surface);
    return parse_list<Aov>(
        text, [](const std::string& name) { return value_named<Aov>(name); }, false);
}

SettingList picture_settings(PictureArguments& a, bool one) {
    SettingList list;
    add_setting(list, a.size,
                {.name = "size",
                 .help = "width and height in pixels",
                 .form = "WIDTHxHEIGHT",
                 .expected = "a picture size WIDTHxHEIGHT, such as 1280x1024",
                 .limits = kSizeLimits});
    add_view(list, a);
    add_light(list, a);
    if (one) add_tracer(list, a.tracing);
    add_effects(list, a);
    add_scene(list, a);
    if (one) add_hit(list, a.tracing);
    add_tracing(list, a.tracing);
    add_measuring(list, a);
    add_device(list, a.device);
    return list;
}

SettingList sequence_settings(SequenceArguments& a) {
    SettingList list;
    const std::string group = "Several frames";
    add_setting(list, a.frames,
                {.name = "frames",
                 .group = group,
                 .help = "the frames A, A+1, ..., B-1 of the animation (without B); frame k shows the moment k/F "
                         "seconds. The output is then a name with one number, such as frame_%05d.exr, or a video, "
                         ".mp4, .webm or -",
                 .form = "A:B",
                 .expected = "a range of frames A:B, such as 0:48",
                 .changes_picture = false});
    add_setting(list, a.fps,
                {.name = "fps",
                 .group = group,
                 .help = "frames per second; of --aov motion and --denoise temporal, which look back by frames, also "
                         "for one picture",
                 .form = "F",
                 .preset = "30",
                 .limits = {.least = 0.001,
                            .most = 1000,
                            .fault = "{} frames per second are out of range",
                            .choose = "0.001 to 1000"}});
    add_setting(list, a.turntable,
                {.name = "turntable",
                 .group = group,
                 .help = "N frames in which the camera goes once around the vertical line through its look point; "
                         "everything else stays at --time or at rest, but with --animation or --fps the animation runs",
                 .limits = {.least = 1,
                            .most = kMostFrames,
                            .fault = "a turntable of {} frames is out of range",
                            .choose = "1 to 10000000"}});
    add_setting(list, a.shard,
                {.name = "shard",
                 .group = group,
                 .help = "only every n-th frame, from the i-th of the range on (i from 0): one of n runs that share "
                         "the work",
                 .form = "i/n",
                 .expected = "a part i/n, such as 0/4",
                 .changes_picture = false});
    add_setting(list, a.resume,
                {.name = "resume",
                 .group = group,
                 .help = "continue a run that ended early: the frames that it finished are left alone",
                 .changes_picture = false});
    return list;
}

void check(const TracingArguments& arguments) {
    TracingArguments a = arguments;
    SettingList list;
    add_tracing(list, a);
    check_limits(list);
    if (a.builder && a.hit) check_captures(*a.builder, *a.hit);
    if (a.batch != Batch::none && a.traversal == Traversal::voxel)
        fail("{} voxel takes one sample and one ray at a time: use {} {} with {} two-level or mipmap",
             setting::traversal, setting::batch, name_of(a.batch), setting::traversal);
    const bool by_samples = a.hit ? *a.hit != HitTest::exact : a.builder == BuilderKind::peel;
    if (a.depth == 16 && a.traversal == Traversal::voxel)
        fail("{} voxel has a depth format of its own: use {} 16 with {} two-level or mipmap{}", setting::traversal,
             setting::depth, setting::traversal,
             by_samples ? "" : fmt::format(", and with {} tolerance or planar", setting::hit));
    if (a.depth == 16 && !by_samples)
        fail("depths of 16 bits are too coarse for {} {}: use {} 16 with {} tolerance or planar", setting::hit,
             a.hit ? name_of(*a.hit) : "auto", setting::depth, setting::hit);
}

void check(const PictureArguments& arguments) {
    check(arguments.tracing);
    PictureArguments a = arguments;
    check_limits(picture_settings(a));
    if (a.background && !a.is_lit_by_background() && a.visible() != EnvVisible::no)
        fail("{} is what is seen instead of the environment, and {} {} shows that: leave one of them out",
             setting::background, setting::env_visible, name_of(a.visible()));
}

}  // namespace peelray
