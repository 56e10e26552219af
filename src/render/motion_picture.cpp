#include "render/motion_picture.h"

namespace peelray {

void MotionPicture::prepare(FrameState& f) {
    const MemoryPart part(f.device, "images");
    ensure_size(f.device, motions_, "motion in the picture", f.pixels() * sizeof(AovMotion));
}

void MotionPicture::record(FrameState& f, const LevelParams& band) const {
    const MotionParams params{f.before.camera(), band.capacity, band.first_row};
    f.commands.run(f.device.pass("aov_motion"),
                   {{"frame", f.view.target.frame},
                    {"positions", f.scene.triangles.positions},
                    {"triangles", f.scene.triangles.triangles},
                    {"instances", f.scene.instances.table()},
                    {"hits", f.queues.level(0).traced->hits},
                    Binding::if_used("positions_before", f.before.positions()),
                    {"transforms_before", f.before.transforms()},
                    {"motions", motions_}},
                   params, groups_for(params.capacity, 64));
}

void MotionPicture::store(FrameState& f, Aovs& aovs) const {
    std::vector<AovMotion> records(f.pixels(), AovMotion{});
    if (f.settings.motion) records = f.commands.download<AovMotion>(motions_, records.size());
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovMotion& record : records) aovs.name.push_back(record.name);
    MOTION_AOVS(AOV_STORE)
#undef AOV_STORE
}

}  // namespace peelray
