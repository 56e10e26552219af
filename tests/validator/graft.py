"""Grafts one valid triangle into a glTF or GLB file, so that a loader does not refuse it for having none:

    graft.py IN OUT

What is wrong with the file stays as it is. The new buffer, buffer view, accessor, mesh and node are appended to the file's lists, the
node to its default scene. Status 2, and no output: the file has no place for them."""
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


def graft(root):
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
    node = append(root, "nodes", {"mesh": mesh})
    if scene is not None:
        append(scene, "nodes", node)


def grafted(data):
    """The bytes of a .gltf or .glb file with the triangle; NoPlace if that cannot be."""
    try:
        if data[:4] != b"glTF":
            root = json.loads(data)
            graft(root)
            return json.dumps(root).encode()
        _, version, _, length, kind = struct.unpack_from("<4sIIII", data)
        if kind != 0x4E4F534A or 20 + length > len(data):
            raise NoPlace("no JSON chunk")
        root = json.loads(data[20 : 20 + length])
        graft(root)
    except (ValueError, struct.error) as error:
        raise NoPlace(str(error)) from error
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    return struct.pack("<4sIIII", b"glTF", version, 20 + len(text) + len(rest), len(text), kind) + text + rest


if __name__ == "__main__":
    try:
        result = grafted(Path(sys.argv[1]).read_bytes())
    except NoPlace as problem:
        print(f"graft: {sys.argv[1]}: {problem}", file=sys.stderr)
        sys.exit(2)
    Path(sys.argv[2]).write_bytes(result)
