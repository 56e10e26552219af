#!/usr/bin/env python3
"""Compares the program's pictures of glTF files with those of Blender's Cycles and lays them out side by side.

    bench/cycles.py --program build/release/peelray --models ../shared/models/gltf --out out/cycles

Both programs see the same file from the same place under the same environment: by default a soft one that is made here, so that few
samples do. Cycles renders twice, with diffuse light between surfaces and without it, as the program has none. Prints the table of
docs/cycles.md. Writes for each file OUT/NAME.cycles.exr and NAME.direct.exr, both by Cycles, and the report NAME.html of `peelray
compare`, and with ImageMagick (`montage`) OUT/sheet.png: the program; Cycles, FLIP; Cycles without diffuse bounces, FLIP; and
OUT/small.webp, which is docs/cycles.webp. Needs Blender 3.4 (Debian: `apt-get install --no-install-recommends blender
python3-numpy`).

    bench/cycles.py --times --env spiaggia_di_mondello_1k.hdr --bounces 4 [--repeat 5] [--files A.glb,B.glb]

prints CPU seconds (user and system, of the whole process) instead: the program with `--tracer auto` and Cycles in turn, at 480x384 with
64 samples each, from the camera that frames the file in the program; medians.
"""
import argparse
import base64
import glob
import json
import math
import os
import re
import resource
import shutil
import statistics
import struct
import subprocess
import sys

from scenes import chosen

SCENES = [  # name, file, eye, look, vertical field of view in degrees
    ("WaterBottle", "WaterBottle.glb", (0.16, 0.1, 0.36), (0, 0, 0), 40),
    ("MetalRoughSpheres", "MetalRoughSpheresNoTextures.glb", (0.0028, 0.0027, 0.0112), (0.0028, 0.0027, 0), 40),
    ("ClearCoatTest", "ClearCoatTest.glb", (-2.1, 0.3, 19), (-2.1, 0.3, 0), 40),
    ("TransmissionTest", "TransmissionTest.glb", (-0.077, 0.34, 1.8), (-0.077, 0.06, 0), 34.5),
    ("SheenChair", "SheenChair/SheenChair.gltf", (0.8, 0.7, 1.2), (0, 0.3, 0), 40),
    ("ToyCar", "ToyCar/ToyCar.gltf", (-0.043, 0.024, 0.076), (0, -0.003, 0), 40),
    ("AnisotropyRotationTest", "AnisotropyRotationTest.glb", (0.56, -0.5, 13), (0.56, -0.5, 0), 40),
]
TIMED = ("WaterBottle.glb,NormalTangentMirrorTest.glb,GlassVaseFlowers.glb,AlphaBlendModeTest.glb,EmissiveStrengthTest.glb,"
         "ClearCoatTest.glb,SheenChair.gltf,ToyCar.gltf,CesiumMan.glb,TransmissionTest.glb")
LOBES = [  # direction, radiance in its middle, how narrow
    ((-0.6, 0.7, 0.5), (5.0, 4.2, 3.2), 16),
    ((0.9, 0.2, 0.4), (0.8, 1.4, 2.4), 16),
    ((0.2, 0.3, -1.0), (2.4, 1.2, 1.6), 16),
]


def soft_radiance(x, y, z):
    """A sky over a brown ground with three soft lamps of different colours."""
    up = 0.5 + 0.5 * y
    colour = [0.16 * (1 - up) + 0.45 * up, 0.12 * (1 - up) + 0.55 * up, 0.08 * (1 - up) + 0.75 * up]
    for direction, radiance, narrow in LOBES:
        cosine = (x * direction[0] + y * direction[1] + z * direction[2]) / math.hypot(*direction)
        weight = math.exp(narrow * (cosine - 1))
        colour = [c + weight * r for c, r in zip(colour, radiance)]
    return colour


def write_environment(path, radiance, height=128):
    """A Radiance file, equirectangular as docs/conventions.md says: -z in the middle, +x right of it."""
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, 2 * height))
        for row in range(height):
            theta = math.pi * (row + 0.5) / height
            for column in range(2 * height):
                phi = math.pi * ((column + 0.5) / height - 1)
                colour = radiance(math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
                exponent = math.frexp(max(colour))[1]
                file.write(struct.pack("4B", *(int(math.ldexp(c, 8 - exponent)) for c in colour), exponent + 128))


def run(words, **options):
    done = subprocess.run(words, capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{words[0]} failed:\n" + "\n".join((done.stdout + done.stderr).strip().splitlines()[-20:]))
    return done


def vector(v):
    return ",".join(str(c) for c in v)


def render_cycles(a, path, view, stem, pictures, run=run, **more):
    eye, look, fov = view
    job = {"file": path, "env": a.env, "eye": eye, "look": look, "fov": fov, "size": a.size, "samples": a.samples,
           "bounces": a.bounces, "pictures": pictures, **more}
    with open(stem + ".json", "w", encoding="utf-8") as file:
        json.dump(job, file)
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "cycles_blender.py")
    # Debian's Blender takes its modules from the first python3 of PATH: it must be Debian's, which has numpy.
    return run([a.blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", script, "--", stem + ".json"],
        env={**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]})


def compare(a, path, view, stem, pictures):
    """Renders with the program. FLIP of each picture against that, and where the report's pictures lie: ours, then each and its map."""
    eye, look, fov = view
    run([a.program, "compare", path, "-o", stem + ".html", "--json", stem + ".json", "--size", f"{a.size[0]}x{a.size[1]}",
         "--spp", str(a.spp), "--bounces", str(a.bounces), "--env", a.env, "--eye", vector(eye), "--look", vector(look),
         "--fov", str(fov), "--effects", "reflection,refraction,shadow,ambient", "--exposure", str(a.exposure), "--tracers", "ldc"] +
        [word for picture in pictures for word in ("--picture", picture)])
    with open(stem + ".json", encoding="utf-8") as file:
        flip = [picture["difference"]["flip"] for picture in json.load(file)["pictures"] if "difference" in picture]
    with open(stem + ".html", encoding="utf-8") as file:
        figures = re.findall(r'<img width="\d+" height="\d+" alt="([^"]*)" src="data:image/png;base64,([^"]*)"', file.read())
    files = {name: f"{stem}.{i}.png" for i, (name, _) in enumerate(figures)}
    for name, data in figures:
        with open(files[name], "wb") as file:
            file.write(base64.b64decode(data))
    names = [os.path.basename(picture) for picture in pictures]
    return flip, [files["ldc"]] + [files[prefix + name] for name in names for prefix in ("", "FLIP: ")]


def cpu_seconds(words, **options):
    """Of the whole process, children included: user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run(words, **options)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def times(a):
    """The table of --times."""
    print("| file | CPU s | Cycles, CPU s | of its time |\n|---|---:|---:|---:|", flush=True)
    for file in a.files.split(","):
        found = sorted(glob.glob(os.path.join(a.models, "..", "**", glob.escape(file)), recursive=True))
        if not found:
            print(f"{file}: not among the models", file=sys.stderr)
            continue
        path, name = os.path.abspath(found[0]), file.split(".")[0]
        stem = os.path.join(a.out, name)
        common = [a.program, "render", path, "--env", a.env, "--size", f"{a.size[0]}x{a.size[1]}", "--bounces", str(a.bounces)]
        moment = {"time": a.moment} if name == "CesiumMan" else {}
        still = ["--time", str(a.moment)] if moment else []
        run(common + still + ["-o", stem + ".png", "--stats", stem + ".json"])
        with open(stem + ".json", encoding="utf-8") as stats:
            camera = json.load(stats)["camera"]
        view = (camera["eye"], camera["look"], camera["fov"])
        ours = common + still + ["--spp", str(a.spp), "-o", stem + ".png", "--eye=" + vector(view[0]), "--look=" + vector(view[1]),
                                 "--fov", str(view[2])]
        both = []
        for _ in range(a.repeat):
            both.append((cpu_seconds(ours), render_cycles(a, path, view, stem, [[stem + ".exr", a.bounces]], cpu_seconds, energy=False,
                                                                **moment)))
        mine, theirs = (statistics.median(column) for column in zip(*both))
        print(f"| {name} | {mine:.1f} | {theirs:.1f} | {mine / theirs:.2f} |", flush=True)


def sheet(path, rows, labels, across, size):
    """One row of pictures for each file, as many as there are labels; `across` files side by side."""
    tiles = [word for name, pictures in rows for label, picture in zip(labels, pictures) for word in ("-label", label or name, picture)]
    run(["montage", "-geometry", f"{size[0]}x{size[1]}+2+2", "-tile", f"{across * len(labels)}x", "-background", "white", "-depth", "8",
         "-quality", "90"] + tiles + [path])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--models", default="../shared/models/gltf")
    parser.add_argument("--out", default="out/cycles")
    parser.add_argument("--only", help="files whose name contains this")
    parser.add_argument("--env", help="environment map; default: a soft one that is made here")
    parser.add_argument("--size", help="default: 320x256; of --times 480x384")
    parser.add_argument("--spp", type=int, default=64, help="the program's samples per pixel")
    parser.add_argument("--samples", type=int, help="Cycles' samples per pixel; default: 128, of --times the program's")
    parser.add_argument("--times", action="store_true", help="compare CPU seconds, not pictures")
    parser.add_argument("--files", default=TIMED, help="of --times")
    parser.add_argument("--repeat", type=int, default=5, help="of --times")
    parser.add_argument("--moment", type=float, default=0.4, help="of what is animated, with --times")
    parser.add_argument("--bounces", type=int, default=8)
    parser.add_argument("--exposure", default=0, help="of what is compared and shown, in stops")
    parser.add_argument("--keep", action="store_true", help="use the pictures by Cycles that an earlier run left in OUT")
    a = parser.parse_args()
    if not shutil.which(a.blender):
        sys.exit("Blender is missing: apt-get install --no-install-recommends blender python3-numpy (or name it with --blender)")
    a.out = os.path.abspath(a.out)
    os.makedirs(a.out, exist_ok=True)
    a.size = [int(n) for n in (a.size or ("480x384" if a.times else "320x256")).split("x")]
    a.samples = a.samples or (a.spp if a.times else 128)
    if not a.env:
        a.env = os.path.join(a.out, "soft.hdr")
        write_environment(a.env, soft_radiance)
    a.env = os.path.abspath(a.env)
    if a.times:
        return times(a)
    rows = []
    print("| file | FLIP | without diffuse bounces |\n|---|---:|---:|", flush=True)
    for name, path, *view in chosen(SCENES, a.models, a.only):
        stem = os.path.join(a.out, name)
        full, direct = stem + ".cycles.exr", stem + ".direct.exr"
        if not (a.keep and os.path.exists(full) and os.path.exists(direct)):
            render_cycles(a, os.path.abspath(path), view, stem, [[full, a.bounces], [direct, 0]])
        flip, pictures = compare(a, path, view, stem, [full, direct])
        print(f"| {name} | {flip[0]:.3f} | {flip[1]:.3f} |", flush=True)
        rows.append((name, pictures))
    if not shutil.which("montage"):
        print("no sheet: ImageMagick's montage is missing", file=sys.stderr)
    elif rows:
        sheet(os.path.join(a.out, "sheet.png"), rows, ("", "Cycles", "FLIP", "Cycles, no diffuse bounces", "FLIP"), 1, a.size)
        sheet(os.path.join(a.out, "small.webp"), rows, ("", "Cycles", "FLIP"), 2, (200, 160))


if __name__ == "__main__":
    main()
