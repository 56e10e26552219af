"""Renders a glTF file with Blender's Cycles; bench/cycles.py runs it inside Blender (3.4, as in Debian 12).

    blender -b --factory-startup --python-exit-code 1 --python bench/cycles_blender.py -- JOB.json

JOB.json holds: file, env (equirectangular), eye, look, fov (degrees, vertical), size, samples, bounces, and `pictures`, a list of
[OpenEXR file to write, number of diffuse bounces]; on demand `time` (seconds of the animation) and `energy` (false: plain GGX). Directions are glTF's: +y is up.
"""
import json
import math
import sys

import bpy
import numpy
from mathutils import Vector

numpy.bool = bool  # the importer of Blender 3.4 asks for it; Debian 12's numpy has dropped the name


def blender_of(v):
    """glTF's +y is up, Blender's +z; the importer turns models the same way."""
    return Vector((v[0], -v[2], v[1]))


def add_camera(scene, job):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(job["fov"])
    eye, look = blender_of(job["eye"]), blender_of(job["look"])
    data.clip_start, data.clip_end = (look - eye).length * 1e-3, (look - eye).length * 1e3
    camera = bpy.data.objects.new("camera", data)
    camera.rotation_mode = "QUATERNION"
    camera.rotation_quaternion = (look - eye).to_track_quat("-Z", "Y")
    camera.location = eye
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_world(scene, path):
    """Blender's map has +x in its middle, ours glTF's -z, which is Blender's +y: a quarter turn."""
    world = scene.world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    image = nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(path)
    image.image.colorspace_settings.name = "Linear"
    turn = nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], image.inputs["Vector"])
    links.new(image.outputs["Color"], nodes["Background"].inputs["Color"])


def set_rendering(scene, job):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.dither_intensity = 0
    scene.render.use_file_extension = False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"  # an OpenEXR file is linear anyway
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["samples"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"  # one pixel wide
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = job["bounces"]
    cycles.transparent_max_bounces = 32


def compensate_energy():
    """The importer's GGX loses the light between microfacets; Peelray returns it."""
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type == "BSDF_PRINCIPLED":
                node.distribution = "MULTI_GGX"


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        job = json.load(file)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.import_scene.gltf(filepath=job["file"])
    scene = bpy.context.scene
    for lamp in [thing for thing in scene.objects if thing.type == "LIGHT"]:
        bpy.data.objects.remove(lamp)  # their units differ
    add_camera(scene, job)
    set_world(scene, job["env"])
    set_rendering(scene, job)
    if "time" in job:
        scene.frame_set(0, subframe=0)
        at = job["time"] * scene.render.fps / scene.render.fps_base
        scene.frame_set(int(at), subframe=at - int(at))
    if job.get("energy", True):
        compensate_energy()
    for path, diffuse_bounces in job["pictures"]:
        scene.cycles.diffuse_bounces = diffuse_bounces
        scene.render.filepath = path
        bpy.ops.render.render(write_still=True)


main()
