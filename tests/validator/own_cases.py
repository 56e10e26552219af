"""glTF files of our own, each with one fault or oddity beside a triangle, and what Peelray is to do about it."""
import copy
import json

import graft

REFUSED = "refused"
QUIET = ""  # drawn without a note

BASE = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def node(**members):
    return lambda root: root["nodes"][0].update(members)


def material(**members):
    def change(root):
        root["materials"] = [members]
        root["meshes"][0]["primitives"][0]["material"] = 0
    return change


def undeclared(name, **members):
    return material(extensions={name: members})


def extension(name, **members):
    return both(undeclared(name, **members), lambda root: root.update(extensionsUsed=[name]))


def camera(**members):
    def change(root):
        root["cameras"] = [members]
        root["nodes"][0]["camera"] = 0
    return change


def light(**members):
    def change(root):
        root["extensionsUsed"] = ["KHR_lights_punctual"]
        root["extensions"] = {"KHR_lights_punctual": {"lights": [members]}}
        root["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    return change


def image(**members):
    def change(root):
        root["images"] = [members]
        root["textures"] = [{"source": 0}]
        material(emissiveTexture={"index": 0}, emissiveFactor=[1, 1, 1])(root)
    return change


def accessor(**members):
    return lambda root: root["accessors"].append(members)


def parent(*children, shown=False):
    def change(root):
        root["nodes"].append({"children": list(children)})
        if shown:
            root["scenes"][0]["nodes"] = [len(root["nodes"]) - 1]
    return change


def both(*changes):
    def change(root):
        for each in changes:
            each(root)
    return change


CASES = {
    "plain": (lambda root: None, QUIET),
    "identity": (node(matrix=IDENTITY), QUIET),
    "later-version": (lambda root: root["asset"].update(version="2.1"), QUIET),
    "empty-scale": (node(scale=[0, 1, 1]), QUIET),
    "rotation-none": (node(rotation=[0, 0, 0, 0]), "ROTATION_NON_UNIT"),
    "rotation-long": (node(rotation=[1, 1, 0, 1]), "ROTATION_NON_UNIT"),
    "rotation-short": (node(rotation=[0, 0, 0, 0.5]), "ROTATION_NON_UNIT"),
    "matrix-and-scale": (node(matrix=IDENTITY, scale=[2, 2, 2]), "NODE_MATRIX_TRS"),
    "shear": (node(matrix=IDENTITY[:4] + [1] + IDENTITY[5:]), "NODE_MATRIX_NON_TRS"),
    "projection": (node(matrix=IDENTITY[:3] + [1] + IDENTITY[4:]), "NODE_MATRIX_NON_TRS"),
    "two-parents": (both(parent(0), parent(0, shown=True)), "NODE_PARENT_OVERRIDE"),
    "not-a-root": (parent(0), "SCENE_NON_ROOT_NODE"),
    "shown-twice": (lambda root: root["scenes"][0]["nodes"].append(0), REFUSED),
    "cycle": (lambda root: root["nodes"][0].update(children=[0]), REFUSED),
    "weights-without-targets": (node(weights=[1]), "NODE_WEIGHTS_INVALID"),
    "mesh-weights": (lambda root: root["meshes"][0].update(weights=[1]), "MESH_INVALID_WEIGHTS_COUNT"),
    "skin-without-joints": (lambda root: (root.update(skins=[{"joints": [0]}]), root["nodes"][0].update(skin=0)),
                            "NODE_SKIN_WITH_NON_SKINNED_MESH"),
    "emission": (material(emissiveFactor=[2, 2, 2]), "VALUE_NOT_IN_RANGE"),
    "base-colour": (material(pbrMetallicRoughness={"baseColorFactor": [2, 0, 0, 1]}), "VALUE_NOT_IN_RANGE"),
    "metallic": (material(pbrMetallicRoughness={"metallicFactor": 2}), "VALUE_NOT_IN_RANGE"),
    "roughness": (material(pbrMetallicRoughness={"roughnessFactor": -1}), "VALUE_NOT_IN_RANGE"),
    "ior": (extension("KHR_materials_ior", ior=0.5), "VALUE_NOT_IN_RANGE"),
    "transmission": (extension("KHR_materials_transmission", transmissionFactor=2), "VALUE_NOT_IN_RANGE"),
    "thickness": (extension("KHR_materials_volume", thicknessFactor=-1), "VALUE_NOT_IN_RANGE"),
    "strength": (extension("KHR_materials_emissive_strength", emissiveStrength=-1), "VALUE_NOT_IN_RANGE"),
    "undeclared": (undeclared("KHR_materials_transmission", transmissionFactor=1), "UNDECLARED_EXTENSION"),
    "cutoff": (material(alphaMode="MASK", alphaCutoff=-1), REFUSED),
    "no-such-texture": (material(normalTexture={"index": 0}), REFUSED),
    "camera-type": (camera(type="fisheye"), "camera of an unknown type"),
    "camera-wide": (camera(type="perspective", perspective={"yfov": 4, "znear": 0.1}), "without a field of view"),
    "camera-orthographic": (camera(type="orthographic", orthographic={"xmag": -1, "ymag": -1, "znear": 0, "zfar": 9}), QUIET),
    "light-type": (light(type="laser"), "VALUE_NOT_IN_LIST"),
    "light-dark": (light(type="point", intensity=-1), "VALUE_NOT_IN_RANGE"),
    "light-range": (light(type="point", range=-1), "VALUE_NOT_IN_RANGE"),
    "light-colour": (light(type="point", color=[2, 0, 0]), "VALUE_NOT_IN_RANGE"),
    "light-cones": (light(type="spot", spot={"innerConeAngle": 1, "outerConeAngle": 0.5}), "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES"),
    "image-broken": (image(uri="data:image/png;base64,AAAA"), "the factor is used"),
    "image-nowhere": (image(uri="nowhere.png"), "missing"),
    "image-empty": (image(), "the factor is used"),
    "accessor-type": (accessor(componentType=5126, count=1, type="VEC9"), QUIET),
    "accessor-component": (accessor(componentType=5130, count=1, type="VEC3"), QUIET),
    "accessor-count": (lambda root: root["accessors"][0].update(count=4), REFUSED),
    "accessor-bounds": (lambda root: root["accessors"][0].update(max=[9, 9, 9]), QUIET),
    "mode": (lambda root: root["meshes"][0]["primitives"][0].update(mode=9), REFUSED),
}


def write(folder):
    """Writes all of them; returns {path: what is expected}."""
    expected = {}
    for name, (change, what) in CASES.items():
        root = copy.deepcopy(BASE)
        graft.graft(root)
        change(root)
        path = folder / f"{name}.gltf"
        path.write_text(json.dumps(root))
        expected[path] = what
    return expected
