"""Grafts one valid triangle into a glTF or GLB file, so that a loader does not refuse it for having none:

    graft.py IN OUT [--show]

What is wrong with the file stays as it is. The new buffer, buffer view, accessors, mesh and node are appended to the file's lists, the
node to its default scene. With --show a node is added for each mesh that none shows, with a skin where it has joints, and a triangle
for each image that no texture shows: then a fault in them is one of the picture. Status 2, and no output: the file has no place for
them."""
import base64
import json
import struct
import sys
from pathlib import Path

CORNERS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


class NoPlace(Exception):
    """A file that is no JSON object, or has something else where a list is needed."""


def append(root, name, value):
    """Appends to a list of the file, which is made if it is missing; returns the index."""
    place = root.setdefault(name, [])
    if not isinstance(place, list):
        raise NoPlace(f"{name} is no list")
    place.append(value)
    return len(place) - 1


def scene_of(root):
    """The scene that a loader shows; None: the file has none, so that all its nodes are shown."""
    scenes = root.get("scenes")
    if scenes is None:
        return None
    shown = root.get("scene", 0)
    if not isinstance(scenes, list) or not isinstance(shown, int) or not 0 <= shown < len(scenes) or not isinstance(scenes[shown], dict):
        raise NoPlace("no scene to put it in")
    return scenes[shown]


def entries(root, name):
    """A list of the file; empty if it is none."""
    place = root.get(name, [])
    return [entry if isinstance(entry, dict) else {} for entry in place] if isinstance(place, list) else []


def node_of(root, scene, node):
    index = append(root, "nodes", node)
    if scene is not None:
        append(scene, "nodes", index)


def has_joints(mesh):
    primitives = mesh.get("primitives")
    return any("JOINTS_0" in json.dumps(primitive) for primitive in primitives) if isinstance(primitives, list) else False


def show(root, scene, position):
    """All meshes and images that nothing shows."""
    shown = {node.get("mesh") for node in entries(root, "nodes")}
    skins = len(entries(root, "skins"))
    for index, mesh in enumerate(entries(root, "meshes")):
        if index not in shown:
            node_of(root, scene, {"mesh": index, **({"skin": 0} if skins and has_joints(mesh) else {})})
    textured = {texture.get("source") for texture in entries(root, "textures")}
    for index in range(len(entries(root, "images"))):
        if index not in textured:
            texture = append(root, "textures", {"source": index})
            material = append(root, "materials", {"emissiveTexture": {"index": texture}})
            mesh = append(root, "meshes", {"primitives": [{"attributes": {"POSITION": position}, "material": material}]})
            node_of(root, scene, {"mesh": mesh})


def graft(root, showing=False):
    """Changes the parsed JSON of a file in place."""
    if not isinstance(root, dict):
        raise NoPlace("no JSON object")
    scene = scene_of(root)
    uri = "data:application/octet-stream;base64," + base64.b64encode(CORNERS).decode()
    buffer = append(root, "buffers", {"byteLength": len(CORNERS), "uri": uri})
    view = append(root, "bufferViews", {"buffer": buffer, "byteLength": len(CORNERS)})
    accessor = append(root, "accessors", {"bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3",
                                          "min": [0, 0, 0], "max": [1, 1, 0]})
    mesh = append(root, "meshes", {"primitives": [{"attributes": {"POSITION": accessor}}]})
    node_of(root, scene, {"mesh": mesh})
    if showing:
        show(root, scene, accessor)


def grafted(data, showing=False):
    """The bytes of a .gltf or .glb file with the triangle; NoPlace if that cannot be."""
    try:
        if data[:4] != b"glTF":
            root = json.loads(data)
            graft(root, showing)
            return json.dumps(root).encode()
        _, version, _, length, kind = struct.unpack_from("<4sIIII", data)
        if kind != 0x4E4F534A or 20 + length > len(data):
            raise NoPlace("no JSON chunk")
        root = json.loads(data[20 : 20 + length])
        graft(root, showing)
    except (ValueError, struct.error) as error:
        raise NoPlace(str(error)) from error
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    return struct.pack("<4sIIII", b"glTF", version, 20 + len(text) + len(rest), len(text), kind) + text + rest


if __name__ == "__main__":
    try:
        result = grafted(Path(sys.argv[1]).read_bytes(), "--show" in sys.argv[3:])
    except NoPlace as problem:
        print(f"graft: {sys.argv[1]}: {problem}", file=sys.stderr)
        sys.exit(2)
    Path(sys.argv[2]).write_bytes(result)
