"""What Khronos's glTF validator says of files, and what Peelray makes of them:

    validator_test.py PROGRAM FOLDER [MODELS]

No valid file with a triangle may be refused; an invalid one is refused in one line, or drawn with a note where its fault is one of the
picture. The files are our own cases and, where MODELS has them, malformed ones of others: as they are, with a triangle grafted in, and
with everything shown that they hold. FOLDER keeps the validator, an npm package. Status 77: skipped, for npm or the package is missing."""
import json
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import graft
import own_cases

PACKAGE = "gltf-validator@2.0.0-dev.3.10"

# Errors of the validator that no picture of ours shows: what they are about is not read, or stands beside what is.
UNSEEN = {
    "ACCESSOR_MAX_MISMATCH", "ACCESSOR_MIN_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
    "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",  # bounds are computed
    "ACCESSOR_NORMALIZED_INVALID",                      # floats stay what they are
    "ACCESSOR_OFFSET_ALIGNMENT", "ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "ACCESSOR_MATRIX_ALIGNMENT", "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
    "BUFFER_VIEW_INVALID_BYTE_STRIDE", "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
    "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE",  # bytes lie where they say
    "BUFFER_VIEW_TARGET_OVERRIDE", "ACCESSOR_USAGE_OVERRIDE",  # for graphics cards
    "INVALID_URI",  # read all the same, or noted as an image that is damaged
    "BUFFER_DATA_URI_MIME_TYPE_INVALID", "IMAGE_MIME_TYPE_INVALID", "UNSATISFIED_DEPENDENCY", "EMPTY_ENTITY", "UNEXPECTED_PROPERTY",
    "MESH_PRIMITIVE_INVALID_ATTRIBUTE", "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",  # attributes that are not read
    "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",  # a set is found by its number
    "SKIN_NO_COMMON_ROOT", "SKIN_SKELETON_INVALID",  # joints are placed one by one
    # Refused where something reads them, or the scene shows them:
    "ACCESSOR_TOO_LONG", "ACCESSOR_SMALL_BYTESTRIDE", "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "BUFFER_VIEW_TOO_LONG", "NODE_LOOP",
    "CAMERA_ZFAR_LEQUAL_ZNEAR", "ONE_OF_MISMATCH",  # nothing is clipped; the camera's type decides
}


def skip(reason):
    print(f"validator_test: skipped: {reason}")
    sys.exit(77)


def install(folder):
    if not shutil.which("node") or not shutil.which("npm"):
        skip("node and npm are missing")
    if (folder / "node_modules" / "gltf-validator").is_dir():
        return
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.json").write_text('{"private": true}')
    command = ["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", str(folder), PACKAGE]
    try:
        subprocess.run(command, capture_output=True, timeout=120, check=True)
    except (subprocess.SubprocessError, OSError) as problem:
        skip(f"npm cannot install {PACKAGE}: {problem}")


def variants(models, folder):
    """Copies of the models' files with their neighbours, and the grafted ones beside them."""
    copied = folder / "malformed"
    shutil.copytree(models, copied)
    for path in sorted([*copied.rglob("*.gltf"), *copied.rglob("*.glb")]):
        yield path
        for kind, showing in (("grafted", False), ("shown", True)):
            try:
                data = graft.grafted(path.read_bytes(), showing)
            except graft.NoPlace:
                continue
            grafted = path.with_name(f"{path.stem}.{kind}{path.suffix}")
            grafted.write_bytes(data)
            yield grafted


def reports(files, package_folder):
    script = Path(__file__).with_name("validate.mjs")
    text = "\n".join(str(path) for path in files)
    run = subprocess.run(["node", str(script), str(package_folder)], input=text, capture_output=True, text=True, timeout=600, check=True)
    return json.loads(run.stdout)


def looked_at(program, path):
    run = subprocess.run([program, "info", str(path)], capture_output=True, text=True, timeout=120)
    notes = [line[4:].strip() for line in run.stdout.splitlines() if line.startswith("note")]
    notes += [line for line in run.stdout.splitlines() if line.startswith("extensions without effect") and not line.endswith(" none")]
    return run.returncode, run.stderr.strip(), notes


def unseen(report):
    """Is none of the file's faults one of the picture?"""

    def is_unseen(code, pointer):
        if code == "VALUE_NOT_IN_RANGE":
            return pointer.startswith("/bufferViews")
        if code == "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR":
            return not pointer.endswith(("/POSITION", "/NORMAL"))  # other targets are not read
        return code in UNSEEN

    return all(is_unseen(code, pointer) for code, pointer in report["errors"])


def judged(report, status, line, notes):
    """What is wrong with Peelray's answer; empty: nothing."""
    name = Path(report["file"]).name
    if status not in (0, 1):
        return f"status {status}"
    if status == 1 and "\n" in line:
        return "more than one line"
    invalid = "failed" in report or report["errors"]
    if not invalid and report["triangles"] > 0 and status == 1:
        unshown = "grafted" not in name and "shown" not in name and "has no triangles" in line
        required = any(extension in line for extension in report["required"])
        return "" if unshown or required else "valid, but refused: " + line
    # What a grafted file holds beside the triangle may be shown by nothing; the variant that shows all of it tells.
    if "grafted" not in name and invalid and status == 0 and not notes and ("failed" in report or not unseen(report)):
        return f"invalid, but drawn without a word: {report.get('failed') or report['errors']}"
    return ""


def judged_own(expected, status, line, notes):
    if expected == own_cases.REFUSED:
        return "" if status == 1 else "is to be refused"
    if status != 0:
        return "is to be drawn: " + line
    if expected == own_cases.QUIET:
        return f"has nothing to note: {notes}" if notes else ""
    return "" if any(expected in note for note in notes) else f"no note says {expected}: {notes}"


def main():
    program, package_folder = sys.argv[1], Path(sys.argv[2]).resolve()
    models = Path(sys.argv[3]) / "malformed" if len(sys.argv) > 3 else None
    install(package_folder)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        own = own_cases.write(folder)
        files = list(own)
        if models and models.is_dir():
            files += variants(models, folder)
        else:
            print(f"validator_test: no models at {models}: our own cases alone")
        with ThreadPoolExecutor(2) as threads:
            answers = list(threads.map(lambda path: looked_at(program, path), files))
        faults = 0
        for path, report, answer in zip(files, reports(files, package_folder), answers):
            problems = [judged(report, *answer), judged_own(own[path], *answer) if path in own else ""]
            for problem in filter(None, problems):
                print(f"{path.relative_to(folder)}: {problem}")
                faults += 1
        print(f"validator_test: {len(files)} files, {faults} faults")
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
