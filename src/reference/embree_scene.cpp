#include "reference/embree_scene.h"

#include "base/error.h"

namespace peelray {

EmbreeScene::~EmbreeScene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
}

void EmbreeScene::start() {
    device = rtcNewDevice(nullptr);
    if (!device)
        fail("cannot start Embree (error {}); check the installed libembree3", int(rtcGetDeviceError(nullptr)));
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
}

void EmbreeScene::build(RTCGeometry geometry, size_t triangles) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        fail("Embree cannot build a BVH of {} triangles (error {}); is there enough memory?", triangles, int(error));
}

}  // namespace peelray
