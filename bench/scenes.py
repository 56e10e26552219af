"""Finding the scenes of a benchmark."""
import os
import sys


def find(models, scene):
    """The file of a scene in the folder `models`, a built-in scene as it is, or None."""
    if scene.startswith("builtin:"):
        return scene
    path = os.path.join(models, scene)
    if not os.path.exists(path):  # the sample assets keep variants in folders
        folder, name = os.path.split(path)
        for root, _, files in sorted(os.walk(folder)):
            if name in files:
                return os.path.join(root, name)
    return path if os.path.exists(path) else None


def chosen(scenes, models, only):
    """Those whose name contains `only`, (name, scene, ...), with the scene's file; a line for each that is not there."""
    for name, scene, *rest in scenes:
        if only and only not in name:
            continue
        path = find(models, scene)
        if path is None:
            print(f"left out: {name}: there is no {os.path.join(models, scene)}", file=sys.stderr)
            continue
        yield name, path, *rest
