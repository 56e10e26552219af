#!/usr/bin/env python3
"""docs_test.py [PROGRAM]: checks README.md, docs/*.md and findings/*.md, and what sources say about them.

README.md has at most 1,300 words; prose is wrapped at 120 columns; relative links lead to files and headings that exist;
its table of glTF extensions, and that of docs/scenes.md, list those that the loader supports and no others;
documents and files that are named exist, with the sections that are named; every option of PROGRAM that is named is in its
help.
The faults of a small folder made here are found, too: a check that finds nothing would pass any document.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = sys.argv[1] if len(sys.argv) > 1 else None
README_WORDS = 1300
COLUMNS = 120
SOURCES = ("src", "include", "shaders", "tests", "bench", "scripts", "examples")
SOURCE_SUFFIXES = {".cpp", ".h", ".glsl", ".comp", ".vert", ".frag", ".geom", ".tesc", ".tese", ".py", ".sh", ".sbatch",
                   ".rgen", ".rchit", ".rahit", ".rmiss", ".txt"}
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")


def documents(root):
    return [root / "README.md", *sorted((root / "docs").glob("*.md")), *sorted((root / "findings").glob("*.md"))]


def prose_and_code(text):
    """Yields (line number, line, is code). Code is fenced, or indented by four and more where no list item goes on."""
    fenced = in_list = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            yield number, line, True
            continue
        if re.match(r"\s{0,3}([-*]|\d+\.) ", line):
            in_list = True
        elif line.strip() and not line.startswith(" "):
            in_list = False
        yield number, line, fenced or (line.startswith("    ") and not in_list)


def headings(text):
    """The anchors that GitHub makes of the headings."""
    found = set()
    for _, line, code in prose_and_code(text):
        if not code and line.startswith("#"):
            title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip()).lower()
            slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
            number, anchor = 0, slug
            while anchor in found:
                number += 1
                anchor = f"{slug}-{number}"
            found.add(anchor)
    return found


def length_faults(root):
    words = len((root / "README.md").read_text().split())
    faults = [] if words <= README_WORDS else [f"README.md: {words} words, at most {README_WORDS}"]
    for document in documents(root):
        for number, line, code in prose_and_code(document.read_text()):
            free = code or line.startswith(("|", "#", "<", "![")) or " " not in line.strip(" -")
            if len(line) > COLUMNS and not free:
                faults.append(f"{document.name}:{number}: {len(line)} columns, at most {COLUMNS}")
    return faults


def link_faults(root):
    faults = []
    for document in documents(root):
        for number, line, code in prose_and_code(document.read_text()):
            if code:
                continue
            plain = re.sub(r"`[^`]*`", "", line)
            for link in re.findall(r"\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"", plain):
                link = link[0] or link[1]
                if re.match(r"[a-z]+:", link):
                    continue
                path, _, anchor = link.partition("#")
                target = (document.parent / path).resolve() if path else document
                if not target.exists():
                    faults.append(f"{document.name}:{number}: {link}: no such file")
                elif anchor and anchor not in headings(target.read_text()):
                    faults.append(f"{document.name}:{number}: {link}: no such heading")
    return faults


def named_faults(root):
    """Documents, and sections of them, that are named and do not exist."""
    faults = []
    sources = [p for folder in SOURCES for p in sorted((root / folder).rglob("*")) if p.suffix in SOURCE_SUFFIXES]
    for path in documents(root) + [p for p in sources if p.resolve() != pathlib.Path(__file__).resolve()]:
        text = path.read_text()
        # Comments go on in the next line.
        joined = re.sub(r"\s*\n\s*(//[/!]?|#|\*)?\s*", " ", text)
        for name, section in re.findall(r"(?<![\w/.])([\w/.]*\w\.md)\b(?:\)?,? \"([^\"]+)\")?", joined):
            is_document = name.startswith("docs/") or (name.split(".")[0].isupper() and name != "FILE.md")
            if path.suffix == ".md":
                is_document = is_document or f"--markdown {name}" not in joined
            if not is_document:
                continue
            target = next((p for p in (root / name, path.parent / name) if p.is_file()), None)
            if target is None:
                faults.append(f"{path.relative_to(root)}: {name}: no such document")
            elif section and path.suffix != ".md" and section.lower() not in target.read_text().lower():
                faults.append(f"{path.relative_to(root)}: {name} has no '{section}'")
        for name in re.findall(r"\b([A-Z]{4,}),? section", joined):
            faults.append(f"{path.relative_to(root)}: {name}: no such document")
    return faults


def path_faults(root):
    """Files of the sources that the documents name and that do not exist. What add_*.md has the reader make may not."""
    made = {p.name for folder in ("src", "include", "shaders", "tests", "bench") for p in (root / folder).rglob("*.*")}
    faults = []
    for document in documents(root):
        for number, line, code in prose_and_code(document.read_text()):
            for span in re.findall(r"`([^`\s]+)`", "" if code else line):
                span = span.replace("NAME", "*")
                if re.fullmatch(r"(src|include|shaders|tests|bench|scripts|examples|cmake|docs|findings)/[\w./*-]+", span):
                    there = any(root.glob(span.rstrip("/")))
                    if not there and document.name.startswith("add_"):
                        there = any(root.glob(str(pathlib.PurePath(span).parent)))
                elif re.fullmatch(r"\w+\.(comp|glsl|vert|frag|geom|cpp|h|py)", span):
                    there = span in made or document.name.startswith("add_")
                else:
                    continue
                if not there:
                    faults.append(f"{document.name}:{number}: {span}: no such file")
    return faults


def rows_of(text, header):
    """The cells of the rows of the table whose first line has `header`; none where there is no such table."""
    lines = text.splitlines()
    start = next((i for i, line in enumerate(lines) if line.startswith("|") and header in line), len(lines))
    for line in lines[start + 2:]:
        if not line.startswith("|"):
            return
        yield line.strip("| ").split("|")


def extension_faults(root):
    """glTF extensions that the loader supports and a table of them lacks, in README.md and docs/scenes.md, and those that
    are there and not supported."""
    checks = (root / "src/loaders/gltf_check.cpp").read_text()
    names = re.findall(r'"((?:KHR|EXT)_\w+)"', checks[checks.index("supported_extensions"):].split(";")[0])
    faults = []
    for document, header, column in (("README.md", "extensions of glTF", 1), ("docs/scenes.md", "| extension |", 0)):
        cells = [row[column] for row in rows_of((root / document).read_text(), header)]
        listed = re.findall(r"\b(?:KHR|EXT)_\w+", " ".join(cells))
        name = pathlib.PurePath(document).name
        faults += [f"{name}: {each} is read and not in the table" for each in names if each not in listed]
        faults += [f"{name}: {each} is in the table and not read" for each in listed if each not in names]
    return faults


def help_of_program():
    """The options of each command, by its help pages."""
    page = lambda *command: subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=True).stdout
    top = page()
    commands = re.findall(r"^  ([a-z]+)  ", top[top.index("Subcommands:"):], re.M)
    options = {command: set(OPTION.findall(page(command))) for command in commands if command != "view"}
    return options, set(OPTION.findall(top)).union(*options.values())


def commands_of(text):
    """Yields (line number, command) of code that begins with a command, continued lines joined."""
    command, first = "", 0
    for number, line, code in prose_and_code(text):
        if not code:
            continue
        line = line.strip().removeprefix("$ ")
        first = first if command else number
        command += line.removesuffix("\\").strip() + " "
        if not line.endswith("\\"):
            yield first, command.strip()
            command = ""


def option_faults(root, options, any_option):
    """`options`: those of each command; `any_option`: those of all commands. Beside them those of the scripts count."""
    known = set(any_option)
    for script in (root / "bench").glob("*.*"):
        known |= set(re.findall(r"\"(--[a-z][a-z-]*)\"", script.read_text()))
        known |= set(re.findall(r"\"(?:[a-z-]+,)?(--[a-z][a-z-]*)\"", script.read_text()))
    faults = []
    for document in documents(root):
        text = document.read_text()
        for number, command in commands_of(text):
            match = re.match(r"(?:exec )?(?:\S*/)?peelray ([a-z]+)\b", command)
            if match and match[1] in options:
                for option in OPTION.findall(command.split(" # ")[0]):
                    if option not in options[match[1]]:
                        faults.append(f"{document.name}:{number}: peelray {match[1]} has no {option}")
            elif re.match(r"(?:\S*/)?(\w+\.py|agreement|hierarchies) ", command):
                for option in OPTION.findall(command):
                    if option not in known:
                        faults.append(f"{document.name}:{number}: {command.split()[0]} has no {option}")
        for number, line, code in prose_and_code(text):
            if code:
                continue
            for span in re.findall(r"`([^`]*)`", line):
                if re.match(r"(cmake|ctest|git|ffmpeg|sbatch) ", span):
                    continue
                for option in OPTION.findall(span):
                    if option not in known and not document.name.startswith("add_"):
                        faults.append(f"{document.name}:{number}: no command has {option}")
    return faults


class Documents(unittest.TestCase):
    """The documents of the repository."""

    def test_lengths(self):
        self.assertEqual(length_faults(ROOT), [])

    def test_links(self):
        self.assertEqual(link_faults(ROOT), [])

    def test_extensions(self):
        self.assertEqual(extension_faults(ROOT), [])

    def test_named_documents(self):
        self.assertEqual(named_faults(ROOT), [])

    def test_paths(self):
        self.assertEqual(path_faults(ROOT), [])

    @unittest.skipIf(PROGRAM is None, "no program was given")
    def test_options(self):
        options, any_option = help_of_program()
        self.assertIn("--resume", options["render"])
        self.assertNotIn("--resume", options["trace"])
        self.assertEqual(option_faults(ROOT, options, any_option), [])


class Faults(unittest.TestCase):
    """Each check finds its fault in a folder that is made for it, and nothing where there is none."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("docs", "findings", "bench", "src"):
            (self.root / name).mkdir()
        self.write("README.md", "# Title\n\nSee [there](docs/a.md#a-heading), `--good`.\n\n    peelray render x --good\n")
        self.write("docs/a.md", "# A `heading`\n\nText, and [back](../README.md).\n")
        self.write("src/a.cpp", "// docs/a.md, \"A `heading`\"\n")

    def write(self, name, text):
        (self.root / name).write_text(text)

    def option_faults(self):
        return option_faults(self.root, {"render": {"--good"}, "trace": {"--other"}}, {"--good", "--other"})

    def test_a_good_folder_has_none(self):
        self.assertEqual(length_faults(self.root) + link_faults(self.root) + named_faults(self.root) +
                         path_faults(self.root), [])
        self.assertEqual(self.option_faults(), [])

    def test_lengths(self):
        self.write("README.md", "word " * 10 + "\n" + "two words\n" * 651)
        self.write("docs/a.md", "word " * 25 + "\n\n| " + "word " * 25 + "|\n\n    " + "word " * 25 + "\n")
        self.assertEqual(length_faults(self.root),
                         ["README.md: 1312 words, at most 1300", "a.md:1: 125 columns, at most 120"])

    def test_links(self):
        self.write("docs/a.md", "# A\n\n[x](b.md) [y](#nowhere) [z](../README.md#title)\n\n![p](p.png) <img src=\"q.png\">\n")
        self.assertEqual(link_faults(self.root),
                         ["README.md:3: docs/a.md#a-heading: no such heading", "a.md:3: b.md: no such file",
                          "a.md:3: #nowhere: no such heading", "a.md:5: p.png: no such file",
                          "a.md:5: q.png: no such file"])

    def test_named_documents(self):
        self.write("docs/a.md", "# A\n\nAs the PLAN.md and the PLAN, section 3, say; also in other.md.\n\n    x --markdown out.md\n")
        self.write("src/a.cpp", "// As docs/b.md and\n// DESIGN.md say, and docs/a.md,\n// \"Some section\". But out.md is a file.\n")
        self.assertEqual(named_faults(self.root),
                         ["docs/a.md: PLAN.md: no such document", "docs/a.md: other.md: no such document",
                          "docs/a.md: PLAN: no such document", "src/a.cpp: docs/b.md: no such document",
                          "src/a.cpp: DESIGN.md: no such document", "src/a.cpp: docs/a.md has no 'Some section'"])

    def test_extensions(self):
        (self.root / "src/loaders").mkdir()
        self.write("src/loaders/gltf_check.cpp",
                   'auto supported_extensions = {"KHR_a", "EXT_b",\n  "KHR_materials"};\nMember x("KHR_c");\n')
        readme = "# A\n\n| | extensions of glTF |\n|---|---|\n| KHR_c | KHR_a, EXT_b |\n| more | {} |\n\nKHR_d\n"
        scenes = "# A\n\n| extension | read |\n|---|---|\n| KHR_a, EXT_b | as KHR_c |\n{}\n| KHR_d | |\n"
        self.write("README.md", readme.format("KHR_materials"))
        self.write("docs/scenes.md", scenes.format("| KHR_materials | |\n"))
        self.assertEqual(extension_faults(self.root), [])
        self.write("README.md", readme.format("KHR_materials_x, EXT_y"))
        self.write("docs/scenes.md", scenes.format("| EXT_y | |\n"))
        self.assertEqual(extension_faults(self.root),
                         ["README.md: KHR_materials is read and not in the table",
                          "README.md: KHR_materials_x is in the table and not read",
                          "README.md: EXT_y is in the table and not read",
                          "scenes.md: KHR_materials is read and not in the table",
                          "scenes.md: EXT_y is in the table and not read"])
        self.write("README.md", "# A\n\nKHR_a, EXT_b, KHR_materials\n")
        self.assertEqual(len(extension_faults(self.root)), 3 + 2)

    def test_paths(self):
        self.write("docs/a.md", "# A\n\n`src/a.*`, `a.cpp`, `src/b.cpp`, `b.comp`\n\n    `src/code.cpp`\n")
        self.write("docs/add_x.md", "# X\n\n`src/new.cpp`, `new.comp`, `nowhere/or/not`, `src/gone/new.cpp`\n")
        self.assertEqual(path_faults(self.root),
                         ["a.md:3: src/b.cpp: no such file", "a.md:3: b.comp: no such file",
                          "add_x.md:3: src/gone/new.cpp: no such file"])

    def test_options(self):
        self.write("docs/a.md", "# A\n\n`--bad` and `--other`, `cmake --preset x`\n\n    $ peelray render x \\\n        --other\n    cmake --preset x\n")
        self.assertEqual(self.option_faults(), ["a.md:5: peelray render has no --other", "a.md:3: no command has --bad"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
