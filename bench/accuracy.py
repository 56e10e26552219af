#!/usr/bin/env python3
"""Compares the method and its baseline with the reference on many scenes and prints the tables of docs/accuracy.md.

    bench/accuracy.py --program build/release/peelray --models ../shared/models --out accuracy.json --pictures FOLDER

Each row is `peelray compare` with the options shown, at 1280x1024 and one sample per pixel. Scenes whose file is missing are left
out, with a line that says so; so are resolutions that the device cannot bind.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

from scenes import chosen, find

MIRROR = ["--material", "mirror", "--floor", "--sky"]
SCENES = [  # name, file or built-in, options
    ("teapots", "builtin:teapots", []),
    ("glass", "builtin:glass", []),
    ("tree", "builtin:tree", []),
    ("blob 100K", "builtin:blob:100000", []),
    ("bunny, mirror", "meshes/bunny_7k.off", MIRROR),
    ("car", "meshes/car2.glb", ["--floor", "--sky"]),
    ("dragon, mirror", "meshes/chinesedragon.gltf", MIRROR),
    ("dragon, as it is", "meshes/chinesedragon.gltf", ["--sky"]),
    ("igea, mirror", "meshes/igea.ply", MIRROR),
    ("nefertiti, mirror", "meshes/nefertiti.obj", MIRROR),
    ("nefertiti, glass", "meshes/nefertiti.obj", ["--material", "glass", "--floor", "--sky"]),
    ("TransmissionTest", "gltf/TransmissionTest.glb", ["--sky"]),
    ("ToyCar", "gltf/ToyCar/ToyCar.gltf", ["--sky"]),
]
WALK = ["--animation", "all", "--floor", "--sky"]
MOVING = [  # name, file or built-in, options, seconds
    ("tiny, Walk", "skinned/tiny.glb", ["--animation", "Walk", "--floor", "--sky"], [0, 0.4, 1.7]),
    ("CesiumMan", "skinned/CesiumMan.glb", WALK, [0.7, 1.5]),
    ("RiggedFigure", "skinned/RiggedFigure.glb", WALK, [0.2, 1]),
    ("AnimatedMorphCube", "skinned/AnimatedMorphCube.glb", WALK, [1.3, 3.1]),
    ("InterpolationTest", "skinned/InterpolationTest.glb", WALK, [0.6, 1.4]),
    ("BoxAnimated", "skinned/BoxAnimated.glb", WALK, [0.8, 2.1]),
    ("Animation_Skin_08", "skinned/AssetGenerator/Animation_Skin_08.gltf", WALK, [0.4, 1.3]),
    ("Animation_Skin_10", "skinned/AssetGenerator/Animation_Skin_10.gltf", WALK, [0.4, 1.3]),
    ("walker", "builtin:walker", [], [0.5, 3.1]),
    ("blob 100K, swell", "builtin:blob:100000", [], [0.7]),
    ("waves", "builtin:waves", [], [0, 0.9, 2.5]),
    ("particles, one bounce", "builtin:particles", ["--bounces", "1"], [0, 1.6]),
    ("particles", "builtin:particles", [], [1.6]),
]
EXACT_BARS = {"flip": 0.002, "share_different": 0.001}
PLANAR_BAR = 0.02
STAGES = [  # what the pixels off come from: each row adds to the one before
    ("camera rays", ["--effects", "none"]),
    ("+ shadows", ["--effects", "shadow"]),
    ("+ first bounce", ["--bounces", "1"]),
    ("+ second bounce", ["--bounces", "2"]),
    ("+ four bounces", []),
]


def compare(program, words, worst=None):
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "compare", words[0], "-o", os.path.join(folder, "r.html"), "--json", os.path.join(folder, "r.json")]
        if worst:
            command += ["--worst", worst]
        done = subprocess.run(command + words[1:], capture_output=True, text=True)
        if done.returncode != 0:
            return None, done.stderr.strip().splitlines()[-1]
        with open(os.path.join(folder, "r.json")) as file:
            return json.load(file), None


def row(name, triangles, label, d, bars):
    mark = lambda key: " (missed)" if d[key] > bars.get(key, float("inf")) else ""
    return (f"| {name} | {triangles:,} | {label} | {d['flip']:.5f}{mark('flip')} | {d['hdr_flip']:.5f} | {d['ssim']:.5f} | "
            f"{d['psnr_db'] or float('inf'):.1f} | {100 * d['share_different']:.4f}{mark('share_different')} |")


def rows_of(name, result, size, results, **about):
    """Prints a row for each picture of a report."""
    results.append({"name": name, "ldc": size, "result": result, **about})
    for picture in result["pictures"]:
        d = picture.get("difference")
        if not d:
            continue
        label = picture["name"] if picture["name"] == "cubemap" else f"{picture['name'][4:]} {size}"
        bars = {}
        if picture["name"] == "ldc exact":
            bars = EXACT_BARS
        elif picture["name"] == "ldc planar" and (size == "auto" or int(size) >= 1024):
            bars = {"flip": PLANAR_BAR}
        print(row(name, result["triangles"], label, d, bars), flush=True)


def moving(a, results):
    for name, path, options, times in chosen(MOVING, a.models, a.only):
        for time in times:
            words = [path] + options + ["--time", str(time), "--tracers", "ldc,reference", "--hit", "exact,planar"]
            result, error = compare(a.program, words)
            if result is None:
                print(f"{name} at {time} s: {error}", file=sys.stderr)
                continue
            rows_of(f"{name}, {time} s", result, "auto", results, options=options, time=time)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--models", default="../shared/models")
    parser.add_argument("--sizes", default="256,512,1024,2048", help="resolutions of the cube")
    parser.add_argument("--only", default="", help="scenes whose name holds this")
    parser.add_argument("--moving", action="store_true", help="moments of scenes that move instead, --ldc auto")
    parser.add_argument("--stages", default="dragon, mirror;nefertiti, glass;teapots", help="scenes to take apart")
    parser.add_argument("--pictures", help="folder for pictures of the worst pixels")
    parser.add_argument("--out", default="accuracy.json")
    a = parser.parse_args()
    results = []
    print("| scene | triangles | picture | FLIP | HDR-FLIP | SSIM | PSNR dB | pixels off % |\n|---|---:|---|---:|---:|---:|---:|---:|")
    if a.moving:
        moving(a, results)
    for name, path, options in chosen([] if a.moving else SCENES, a.models, a.only):
        for index, size in enumerate(a.sizes.split(",")):
            tracers = "cubemap,ldc,reference" if index == 0 else "ldc,reference"
            worst = os.path.join(a.pictures, f"{name.replace(', ', '-').replace(' ', '-')}-{size}.png") if a.pictures else None
            words = [path] + options + ["--tracers", tracers, "--hit", "exact,planar", "--ldc", size]
            result, error = compare(a.program, words, worst)
            if result is None:
                print(f"{name} at {size}: {error}", file=sys.stderr)
                continue
            rows_of(name, result, size, results, options=options)
    if not a.moving:
        print("\n| scene | " + " | ".join(stage for stage, _ in STAGES) + " |\n|---|" + "---:|" * len(STAGES))
    for wanted in [] if a.moving else a.stages.split(";"):
        for name, scene, options in SCENES:
            path = find(a.models, scene)
            if name != wanted or path is None:
                continue
            counts = []
            for _, extra in STAGES:
                words = [path] + options + extra + ["--tracers", "ldc,reference", "--hit", "exact", "--ldc", "512"]
                result, error = compare(a.program, words)
                share = result["pictures"][0]["difference"]["share_different"] if result else None
                counts.append("-" if share is None else f"{share * 1280 * 1024:.0f}")
            results.append({"name": name, "stages": counts})
            print(f"| {name} | " + " | ".join(counts) + " |", flush=True)
    with open(a.out, "w") as file:
        json.dump(results, file, indent=1)


if __name__ == "__main__":
    main()
