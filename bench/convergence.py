#!/usr/bin/env python3
"""How the error of pictures falls with their samples, and whether their mean is right.

    bench/convergence.py --program build/release/peelray --models ../shared/models --tracer cpu --plot docs/convergence.svg

For each scene, at 120x96: the root of the mean squared error at 1, 4, 16, 64 and 256 samples, and mean FLIP at 1, 16 and 256, against
`--tracer reference` with 4096 samples of another seed; the slope of the error over the samples in double logarithm, which is -0.5
for independent ones; and with each effect alone the difference of the mean over eight pictures of 64 samples and as many seeds from
as many by the reference of other seeds, in percent of the scene's mean radiance, with its standard error. (Where the samples of a
pixel lie depends on their number alone: what they miss of edges and of a sun's images is the same for all seeds.)
Needs numpy and, for the plot, matplotlib (Debian: python3-numpy, python3-matplotlib).
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy

from exr import read_rgb
from scenes import chosen

HDR = ["--env", "HDR", "--env-visible", "no", "--background", "0,0,0"]  # a sun in the picture would be all of the error
SCENES = [  # name, file or built-in, options
    ("teapots", "builtin:teapots", HDR),
    ("ToyCar", "gltf/ToyCar/ToyCar.gltf", HDR),
    ("SheenChair", "gltf/SheenChair/SheenChair.gltf", HDR),
    ("TransmissionRoughness", "gltf/TransmissionRoughnessTest.glb", HDR),
    ("MetalRoughSpheres", "gltf/MetalRoughSpheresNoTextures.glb", HDR),
    ("ClearCoat", "gltf/ClearCoatTest.glb", HDR),
    ("Emissive", "gltf/EmissiveStrengthTest.glb", ["--background", "0,0,0", "--floor", "--gi", "1"]),
    ("room", "builtin:room", ["--gi", "2", "--clamp", "20"]),
]
SAMPLES = [1, 4, 16, 64, 256]
EFFECTS = ["reflection", "refraction", "shadow"]


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(" ".join(words) + "\n" + done.stderr)


class Pictures:
    def __init__(self, a, path, options):
        self.a, self.path, self.folder = a, path, tempfile.mkdtemp(prefix="convergence-")
        self.options = [a.env if word == "HDR" else word for word in options]

    def render(self, name, tracer, spp, seed, effects=None):
        """The linear picture; its OpenEXR file stays under that name."""
        exr = os.path.join(self.folder, name + ".exr")
        run([self.a.program, "render", self.path, "-o", exr, "--size", self.a.size, "--tracer", tracer, "--spp", str(spp), "--seed",
             str(seed)] + (["--effects", effects] if effects else []) + self.options)
        return read_rgb(exr)

    def flip(self, names):
        """Mean FLIP of each to the reference, which is rendered once more."""
        report = os.path.join(self.folder, "r.json")
        words = [word for name in names for word in ("--picture", os.path.join(self.folder, name + ".exr"))]
        run([self.a.program, "compare", self.path, "--tracers", "reference", "--spp", str(self.a.truth // 4), "-o", os.path.join(self.folder, "r.html"), "--json", report,
             "--size", self.a.size] + self.options + words)
        with open(report, encoding="utf-8") as file:
            return {p["name"].removesuffix(".exr"): p["difference"]["flip"] for p in json.load(file)["pictures"] if "difference" in p}


def errors_of(pictures, a):
    """Root mean squared errors by samples, and the reference's mean."""
    truth = pictures.render("truth", "reference", a.truth, 999)
    errors = []
    for spp in SAMPLES:
        squares = [numpy.mean((pictures.render(f"n{spp}", a.tracer, spp, seed) - truth) ** 2) for seed in range(1, 3)]
        errors.append(float(numpy.sqrt(numpy.mean(squares))))
    return errors, truth


def bias_of(pictures, a, effects, scale):
    """Percent of `scale`: the difference of means, and its standard error."""
    truth = numpy.mean([pictures.render("mean", "reference", a.of, 900 + seed, effects).mean() for seed in range(a.seeds)])
    means = [pictures.render("seed", a.tracer, a.of, seed, effects).mean() for seed in range(a.seeds)]
    error = numpy.std(means, ddof=1) / numpy.sqrt(a.seeds)
    return 100 * (numpy.mean(means) - truth) / scale, 100 * error / scale


def plot(path, curves):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "peelray"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6.4, 4.2))
    for name, errors in curves:
        axes.loglog(SAMPLES, [e / errors[0] for e in errors], marker="o", markersize=3, label=name)
    axes.loglog(SAMPLES, [n ** -0.5 for n in SAMPLES], color="black", linestyle="--", label="1/√N")
    axes.set_xlabel("samples per pixel")
    axes.set_ylabel("error by that of one sample")
    axes.legend(fontsize=7)
    figure.savefig(path, bbox_inches="tight", metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/peelray")
    parser.add_argument("--models", default="../shared/models")
    parser.add_argument("--tracer", default="cpu")
    parser.add_argument("--size", default="120x96")
    parser.add_argument("--truth", type=int, default=4096, help="samples of the reference")
    parser.add_argument("--of", type=int, default=64, help="samples of the pictures whose mean is looked at")
    parser.add_argument("--seeds", type=int, default=8, help="how many there are")
    parser.add_argument("--only", help="scenes whose name contains this")
    parser.add_argument("--plot", help="SVG file to write")
    a = parser.parse_args()
    a.env = os.path.abspath(os.path.join(a.models, "env", "spiaggia_di_mondello_1k.hdr"))
    curves = []
    print("| scene | " + " | ".join(f"error at {n}" for n in SAMPLES) + " | slope | FLIP at 1, 16, 256 | "
          + " | ".join(f"bias with {effect}, %" for effect in ["none"] + EFFECTS) + " |")
    print("|---|" + "---:|" * (len(SAMPLES) + 2 + 1 + len(EFFECTS)), flush=True)
    for name, path, options in chosen(SCENES, a.models, a.only):
        pictures = Pictures(a, path, options)
        errors, truth = errors_of(pictures, a)
        slope = numpy.polyfit(numpy.log(SAMPLES), numpy.log(errors), 1)[0]
        flip = pictures.flip(["n1", "n16", "n256"])
        biases = [bias_of(pictures, a, effects, truth.mean()) for effects in ["none"] + EFFECTS]
        print(f"| {name} | " + " | ".join(f"{e:.4f}" for e in errors) + f" | {slope:.2f} | "
              + ", ".join(f"{flip.get(n, float('nan')):.3f}" for n in ("n1", "n16", "n256")) + " | "
              + " | ".join(f"{bias:+.2f} ± {error:.2f}" for bias, error in biases) + " |", flush=True)
        curves.append((name, errors))
    if a.plot and curves:
        plot(a.plot, curves)


if __name__ == "__main__":
    main()
