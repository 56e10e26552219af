#!/usr/bin/env python3
"""Names what is too long to be read at a glance: files above 500 lines, functions above 60.

    scripts/lengths.py [FOLDER...]    default: src, include and shaders of this repository

Prints one line per offender. Exit status: 0 nothing is too long; 1 something is; 2 a folder or file could not be read.
A function's lines are those from its return type (or `template`) to its closing brace. Comments before it do not count,
a lambda counts with the function that it stands in, and a macro of several lines counts as a function.
"""

import argparse
import bisect
import os
import re
import sys

FILE_LINES = 500
FUNCTION_LINES = 60
# A page that is its own program: markup, style and script in the one file that a report is made of.
LONG_FILES = {"report.html"}
CODE = {".cpp", ".h", ".glsl", ".comp", ".vert", ".tesc", ".tese", ".geom", ".frag", ".rgen", ".rmiss", ".rchit",
        ".rahit"}

# What braces may stand in without opening anything.
TEXT = re.compile(
    r"""//(?:\\\n|[^\n])* | /\*.*?\*/
      | (?P<literal>\bR"(?P<fence>[^\s()\\]*)\(.*?\)(?P=fence)" | "(?:\\.|[^"\\\n])*"
                    | (?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+')
      | (?P<directive>^[ \t]*\#(?:\\\n|//[^\n]*|/\*.*?\*/|[^\n])*)
    """, re.VERBOSE | re.DOTALL | re.MULTILINE)
LAMBDA = re.compile(r"(?:^|[=(,?:&|]|\breturn)\s*\[[^\[\]]*\]\s*(?:<[^{}]*>\s*)?(?:\(|mutable\b|$)")
# What may stand before a function: access specifiers, and calls of macros that declare something.
BEFORE_FUNCTION = re.compile(
    r"(?:(?:public|private|protected)\s*:\s*|[A-Z][A-Z0-9_]*\s*\((?:[^()]|\([^()]*\))*\)\s*\n\s*)*")
NO_FUNCTION = re.compile(r"(?:typedef\s+)?(?:struct|class|union|enum|namespace|layout|extern\s*\")\b|extern\s*\"")


class NotUnderstood(Exception):
    pass


def split(code):
    """The code with comments, literals and directives blanked, and the directives by where they begin."""
    directives = {}

    def blank(match):
        if match.group("directive") is not None:
            directives[match.start()] = match.group()
        spaces = re.sub(r"[^\n]", " ", match.group())
        return '"' + spaces[2:] + '"' if match.group("literal") is not None else spaces

    return TEXT.sub(blank, code), directives


def outside_parentheses(head):
    depth, kept = 0, []
    for character in head:
        if character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
            if character == ")" and depth == 0:
                kept.append("()")
        elif depth == 0:
            kept.append(character)
    return "".join(kept)


def opens_function(head):
    """Whether a brace that follows `head` outside of any function opens a function's body."""
    head = head[BEFORE_FUNCTION.match(head).end():]
    if LAMBDA.search(head):
        return True
    head = re.sub(r"\boperator\s*(\(\s*\)|[^\s\w(]+)", "operator", head)  # its '=' assigns nothing
    flat = outside_parentheses(head).strip()
    flat = re.sub(r"^(template\s*<.*?>\s*(?=[\w:\[]))+", "", flat, flags=re.DOTALL)
    return "()" in flat and "=" not in flat and not NO_FUNCTION.match(flat)


def name_of(head):
    found = re.search(r"((?:\w+::)*~?(?:operator\s*(?:\(\s*\)|[^\s\w(]+|[\w ]+)|\w+))\s*\(", head)
    return found.group(1) if found else "a lambda"


def functions(code):
    """The functions of a file as (name, first line, number of lines)."""
    text, directives = split(code)
    ends = [i for i, character in enumerate(text) if character == "\n"]
    line_of = lambda offset: bisect.bisect_left(ends, offset) + 1
    found = []
    # Of every open brace where its function begins: None outside of functions, -1 within one.
    stack = []
    names = {}  # of the functions that are open, by where they begin
    head, parentheses = None, 0  # where the text before the next brace begins
    branches = []  # of every #if that is open: the state where it begins, and where its first branch ends
    offset = 0
    while offset < len(text):
        if offset in directives:
            directive = directives[offset]
            word, rest = re.match(r"\s*#\s*(\w*)\s*(\w*)", directive).groups()
            if word in ("if", "ifdef", "ifndef"):
                branches.append([(stack[:], head, parentheses)])
            elif word in ("else", "elif", "endif") and branches:
                branches[-1].append((stack[:], head, parentheses))
                # Every branch begins where the first did, and what follows goes on from the end of the first.
                stack, head, parentheses = branches[-1][0 if word != "endif" else 1]
                stack = stack[:]
                if word == "endif":
                    branches.pop()
            elif word == "define" and "\n" in directive:
                found.append((rest, line_of(offset), directive.count("\n") + 1))
            offset += len(directive)
            continue
        character = text[offset]
        inside = bool(stack) and stack[-1] is not None
        parentheses += (character == "(") - (character == ")")
        if character == "{":
            if inside:
                stack.append(-1)
            elif head is not None and parentheses == 0 and opens_function(text[head:offset]):
                head += BEFORE_FUNCTION.match(text[head:offset]).end()
                names[head] = name_of(text[head:offset])
                stack.append(head)
            else:
                stack.append(None)
                head = None if parentheses == 0 else head
        elif character == "}":
            if not stack:
                raise NotUnderstood(f"line {line_of(offset)}: a brace too many is closed")
            begin = stack.pop()
            if begin is not None and begin >= 0:
                # `Name() : a{1}, b{2} {`: what has just ended was a member's value.
                if text[offset + 1:].lstrip()[:1] not in (",", "{"):
                    found.append((names[begin], line_of(begin), line_of(offset) - line_of(begin) + 1))
                    head = None
            elif not inside and parentheses == 0:
                head = None
        elif character == ";" and not inside and parentheses == 0:
            head = None
        elif head is None and not inside and not character.isspace():
            head = offset
        offset += 1
    if stack or parentheses:
        raise NotUnderstood("a brace or a parenthesis stays open")
    return found


def offenders(path):
    """A line for each thing of a file that is too long."""
    with open(path, encoding="utf-8") as file:
        code = file.read()
    path = os.path.relpath(path)
    lines = code.count("\n")
    if lines > FILE_LINES and os.path.basename(path) not in LONG_FILES:
        yield f"{path}: {lines} lines, at most {FILE_LINES}"
    if os.path.splitext(path)[1] in CODE:
        for name, first, length in functions(code):
            if length > FUNCTION_LINES:
                yield f"{path}:{first}: {name} has {length} lines, at most {FUNCTION_LINES}"


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folders", nargs="*", metavar="FOLDER",
                        default=[os.path.join(root, name) for name in ("src", "include", "shaders")])
    status = 0
    for folder in parser.parse_args().folders:
        if not os.path.isdir(folder):
            print(f"lengths: {folder}: no such folder", file=sys.stderr)
            return 2
        for place, folders, names in os.walk(folder):
            folders.sort()
            for path in (os.path.join(place, name) for name in sorted(names)):
                try:
                    for line in offenders(path):
                        print(line)
                        status = 1
                except (NotUnderstood, OSError, UnicodeDecodeError) as error:
                    print(f"lengths: {path}: {error}", file=sys.stderr)
                    return 2
    return status


if __name__ == "__main__":
    sys.exit(main())
